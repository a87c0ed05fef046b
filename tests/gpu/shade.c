// shade.c -- what surfaces send to the camera, against closed forms and integrals on the CPU.
//
// The G-buffer is made by hand: planes, of which the test says where the picture shows them. M is the world.
#include "gpu_test.h"
#include "passes/shade/shade.h"
#include "shaders/surfaces/gbuffer_edge_args.h"
#include "homogeneous.h"
#include "shaders/walls/rooms.h"
#include "shaders/common/scene_args.h"
#include "shaders/light/shadow_args.h"
#include "shaders/surfaces/surface_args.h"
#include "shaders/walls/walls_args.h"
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979;

enum { WIDTH = 24, HEIGHT = 16, MOST_SAMPLES = 4, MAP = 64, CELLS = 4, VPL_MAP = 8, GRIDS = 16 };
enum { NONE, WHOLE, SEVERAL }; // what a pixel of the G-buffer shows
enum { LIT, DARK, HALF };      // shadow maps: HALF hides what is at u > 0

typedef struct piece { // a plane
    float at[3], facet[3], normal[3], albedo[3], emission[3];
} piece;

typedef struct stage {
    tyn_shade_params params;
    struct medium_block medium;
    struct camera_block camera;
    struct env_block environment;
    struct light_block suns[TYN_LIGHTS_MAX], lights[TYN_LIGHTS_MAX];
    piece pieces[2];
    int (*shown)(double x, double y); // the piece at a place of the picture, pixels; -1: none
    int samples;                      // along each side of a pixel
    bool fog;                         // beams and radials
    float mean[3];                    // of the medium: density, or sigma_s; then sigma_a
    float scaled[3];                  // (1 - f) sigma_s
    int shadows;                      // -1: none
    struct shadow_light maps[TYN_SHADOW_MAX];
    struct radial_vpls vpls;
    int hidden_vpl; // -1: no maps
    bool lattice;   // within it are surfaces
    float moments[3][4];
    const uint32_t *rooms;
    struct surface_triangle triangles[4];
    struct surface_vertex vertices[12];
    struct surface_node node;
} stage;

static stage s; // large

static int everywhere(double x, double y)
{
    (void)x;
    (void)y;
    return 0;
}

