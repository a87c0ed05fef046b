// shade_stage.c -- see shade_stage.h.
#include "bound.h"
#include "shade_stage.h"
#include "homogeneous.h"
#include "shaders/walls/rooms.h"
#include "shaders/walls/walls_args.h"
#include "numbers.h"
#include <string.h>

static const double pi = 3.14159265358979;

shade_stage stage;

static int everywhere(double x, double y)
{
    (void)x;
    (void)y;
    return 0;
}

void shade_look(const float at[3], const float forward[3], float half_height, bool parallel)
{
    struct camera_block *c = &stage.camera;
    *c = (struct camera_block){.orthographic = parallel,
                               .half_height = half_height,
                               .half_width = half_height * WIDTH / HEIGHT,
                               .size = {WIDTH, HEIGHT}};
    memcpy(c->origin, at, sizeof c->origin);
    memcpy(c->forward, forward, sizeof c->forward);
    vector_normalisef(c->forward);
    vector_crossf(c->forward, (float[]){0, 1, 0}, c->right);
    vector_normalisef(c->right);
    vector_crossf(c->right, c->forward, c->up);
}

void shade_start(void)
{
    memset(&stage, 0, sizeof stage);
    tyn_pass_defaults(&tyn_pass_shade, &stage.params);
    stage.params.size[0] = WIDTH;
    stage.params.size[1] = HEIGHT;
    stage.samples = 1;
    stage.shown = everywhere;
    stage.shadows = stage.hidden_vpl = -1;
    for (int i = 0; i < 3; i++) {
        stage.medium.extent[i] = 4;
        stage.medium.voxel[i] = 4;
        stage.medium.size[i] = stage.medium.bricks[i] = 1;
        stage.mean[i] = 1;
    }
    stage.medium.max_density = 1;
    stage.pieces[0] =
        (shade_piece){.facet = {0, 0, 1}, .normal = {0, 0, 1}, .albedo = {0.75f, 0.5f, 0.25f}};
    shade_look((float[]){0, 0, 3}, (float[]){0, 0, -1}, 1, true);
}

// ---- the G-buffer -----------------------------------------------------------------------------

double shade_meet(const shade_piece *on, double x, double y, double p[3])
{
    const struct camera_block *c = &stage.camera;
    double o[3], d[3], above = 0, along = 0;
    for (int i = 0; i < 3; i++) {
        const double across = (2 * x / WIDTH - 1) * (double)c->half_width * (double)c->right[i] +
                              (1 - 2 * y / HEIGHT) * (double)c->half_height * (double)c->up[i];
        o[i] = (double)c->origin[i] + (c->orthographic ? across : 0);
        d[i] = (double)c->forward[i] + (c->orthographic ? 0 : across);
    }
    vector_normalise(d);
    for (int i = 0; i < 3; i++) {
        above += (o[i] - (double)on->at[i]) * (double)on->facet[i];
        along += d[i] * (double)on->facet[i];
    }
    for (int i = 0; i < 3; i++) {
        p[i] = o[i] - above / along * d[i];
    }
    return -above / along;
}

// Three numbers of 18 bits with a common exponent.
static void unpack(const uint32_t words[2], double colour[3])
{
    const uint32_t c[3] = {words[0] & 0x3ffff, words[1] & 0x3ffff,
                           words[0] >> 18 | (words[1] >> 18 & 15) << 14};
    for (int i = 0; i < 3; i++) {
        colour[i] = ldexp((double)c[i], (int)(words[1] >> 22 & 255) - 126 - 18);
    }
}

// Of one of two groups: a distance of 20 bits, and three numbers of 12 bits with a common exponent.
static void unpack_half(const uint32_t words[2], double colour[3], double *distance)
{
    const uint32_t c[3] = {words[0] >> 20, words[1] & 0xfff, words[1] >> 12 & 0xfff};
    for (int i = 0; i < 3; i++) {
        colour[i] = ldexp((double)c[i], (int)(words[1] >> 24) - 126 - 12);
    }
    const uint32_t bits = (words[0] & 0xfffff) << 11;
    float x;
    memcpy(&x, &bits, sizeof x);
    *distance = (double)x;
}

// gbuffer.glsl
static const uint32_t several_bit = 0x80000000u, mixed_bit = 0x40000000u, second_bit = 0x20000000u;
enum { SEEN = 2 }; // the first triangle that is seen; those before it hide light

