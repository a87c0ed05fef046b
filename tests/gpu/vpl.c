// vpl.c -- virtual point lights: no power lost, where they should be, steady, attenuated.
#include "bound.h"
#include "gpu_test.h"
#include "passes/vpl/vpl.h"
#include "shaders/beams/radial_args.h"
#include "shaders/common/scene_args.h"
#include "shaders/surfaces/surface_args.h"
#include "numbers.h"
#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846
#define PORT(name) VPL_PORT_##name

enum { SIDE = 64, MAX_TILES = 8, HEIGHT = SIDE * MAX_TILES };

typedef struct vpl_scene {
    float flux[HEIGHT][SIDE][4], position[HEIGHT][SIDE][4], normal[HEIGHT][SIDE][4];
    struct light_block suns[TYN_LIGHTS_MAX], lights[TYN_LIGHTS_MAX];
    struct medium_block medium;
    bool fog;
    struct surface_block surfaces;
    struct surface_vertex vertices[64];
    struct surface_triangle triangles[64];
    struct surface_material materials[4];
    tyn_vpl_params params;
} vpl_scene;

static vpl_scene scene; // large

static void add_tile(uint32_t light)
{
    tyn_vpl_params *p = &scene.params;
    p->tiles[p->num_tiles] = (struct rsm_tile){{0, p->num_tiles * SIDE}, SIDE, light};
    p->num_tiles++;
}

// Tile `tile` sees a floor of 2 m x 2 m at x = 3 tile, as bright as `light` says of a place on it in [0, 1]^2.
static void fill_floor(uint32_t tile, void (*light)(double x, double y, float rgb[4]))
{
    for (uint32_t j = 0; j < SIDE; j++) {
        for (uint32_t i = 0; i < SIDE; i++) {
            double x = (i + 0.5) / SIDE, y = (j + 0.5) / SIDE;
            float *flux = scene.flux[tile * SIDE + j][i];
            light(x, y, flux);
            const float position[4] = {(float)(3 * tile + 2 * x), 0, (float)(2 * y),
                                       4.0f / (SIDE * SIDE)};
            memcpy(scene.position[tile * SIDE + j][i], position, sizeof position);
            scene.normal[tile * SIDE + j][i][1] = 1;
        }
    }
}

static void start(void)
{
    memset(&scene, 0, sizeof scene);
    tyn_pass_defaults(&tyn_pass_vpl, &scene.params);
    scene.params.num_suns = 1;
    for (int i = 0; i < 3; i++) {
        scene.surfaces.to_world[i][i] = scene.surfaces.from_world[i][i] = 1;
        scene.medium.extent[i] = scene.medium.voxel[i] = 1;
        scene.medium.size[i] = 1;
    }
    scene.suns[0].direction[1] = scene.lights[0].direction[1] = -1;
}

static const struct radial_vpls *run(gpu_test *t)
{
    tyn_ref refs[TYN_MAX_PORTS] = {0};
    tyn_graph_begin(t->graph);
    refs[PORT(MEDIUM)] = gpu_buffer(t, "medium", &scene.medium, sizeof scene.medium);
    refs[PORT(SUNS)] = gpu_buffer(t, "suns", scene.suns, sizeof scene.suns);
    refs[PORT(LIGHTS)] = gpu_buffer(t, "lights", scene.lights, sizeof scene.lights);
    const float full = 1;
    if (scene.fog) {
        refs[PORT(DENSITY)] =
            gpu_image(t, "density", TYN_IMAGE_3D, (tyn_extent){1, 1, 1}, 1, &full);
    }
    if (scene.params.num_tiles) {
        const tyn_extent size = {SIDE, HEIGHT, 1};
        refs[PORT(RSM_FLUX)] = gpu_image(t, "flux", TYN_IMAGE_2D, size, 4, scene.flux[0][0]);
        refs[PORT(RSM_POSITION)] =
            gpu_image(t, "position", TYN_IMAGE_2D, size, 4, scene.position[0][0]);
        refs[PORT(RSM_NORMAL)] = gpu_image(t, "normal", TYN_IMAGE_2D, size, 4, scene.normal[0][0]);
    }
    if (scene.params.num_triangles) {
        refs[PORT(SURFACES)] = gpu_buffer(t, "surfaces", &scene.surfaces, sizeof scene.surfaces);
        refs[PORT(VERTICES)] = gpu_buffer(t, "vertices", scene.vertices, sizeof scene.vertices);
        refs[PORT(TRIANGLES)] = gpu_buffer(t, "triangles", scene.triangles, sizeof scene.triangles);
        refs[PORT(MATERIALS)] = gpu_buffer(t, "materials", scene.materials, sizeof scene.materials);
    }
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_vpl, &scene.params, refs), TYN_OK);
    tyn_graph_output(t->graph, "vpls", refs[PORT(VPLS)], true);
    gpu_run(t);
    return gpu_map(t, "vpls");
}