// A camera at `at` that looks along `forward`; half as high as it is wide, about.
static void look(const float at[3], const float forward[3], float half_height, bool parallel)
{
    struct camera_block *c = &s.camera;
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

// A floor z = 0 seen from above through parallel rays, in a medium's box of 4 m.
static void start(void)
{
    memset(&s, 0, sizeof s);
    tyn_pass_defaults(&tyn_pass_shade, &s.params);
    s.params.size[0] = WIDTH;
    s.params.size[1] = HEIGHT;
    s.samples = 1;
    s.shown = everywhere;
    s.shadows = s.hidden_vpl = -1;
    for (int i = 0; i < 3; i++) {
        s.medium.extent[i] = 4;
        s.medium.voxel[i] = 4;
        s.medium.size[i] = s.medium.bricks[i] = 1;
        s.mean[i] = 1;
    }
    s.medium.max_density = 1;
    s.pieces[0] = (piece){.facet = {0, 0, 1}, .normal = {0, 0, 1}, .albedo = {0.75f, 0.5f, 0.25f}};
    look((float[]){0, 0, 3}, (float[]){0, 0, -1}, 1, true);
}

// ---- the G-buffer -----------------------------------------------------------------------------

// Where the ray through a place of the picture (pixels) meets a piece's plane; returns the distance.
static double meet(const piece *on, double x, double y, double p[3])
{
    const struct camera_block *c = &s.camera;
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

static uint32_t bits_of(float x)
{
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

// A unit vector as a place in the square [-1, 1]^2: the octahedron, its lower half folded out.
static void fold(const float n[3], float out[2])
{
    const float sum = fabsf(n[0]) + fabsf(n[1]) + fabsf(n[2]);
    for (int i = 0; i < 2; i++) {
        out[i] = n[i] / sum;
    }
    if (n[2] < 0) {
        const float x = out[0], y = out[1];
        out[0] = (1 - fabsf(y)) * (x >= 0 ? 1.0f : -1.0f);
        out[1] = (1 - fabsf(x)) * (y >= 0 ? 1.0f : -1.0f);
    }
}

// Three numbers of 18 bits with a common exponent.
static void pack(const float colour[3], uint32_t words[2])
{
    const float largest = fmaxf(colour[0], fmaxf(colour[1], colour[2]));
    int exponent = 0;
    frexpf(largest, &exponent); // largest < 2^exponent
    uint32_t c[3];
    for (int i = 0; i < 3; i++) {
        c[i] = (uint32_t)fminf(ldexpf(colour[i], 18 - exponent) + 0.5f, 262143);
    }
    words[0] = c[0] | c[2] << 18;
    words[1] = c[1] | c[2] >> 14 << 18 | (uint32_t)(exponent + 126) << 22;
}

static void unpack(const uint32_t words[2], double colour[3])
{
    const uint32_t c[3] = {words[0] & 0x3ffff, words[1] & 0x3ffff,
                           words[0] >> 18 | (words[1] >> 18 & 15) << 14};
    for (int i = 0; i < 3; i++) {
        colour[i] = ldexp((double)c[i], (int)(words[1] >> 22 & 255) - 126 - 18);
    }
}

static float distances[HEIGHT * MOST_SAMPLES][WIDTH * MOST_SAMPLES];
static uint32_t facing[HEIGHT][WIDTH][4], colours[HEIGHT][WIDTH][4], edges[HEIGHT * WIDTH];

// What pixel (x, y) shows; the pieces of its samples.
static int pixel_shows(int x, int y, int pieces[4])
{
    const int count = s.samples * s.samples;
    int first = 0, none = 0, other = 0;
    for (int k = 0; k < count; k++) {
        pieces[k] =
            s.shown(x + (k % s.samples + 0.5) / s.samples, y + (k / s.samples + 0.5) / s.samples);
        first = k ? first : pieces[k];
        none += pieces[k] < 0;
        other += pieces[k] != first;
    }
    return none == count ? NONE : other ? SEVERAL : WHOLE;
}

static uint32_t make_gbuffer(void)
{
    uint32_t num_edges = 0;
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++) {
            int pieces[4], which = 0;
            const int shows = pixel_shows(x, y, pieces), n = s.samples;
            float *row = &distances[0][0];
            for (int k = 0; k < n * n; k++) {
                const int tx = x * n + k % n, ty = y * n + k / n;
                double p[3];
                row[ty * WIDTH * n + tx] =
                    pieces[k] < 0
                        ? 0
                        : (float)meet(&s.pieces[pieces[k]], (tx + 0.5) / n, (ty + 0.5) / n, p);
                which = pieces[which] < 0 ? k : which;
            }
            memset(facing[y][x], 0, sizeof facing[y][x]);
            memset(colours[y][x], 0, sizeof colours[y][x]);
            if (shows == NONE) {
                continue;
            }
            const piece *seen = &s.pieces[pieces[which]];
            float folded[4];
            fold(seen->facet, folded);
            fold(seen->normal, folded + 2);
            for (int i = 0; i < 4; i++) {
                facing[y][x][i] = bits_of(folded[i]);
            }
            facing[y][x][2] = (facing[y][x][2] & ~3u) | (uint32_t)shows;
            facing[y][x][3] = (facing[y][x][3] & ~15u) | (uint32_t)which;
            if (shows == SEVERAL) {
                for (int k = 0; k < n * n; k++) {
                    colours[y][x][k] = (uint32_t)(pieces[k] + 1); // a piece is a triangle
                }
                edges[num_edges++] = (uint32_t)x | (uint32_t)y << 16;
                continue;
            }
            uint32_t c[3];
            for (int i = 0; i < 3; i++) {
                c[i] = (uint32_t)(seen->albedo[i] * 1048575 + 0.5f);
            }
            pack(seen->emission, colours[y][x]);
            colours[y][x][2] = c[0] | c[2] << 20;
            colours[y][x][3] = c[1] | c[2] >> 12 << 20;
        }
    }
    return num_edges;
}

// A triangle in a piece's plane, its front where the facet points.
static void make_triangle(uint32_t k)
{
    const piece *on = &s.pieces[k];
    float across[3], up[3];
    vector_crossf(on->facet, fabsf(on->facet[0]) < 0.5f ? (float[]){1, 0, 0} : (float[]){0, 1, 0},
                  across);
    vector_normalisef(across);
    vector_crossf(on->facet, across, up);
    const float corners[3][2] = {{-9, -9}, {20, -9}, {-9, 20}};
    for (int c = 0; c < 3; c++) {
        struct surface_vertex *v = &s.vertices[3 * k + (uint32_t)c];
        for (int i = 0; i < 3; i++) {
            v->position[i] = on->at[i] + corners[c][0] * across[i] + corners[c][1] * up[i];
            v->normal[i] = on->normal[i];
        }
    }
    s.triangles[k] = (struct surface_triangle){3 * k, 3 * k + 1, 3 * k + 2, k};
}

// ---- the pass ---------------------------------------------------------------------------------

static void set(tyn_ref *refs, const char *port, tyn_ref ref)
{
    *gpu_port(&tyn_pass_shade, refs, port) = ref;
}

// What virtual light k has of the medium on its ways: its grid is no other's.
static double vpl_density(uint32_t k)
{
    return 1 + 0.25 * k;
}

// The medium is the same everywhere: textures hold its mean, and depths are that times lengths in the box.
static void add_fog(gpu_test *t, tyn_ref *refs)
{
    const tyn_extent texel = {1, 1, 1};
    const bool density = s.params.mode == TYN_MEDIUM_DENSITY;
    const int channels = density ? 1 : 4;
    const float scattering[4] = {s.mean[0], s.mean[1], s.mean[2], 0};
    const float absorption[4] = {s.medium.sigma_a[0], s.medium.sigma_a[1], s.medium.sigma_a[2], 0};
    const float scaled[4] = {s.scaled[0], s.scaled[1], s.scaled[2], 0};
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
    for (uint32_t n = 0; n < s.params.num_suns; n++) {
        homogeneous_beam(&beams[n], s.medium.extent, s.suns[n].direction, n);
    }
    set(refs, "beams", gpu_buffer(t, "beams", beams, sizeof beams));
    static struct radial_block radials;
    radials = (struct radial_block){.count = s.params.num_lamps + s.vpls.count,
                                    .num_lamps = s.params.num_lamps};
    for (uint32_t n = 0; n < radials.count; n++) {
        // The order of the grids is not that of the lamps.
        const uint32_t lamp = s.params.num_lamps - 1 - n;
        struct light_block light = {.shadow = TYN_SHADOW_LAMP(lamp)};
        if (n < s.params.num_lamps) {
            memcpy(light.position, s.lights[s.params.num_directional + lamp].position,
                   sizeof light.position);
        } else {
            light = s.vpls.list[n - s.params.num_lamps];
        }
        homogeneous_radial(&radials.list[n], s.medium.extent, &light);
        radials.list[n].base[0] = ((float)n + 0.5f) / GRIDS; // a texel each
    }
    if (density) {
        float column[GRIDS];
        for (uint32_t n = 0; n < GRIDS; n++) {
            column[n] = n < s.params.num_lamps ? 1 : (float)vpl_density(n - s.params.num_lamps);
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
            const bool dark = s.shadows == DARK || (s.shadows == HALF && x % MAP >= MAP / 2);
            atlas[y][x] = dark ? 1 : 0;
        }
    }
    set(refs, "shadow_atlas",
        gpu_image(t, "shadow_atlas", TYN_IMAGE_2D, (tyn_extent){2 * MAP, MAP, 1}, 1, atlas[0]));
    set(refs, "shadows", gpu_buffer(t, "shadows", s.maps, sizeof s.maps));
}

static void add_vpls(gpu_test *t, tyn_ref *refs)
{
    set(refs, "vpls", gpu_buffer(t, "vpls", &s.vpls, sizeof s.vpls));
    if (s.hidden_vpl >= 0) {
        static float reach[VPL_MAP][16 * VPL_MAP], planes[VPL_MAP][16 * VPL_MAP][4];
        for (int y = 0; y < VPL_MAP; y++) {
            for (int x = 0; x < 16 * VPL_MAP; x++) {
                reach[y][x] = x / VPL_MAP == s.hidden_vpl ? 0.1f : 1e6f;
            }
        }
        const tyn_extent size = {16 * VPL_MAP, VPL_MAP, 1};
        set(refs, "vpl_distances", gpu_image(t, "vpl_distances", TYN_IMAGE_2D, size, 1, reach[0]));
        set(refs, "vpl_planes", gpu_image(t, "vpl_planes", TYN_IMAGE_2D, size, 4, planes[0][0]));
    }
}

static void add_lattice(gpu_test *t, tyn_ref *refs)
{
    const int channels = s.params.one_channel ? 1 : 3;
    static float moments[3 * CELLS * CELLS * CELLS][4];
    for (int i = 0; i < channels * CELLS * CELLS * CELLS; i++) {
        memcpy(moments[i], s.moments[i / (CELLS * CELLS * CELLS)], sizeof *moments);
    }
    const tyn_extent size = {CELLS, CELLS, CELLS * (uint32_t)channels};
    set(refs, "moments", gpu_image(t, "moments", TYN_IMAGE_3D, size, 4, moments[0]));
    if (s.lattice) { // without walls in its cells
        static const uint32_t links[CELLS * CELLS * CELLS];
        static const struct wall_cell cells[CELLS * CELLS * CELLS];
        set(refs, "wall_links", gpu_buffer(t, "wall_links", links, sizeof links));
        set(refs, "wall_cells", gpu_buffer(t, "wall_cells", cells, sizeof cells));
    }
    if (s.rooms) {
        const size_t words = TYN_ROOMS_SIZE(CELLS * CELLS * CELLS);
        set(refs, "rooms", gpu_buffer(t, "rooms", s.rooms, words * sizeof *s.rooms));
    }
}

static const uint32_t (*radiance)[2]; // a texel a sample

static void draw(gpu_test *t)
{
    tyn_ref refs[TYN_MAX_PORTS] = {0};
    const uint32_t num_edges = make_gbuffer();
    const struct gbuffer_edge_count count = {
        .groups = {(num_edges + GBUFFER_EDGES - 1) / GBUFFER_EDGES, 1, 1}, .count = num_edges};
    struct surface_block surfaces = {.num_triangles = 2, .num_nodes = s.params.hidden ? 1 : 0};
    struct surface_material materials[2] = {{.flags = 0}};
    for (int i = 0; i < 3; i++) {
        surfaces.to_world[i][i] = surfaces.from_world[i][i] = 1;
        for (int k = 0; k < 2; k++) {
            materials[k].albedo[i] = s.pieces[k].albedo[i];
            materials[k].emission[i] = s.pieces[k].emission[i];
            materials[k].texture = TYN_SURFACE_NO_TEXTURE;
        }
    }
    const struct surface_texture texture = {.levels = 1, .size = {1, 1}};
    const uint32_t n = (uint32_t)s.samples;
    const tyn_extent samples = {WIDTH * n, HEIGHT * n, 1}, pixels = {WIDTH, HEIGHT, 1};
    tyn_graph_begin(t->graph);
    set(refs, "medium", gpu_buffer(t, "medium", &s.medium, sizeof s.medium));
    set(refs, "camera", gpu_buffer(t, "camera", &s.camera, sizeof s.camera));
    set(refs, "environment", gpu_buffer(t, "environment", &s.environment, sizeof s.environment));
    set(refs, "suns", gpu_buffer(t, "suns", s.suns, sizeof s.suns));
    set(refs, "lights", gpu_buffer(t, "lights", s.lights, sizeof s.lights));
    set(refs, "distances", gpu_image(t, "distances", TYN_IMAGE_2D, samples, 1, distances[0]));
    set(refs, "facing", gpu_image(t, "facing", TYN_IMAGE_2D, pixels, -4, (float *)facing));
    set(refs, "colours", gpu_image(t, "colours", TYN_IMAGE_2D, pixels, -4, (float *)colours));
    set(refs, "edge_count", gpu_buffer(t, "edge_count", &count, sizeof count));
    set(refs, "edges", gpu_buffer(t, "edges", edges, sizeof edges));
    set(refs, "surfaces", gpu_buffer(t, "surfaces", &surfaces, sizeof surfaces));
    set(refs, "vertices", gpu_buffer(t, "vertices", s.vertices, sizeof s.vertices));
    set(refs, "triangles", gpu_buffer(t, "triangles", s.triangles, sizeof s.triangles));
    set(refs, "materials", gpu_buffer(t, "materials", materials, sizeof materials));
    set(refs, "textures", gpu_buffer(t, "textures", &texture, sizeof texture));
    set(refs, "texels", gpu_buffer(t, "texels", &(uint32_t){0}, 4));
    if (s.params.hidden) {
        set(refs, "nodes", gpu_buffer(t, "nodes", &s.node, sizeof s.node));
    }
    if (s.fog) {
        add_fog(t, refs);
    }
    if (s.shadows >= 0) {
        add_shadows(t, refs);
    }
    if (s.vpls.count) {
        add_vpls(t, refs);
    }
    if (s.lattice || s.params.outside) {
        add_lattice(t, refs);
    }
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_shade, &s.params, refs), TYN_OK);
    tyn_graph_output(t->graph, "radiance", *gpu_port(&tyn_pass_shade, refs, "surface_radiance"),
                     true);
    gpu_run(t);
    radiance = (const uint32_t(*)[2])gpu_map(t, "radiance");
}