static uint32_t texels[HEIGHT * MOST_SAMPLES * WIDTH * MOST_SAMPLES];

// What pixel (x, y) shows; the pieces of its samples.
static int pixel_shows(int x, int y, int pieces[4])
{
    const int count = stage.samples * stage.samples;
    int first = 0, none = 0, other = 0;
    for (int k = 0; k < count; k++) {
        pieces[k] = stage.shown(x + (k % stage.samples + 0.5) / stage.samples,
                                y + (k / stage.samples + 0.5) / stage.samples);
        first = k ? first : pieces[k];
        none += pieces[k] < 0;
        other += pieces[k] != first;
    }
    return none == count ? NONE : other ? SEVERAL : WHOLE;
}

static uint32_t *texel_of(int x, int y, int k)
{
    const int n = stage.samples;
    return &texels[(y * n + k / n) * WIDTH * n + x * n + k % n];
}

static void make_gbuffer(void)
{
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        int pieces[4], first = -1;
        const int x = i % WIDTH, y = i / WIDTH;
        const int shows = pixel_shows(x, y, pieces);
        for (int k = 0; k < stage.samples * stage.samples; k++) {
            first = first < 0 ? pieces[k] : first;
            *texel_of(x, y, k) = pieces[k] < 0 ? 0 : (uint32_t)(pieces[k] + 1 + SEEN);
            *texel_of(x, y, k) |= pieces[k] >= 0 && pieces[k] != first ? second_bit : 0;
        }
        *texel_of(x, y, 0) |= shows == SEVERAL ? several_bit | mixed_bit : 0;
    }
}

// Triangle `t`, in the plane of piece `k`.
static void make_triangle(uint32_t t, uint32_t k)
{
    const shade_piece *on = &stage.pieces[k];
    float across[3], up[3];
    vector_crossf(on->facet, fabsf(on->facet[0]) < 0.5f ? (float[]){1, 0, 0} : (float[]){0, 1, 0},
                  across);
    vector_normalisef(across);
    vector_crossf(on->facet, across, up);
    const float corners[3][2] = {{-9, -9}, {20, -9}, {-9, 20}};
    for (int c = 0; c < 3; c++) {
        struct surface_vertex *v = &stage.vertices[3 * t + (uint32_t)c];
        for (int i = 0; i < 3; i++) {
            v->position[i] = on->at[i] + corners[c][0] * across[i] + corners[c][1] * up[i];
            v->normal[i] = on->normal[i];
        }
    }
    stage.triangles[t] = (struct surface_triangle){3 * t, 3 * t + 1, 3 * t + 2, k};
}

void shade_triangle(uint32_t k)
{
    make_triangle(k, k);
}

// ---- the pass ---------------------------------------------------------------------------------

static void set(tyn_ref *refs, const char *port, tyn_ref ref)
{
    *gpu_port(&tyn_pass_shade, refs, port) = ref;
}

double shade_vpl_density(uint32_t k)
{
    return 1 + 0.25 * k;
}

