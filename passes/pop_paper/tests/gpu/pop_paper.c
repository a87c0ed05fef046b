// pop_paper.c -- the passes of method "pop-paper" together: its picture against that of the prototype
// behind the reference states.
#include "bound.h"
#include "gpu_test.h"
#include "numbers.h"
#include "offline_frame.h"
#include "picture.h"
#include "propagate_twin.h"
#include "passes/pop_paper/propagate_rect/propagate_rect.h"
#include "passes/pop_paper/merge_grids/merge_grids.h"
#include "passes/pop_paper/upsample/upsample.h"
#include "passes/raymarch/raymarch.h"
#include "shaders/light/ordinate_args.h"
#include "shaders/common/scene_args.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// The prototype averages 2 x 2 rays a pixel; here every ray is a pixel.
enum { PIXELS = 32, RAYS = 2 * PIXELS };

typedef struct viewpoint {
    const char *name;
    float to_eye[3], right[3], half_width;
    bool mirrored; // columns of the prototype run against `right`
} viewpoint;

static const viewpoint views[] = {
    {"image0", {0, 0, 1}, {1, 0, 0}, 0.5f, false},
    {"image45", {0.70710678f, 0, 0.70710678f}, {0.70710678f, 0, -0.70710678f}, 0.70710678f, false},
    {"image90", {1, 0, 0}, {0, 0, -1}, 0.5f, true},
    {"image180", {0, 0, -1}, {-1, 0, 0}, 0.5f, true},
};

// The case hom4_g60: a unit cube, sigma_s = 4 /m, g = 0.6, irradiance 1 along +z.
static const struct medium_block medium = {
    .extent = {1, 1, 1},
    .size = {1, 1, 1},
    .num_shapes = 1,
    .voxel = {1, 1, 1},
    .max_density = 1,
    .sigma_s = {4, 4, 4},
    .phase = {{.g = 0.6f}, {.g = 0.6f}, {.g = 0.6f}},
    .bricks = {1, 1, 1},
    .brick_size = {TYN_BRICK, TYN_BRICK, TYN_BRICK},
    .sigma_t_max = 4,
};

static struct camera_block camera_of(const viewpoint *v)
{
    struct camera_block c = {.orthographic = 1,
                             .half_width = v->half_width,
                             .half_height = 0.5f,
                             .up = {0, 1, 0},
                             .size = {RAYS, RAYS}};
    for (int i = 0; i < 3; i++) {
        c.origin[i] = 0.5f + 3 * v->to_eye[i];
        c.right[i] = v->right[i];
        c.forward[i] = -v->to_eye[i];
    }
    return c;
}