// ---- what is right ----------------------------------------------------------------------------

static int pixel_x, pixel_y; // that is asked about

// Irradiance at p on a side n.
typedef void (*light_at)(const double p[3], const double n[3], double irradiance[3]);

// What is right at a sample; false: it shows nothing, or it is left out.
static bool right_at(light_at light, bool (*sure)(const double p[3]), int x, int y, double right[3])
{
    int pieces[4];
    const int n = s.samples, shows = pixel_shows(x / n, y / n, pieces);
    const int seen = pieces[y % n * n + x % n];
    memset(right, 0, 3 * sizeof *right);
    if (seen < 0) {
        const uint32_t *words = radiance[y * WIDTH * n + x];
        assert_true(words[0] == 0 && words[1] == 0);
        return false;
    }
    const piece *on = &s.pieces[seen];
    const double normal[3] = {(double)on->normal[0], (double)on->normal[1], (double)on->normal[2]};
    // A pixel on one piece is shaded in its middle.
    double p[3];
    meet(on, shows == WHOLE ? x / n + 0.5 : (x + 0.5) / n,
         shows == WHOLE ? y / n + 0.5 : (y + 0.5) / n, p);
    pixel_x = x / n;
    pixel_y = y / n;
    if (sure && !sure(p)) {
        return false;
    }
    light(p, normal, right);
    for (int i = 0; i < 3; i++) {
        right[i] = (double)on->emission[i] + (double)on->albedo[i] / pi * right[i];
    }
    return true;
}

