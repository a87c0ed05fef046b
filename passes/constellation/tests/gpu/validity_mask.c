// validity_mask.c -- iFirst of every pixel against slices looked at one by one, with and without the distance map.
#include "bound.h"
#include "gpu_test.h"
#include "numbers.h"
#include "medium_grid.h"
#include "passes/constellation/validity_mask/validity_mask.h"
#include "passes/constellation/voxel_distance/voxel_distance.h"
#include "base/half.h"
#include "random_unit.h"
#include <math.h>
#include <string.h>

enum { SIZE = 48 };

static const float extent[3] = {1.2f, 0.9f, 0.7f};
static const uint32_t size[3] = {24, 15, 11};

typedef struct stage {
    medium_grid grid;
    struct camera_block camera;
    struct slices_args slices;
} stage;

static void make_stage(stage *s, float distance)
{
    s->grid = medium_grid_make(extent, size, TYN_MEDIUM_DENSITY);
    uint32_t seed = 11;
    for (uint32_t q = 0; q < size[0] * size[1] * size[2]; q++) {
        s->grid.texels[0][q] = random_unit(&seed) < 0.006 ? 1 : 0;
    }
    s->camera = (struct camera_block){.origin = {0.6f, 0.45f, 3},
                                      .right = {1, 0, 0},
                                      .up = {0, 1, 0},
                                      .forward = {0, 0, -1},
                                      .half_width = 0.3f,
                                      .half_height = 0.3f,
                                      .size = {SIZE, SIZE}};
    double diagonal = 0;
    for (int a = 0; a < 3; a++) {
        diagonal += pow(extent[a] / (double)size[a], 2);
    }
    s->slices = (struct slices_args){distance, (float)(0.5001 * sqrt(diagonal))};
}

static const uint16_t *run(gpu_test *t, stage *s, bool distance)
{
    const tyn_extent voxels = {size[0], size[1], size[2]};
    tyn_voxel_distance_params map = {.mode = TYN_MEDIUM_DENSITY, .reach = 1};
    memcpy(map.voxel, s->grid.block.voxel, sizeof map.voxel);
    const tyn_validity_mask_params params = {.mode = TYN_MEDIUM_DENSITY,
                                             .distance = distance,
                                             .width = SIZE,
                                             .height = SIZE,
                                             .slices = s->slices};
    tyn_ref of_map[VOXEL_DISTANCE_NUM_PORTS] = {0}, refs[VALIDITY_MASK_NUM_PORTS] = {0};
    tyn_graph_begin(t->graph);
    of_map[VOXEL_DISTANCE_PORT_DENSITY] =
        gpu_image(t, "density", TYN_IMAGE_3D, voxels, 1, s->grid.texels[0]);
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_voxel_distance, &map, of_map), TYN_OK);
    refs[VALIDITY_MASK_PORT_MEDIUM] = gpu_buffer(t, "medium", &s->grid.block, sizeof s->grid.block);
    refs[VALIDITY_MASK_PORT_VOXELS] = of_map[VOXEL_DISTANCE_PORT_VOXELS];
    refs[VALIDITY_MASK_PORT_CAMERA] = gpu_buffer(t, "camera", &s->camera, sizeof s->camera);
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_validity_mask, &params, refs), TYN_OK);
    tyn_graph_output(t->graph, "mask", refs[VALIDITY_MASK_PORT_MASK], true);
    gpu_run(t);
    return gpu_map(t, "mask");
}

// The farthest slice that is not empty and whether rounding may decide on that: near the edges of what voxels fill.
// `shift`: texels that texture units may be off by.
static int twin(const stage *s, int x, int y, double shift, double direction[3], bool *close)
{
    const double u = 2 * (x + 0.5) / SIZE - 1, v = 1 - 2 * (y + 0.5) / SIZE;
    const double d[3] = {0.3 * u, 0.3 * v, -1}, length = sqrt(d[0] * d[0] + d[1] * d[1] + 1);
    double near = 0, far = INFINITY;
    for (int a = 0; a < 3; a++) {
        direction[a] = d[a] / length;
        const double o = s->camera.origin[a];
        const double p = (0 - o) / direction[a], q = (extent[a] - o) / direction[a];
        near = fmax(near, fmin(p, q));
        far = fmin(far, fmax(p, q));
    }
    const double step = s->slices.distance;
    const int first = (int)ceil(near / step), last = (int)floor(far / step);
    *close = fabs(near / step - round(near / step)) < 1e-3 ||
             fabs(far / step - round(far / step)) < 1e-3 || fabs(far - near) < step;
    if (near >= far) {
        *close = fabs(near - far) < 1e-4;
        return -1;
    }
    for (int i = last; i >= first; i--) {
        double p[3];
        for (int a = 0; a < 3; a++) {
            p[a] = s->camera.origin[a] + i * step * direction[a];
        }
        const double value = medium_grid_value(&s->grid, 0, 0, p);
        *close = *close || (value > 0 && value < 1e-4);
        for (int k = 0; k < 8 && shift > 0; k++) {
            double q[3];
            for (int a = 0; a < 3; a++) {
                q[a] = p[a] + (k >> a & 1 ? shift : -shift) * (double)s->grid.block.voxel[a];
            }
            *close = *close || (medium_grid_value(&s->grid, 0, 0, q) > 0) != (value > 0);
        }
        if (value > 0) {
            return i - first;
        }
    }
    return -1;
}

static void equals_twin(void **state)
{
    for (int k = 0; k < 4; k++) {
        stage s;
        make_stage(&s, k / 2 ? 0.11f : 0.025f);
        const uint16_t *mask = run(*state, &s, k % 2);
        int valid = 0, looked_at = 0;
        double worst = 0;
        for (int i = 0; i < SIZE * SIZE; i++) {
            double direction[3];
            bool close;
            const int first =
                twin(&s, i % SIZE, i / SIZE, gpu_filter_shift(*state), direction, &close);
            for (int c = 0; c < 3; c++) {
                worst = maximum(worst, fabs(tyn_half_to_float(mask[4 * i + c]) - direction[c]));
            }
            if (close) {
                continue;
            }
            looked_at++;
            valid += first >= 0;
            assert_int_equal((int)tyn_half_to_float(mask[4 * i + 3]), first);
        }
        print_message(
            "slices %g m apart, distance %s: %d of %d pixels valid; directions %.1e off\n",
            (double)s.slices.distance, k % 2 ? "on" : "off", valid, looked_at, worst);
        assert_true(looked_at > SIZE * SIZE / 2 && valid > 100 && valid < looked_at - 100);
        assert_true(worst < 6e-4); // half floats
        medium_grid_free(&s.grid);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(equals_twin)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
