// lpv_scatter.c -- light that scatters first on rays of suns and lamps: as much as Beer's law says, the same each time.
#include "bound.h"
#include "gpu_test.h"
#include "homogeneous.h"
#include "passes/lpv/lpv_scatter/lpv_scatter.h"
#include "shaders/common/counters.h"
#include "shaders/common/scene_args.h"
#include "numbers.h"
#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

enum { CELLS = 8, N = CELLS * CELLS * CELLS };

typedef struct stage {
    struct medium_block medium;
    struct beam_block beams[TYN_BEAM_MAX_SUNS];
    struct radial_block radials;
    struct light_block suns[TYN_LIGHTS_MAX];
    tyn_lpv_scatter_params params;
    bool shadows;
} stage;

static stage s; // large

typedef struct sums {
    float unit;
    uint32_t pad[3];
    int32_t power[3 * N][4];
} sums;

static void start(float sigma_s)
{
    memset(&s, 0, sizeof s);
    tyn_pass_defaults(&tyn_pass_lpv_scatter, &s.params);
    s.params.shape =
        (tyn_lattice_shape){.extent = {2, 2, 2}, .cells = CELLS, .channels = 3, .tint = {1, 1, 1}};
    s.medium.max_density = 1;
    for (int i = 0; i < 3; i++) {
        s.medium.extent[i] = s.medium.voxel[i] = 2;
        s.medium.size[i] = 1;
        s.medium.sigma_s[i] = sigma_s * (float)(1 + i);
        s.medium.sigma_a[i] = 0.1f;
    }
}

static float majorant_of(void)
{
    return s.medium.sigma_s[2] + s.medium.sigma_a[2];
}

static const sums *run(gpu_test *t)
{
    const tyn_pass_desc *pass = &tyn_pass_lpv_scatter;
    static const float one = 1;
    const tyn_extent texel = {1, 1, 1};
    tyn_ref refs[TYN_MAX_PORTS] = {{0}};
    tyn_graph_begin(t->graph);
    *gpu_port(pass, refs, "medium") = gpu_buffer(t, "medium", &s.medium, sizeof s.medium);
    *gpu_port(pass, refs, "density") = gpu_image(t, "density", TYN_IMAGE_3D, texel, 1, &one);
    *gpu_port(pass, refs, "lights") = gpu_buffer(t, "lights", s.suns, sizeof s.suns);
    *gpu_port(pass, refs, "beams") = gpu_buffer(t, "beams", s.beams, sizeof s.beams);
    *gpu_port(pass, refs, "column") = gpu_image(t, "column", TYN_IMAGE_3D, texel, 1, &one);
    *gpu_port(pass, refs, "radials") = gpu_buffer(t, "radials", &s.radials, sizeof s.radials);
    *gpu_port(pass, refs, "radial_column") = gpu_image(t, "means", TYN_IMAGE_3D, texel, 1, &one);
    if (s.shadows) { // of the sun along -y: a roof over x < 1 at the height 1.5
        enum { MAP = 64 };
        struct shadow_light maps[TYN_SHADOW_MAX] = {{.kind = TYN_SHADOW_NONE}};
        maps[0] = (struct shadow_light){
            .rows = {{0.5f, 0, 0, -0.5f}, {0, 0, 0.5f, -0.5f}, {0, 0.25f, 0, 0.25f}},
            .texels = MAP,
            .kind = TYN_SHADOW_SUN};
        static float atlas[MAP][MAP];
        for (int i = 0; i < MAP * MAP; i++) {
            atlas[i / MAP][i % MAP] = i % MAP < MAP / 2 ? 0.25f * 1.5f + 0.25f : 0;
        }
        *gpu_port(pass, refs, "shadow_atlas") =
            gpu_image(t, "atlas", TYN_IMAGE_2D, (tyn_extent){MAP, MAP, 1}, 1, atlas[0]);
        *gpu_port(pass, refs, "shadows") = gpu_buffer(t, "shadows", maps, sizeof maps);
    }
    assert_int_equal(tyn_graph_add(t->graph, pass, &s.params, refs), TYN_OK);
    tyn_graph_output(t->graph, "scattered", *gpu_port(pass, refs, "scattered"), true);
    tyn_graph_output(t->graph, "counters", *gpu_port(pass, refs, "counters"), true);
    gpu_run(t);
    assert_int_equal(gpu_non_finite(t), 0);
    return gpu_map(t, "scattered");
}