// All samples against emission + albedo / pi irradiance, within `tolerance` of the largest channel; what is a thousandth
// of the picture's brightest counts as that. Samples for which `sure` is false are left out. Returns what all of the
// picture's light is off by, as a part of it.
static double compare(light_at light, bool (*sure)(const double p[3]), double tolerance)
{
    static double right[HEIGHT * MOST_SAMPLES * WIDTH * MOST_SAMPLES][3];
    static bool looked[HEIGHT * MOST_SAMPLES * WIDTH * MOST_SAMPLES];
    const int width = WIDTH * s.samples, count = HEIGHT * s.samples * width;
    double worst = 0, brightest = 0, sums[2] = {0, 0};
    int num_looked = 0;
    for (int i = 0; i < count; i++) {
        looked[i] = right_at(light, sure, i % width, i / width, right[i]);
        num_looked += looked[i];
        brightest = fmax(brightest, fmax(right[i][0], fmax(right[i][1], right[i][2])));
    }
    for (int i = 0; i < count; i++) {
        double found[3];
        unpack(radiance[i], found);
        const double largest = fmax(right[i][0], fmax(right[i][1], right[i][2]));
        const double unit = fmax(largest, 1e-3 * brightest);
        for (int c = 0; c < 3 && looked[i]; c++) {
            sums[0] += found[c];
            sums[1] += right[i][c];
            const double error = fabs(found[c] - right[i][c]);
            worst = fmax(worst, error / fmax(unit, 1e-30));
            if (!(error <= tolerance * unit)) {
                fail_msg("sample %d %d, channel %d: %g, not %g", i % width, i / width, c, found[c],
                         right[i][c]);
            }
        }
    }
    assert_true(num_looked > count / 10);
    const double all = sums[1] > 0 ? sums[0] / sums[1] - 1 : 0;
    print_message("within %.1e of the light, of all by %.1e, at %d samples\n", worst, all,
                  num_looked);
    return fabs(all);
}

// Length within the medium's box of the way from a to b.
static double length_in_box(const double a[3], const double b[3])
{
    return homogeneous_length(s.medium.extent, a, b);
}

// What is left after a way in the medium, of which scattering forward counts as none.
static double left_of(double length, int channel)
{
    const double g = (double)s.medium.phase[channel].g;
    const double scattering = s.params.mode == TYN_MEDIUM_DENSITY
                                  ? (1 - g * g) * (double)s.medium.sigma_s[channel]
                                  : (double)s.scaled[channel];
    return s.fog ? exp(-length * (scattering + (double)s.medium.sigma_a[channel])) : 1;
}

static void of_suns(const double p[3], const double n[3], double irradiance[3])
{
    const double facet[3] = {(double)s.pieces[0].facet[0], (double)s.pieces[0].facet[1],
                             (double)s.pieces[0].facet[2]};
    memset(irradiance, 0, 3 * sizeof *irradiance);
    for (uint32_t k = 0; k < s.params.num_suns; k++) {
        double towards[3], far[3];
        for (int i = 0; i < 3; i++) {
            towards[i] = -(double)s.suns[k].direction[i];
            far[i] = p[i] + 1e3 * towards[i];
        }
        const double cosine = vector_dot(facet, towards) > 0 ? fmax(vector_dot(n, towards), 0) : 0;
        for (int c = 0; c < 3; c++) {
            irradiance[c] +=
                (double)s.suns[k].color[c] * cosine * left_of(length_in_box(p, far), c);
        }
    }
}

static void add_sun(float x, float y, float z, float r, float g, float b)
{
    struct light_block *l = &s.suns[s.params.num_suns++];
    *l = (struct light_block){.kind = TYN_LIGHT_KIND_DIRECTIONAL, .color = {r, g, b}};
    memcpy(l->direction, (float[]){x, y, z}, sizeof l->direction);
    vector_normalisef(l->direction);
    s.lights[s.params.num_directional++] = *l;
}

// ---- suns -------------------------------------------------------------------------------------

static int right_half(double x, double y)
{
    return x + 0.1 * y > WIDTH / 2 ? 0 : -1;
}

static void suns(void **state)
{
    for (int samples = 1; samples <= 2; samples++) {
        start();
        s.samples = samples;
        piece *on = &s.pieces[0];
        memcpy(on->normal, (float[]){0.48f, 0, 0.8772685f}, sizeof on->normal);
        memcpy(on->emission, (float[]){0.01f, 0.3f, 2e-4f}, sizeof on->emission);
        make_triangle(0);
        s.shown = right_half;
        add_sun(0.3f, -0.5f, -1, 3, 2, 1);
        add_sun(-0.9f, 0.1f, -0.2f, 0.1f, 0.2f, 5);
        add_sun(-1, 0, 0.1f, 100, 100, 100);  // before the normal, but behind the facet
        add_sun(0.95f, 0, -0.1f, 70, 70, 70); // before the facet, but behind the normal
        draw(*state);
        compare(of_suns, NULL, 1e-5);
    }
}

