// merge.c -- radiance towards the eye and its ghost layer, against the formula on the CPU.
#include "gpu_test.h"
#include "scene_args.h"
#include "passes/merge/merge.h"
#include <math.h>
#include <string.h>

enum { NX = 5, NY = 3, NZ = 4, CELLS = NX * NY * NZ };

static const float extent[3] = {2.5f, 1.4f, 1.9f}; // dx = 0.5: the box reaches 0.05 beyond y and z

static float random_01(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (float)(*seed >> 8) / 16777216.0f;
}

// J of a cell inside the lattice.
static double inside(const float *cells, const float *moments, const struct camera_block *camera,
                     int x, int y, int z, int ch)
{
    const int c[3] = {x, y, z}, n[3] = {NX, NY, NZ};
    double v[3], length = 0, flux = 0;
    int i = ((ch * NZ + z) * NY + y) * NX + x;
    for (int a = 0; a < 3; a++) {
        double p = 0.5 * (extent[a] - 0.5 * n[a]) + 0.5 * (c[a] + 0.5);
        v[a] = camera->orthographic ? -camera->forward[a] : camera->origin[a] - p;
        length += v[a] * v[a];
    }
    for (int a = 0; a < 3; a++) {
        flux += v[a] / sqrt(length) * moments[4 * i + 1 + a];
    }
    return fmax(0, moments[4 * i] + 3 * cells[4 * i + 2] * flux) / (4 * 3.14159265358979);
}

// Along each axis outside: 2 J_0 - J_1.
static double outside(const float *cells, const float *moments, const struct camera_block *camera,
                      int x, int y, int z, int ch)
{
    int c[3] = {x, y, z};
    const int n[3] = {NX, NY, NZ};
    for (int a = 0; a < 3; a++) {
        int inward = c[a] < 0 ? 1 : c[a] >= n[a] ? -1 : 0;
        if (inward) {
            int near[3] = {c[0], c[1], c[2]}, far[3] = {c[0], c[1], c[2]};
            near[a] += inward;
            far[a] += 2 * inward;
            return 2 * outside(cells, moments, camera, near[0], near[1], near[2], ch) -
                   outside(cells, moments, camera, far[0], far[1], far[2], ch);
        }
    }
    return inside(cells, moments, camera, x, y, z, ch);
}

static void against_cpu(void **state)
{
    gpu_test *t = *state;
    float cells[3 * CELLS * 4], moments[3 * CELLS * 4];
    uint32_t seed = 7;
    for (int i = 0; i < 3 * CELLS * 4; i++) {
        cells[i] = random_01(&seed);
        moments[i] = i % 4 ? 2 * random_01(&seed) - 1 : random_01(&seed);
    }
    for (int orthographic = 0; orthographic < 2; orthographic++) {
        for (uint32_t channels = 1; channels <= 3; channels += 2) {
            const struct medium_block medium = {.extent = {extent[0], extent[1], extent[2]}};
            const struct camera_block camera = {.origin = {0.7f, 3, -1},
                                                .orthographic = (uint32_t)orthographic,
                                                .forward = {0.6f, 0, 0.8f}};
            const tyn_merge_params params = {.channels = channels};
            tyn_extent texels = {NX, NY, NZ * channels};
            tyn_graph_begin(t->graph);
            tyn_ref refs[TYN_MAX_PORTS] = {
                [MERGE_PORT_MEDIUM] = gpu_buffer(t, "medium", &medium, sizeof medium),
                [MERGE_PORT_CAMERA] = gpu_buffer(t, "camera", &camera, sizeof camera),
                [MERGE_PORT_CELLS] = gpu_image(t, "cells", TYN_IMAGE_3D, texels, 4, cells),
                [MERGE_PORT_MOMENTS] = gpu_image(t, "moments", TYN_IMAGE_3D, texels, 4, moments),
            };
            assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_merge, &params, refs), TYN_OK);
            tyn_graph_output(t->graph, "inscatter", refs[MERGE_PORT_INSCATTER], true);
            gpu_run(t);
            const float *j = gpu_map(t, "inscatter");
            for (int i = 0; i < (NX + 2) * (NY + 2) * (NZ + 2); i++) {
                int x = i % (NX + 2) - 1, y = i / (NX + 2) % (NY + 2) - 1;
                int z = i / (NX + 2) / (NY + 2) - 1;
                for (int ch = 0; ch < (int)channels; ch++) {
                    double expected = fmax(0, outside(cells, moments, &camera, x, y, z, ch));
                    assert_true(fabs(j[(channels == 1 ? 1 : 4) * i + ch] - expected) < 1e-5);
                }
            }
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(against_cpu)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