// The medium is the same everywhere: textures hold its mean, and depths are that times lengths in the box.
static void add_fog(gpu_test *t, tyn_ref *refs)
{
    const tyn_extent texel = {1, 1, 1};
    const bool density = stage.params.mode == TYN_MEDIUM_DENSITY;
    const int channels = density ? 1 : 4;
    const float scattering[4] = {stage.mean[0], stage.mean[1], stage.mean[2], 0};
    const float absorption[4] = {stage.medium.sigma_a[0], stage.medium.sigma_a[1],
                                 stage.medium.sigma_a[2], 0};
    const float scaled[4] = {stage.scaled[0], stage.scaled[1], stage.scaled[2], 0};
    const char *const names[2][3] = {{"column", "tau_a", "tau_p"},
                                     {"radial_column", "radial_tau_a", "radial_tau_p"}};
    for (int i = 0; i < 2; i++) {
        if (!density || i == 0) {
            set(refs, names[i][0],
                gpu_image(t, names[i][0], TYN_IMAGE_3D, texel, channels, scattering));
        }
        if (!density) {
            set(refs, names[i][1],
                gpu_image(t, names[i][1], TYN_IMAGE_3D, texel, channels, absorption));
            set(refs, names[i][2],
                gpu_image(t, names[i][2], TYN_IMAGE_3D, texel, channels, scaled));
        }
    }
    struct beam_block beams[TYN_BEAM_MAX_SUNS] = {{.light = 0}};
    for (uint32_t n = 0; n < stage.params.num_suns; n++) {
        homogeneous_beam(&beams[n], stage.medium.extent, stage.suns[n].direction, n);
    }
    set(refs, "beams", gpu_buffer(t, "beams", beams, sizeof beams));
    static struct radial_block radials;
    radials = (struct radial_block){.count = stage.params.num_lamps + stage.vpls.count,
                                    .num_lamps = stage.params.num_lamps};
    for (uint32_t n = 0; n < radials.count; n++) {
        // The order of the grids is not that of the lamps.
        const uint32_t lamp = stage.params.num_lamps - 1 - n;
        struct light_block light = {.shadow = TYN_SHADOW_LAMP(lamp)};
        if (n < stage.params.num_lamps) {
            memcpy(light.position, stage.lights[stage.params.num_directional + lamp].position,
                   sizeof light.position);
        } else {
            light = stage.vpls.list[n - stage.params.num_lamps];
        }
        homogeneous_radial(&radials.list[n], stage.medium.extent, &light);
        radials.list[n].base[0] = ((float)n + 0.5f) / GRIDS; // a texel each
    }
    if (density) {
        float column[GRIDS];
        for (uint32_t n = 0; n < GRIDS; n++) {
            column[n] = n < stage.params.num_lamps
                            ? 1
                            : (float)shade_vpl_density(n - stage.params.num_lamps);
        }
        set(refs, "radial_column",
            gpu_image(t, "radial_column", TYN_IMAGE_3D, (tyn_extent){GRIDS, 1, 1}, 1, column));
    }
    set(refs, "radials", gpu_buffer(t, "radials", &radials, sizeof radials));
}

// Two maps of MAP texels beside each other, the same in both: those of suns are the right one.
static void add_shadows(gpu_test *t, tyn_ref *refs)
{
    static float atlas[MAP][2 * MAP];
    for (int y = 0; y < MAP; y++) {
        for (int x = 0; x < 2 * MAP; x++) {
            const bool dark =
                stage.shadows == DARK || (stage.shadows == HALF && x % MAP >= MAP / 2);
            atlas[y][x] = dark ? 1 : 0;
        }
    }
    set(refs, "shadow_atlas",
        gpu_image(t, "shadow_atlas", TYN_IMAGE_2D, (tyn_extent){2 * MAP, MAP, 1}, 1, atlas[0]));
    set(refs, "shadows", gpu_buffer(t, "shadows", stage.maps, sizeof stage.maps));
}

static void add_vpls(gpu_test *t, tyn_ref *refs)
{
    set(refs, "vpls", gpu_buffer(t, "vpls", &stage.vpls, sizeof stage.vpls));
    if (stage.hidden_vpl >= 0) {
        static float reach[VPL_MAP][16 * VPL_MAP], planes[VPL_MAP][16 * VPL_MAP][4];
        for (int y = 0; y < VPL_MAP; y++) {
            for (int x = 0; x < 16 * VPL_MAP; x++) {
                reach[y][x] = x / VPL_MAP == stage.hidden_vpl ? 0.1f : 1e6f;
            }
        }
        const tyn_extent size = {16 * VPL_MAP, VPL_MAP, 1};
        set(refs, "vpl_distances", gpu_image(t, "vpl_distances", TYN_IMAGE_2D, size, 1, reach[0]));
        set(refs, "vpl_planes", gpu_image(t, "vpl_planes", TYN_IMAGE_2D, size, 4, planes[0][0]));
    }
}

static void add_lattice(gpu_test *t, tyn_ref *refs)
{
    const int channels = stage.params.one_channel ? 1 : 3;
    static float moments[3 * CELLS * CELLS * CELLS][4];
    for (int i = 0; i < channels * CELLS * CELLS * CELLS; i++) {
        memcpy(moments[i], stage.moments[i / (CELLS * CELLS * CELLS)], sizeof *moments);
    }
    const tyn_extent size = {CELLS, CELLS, CELLS * (uint32_t)channels};
    set(refs, "moments", gpu_image(t, "moments", TYN_IMAGE_3D, size, 4, moments[0]));
    if (stage.lattice) { // without walls in its cells
        static const uint32_t links[CELLS * CELLS * CELLS];
        static const struct wall_cell cells[CELLS * CELLS * CELLS];
        set(refs, "wall_links", gpu_buffer(t, "wall_links", links, sizeof links));
        set(refs, "wall_cells", gpu_buffer(t, "wall_cells", cells, sizeof cells));
    }
    if (stage.rooms) {
        const size_t words = TYN_ROOMS_SIZE(CELLS * CELLS * CELLS);
        set(refs, "rooms", gpu_buffer(t, "rooms", stage.rooms, words * sizeof *stage.rooms));
    }
}