static void suns_through_the_medium(void **state)
{
    // The floor is within the box, below it, and beside its shadow.
    const float heights[] = {1, -0.5f};
    for (int i = 0; i < 4; i++) {
        start();
        s.fog = true;
        s.params.mode = i / 2 ? TYN_MEDIUM_COEFFICIENTS : TYN_MEDIUM_DENSITY;
        for (int c = 0; c < 3; c++) {
            s.medium.sigma_s[c] = 0.1f + 0.3f * (float)c;
            s.medium.sigma_a[c] = 0.2f / (1 + (float)c);
            s.medium.phase[c].g = 0.5f;
            s.scaled[c] = 0.6f * s.medium.sigma_s[c];
            s.mean[c] = i / 2 ? s.medium.sigma_s[c] : 1;
        }
        s.pieces[0].at[2] = heights[i % 2];
        look((float[]){2, 2, 9}, (float[]){0.05f, 0, -1}, 4, true);
        add_sun(0.3f, -0.5f, -1, 3, 2, 1);
        add_sun(-0.9f, 0.1f, -0.4f, 0.5f, 2, 5);
        draw(*state);
        compare(of_suns, NULL, 1e-5);
    }
}

// The map of a sun straight above, over [-2, 2]^2, depths 1 at z = 4 and 0 at z = -4.
static const struct shadow_light sun_map = {
    .rows = {{0.5f, 0, 0, 0}, {0, 0.5f, 0, 0}, {0, 0, 0.125f, 0.5f}},
    .offset = {MAP, 0},
    .texels = MAP,
    .kind = TYN_SHADOW_SUN};

static bool far_from_the_border(const double p[3])
{
    return fabs(p[0]) > 4 * 4.0 / MAP;
}

static void of_suns_on_the_left(const double p[3], const double n[3], double irradiance[3])
{
    of_suns(p, n, irradiance);
    for (int c = 0; p[0] > 0 && c < 3; c++) {
        irradiance[c] = 0;
    }
}

static void dark(const double p[3], const double n[3], double irradiance[3])
{
    (void)p;
    (void)n;
    memset(irradiance, 0, 3 * sizeof *irradiance);
}

static void shadows_of_suns(void **state)
{
    const light_at right[] = {of_suns, dark, of_suns_on_the_left};
    for (int i = LIT; i <= HALF; i++) {
        start();
        s.shadows = i;
        s.maps[0] = sun_map;
        add_sun(0, 0, -1, 3, 2, 1);
        // Steep enough that its depth changes by much more than rounding from texel to texel.
        memcpy(s.pieces[0].facet, (float[]){0.6f, 0, 0.8f}, sizeof s.pieces[0].facet);
        memcpy(s.pieces[0].normal, s.pieces[0].facet, sizeof s.pieces[0].normal);
        draw(*state);
        compare(right[i], far_from_the_border, 1e-5);
    }
}

// ---- lamps ------------------------------------------------------------------------------------

static struct light_block *add_lamp(float x, float y, float z, float r, float g, float b)
{
    const uint32_t lamp = s.params.num_lamps++;
    struct light_block *l = &s.lights[s.params.num_directional + lamp];
    *l = (struct light_block){.kind = TYN_LIGHT_KIND_POINT,
                              .color = {r, g, b},
                              .position = {x, y, z},
                              .shadow = TYN_SHADOW_LAMP(lamp)};
    return l;
}

// Irradiance at a point.
static void of_lamps(const double p[3], const double n[3], double irradiance[3])
{
    memset(irradiance, 0, 3 * sizeof *irradiance);
    for (uint32_t k = 0; k < s.params.num_lamps; k++) {
        const struct light_block *l = &s.lights[s.params.num_directional + k];
        double towards[3], at[3], cone = 0;
        for (int i = 0; i < 3; i++) {
            at[i] = (double)l->position[i];
            towards[i] = at[i] - p[i];
        }
        const double r = vector_normalise(towards);
        for (int i = 0; i < 3; i++) {
            cone -= towards[i] * (double)l->direction[i];
        }
        const double inner = (double)l->cos_inner, outer = (double)l->cos_outer;
        const double share = fmin(fmax((cone - outer) / (inner - outer), 0), 1);
        const double lobe = l->kind == TYN_LIGHT_KIND_SPOT ? share * share : 1;
        for (int c = 0; c < 3; c++) {
            irradiance[c] += (double)l->color[c] * lobe * fmax(vector_dot(n, towards), 0) /
                             (r * r) * left_of(length_in_box(p, at), c);
        }
    }
}

// The mean over the pixel: of the picture, not of the floor.
static void of_lamps_in_pixel(const double p[3], const double n[3], double irradiance[3])
{
    enum { SIDE = 100 };
    (void)p;
    memset(irradiance, 0, 3 * sizeof *irradiance);
    for (int k = 0; k < SIDE * SIDE; k++) {
        double q[3], e[3];
        meet(&s.pieces[0], pixel_x + (k % SIDE + 0.5) / SIDE, pixel_y + (k / SIDE + 0.5) / SIDE, q);
        of_lamps(q, n, e);
        for (int c = 0; c < 3; c++) {
            irradiance[c] += e[c] / (SIDE * SIDE);
        }
    }
}

static void far_lamps(void **state)
{
    for (int fog = 0; fog < 2; fog++) {
        start();
        s.fog = fog;
        for (int c = 0; c < 3; c++) {
            s.medium.sigma_s[c] = 0.1f + 0.1f * (float)c;
            s.medium.sigma_a[c] = 0.2f;
            s.medium.phase[c].g = 0.7f;
        }
        s.pieces[0].at[2] = 0.5f;
        look((float[]){2, 2, 3}, (float[]){0.1f, 0, -1}, 0.3f, false);
        add_lamp(1, 2, 3, 1, 2, 3);
        add_lamp(2, 6, 2, 9, 1, 9);          // outside the box
        add_lamp(1, 2, 0.4f, 500, 500, 500); // below the floor
        struct light_block *spot = add_lamp(3, 3, 4, 20, 30, 10);
        spot->kind = TYN_LIGHT_KIND_SPOT;
        memcpy(spot->direction, (float[]){-0.36f, -0.48f, -0.8f}, sizeof spot->direction);
        spot->cos_inner = 0.99f;
        spot->cos_outer = 0.9f;
        draw(*state);
        compare(of_lamps, NULL, 1e-5);
    }
}