static double sum_of(const sums *found, uint32_t ch)
{
    double sum = 0;
    for (uint32_t i = 0; i < N; i++) {
        sum += (double)found->unit * found->power[ch * N + i][0];
    }
    return sum;
}

static void set_sun(float x, float y, float z)
{
    const float r = sqrtf(x * x + y * y + z * z), d[3] = {x / r, y / r, z / r};
    s.suns[0] = (struct light_block){.kind = TYN_LIGHT_KIND_DIRECTIONAL,
                                     .color = {3, 2, 1},
                                     .mean_cosine = 1,
                                     .shadow = TYN_LIGHT_NO_SHADOW};
    memcpy(s.suns[0].direction, d, sizeof d);
    homogeneous_beam(&s.beams[0], s.medium.extent, d, 0);
}

// Of the sun straight down a box of 2 m: E A albedo (1 - e^-tau), also behind a roof's edge; twice the same bytes.
static void sun(void **state)
{
    const double edge =
        1 +
        0.5 * 4 / 64; // half a texel farther than the roof reaches: all four texels must be free
    for (int k = 0; k < 2; k++) {
        start(0.3f);
        s.shadows = k;
        set_sun(0, -1, 0);
        tyn_lpv_scatter_plan(&s.params, s.medium.extent, majorant_of(), s.suns, 1, NULL, 0);
        static sums first;
        memcpy(&first, run(*state), sizeof first);
        assert_memory_equal(&first, run(*state), sizeof first);
        for (uint32_t ch = 0; ch < 3; ch++) {
            const double sigma_s = (double)s.medium.sigma_s[ch], sigma_t = sigma_s + 0.1;
            const double full = sigma_s / sigma_t * (1 - exp(-2 * sigma_t)),
                         above = sigma_s / sigma_t * (1 - exp(-0.5 * sigma_t));
            const double expected = (double)s.suns[0].color[ch] *
                                    (k ? 2 * (edge * above + (2 - edge) * full) : 4 * full);
            assert_within(fabs(sum_of(&first, ch) / expected - 1), 3.9e-4, NULL);
        }
        for (uint32_t i = 0; k && i < N; i++) { // dark under the roof
            if (i % CELLS < 4 && i / CELLS % CELLS < 6) {
                assert_int_equal(first.power[i][0], 0);
            }
        }
    }
}

// A slanting one loses what its beam loses on all ways through the box; a lamp in the middle what it loses in all
// directions.
static void others(void **state)
{
    start(0.3f);
    set_sun(1, -2, 0.5f);
    tyn_lpv_scatter_plan(&s.params, s.medium.extent, majorant_of(), s.suns, 1, NULL, 0);
    double slanting = sum_of(run(*state), 0), expected = 0;
    const double sigma_t = 0.4;
    for (int face = 0; face < 3; face++) { // where it leaves
        const float *d = s.suns[0].direction;
        enum { M = 400 };
        for (int i = 0; i < M * M; i++) {
            double p[3] = {0}, o[3];
            p[face] = d[face] > 0 ? 2 : 0;
            p[(face + 1) % 3] = 2 * (i % M + 0.5) / M;
            p[(face + 2) % 3] = 2 * (i / M + 0.5) / M;
            for (int a = 0; a < 3; a++) {
                o[a] = p[a] - 10 * (double)d[a];
            }
            const double way = homogeneous_length(s.medium.extent, o, p);
            expected += 4.0 / M / M * fabs((double)d[face]) * 3 * 0.75 * (1 - exp(-sigma_t * way));
        }
    }
    assert_within(fabs(slanting / expected - 1), 1.5e-4, NULL);

    start(0.3f);
    const struct light_block lamp = {.position = {1.1f, 0.9f, 1.2f},
                                     .kind = TYN_LIGHT_KIND_POINT,
                                     .color = {1, 1, 1},
                                     .direction = {0, 0, -1},
                                     .cos_inner = -1,
                                     .cos_outer = -1,
                                     .shadow = TYN_SHADOW_LAMP(0)};
    homogeneous_radial(&s.radials.list[0], s.medium.extent, &lamp);
    s.radials.count = s.radials.num_lamps = 1;
    tyn_lpv_scatter_plan(&s.params, s.medium.extent, majorant_of(), NULL, 0, &lamp, 1);
    assert_int_equal(s.params.num_bundles, 6);
    const double found = sum_of(run(*state), 0);
    expected = 0;
    enum { M = 200 };
    for (int i = 0; i < M * 2 * M; i++) {
        const double c = 1 - 2 * (i / (2 * M) + 0.5) / M, phi = PI * (i % (2 * M) + 0.5) / M;
        const double r = sqrt(1 - c * c),
                     o[3] = {(double)lamp.position[0], (double)lamp.position[1],
                             (double)lamp.position[2]};
        const double p[3] = {o[0] + 10 * r * cos(phi), o[1] + 10 * r * sin(phi), o[2] + 10 * c};
        expected += 4 * PI / (2.0 * M * M) * 0.75 *
                    (1 - exp(-sigma_t * homogeneous_length(s.medium.extent, o, p)));
    }
    assert_within(fabs(found / expected - 1), 1.5e-4, NULL);
}