// The passes as the method wires them; radiance of RAYS x RAYS pixels.
static const float *radiance_of(gpu_test *t, const struct camera_block *camera)
{
    const struct light_block light = {{0}};
    const struct ordinates_block sun = {
        .count = 1, .list = {{.irradiance = {1, 1, 1}, .mean_cosine = 1, .direction = {0, 0, 1}}}};
    const struct shape_block shape = {
        .rows = {{1, 0, 0, -0.5f}, {0, 1, 0, -0.5f}, {0, 0, 1, -0.5f}}, .size = {1, 1, 1}};
    const struct env_block dark = {{{0}}};
    const float one = 1, zero = 0;

    tyn_graph_begin(t->graph);
    tyn_ref media = gpu_buffer(t, "medium", &medium, sizeof medium);
    tyn_ref lights = gpu_buffer(t, "lights", &light, sizeof light);
    tyn_ref eye = gpu_buffer(t, "camera", camera, sizeof *camera);
    tyn_ref density = gpu_image(t, "density", TYN_IMAGE_3D, (tyn_extent){1, 1, 1}, 1, &one);

    tyn_propagate_rect_params propagate;
    tyn_pass_defaults(&tyn_pass_propagate_rect, &propagate);
    propagate.cells = propagate.iterations = 16;
    propagate.num_ordinates = propagate.channels = 1;
    memcpy(propagate.extent, medium.extent, sizeof propagate.extent);
    memcpy(propagate.size, medium.size, sizeof propagate.size);
    tyn_ref a[PROPAGATE_RECT_NUM_PORTS] = {[PROPAGATE_RECT_PORT_MEDIUM] = media,
                                           [PROPAGATE_RECT_PORT_ORDINATES] =
                                               gpu_buffer(t, "ordinates", &sun, sizeof sun),
                                           [PROPAGATE_RECT_PORT_CAMERA] = eye,
                                           [PROPAGATE_RECT_PORT_DENSITY] = density};
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_propagate_rect, &propagate, a), TYN_OK);

    tyn_merge_grids_params merge;
    tyn_pass_defaults(&tyn_pass_merge_grids, &merge);
    merge.finer = 1; // the prototype does not refine
    merge.num_grids = merge.channels = 1;
    merge.grid_cells = (uint32_t)propagate.cells;
    memcpy(merge.extent, medium.extent, sizeof merge.extent);
    tyn_ref m[MERGE_GRIDS_NUM_PORTS] = {[MERGE_GRIDS_PORT_MEDIUM] = media,
                                        [MERGE_GRIDS_PORT_DENSITY] = density,
                                        [MERGE_GRIDS_PORT_PLACES] = a[PROPAGATE_RECT_PORT_PLACES],
                                        [MERGE_GRIDS_PORT_SEEN] = a[PROPAGATE_RECT_PORT_SEEN]};
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_merge_grids, &merge, m), TYN_OK);

    tyn_upsample_params upsample;
    tyn_pass_defaults(&tyn_pass_upsample, &upsample);
    upsample.cells = propagate.cells;
    memcpy(upsample.extent, medium.extent, sizeof upsample.extent);
    memcpy(upsample.size, medium.size, sizeof upsample.size);
    tyn_ref b[UPSAMPLE_NUM_PORTS] = {[UPSAMPLE_PORT_MEDIUM] = media,
                                     [UPSAMPLE_PORT_DENSITY] = density,
                                     [UPSAMPLE_PORT_MERGED] = m[MERGE_GRIDS_PORT_MERGED]};
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_upsample, &upsample, b), TYN_OK);

    tyn_raymarch_params march;
    tyn_pass_defaults(&tyn_pass_raymarch, &march);
    march.grey = 1;
    march.sparse = 0; // so does the prototype
    march.field = TYN_INSCATTER_PLAIN;
    march.width = march.height = RAYS;
    march.longest_step = 1.0f / 128;
    memcpy(march.extent, medium.extent, sizeof march.extent);
    tyn_ref c[RAYMARCH_NUM_PORTS] = {
        [RAYMARCH_PORT_MEDIUM] = media,
        [RAYMARCH_PORT_DENSITY] = density,
        [RAYMARCH_PORT_DISTANCE] =
            gpu_image(t, "distance", TYN_IMAGE_3D, (tyn_extent){1, 1, 1}, 1, &zero),
        [RAYMARCH_PORT_SHAPES] = gpu_buffer(t, "shapes", &shape, sizeof shape),
        [RAYMARCH_PORT_LIGHTS] = lights,
        [RAYMARCH_PORT_INSCATTER] = b[UPSAMPLE_PORT_INSCATTER],
        [RAYMARCH_PORT_CAMERA] = eye,
        [RAYMARCH_PORT_ENVIRONMENT] = gpu_buffer(t, "environment", &dark, sizeof dark)};
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_raymarch, &march, c), TYN_OK);
    tyn_graph_output(t->graph, "radiance", c[RAYMARCH_PORT_RADIANCE], true);
    gpu_run(t);
    return gpu_map(t, "radiance");
}

static double pixel_of(const float *radiance, const viewpoint *v, int x, int y)
{
    double sum = 0;
    for (int k = 0; k < 4; k++) {
        int column = 2 * x + (k & 1), row = 2 * y + (k >> 1);
        column = v->mirrored ? RAYS - 1 - column : column;
        row = RAYS - 1 - row; // row 0 on top
        sum += radiance[4 * (row * RAYS + column)];
    }
    return sum / 4;
}