// A lamp as near as a part of a pixel's width: pixels have the mean of their light.
static void near_lamps(void **state)
{
    const double pixel = 2.0 / HEIGHT;
    for (int i = 0; i < 6; i++) {
        start();
        const bool spot = i % 3 == 2, parallel = i < 3;
        const double height = i % 3 == 1 ? 0.2 * pixel : 1.5 * pixel;
        look((float[]){0, parallel ? 0 : -1, parallel ? 3 : 1}, (float[]){0, parallel ? 0 : 1, -1},
             parallel ? 1 : 0.7f, parallel);
        struct light_block *l = add_lamp(0.31f, 0.22f, (float)height, 1, 2, 3);
        if (spot) {
            l->kind = TYN_LIGHT_KIND_SPOT;
            memcpy(l->direction, (float[]){0.6f, 0, -0.8f}, sizeof l->direction);
            l->cos_inner = 0.9f;
            l->cos_outer = 0.6f;
        }
        draw(*state);
        const double worst = !parallel ? 0.04 : spot ? 0.15 : 4e-3;
        assert_true(compare(of_lamps_in_pixel, NULL, worst) < 5e-3);
    }
}

static void of_lamps_on_the_left(const double p[3], const double n[3], double irradiance[3])
{
    of_lamps(p, n, irradiance);
    for (int c = 0; p[0] > 0 && c < 3; c++) {
        irradiance[c] = 0;
    }
}

static bool far_from_the_cones_border(const double p[3])
{
    return fabs(p[0]) > 4 * 4.0 / MAP && fabs(p[0]) < 2;
}

// A map of 90 degrees that looks down.
static void shadows_of_lamps(void **state)
{
    const light_at right[] = {of_lamps, dark, of_lamps_on_the_left};
    for (int i = LIT; i <= HALF; i++) {
        start();
        s.shadows = i;
        s.maps[TYN_SHADOW_LAMP(0)] =
            (struct shadow_light){.rows = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, -1, 2}},
                                  .texels = MAP,
                                  .scale = 1,
                                  .near = 0.01f,
                                  .kind = TYN_SHADOW_CONE};
        add_lamp(0, 0, 2, 1, 2, 3);
        draw(*state);
        compare(right[i], far_from_the_cones_border, 1e-5);
    }
}

// ---- virtual point lights ---------------------------------------------------------------------

// A disc that shines along `axis`, with the intensity I: that of a small one.
static void add_vpl(float x, float y, float z, const float axis[3], float radius, float intensity)
{
    struct light_block *l = &s.vpls.list[s.vpls.count++];
    *l = (struct light_block){.position = {x, y, z},
                              .kind = TYN_LIGHT_KIND_COSINE,
                              .color = {intensity, 0.5f * intensity, 2 * intensity},
                              .radius = radius,
                              .shadow = TYN_LIGHT_NO_SHADOW};
    memcpy(l->direction, axis, sizeof l->direction);
}

// Of discs parallel to the floor in closed form, of others as points.
static void of_vpls(const double p[3], const double n[3], double irradiance[3])
{
    memset(irradiance, 0, 3 * sizeof *irradiance);
    for (uint32_t k = 0; k < s.vpls.count; k++) {
        const struct light_block *l = &s.vpls.list[k];
        double away[3], axis[3], at[3];
        for (int i = 0; i < 3; i++) {
            at[i] = (double)l->position[i];
            away[i] = p[i] - at[i];
            axis[i] = (double)l->direction[i];
        }
        const double rr = vector_dot(away, away), height = vector_dot(away, axis);
        const double towards = -vector_dot(away, n), RR = (double)(l->radius * l->radius);
        const double d = rr - height * height + height * height - RR;
        const double root = sqrt(d * d + 4 * RR * height * height);
        const double disc = 2 * height * height / (root * (root + d));
        const double share = vector_dot(axis, n) < -0.9999 ? disc : height * towards / (rr * rr);
        const bool lit = height > 0 && towards > 0 && (int)k != s.hidden_vpl;
        for (int c = 0; c < 3; c++) {
            irradiance[c] += lit ? (double)l->color[c] * share *
                                       left_of(vpl_density(k) * length_in_box(p, at), c)
                                 : 0;
        }
    }
}

static const float down[3] = {0, 0, -1};

// Few lights: every pixel takes all.
static void vpls(void **state)
{
    for (int i = 0; i < 3; i++) {
        start();
        s.fog = i == 1;
        s.hidden_vpl = i == 2 ? 3 : -1;
        for (int c = 0; c < 3; c++) {
            s.medium.sigma_s[c] = 0.1f + 0.1f * (float)c;
            s.medium.sigma_a[c] = 0.2f;
            s.medium.phase[c].g = 0.7f;
        }
        s.pieces[0].at[2] = 0.5f;
        look((float[]){2, 2, 3}, (float[]){0.1f, 0, -1}, 0.5f, false);
        add_lamp(2, 2, 3, 0, 0, 0); // dark, but with a grid
        add_vpl(2, 2, 1.5f, down, 0.5f, 1);
        add_vpl(1, 3, 3.5f, (float[]){0.6f, 0, -0.8f}, 1e-3f, 9);
        add_vpl(2, 2, 3, (float[]){0, 0, 1}, 0.1f, 500); // faces the other way
        add_vpl(3, 1, 2.5f, down, 0.1f, 4);
        add_vpl(3, 1, 0.4f, (float[]){0, 0, 1}, 0.1f, 500); // below the floor
        draw(*state);
        compare(of_vpls, NULL, 1e-4);
    }
}

// Where a place of the picture has all of the pattern around it.
static bool amid_the_pattern(const double p[3])
{
    (void)p;
    const int border = s.params.pattern * s.params.step;
    return pixel_x >= border && pixel_y >= border && pixel_x < WIDTH - border &&
           pixel_y < HEIGHT - border;
}

// Many: blocks of pixels take a part, and tell each other.
static void many_vpls(void **state)
{
    const struct {
        int pattern, step, count;
        double tolerance;
    } cases[] = {{1, 1, 200, 2e-5},
                 {3, 1, 20, 3e-3},
                 {3, 1, 200, 3e-3},
                 {1, 2, 200, 3e-3},
                 {3, 2, 200, 6e-3}};
    for (int i = 0; i < 5; i++) {
        start();
        s.params.pattern = cases[i].pattern;
        s.params.step = cases[i].step;
        for (int k = 0; k < cases[i].count; k++) {
            const float x = (float)(k * 0.618034 - floor(k * 0.618034));
            add_vpl(6 * x - 3, 6 * (float)k / (float)cases[i].count - 3, 2.5f + 0.02f * (float)k,
                    (float[]){0.48f, -0.36f, -0.8f}, 1e-3f, 0.01f + 0.01f * (float)(k % 7));
        }
        draw(*state);
        compare(of_vpls, cases[i].tolerance < 1e-4 ? NULL : amid_the_pattern, cases[i].tolerance);
    }
}