// The power of all lights of `found` against what is in the maps and `emitted`.
static void check_power(const struct radial_vpls *found, const double emitted[3])
{
    assert_true(found->count > 0 && found->count <= (uint32_t)scene.params.count);
    double worst = 0;
    for (int c = 0; c < 3; c++) {
        double power = 0, expected = emitted[c];
        for (uint32_t i = 0; i < scene.params.num_tiles * SIDE * SIDE; i++) {
            expected += scene.flux[i / SIDE][i % SIDE][c];
        }
        for (uint32_t k = 0; k < found->count; k++) {
            power += PI * found->list[k].color[c];
        }
        worst = maximum(worst, fabs(power / expected - 1));
    }
    print_message("%u lights: power off by %.1e at most\n", found->count, worst);
    assert_true(worst < 1e-4);
}

static void sun_on_floor(double x, double y, float rgb[4])
{
    double bright = 1 + 0.9 * sin(7 * x) * cos(5 * y);
    rgb[0] = (float)bright;
    rgb[1] = (float)(bright * (1 - x));
    rgb[2] = (float)(0.1 + 3 * y * y);
}

static void spot_on_floor(double x, double y, float rgb[4])
{
    double r2 = (x - 0.5) * (x - 0.5) + (y - 0.4) * (y - 0.4);
    rgb[0] = r2 < 0.09 ? 40.0f : 0.0f;
    rgb[1] = rgb[2] = rgb[0] * 0.5f;
}

static void power_of_maps(void **state)
{
    const double none[3] = {0, 0, 0};
    const int32_t counts[] = {1, 3, 16, 128, 256};
    for (int i = 0; i < 5; i++) {
        start();
        scene.params.count = counts[i];
        add_tile(0);
        add_tile(4);
        fill_floor(0, sun_on_floor);
        fill_floor(1, spot_on_floor);
        const struct radial_vpls *found = run(*state);
        check_power(found, none);
        for (uint32_t k = 0; k < found->count; k++) {
            const struct light_block *l = &found->list[k];
            assert_int_equal(l->kind, TYN_LIGHT_KIND_COSINE);
            assert_true(fabsf(l->position[1]) < 1e-5f && l->direction[1] > 0.9999f);
            bool sun = l->position[0]<2.01f, spot = l->position[0]> 3.39f;
            assert_true(counts[i] < 4 || sun || spot); // none between the two
        }
        if (counts[i] >= 16) {
            // What VPLs stand for covers the floor of 4 m^2 and the spot's disc.
            double area = 0, lit = 4 + PI * 0.09 * 4;
            for (uint32_t k = 0; k < found->count; k++) {
                area += PI * found->list[k].radius * found->list[k].radius;
            }
            print_message("their discs cover %.2f of the lit area\n", area / lit);
            assert_true(area > 0.85 * lit && area < 1.05 * lit);
        }
    }
}

// Sixty-four patches, a hundred times as bright here as there, of two colours.
static void patches(double x, double y, float rgb[4])
{
    const int i = (int)(8 * x), j = (int)(8 * y);
    const double bright = pow(100, (i * 37 + j * 61) % 64 / 63.0) * 1e-4;
    rgb[0] = (float)bright;
    rgb[1] = (float)(bright * ((i ^ j) & 1 ? 0.2 : 1));
    rgb[2] = 0;
}