// Where a ray's sample brings far less than a unit of a sum over all rays of all lights: in thin media, with many rays, of a weak
// lamp beside a sun.
static void faint(void **state)
{
    const struct light_block lamp = {.position = {1, 1, 1},
                                     .kind = TYN_LIGHT_KIND_POINT,
                                     .color = {3e-4f, 2e-4f, 1e-4f},
                                     .direction = {0, 0, -1},
                                     .cos_inner = -1,
                                     .cos_outer = -1,
                                     .shadow = TYN_SHADOW_LAMP(0)};
    for (int k = 0; k < 4; k++) {
        const bool with_sun = k != 2, with_lamp = k >= 2;
        start(k == 0 ? 1e-5f : 1e-3f);
        s.params.sun_texels = k == 1 ? 1024 : 256;
        s.medium.sigma_a[0] = s.medium.sigma_a[1] = s.medium.sigma_a[2] = 1e-6f;
        set_sun(0, -1, 0);
        homogeneous_radial(&s.radials.list[0], s.medium.extent, &lamp);
        s.radials.count = s.radials.num_lamps = with_lamp;
        tyn_lpv_scatter_plan(&s.params, s.medium.extent, majorant_of(), s.suns, with_sun, &lamp,
                             with_lamp);
        static sums first;
        memcpy(&first, run(*state), sizeof first);
        assert_memory_equal(&first, run(*state), sizeof first);
        // Deposits are rounded to units at random: half a unit each.
        double samples = 0;
        for (uint32_t b = 0; b < s.params.num_bundles; b++) {
            samples +=
                (double)s.params.bundles[b].texels * s.params.bundles[b].texels * s.params.samples;
        }
        const double noise = 0.5 * sqrt(samples) * (double)first.unit;
        for (uint32_t ch = 0; ch < 3; ch++) {
            const double sigma_s = (double)s.medium.sigma_s[ch], sigma_t = sigma_s + 1e-6;
            const double sun =
                4 * (double)s.suns[0].color[ch] * sigma_s / sigma_t * -expm1(-2 * sigma_t);
            // The mean way from the middle of a cube of 2 m to its faces is 1.22137 m.
            const double of_lamp =
                4 * PI * (double)lamp.color[ch] * sigma_s / sigma_t * -expm1(-1.22137 * sigma_t);
            const double expected = (with_sun ? sun : 0) + (with_lamp ? of_lamp : 0);
            const double off = fabs(sum_of(&first, ch) - expected);
            print_message(
                "faint %d, channel %u: %.6e W, off by %.1e, noise %.1e; the lamp's %.1e\n", k, ch,
                expected, off, noise, of_lamp);
            assert_true(off <= 5 * noise + (k == 3 ? 1e-5 : 5e-5) * expected);
        }
    }
}

// Thick cells: no sample brings more than its ray has.
static void bounded(void **state)
{
    start(1000);
    set_sun(0, -1, 0);
    s.params.samples = 1;
    tyn_lpv_scatter_plan(&s.params, s.medium.extent, majorant_of(), s.suns, 1, NULL, 0);
    const sums *found = run(*state);
    const double power = sum_of(found, 0);
    // 12 W, of which a ray brings the mean of min(2000 e^(-1000 x), 1) over its 2 m.
    const double expected = 12 * (log(2000) + 1) / 2000;
    print_message("of thick cells: %.4f W, expected %.4f\n", power, expected);
    assert_within(fabs(power / expected - 1), 0.15, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sun),
        cmocka_unit_test(others),
        cmocka_unit_test(faint),
        cmocka_unit_test(bounded),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