// ---- edges ------------------------------------------------------------------------------------

// Nothing, then the floor, and on it a bar that is narrower than a pixel.
static int bar_on_floor(double x, double y)
{
    (void)y;
    return x < 7.5 ? -1 : x > 15.5 && x < 16 ? 1 : 0;
}

static void of_suns_and_vpls(const double p[3], const double n[3], double irradiance[3])
{
    double more[3];
    of_vpls(p, n, irradiance);
    of_suns(p, n, more);
    for (int c = 0; c < 3; c++) {
        irradiance[c] += more[c];
    }
}

static void edges_of_surfaces(void **state)
{
    for (int i = 0; i < 3; i++) {
        start();
        s.samples = 2;
        s.shown = bar_on_floor;
        s.params.step = 1 + i / 2;
        s.pieces[0].emission[1] = 0.1f;
        s.pieces[1] = (piece){.at = {0, 0, 0.5f},
                              .facet = {0.6f, 0, 0.8f},
                              .normal = {0.6f, 0, 0.8f},
                              .albedo = {0.1f, 0.9f, 0.4f},
                              .emission = {0, 0, 0.2f}};
        make_triangle(0);
        make_triangle(1);
        add_sun(0.3f, -0.5f, -1, 3, 2, 1);
        for (int k = 0; k < (i ? 5 : 0); k++) {
            add_vpl(40 + (float)k, (float)k - 3, 60, down, 1e-3f, 3000 + 500 * (float)k);
        }
        draw(*state);
        compare(of_suns_and_vpls, NULL, i ? 2e-3 : 1e-5);
        // The number of its piece is beside a sample's radiance, for what makes pixels of samples.
        for (int y = 0; y < 2 * HEIGHT; y++) {
            const uint32_t *floor = radiance[y * 2 * WIDTH + 30], *bar = floor + 2;
            assert_true(floor[1] >> 30 == 0 && bar[1] >> 30 == 1);
        }
    }
}

// ---- the sky and the lattice ------------------------------------------------------------------

static void of_sky(const double p[3], const double n[3], double irradiance[3])
{
    (void)p;
    (void)n;
    for (int c = 0; c < 3; c++) {
        irradiance[c] = pi * (double)s.environment.sky[c];
    }
}

static void sky(void **state)
{
    start();
    s.params.sky = 1;
    memcpy(s.environment.sky, (float[]){0.5f, 1, 2}, sizeof s.environment.sky);
    draw(*state);
    compare(of_sky, NULL, 1e-5);
}

// Radiance that is linear in direction, (phi + 3 w.F) / 4 pi, on a plane: phi / 4 - F.n / 2.
static void of_moments(const double p[3], const double n[3], double irradiance[3])
{
    (void)p;
    for (int c = 0; c < 3; c++) {
        const float *m = s.moments[s.params.one_channel ? 0 : c];
        double flux = 0;
        for (int i = 0; i < 3; i++) {
            flux += (double)m[1 + i] * n[i];
        }
        irradiance[c] = (0.25 * (double)m[0] - 0.5 * flux) *
                        (s.params.one_channel ? (double)s.params.tint[c] : 1);
    }
}

static void light_of_the_lattice(void **state)
{
    for (int i = 0; i < 4; i++) {
        start();
        s.lattice = true;
        s.params.one_channel = i / 2;
        s.params.step = 1 + i % 2;
        memcpy(s.params.tint, (float[]){0.5f, 1, 2}, sizeof s.params.tint);
        memcpy(s.moments,
               (float[3][4]){{4, 0.5f, 0, -0.7f}, {3, -0.2f, 0.4f, 0}, {9, 0, 0.5f, 0.5f}},
               sizeof s.moments);
        s.pieces[0].at[2] = 1.3f;
        memcpy(s.pieces[0].facet, (float[]){0.48f, -0.36f, 0.8f}, sizeof s.pieces[0].facet);
        memcpy(s.pieces[0].normal, s.pieces[0].facet, sizeof s.pieces[0].normal);
        look((float[]){2, 2, 9}, (float[]){0, 0, -1}, 0.5f, true);
        memcpy(s.pieces[0].at, (float[]){2, 2, 1.3f}, sizeof s.pieces[0].at);
        draw(*state);
        compare(of_moments, NULL, 2e-5);
    }
}

// A VPL lights its own room only.
static void vpls_in_rooms(void **state)
{
    start();
    s.lattice = true;
    enum { N = CELLS * CELLS * CELLS };
    static uint32_t rooms[TYN_ROOMS_SIZE(N)];
    for (int i = 0; i < N; i++) {
        rooms[TYN_ROOMS_OF_CELL(i)] = 7;
    }
    const uint32_t of_lights[] = {7, TYN_ROOMS_ANY, 8};
    memcpy(rooms + TYN_ROOMS_OF_VPL(N, 0), of_lights, sizeof of_lights);
    s.rooms = rooms;
    s.pieces[0].at[2] = 0.5f;
    look((float[]){2, 2, 3}, (float[]){0, 0, -1}, 0.5f, true);
    add_vpl(2, 2, 1.5f, down, 0.5f, 1);
    add_vpl(1, 2, 1.5f, down, 0.5f, 2);
    add_vpl(2, 1, 2.5f, down, 0.5f, 500);
    draw(*state);
    s.vpls.count = 2;
    compare(of_vpls, NULL, 1e-4);
}

// ---- what leaves the medium's box -------------------------------------------------------------