// Under a sky VPLs have all power in the mean over choices of places: here over numbers of VPLs, which cut other strata.
static void power_under_a_sky(void **state)
{
    enum { LEAST = 9, MOST = 72 };
    double mean[2] = {0}, all[2] = {0};
    for (int32_t count = LEAST; count <= MOST; count++) {
        start();
        scene.params.count = count;
        scene.params.sky_irradiance = 30;
        add_tile(TYN_RSM_SKY);
        fill_floor(0, patches);
        const struct radial_vpls *found = run(*state);
        for (uint32_t k = 0; k < found->count; k++) {
            const struct light_block *l = &found->list[k];
            assert_true(isfinite(l->position[0] + l->position[2] + l->radius + l->color[1]));
            assert_true(l->color[2] == 0);
            for (int c = 0; c < 2; c++) {
                mean[c] += PI * l->color[c] / (MOST - LEAST + 1);
            }
        }
    }
    for (int i = 0; i < SIDE * SIDE; i++) {
        all[0] += scene.flux[i / SIDE][i % SIDE][0];
        all[1] += scene.flux[i / SIDE][i % SIDE][1];
    }
    print_message("power under a sky: off by %+.2f, %+.2f %% in the mean\n",
                  100 * (mean[0] / all[0] - 1), 100 * (mean[1] / all[1] - 1));
    const double off = maximum(fabs(mean[0] / all[0] - 1), fabs(mean[1] / all[1] - 1));
    assert_within(off, 0.02, NULL);
    scene.params.sky_irradiance = 0; // dark, though the map is not: nothing is chosen
    assert_int_equal(run(*state)->count, 0);
}

static double slide;
static void sliding(double x, double y, float rgb[4])
{
    rgb[0] = rgb[1] = rgb[2] = (float)(1 + 0.8 * sin(9 * (x + slide)) * cos(6 * (y - slide)));
}

// A light that changes a little moves VPLs a little, at any moment.
static void steady(void **state)
{
    struct radial_vpls last = {0};
    double mean = 0, most = 0;
    const int steps = 20;
    for (int step = 0; step <= steps; step++) {
        start();
        add_tile(0);
        slide = 1e-3 * step;
        fill_floor(0, sliding);
        const struct radial_vpls *found = run(*state);
        assert_true(step == 0 || found->count == last.count);
        for (uint32_t k = 0; step && k < found->count; k++) {
            const float *a = found->list[k].position, *b = last.list[k].position;
            double moved = sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[2] - b[2]) * (a[2] - b[2]));
            mean += moved / (steps * found->count);
            most = maximum(most, moved);
        }
        last = *found;
    }
    const double spacing = sqrt(4.0 / last.count);
    print_message("a pattern moves by 2.8 mm, VPLs %.0f mm apart by %.2f mm, %.1f mm at most\n",
                  1e3 * spacing, 1e3 * mean, 1e3 * most);
    assert_within(mean, 4e-3, NULL);
    assert_within(most, 0.2 * spacing, NULL);
}

static void set_quad(uint32_t i, float x, float side, uint32_t material)
{
    const float corners[4][2] = {{0, 0}, {0, 1}, {1, 1}, {1, 0}}; // counter-clockwise from above
    for (uint32_t k = 0; k < 4; k++) {
        float *p = scene.vertices[4 * i + k].position;
        p[0] = x + side * corners[k][0];
        p[1] = 2;
        p[2] = side * corners[k][1];
    }
    scene.triangles[2 * i] = (struct surface_triangle){4 * i, 4 * i + 1, 4 * i + 2, material};
    scene.triangles[2 * i + 1] = (struct surface_triangle){4 * i, 4 * i + 2, 4 * i + 3, material};
    scene.params.num_triangles = 2 * (i + 1);
}