static const uint32_t (*shade_light)[4];
static double sample_radiance[HEIGHT * MOST_SAMPLES * WIDTH * MOST_SAMPLES][3];
static bool sample_coarse[HEIGHT * MOST_SAMPLES * WIDTH * MOST_SAMPLES]; // the pixel has two groups

// What samples have of the pixels' texels.
static void spread(const uint32_t (*light)[4])
{
    const int n = stage.samples;
    for (int i = 0; i < WIDTH * n * HEIGHT * n; i++) {
        const int x = i % (WIDTH * n) / n, y = i / (WIDTH * n) / n;
        bool two = false;
        for (int k = 0; k < n * n; k++) {
            two |= (*texel_of(x, y, k) & second_bit) != 0;
        }
        const uint32_t *texel = light[y * WIDTH + x];
        sample_coarse[i] = two;
        if (!(texels[i] & ~(several_bit | mixed_bit))) {
            memset(sample_radiance[i], 0, sizeof *sample_radiance);
        } else if (two) {
            double distance;
            unpack_half(texel + (texels[i] & second_bit ? 2 : 0), sample_radiance[i], &distance);
        } else {
            unpack(texel, sample_radiance[i]);
        }
    }
}

double shade_group_distance(int x, int y, int group)
{
    double colour[3], distance;
    unpack_half(shade_light[y * WIDTH + x] + 2 * group, colour, &distance);
    return distance;
}

void shade_draw(gpu_test *t)
{
    tyn_ref refs[TYN_MAX_PORTS] = {0};
    make_gbuffer();
    for (uint32_t k = 0; k < 2; k++) {
        const shade_piece *on = &stage.pieces[k];
        if (vector_dotf(on->facet, on->facet) > 0) {
            make_triangle(SEEN + k, k);
        }
    }
    stage.params.samples = (uint32_t)stage.samples;
    struct surface_block surfaces = {.num_triangles = 2, .num_nodes = stage.params.hidden ? 1 : 0};
    struct surface_material materials[2] = {{.flags = 0}};
    for (int i = 0; i < 3; i++) {
        surfaces.to_world[i][i] = surfaces.from_world[i][i] = 1;
        for (int k = 0; k < 2; k++) {
            materials[k].albedo[i] = stage.pieces[k].albedo[i];
            materials[k].emission[i] = stage.pieces[k].emission[i];
            materials[k].texture = TYN_SURFACE_NO_TEXTURE;
        }
    }
    const struct surface_texture texture = {.levels = 1, .size = {1, 1}};
    const uint32_t n = (uint32_t)stage.samples;
    const tyn_extent samples = {WIDTH * n, HEIGHT * n, 1};
    tyn_graph_begin(t->graph);
    set(refs, "medium", gpu_buffer(t, "medium", &stage.medium, sizeof stage.medium));
    set(refs, "camera", gpu_buffer(t, "camera", &stage.camera, sizeof stage.camera));
    set(refs, "environment",
        gpu_buffer(t, "environment", &stage.environment, sizeof stage.environment));
    set(refs, "suns", gpu_buffer(t, "suns", stage.suns, sizeof stage.suns));
    set(refs, "lights", gpu_buffer(t, "lights", stage.lights, sizeof stage.lights));
    set(refs, "seen", gpu_image(t, "seen", TYN_IMAGE_2D, samples, -2, (const float *)texels));
    set(refs, "surfaces", gpu_buffer(t, "surfaces", &surfaces, sizeof surfaces));
    set(refs, "vertices", gpu_buffer(t, "vertices", stage.vertices, sizeof stage.vertices));
    set(refs, "triangles", gpu_buffer(t, "triangles", stage.triangles, sizeof stage.triangles));
    set(refs, "materials", gpu_buffer(t, "materials", materials, sizeof materials));
    set(refs, "textures", gpu_buffer(t, "textures", &texture, sizeof texture));
    set(refs, "texels", gpu_buffer(t, "texels", &(uint32_t){0}, 4));
    if (stage.params.hidden) {
        set(refs, "nodes", gpu_buffer(t, "nodes", &stage.node, sizeof stage.node));
    }
    if (stage.fog) {
        add_fog(t, refs);
    }
    if (stage.shadows >= 0) {
        add_shadows(t, refs);
    }
    if (stage.vpls.count) {
        add_vpls(t, refs);
    }
    if (stage.lattice || stage.params.outside) {
        add_lattice(t, refs);
    }
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_shade, &stage.params, refs), TYN_OK);
    tyn_graph_output(t->graph, "radiance", *gpu_port(&tyn_pass_shade, refs, "surface_radiance"),
                     true);
    gpu_run(t);
    shade_light = (const uint32_t(*)[4])gpu_map(t, "radiance");
    spread(shade_light);
}