// The face x = 4 shines with the radiance F / pi: the integral over it; and the sky's mean.
static void of_face(const double p[3], const double n[3], double irradiance[3])
{
    enum { SIDE = 100 };
    double sum = 0;
    for (int k = 0; k < SIDE * SIDE; k++) {
        const double cell = (double)s.medium.extent[0] / SIDE;
        double towards[3] = {(double)s.medium.extent[0] - p[0], (k % SIDE + 0.5) * cell - p[1],
                             (k / SIDE + 0.5) * cell - p[2]};
        const double r = vector_normalise(towards);
        sum += fmax(vector_dot(n, towards), 0) * fmax(-towards[0], 0) / (r * r) * cell * cell;
    }
    of_sky(p, n, irradiance);
    for (int c = 0; c < 3; c++) {
        const double flux = s.params.one_channel ? (double)(s.moments[0][1] * s.params.tint[c])
                                                 : (double)s.moments[c][1];
        irradiance[c] += flux / pi * sum;
    }
}

// Between the face and the wall, or beyond the wall.
static void put_card(float x)
{
    const float corners[6][2] = {{-9, -9}, {13, -9}, {13, 13}, {-9, -9}, {13, 13}, {-9, 13}};
    for (uint32_t v = 0; v < 6; v++) {
        memcpy(s.vertices[v].position, (float[]){x, corners[v][0], corners[v][1]},
               sizeof s.vertices[v].position);
        const uint32_t first = v / 3 * 3;
        s.triangles[v / 3] = (struct surface_triangle){first, first + 1, first + 2, 0};
    }
    s.node = (struct surface_node){
        .lo = {x - 0.01f, -9, -9}, .hi = {x + 0.01f, 13, 13}, .first = 0, .count = 2};
}

static void light_from_the_box(void **state)
{
    for (int i = 0; i < 5; i++) {
        start();
        s.params.outside = 1;
        s.params.one_channel = i == 1;
        s.params.sky = i == 2 || i == 4;
        s.params.hidden = i >= 3;
        memcpy(s.params.tint, (float[]){0.5f, 1, 2}, sizeof s.params.tint);
        memcpy(s.moments, (float[3][4]){{9, 3}, {5, 2}, {4, 1}}, sizeof s.moments);
        if (s.params.sky) {
            memcpy(s.environment.sky, (float[]){0.05f, 0.1f, 0.02f}, sizeof s.environment.sky);
        }
        if (s.params.hidden) {
            put_card(i == 3 ? 9 : 5);
            s.params.sight_edge = 1;
            for (int k = 0; k < 3; k++) {
                s.params.sight_places[k] = 10;
                s.params.sight_lo[k] = k == 0 ? 0 : -3;
            }
        }
        // It faces the box; turned, a part of the face is below its horizon.
        piece *wall = &s.pieces[0];
        *wall = (piece){.at = {7, 2, 2}, .facet = {-0.6f, 0.8f, 0}, .albedo = {0.75f, 0.5f, 0.25f}};
        memcpy(wall->normal, wall->facet, sizeof wall->normal);
        look((float[]){5.5f, 2, 2}, (float[]){1, 0, 0}, 0.5f, true);
        draw(*state);
        compare(i < 4 ? of_face : of_sky, NULL, 1e-4);
    }
}

// ---- sunlight that was scattered forward ------------------------------------------------------

// The mean cosine of the most forward part of Henyey and Greenstein's lobe, g^2 of all that is scattered.
static double mean_cosine_forward(double g)
{
    enum { STEPS = 100000 };
    double share = 0, sum = 0;
    for (int i = 0; i < STEPS && share < g * g; i++) {
        const double mu = 1 - (i + 0.5) * 2 / STEPS, s2 = 1 + g * g - 2 * g * mu;
        const double weight = 0.5 * (1 - g * g) / (s2 * sqrt(s2)) * 2 / STEPS;
        share += weight;
        sum += weight * mu;
    }
    return sum / share;
}

// It comes from around the sun: as from a beam, and as much less directed as its mean direction is shorter than 1.
static void of_forward_light(const double p[3], const double n[3], double irradiance[3])
{
    const double g = (double)s.medium.phase[0].g, directed = mean_cosine_forward(g);
    of_moments(p, n, irradiance);
    double towards[3], far[3];
    for (int i = 0; i < 3; i++) {
        towards[i] = -(double)s.suns[0].direction[i];
        far[i] = p[i] + 1e3 * towards[i];
    }
    const double cosine = vector_dot(n, towards), length = length_in_box(p, far);
    const double wide = (0.5 + 0.5 * directed) * directed * cosine + 0.25 * (1 - directed);
    for (int c = 0; c < 3; c++) {
        const double both = left_of(length, c),
                     straight = exp(-length * (double)(s.medium.sigma_s[c] + s.medium.sigma_a[c]));
        irradiance[c] +=
            (double)s.suns[0].color[c] * (cosine * straight + wide * (both - straight));
    }
}

static void forward_light(void **state)
{
    for (int i = LIT; i <= DARK; i++) {
        start();
        s.fog = s.lattice = true;
        s.shadows = i;
        s.maps[0] = sun_map;
        s.maps[0].rows[0][0] = s.maps[0].rows[1][1] = 0.05f; // wide enough for what comes aslant
        for (int c = 0; c < 3; c++) {
            s.medium.sigma_s[c] = 0.4f + 0.2f * (float)c;
            s.medium.sigma_a[c] = 0.1f;
            s.medium.phase[c].g = 0.8f;
            s.moments[c][0] = 1e-3f;
        }
        s.pieces[0].at[2] = 0.5f;
        look((float[]){2, 2, 3}, (float[]){0, 0, -1}, 0.5f, true);
        add_sun(0, 0, -1, 3, 2, 1);
        draw(*state);
        compare(i == LIT ? of_forward_light : of_moments, NULL, i == LIT ? 2e-3 : 2e-5);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(suns),
        cmocka_unit_test(suns_through_the_medium),
        cmocka_unit_test(shadows_of_suns),
        cmocka_unit_test(far_lamps),
        cmocka_unit_test(near_lamps),
        cmocka_unit_test(shadows_of_lamps),
        cmocka_unit_test(vpls),
        cmocka_unit_test(many_vpls),
        cmocka_unit_test(edges_of_surfaces),
        cmocka_unit_test(sky),
        cmocka_unit_test(light_of_the_lattice),
        cmocka_unit_test(vpls_in_rooms),
        cmocka_unit_test(light_from_the_box),
        cmocka_unit_test(forward_light),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
