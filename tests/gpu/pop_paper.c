// pop_paper.c -- the passes of method "pop-paper" together: its picture against that of the prototype
// behind the reference states.
#include "gpu_test.h"
#include "propagate_twin.h"
#include "passes/propagate_rect/propagate_rect.h"
#include "passes/merge_grids/merge_grids.h"
#include "passes/upsample/upsample.h"
#include "passes/raymarch/raymarch.h"
#include "ordinate_args.h"
#include "scene_args.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// The prototype averages 2 x 2 rays a pixel; here every ray is a pixel.
enum { PIXELS = 32, RAYS = 2 * PIXELS };

typedef struct view {
    const char *name;
    float to_eye[3], right[3], half_width;
    bool mirrored; // columns of the prototype run against `right`
} view;

static const view views[] = {
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
    .g = {0.6f, 0.6f, 0.6f},
    .bricks = {1, 1, 1},
    .brick_size = {TYN_BRICK, TYN_BRICK, TYN_BRICK},
    .sigma_t_max = 4,
};

static struct camera_block camera_of(const view *v)
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
static const float *picture(gpu_test *t, const struct camera_block *camera)
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
    march.field = RAYMARCH_INSCATTER_PLAIN;
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

static double pixel_of(const float *radiance, const view *v, int x, int y)
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
        const view *v = &views[i];
        const state_record *r = states_find(records, num, v->name, "hom4_g60", 16);
        assert_non_null(r);
        struct camera_block camera = camera_of(v);
        const float *radiance = picture(*state, &camera);
        double difference = 0, sum = 0, worst = 0;
        for (int y = 0; y < PIXELS; y++) {
            for (int x = 0; x < PIXELS; x++) {
                double found = pixel_of(radiance, v, x, y), expected = r->values[0][y * PIXELS + x];
                difference += fabs(found - expected);
                worst = fmax(worst, fabs(found - expected) / expected);
                sum += expected;
            }
        }
        print_message("%s: relative difference %.2e, of a pixel at most %.2e\n", v->name,
                      difference / sum, worst);
        assert_true(difference / sum < 5e-4 && worst < 0.01);
    }
    free(records);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(equals_prototype)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