static void equals_prototype(void **state)
{
    state_record *records;
    int num = states_load(&records);
    for (size_t i = 0; i < sizeof views / sizeof *views; i++) {
        const viewpoint *v = &views[i];
        const state_record *r = states_find(records, num, v->name, "hom4_g60", 16);
        assert_non_null(r);
        struct camera_block camera = camera_of(v);
        const float *radiance = radiance_of(*state, &camera);
        double difference = 0, sum = 0, worst = 0;
        for (int y = 0; y < PIXELS; y++) {
            for (int x = 0; x < PIXELS; x++) {
                double found = pixel_of(radiance, v, x, y), expected = r->values[0][y * PIXELS + x];
                difference += fabs(found - expected);
                worst = maximum(worst, fabs(found - expected) / expected);
                sum += expected;
            }
        }
        print_message("%s: relative difference %.2e, of a pixel at most %.2e\n", v->name,
                      difference / sum, worst);
        // In the second view one pixel is off by more.
        const double sums[] = {3e-4, 1.5e-4, 1e-4, 3e-4}, pixels[] = {3e-4, 0.01, 1.2e-4, 3e-4};
        assert_true(within(difference / sum, sums[i], NULL, "%s, sum", v->name));
        assert_true(within(worst, pixels[i], NULL, "%s, pixel", v->name));
    }
    free(records);
}

// ---- the method under an environment -------------------------------------------------------------

// A box in light that is 1 from all sides, seen across one side.
static void set_furnace(tyn_scene *scene, tyn_view *view, float sigma_s)
{
    tyn_medium box = grey_medium(sigma_s, 0, 0.5f);
    tyn_scene_init(scene);
    scene_add_box(scene, &box, (float[]){0, 0, 0}, (float[]){1, 1, 1}, NULL, NULL);
    scene_set_sky(scene, 1);
    view_orthographic(view, (float[]){0.5f, 0.5f, 0.5f}, 1, 0, 0, (float[]){0, 1, 0}, 0.5f, 16);
    view->no_background = true;
    view->outputs = TYN_OUTPUT_RADIANCE;
}

// In a thin medium every ordinate crosses its grid with little change, and J = sum E_n / 4 pi = 1.
static void thin_furnace(void **state)
{
    gpu_test *t = *state;
    tyn_scene scene;
    tyn_view view = {0};
    picture p;
    set_furnace(&scene, &view, 0.08f);
    static const char *const settings[] = {
        "propagate_rect.cells=12 propagate_rect.prefilter=off",
        "propagate_rect.cells=12 propagate_rect.prefilter=exact",
        "propagate_rect.cells=8 propagate_rect.cells_along=24 propagate_rect.prefilter=off "
        "propagate_rect.iterations=24",
        "propagate_rect.cells=32 propagate_rect.cells_along=16 propagate_rect.prefilter=off",
    };
    for (int i = 0; i < 4; i++) {
        picture_render(&p, t->dev, "pop-paper", &scene, &view, settings[i], 0);
        double sum = 0;
        for (uint32_t k = 0; k < 3 * p.width * p.height; k++) {
            assert_true(isfinite(p.rgb[k]));
            sum += p.rgb[k];
        }
        double expected = -expm1(-0.08) * 3 * p.width * p.height;
        print_message("%s: %.4f of what a furnace shows\n", settings[i], sum / expected);
        assert_within(fabs(sum / expected - 1), 0.04, NULL);
        picture_free(&p);
    }
    tyn_scene_finish(&scene);
}

// `more`: another setting and its value, or NULL.
static tyn_report frame_report(gpu_test *t, tyn_offline **off, const tyn_scene *scene,
                               const tyn_view *view, const char *name, const char *value,
                               const char *more, const char *more_value)
{
    tyn_settings *settings;
    tyn_report report;
    assert_int_equal(tyn_settings_create(&settings), TYN_OK);
    assert_int_equal(tyn_settings_set(settings, "propagate_rect.cells", "8", NULL), TYN_OK);
    assert_int_equal(tyn_settings_set(settings, "ordinates.count", "8", NULL), TYN_OK);
    assert_int_equal(tyn_settings_set(settings, name, value, NULL), TYN_OK);
    if (more) {
        assert_int_equal(tyn_settings_set(settings, more, more_value, NULL), TYN_OK);
    }
    assert_int_equal(
        tyn_offline_create(t->dev, tyn_offline_params(.method = "pop-paper", .settings = settings),
                           off),
        TYN_OK);
    offline_frame(*off, scene, view);
    tyn_offline_report(*off, &report);
    tyn_settings_destroy(&settings);
    return report;
}

static const tyn_node_report *node_of(const tyn_report *report, const char *name)
{
    for (uint32_t i = 0; i < report->num_nodes; i++) {
        if (!strcmp(report->nodes[i].name, name)) {
            return &report->nodes[i];
        }
    }
    return NULL;
}