// ---- what is right ----------------------------------------------------------------------------

int shade_x, shade_y;

// What is right at a sample; false: it shows nothing, or it is left out.
static bool right_at(shade_light_at light, bool (*sure)(const double p[3]), int x, int y,
                     double right[3])
{
    int pieces[4];
    const int n = stage.samples, shows = pixel_shows(x / n, y / n, pieces);
    const int seen = pieces[y % n * n + x % n];
    memset(right, 0, 3 * sizeof *right);
    if (seen < 0) {
        if (shows == NONE) {
            const uint32_t *texel = shade_light[y / n * WIDTH + x / n];
            assert_true(texel[0] == 0 && (texel[1] & 0x3fffff) == 0 && texel[2] == 0);
        }
        return false;
    }
    const shade_piece *on = &stage.pieces[seen];
    const double normal[3] = {(double)on->normal[0], (double)on->normal[1], (double)on->normal[2]};
    // A pixel on one piece is shaded in its middle.
    double p[3];
    shade_meet(on, shows == WHOLE ? x / n + 0.5 : (x + 0.5) / n,
               shows == WHOLE ? y / n + 0.5 : (y + 0.5) / n, p);
    shade_x = x / n;
    shade_y = y / n;
    if (sure && !sure(p)) {
        return false;
    }
    light(p, normal, right);
    for (int i = 0; i < 3; i++) {
        right[i] = (double)on->emission[i] + (double)on->albedo[i] / pi * right[i];
    }
    return true;
}

static int stage_checks; // told apart by their order

double shade_compare(shade_light_at light, bool (*sure)(const double p[3]), double tolerance)
{
    static double right[HEIGHT * MOST_SAMPLES * WIDTH * MOST_SAMPLES][3];
    static bool looked[HEIGHT * MOST_SAMPLES * WIDTH * MOST_SAMPLES];
    const int width = WIDTH * stage.samples, count = HEIGHT * stage.samples * width;
    double worst = 0, brightest = 0, sums[2] = {0, 0};
    int num_looked = 0;
    for (int i = 0; i < count; i++) {
        looked[i] = right_at(light, sure, i % width, i / width, right[i]);
        num_looked += looked[i];
        brightest = maximum(brightest, maximum(right[i][0], maximum(right[i][1], right[i][2])));
    }
    for (int i = 0; i < count; i++) {
        const double *found = sample_radiance[i];
        const double largest = fmax(right[i][0], fmax(right[i][1], right[i][2]));
        const double unit = fmax(largest, 1e-3 * brightest);
        for (int c = 0; c < 3 && looked[i]; c++) {
            sums[0] += found[c];
            sums[1] += right[i][c];
            const double error = fabs(found[c] - right[i][c]);
            // Of two groups there are 12 bits, which is no fault of the light's.
            const double coarse = sample_coarse[i] ? ldexp(unit, -12) : 0;
            worst = maximum(worst, (error - coarse) / fmax(unit, 1e-30));
            if (!(error <= tolerance * unit + coarse)) {
                fail_msg("sample %d %d, channel %d: %g, not %g", i % width, i / width, c, found[c],
                         right[i][c]);
            }
        }
    }
    assert_true(num_looked > count / 10);
    assert_true(tolerance <= 1e-4 || within(worst, tolerance, NULL, "shading %d", stage_checks++));
    const double all = sums[1] > 0 ? sums[0] / sums[1] - 1 : 0;
    print_message("within %.1e of the light, of all by %.1e, at %d samples\n", worst, all,
                  num_looked);
    return fabs(all);
}