static void emitters(void **state)
{
    start();
    scene.params.count = 160; // of which 100 are not kept for further reflections
    scene.params.emitters = 2;
    scene.materials[1] = (struct surface_material){.emission = {2, 1, 0}};
    scene.materials[2] =
        (struct surface_material){.emission = {0, 3, 1}, .flags = TYN_SURFACE_DOUBLE_SIDED};
    set_quad(0, 0, 5, 0); // dark
    set_quad(1, 6, 2, 1);
    set_quad(2, 10, 1, 2);
    // With a sun besides.
    add_tile(0);
    fill_floor(0, sun_on_floor);
    for (int i = 0; i < SIDE * SIDE; i++) {
        for (int c = 0; c < 3; c++) {
            scene.flux[i / SIDE][i % SIDE][c] *= 1e-2f;
        }
    }
    const double emitted[3] = {PI * 4 * 2, PI * (4 * 1 + 2 * 3), PI * 2 * 1};
    const struct radial_vpls *found = run(*state);
    check_power(found, emitted);
    double up = 0, down = 0, first[3] = {0, 0, 0}, weight = 0, area = 0;
    for (uint32_t k = 0; k < found->count; k++) {
        const struct light_block *l = &found->list[k];
        if (l->position[1] < 1) {
            continue;
        }
        assert_near(l->position[1], 2, 1e-5);
        assert_true(fabsf(l->direction[1]) > 0.9999f);
        if (l->position[0] > 9) {
            *(l->direction[1] > 0 ? &up : &down) += l->color[1];
        } else {
            assert_true(l->direction[1] > 0 && l->position[0] > 6 && l->position[0] < 8);
            area += PI * l->radius * l->radius;
            weight += l->color[0];
            for (int c = 0; c < 3; c++) {
                first[c] += l->color[0] * l->position[c];
            }
        }
    }
    assert_within(fabs(up - 3), 0.2, NULL); // one stratum may straddle both emitters
    assert_true(fabs(down - 3) < 1e-4);
    // Evenly spread: the mean is the middle.
    assert_within(fabs(first[0] / weight - 7), 3e-4, NULL);
    assert_within(fabs(first[2] / weight - 1), 2e-3, NULL);
    print_message("discs cover %.2f of the emitter\n", area / 4);
    assert_true(area > 3.4 && area < 4.2);
}

static void one(double x, double y, float rgb[4])
{
    (void)x;
    (void)y;
    rgb[0] = rgb[1] = rgb[2] = 1;
}

// Light passes 0.5 m of a medium on its way, of which the part scattered forward is not lost.
static void in_fog(void **state)
{
    start();
    scene.fog = true;
    scene.medium.extent[0] = scene.medium.extent[2] = 2;
    scene.medium.extent[1] = 0.5f;
    for (int c = 0; c < 3; c++) {
        scene.medium.sigma_s[c] = 1;
        scene.medium.sigma_a[c] = 0.3f * (float)c;
        scene.medium.phase[c].g = 0.5f;
    }
    add_tile(0);
    fill_floor(0, one);
    const struct radial_vpls *found = run(*state);
    for (int c = 0; c < 3; c++) {
        double power = 0, expected = SIDE * SIDE * exp(-0.5 * (0.75 + 0.3 * c));
        for (uint32_t k = 0; k < found->count; k++) {
            power += PI * found->list[k].color[c];
        }
        assert_true(fabs(power / expected - 1) < 1e-5);
    }
    // A lamp 0.25 m above the floor's middle.
    start();
    scene.fog = true;
    for (int c = 0; c < 3; c++) {
        scene.medium.extent[c] = 3;
        scene.medium.sigma_a[c] = 1;
    }
    add_tile(4);
    fill_floor(0, one);
    scene.lights[1] = (struct light_block){.position = {1, 0.25f, 1}};
    found = run(*state);
    for (uint32_t k = 0; k < found->count; k++) {
        const float *p = found->list[k].position;
        double r = sqrt((p[0] - 1) * (p[0] - 1) + 0.25 * 0.25 + (p[2] - 1) * (p[2] - 1));
        double expected = SIDE * SIDE / (PI * found->count) * exp(-r);
        assert_true(fabs((double)found->list[k].color[1] / expected - 1) < 1e-4);
    }
}

static void nothing(void **state)
{
    start();
    add_tile(0);
    assert_int_equal(run(*state)->count, 0); // dark
    start();
    scene.params.count = 0;
    add_tile(0);
    fill_floor(0, one);
    assert_int_equal(run(*state)->count, 0);
    start();
    assert_int_equal(run(*state)->count, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(power_of_maps), cmocka_unit_test(power_under_a_sky),
        cmocka_unit_test(steady),        cmocka_unit_test(emitters),
        cmocka_unit_test(in_fog),        cmocka_unit_test(nothing),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