// Of propagate_rect, those that were run.
static double iterations(const tyn_report *report)
{
    const tyn_node_report *n = node_of(report, "propagate_rect");
    assert_non_null(n);
    for (uint32_t k = 0; k < n->num_work; k++) {
        if (!strcmp(n->work[k].name, "iterations")) {
            return n->work[k].amount;
        }
    }
    return -1;
}

static uint32_t dispatches(const tyn_report *report)
{
    uint32_t sum = 0;
    for (uint32_t i = 0; i < report->num_nodes; i++) {
        sum += report->nodes[i].dispatches;
    }
    return sum;
}

static void dispatches_do_not_depend_on_ordinates(void **state)
{
    gpu_test *t = *state;
    tyn_scene scene;
    tyn_view view = {0};
    tyn_offline *off;
    uint32_t expected = 0;
    set_furnace(&scene, &view, 2);
    scene_add_sun(&scene, 1, -2, 0.5f, 2, 1.5f, 1);
    for (int i = 0; i < 3; i++) {
        tyn_report report = frame_report(t, &off, &scene, &view, "ordinates.count",
                                         ((const char *[]){"1", "64", "256"})[i], NULL, NULL);
        for (uint32_t k = 0; k < report.num_warnings; k++) { // only of what the method cannot
            assert_true(!strncmp(report.warnings[k], "accuracy:", 9));
        }
        expected = i ? expected : dispatches(&report);
        assert_int_equal(dispatches(&report), expected);
        tyn_offline_destroy(&off);
    }
    tyn_scene_finish(&scene);
}

// The residuum waits for as many iterations as the grid has cells, or as Eq 10 wants: with the mean cosine that 8 ordinates
// are prefiltered to, 7/8, and the mean of what is not empty.
static void residuum_after(void **state)
{
    gpu_test *t = *state;
    static const struct {
        float sigma_s;
        double iterations, coarse; // the latter with 4 cells along the light
        bool half_empty;
    } cases[] = {
        {100, 8, 4, false}, {2, 13, 7, false}, {0.001f, 256, 256, false}, {2, 13, 7, true}};
    for (int i = 0; i < 4; i++) {
        tyn_scene scene;
        tyn_view view = {0};
        tyn_offline *off;
        set_furnace(&scene, &view, cases[i].sigma_s); // g = 0.5, hops of 1/8 m
        if (cases[i].half_empty) {
            scene.num_volumes = 1;
            scene.volumes = calloc(1, sizeof *scene.volumes);
            scene.volumes[0] = (tyn_volume){
                .size = {4, 4, 4}, .data = calloc(64, sizeof(float)), .max_density = 1, .hash = 5};
            for (int q = 0; q < 32; q++) {
                scene.volumes[0].data[q] = 1;
            }
            scene.media[0].volume = 0;
        }
        tyn_report report = frame_report(t, &off, &scene, &view, "residuum.on", "1", NULL, NULL);
        assert_non_null(node_of(&report, "residuum"));
        assert_near(iterations(&report), cases[i].iterations, 0);
        tyn_offline_destroy(&off);
        // Light that is only looked at ends nothing while there is some; where little is left, there are fewer.
        report = frame_report(t, &off, &scene, &view, "residuum.on", "1",
                              "propagate_rect.threshold", "1e-30");
        const double some = iterations(&report);
        assert_true(i == 2 ? some > 8 && some <= cases[i].iterations : some == cases[i].iterations);
        tyn_offline_destroy(&off);
        report = frame_report(t, &off, &scene, &view, "residuum.on", "1",
                              "propagate_rect.threshold", "0.3");
        print_message("sigma_s %g: %g iterations, %g while there is light, %g with the stop\n",
                      cases[i].sigma_s, cases[i].iterations, some, iterations(&report));
        assert_true(iterations(&report) > 0 && iterations(&report) < some);
        tyn_offline_destroy(&off);
        // The grids are crossed in as many hops as they have cells along the light.
        report = frame_report(t, &off, &scene, &view, "residuum.on", "1",
                              "propagate_rect.cells_along", "4");
        assert_near(iterations(&report), cases[i].coarse, 0);
        tyn_offline_destroy(&off);
        tyn_scene_finish(&scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equals_prototype),
        cmocka_unit_test(thin_furnace),
        cmocka_unit_test(dispatches_do_not_depend_on_ordinates),
        cmocka_unit_test(residuum_after),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
