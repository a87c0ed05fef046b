// beam_plan.c -- the layout of the suns' grids: sizes that do not follow the sun, and maps that agree.
#include "passes/beam/beam.h"
#include "random_unit.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <cmocka.h>

static struct medium_block box(const uint32_t size[3], uint32_t mode)
{
    struct medium_block m = {.mode = mode};
    for (int i = 0; i < 3; i++) {
        m.size[i] = size[i];
        m.extent[i] = 0.01f * (float)size[i];
        m.voxel[i] = 0.01f;
    }
    return m;
}

static struct light_block sun(double x, double y, double z)
{
    double n = sqrt(x * x + y * y + z * z);
    return (struct light_block){.direction = {(float)(x / n), (float)(y / n), (float)(z / n)}};
}

static const uint32_t sizes[][3] = {
    {64, 64, 64}, {96, 160, 96}, {512, 512, 512}, {1, 1, 1}, {8, 1, 300}};
enum { NUM_SIZES = sizeof sizes / sizeof *sizes };

// The texture keeps its extent while the suns turn about the axis they are closest to, has room for all
// nodes, and stays within its bounds.
static void extents(void **state)
{
    (void)state;
    for (size_t k = 0; k < NUM_SIZES; k++) {
        for (uint32_t mode = 0; mode < 2; mode++) {
            struct medium_block m = box(sizes[k], mode);
            uint32_t most = mode == TYN_MEDIUM_DENSITY ? 160 : 96, first[3] = {0}, seed = 1;
            for (int n = 0; n < 200; n++) {
                struct light_block s[2] = {
                    sun(random_unit(&seed) - 0.5, 0.9, random_unit(&seed) - 0.5),
                    sun(0.9, random_unit(&seed) - 0.5, random_unit(&seed) - 0.5),
                };
                tyn_beam_params params = {.cells = 160};
                tyn_beam_plan(&params, &m, s, 2);
                if (n == 0) {
                    memcpy(first, params.extent, sizeof first);
                }
                assert_memory_equal(first, params.extent, sizeof first);
                assert_true(params.extent[0] <= most + 2 && params.extent[1] <= most + 2);
                assert_true(params.extent[2] <= 2 * (most + 1));
                for (uint32_t b = 0; b < 2; b++) {
                    const struct beam_block *beam = &params.beams[b];
                    assert_true(beam->nodes[0] <= params.extent[0]);
                    assert_true(beam->nodes[1] <= params.extent[1]);
                    assert_true(beam->first_slice + beam->nodes[2] <= params.extent[2]);
                    assert_true(beam->samples >= 1);
                }
            }
        }
    }
}

// Every node's position maps to its texel's centre and to its distance along the light; every point of
// the box lies between nodes.
static void maps(void **state)
{
    (void)state;
    uint32_t seed = 5;
    for (int n = 0; n < 400; n++) {
        struct medium_block m = box(sizes[n % NUM_SIZES], TYN_MEDIUM_DENSITY);
        bool periodic = n % 7 == 0;
        m.repeat[0] = m.repeat[2] = periodic;
        struct light_block s =
            sun(random_unit(&seed) - 0.5, random_unit(&seed) - 0.5 + (periodic ? 1 : 0),
                random_unit(&seed) - 0.5);
        tyn_beam_params params = {.cells = 100};
        tyn_beam_plan(&params, &m, &s, 1);
        const struct beam_block *b = &params.beams[0];
        double longest = fmax(m.extent[0], fmax(m.extent[1], m.extent[2]));
        double steep = 1 / fabs(b->direction[b->axis]);
        for (int q = 0; q < 20; q++) {
            uint32_t node[3];
            double p[3], depth = b->depth_row[3], step = 0;
            for (int i = 0; i < 3; i++) {
                node[i] = (uint32_t)(random_unit(&seed) * b->nodes[i]);
            }
            for (int i = 0; i < 3; i++) {
                p[i] = b->origin[i] + node[0] * (double)b->step_u[i] +
                       node[1] * (double)b->step_v[i] + node[2] * (double)b->step_w[i];
                depth += p[i] * b->depth_row[i];
                step += (double)b->step_w[i] * b->step_w[i];
            }
            assert_true(fabs(depth - node[2] * sqrt(step)) < 1e-5 * longest * steep);
            for (int k = 0; k < 3; k++) {
                double texel = b->rows[k][3];
                for (int i = 0; i < 3; i++) {
                    texel += p[i] * b->rows[k][i];
                }
                assert_true(fabs(texel * params.extent[k] - node[k] - 0.5) < 1e-3 * steep);
            }
            for (int i = 0; i < 3; i++) {
                p[i] = random_unit(&seed) * m.extent[i];
            }
            for (int k = 0; k < 3; k++) {
                double texel = b->rows[k][3];
                for (int i = 0; i < 3; i++) {
                    texel += p[i] * b->rows[k][i];
                }
                if (k < 2 && b->period[k] > 0) {
                    texel -= floor((texel - b->period_first[k]) / b->period[k]) * b->period[k];
                }
                texel *= params.extent[k];
                assert_true(texel > 0.5 - 1e-3 && texel < b->nodes[k] - 0.5 + 1e-3);
            }
        }
    }
}

// Light within a face, along an edge of the box, in a box that is periodic all around.
static void odd_directions(void **state)
{
    (void)state;
    struct medium_block m = box((uint32_t[3]){20, 20, 20}, TYN_MEDIUM_DENSITY);
    const struct light_block suns[4] = {sun(1, 0, 0), sun(0, -1, 1e-9), sun(1, 1, 0),
                                        sun(-1e-7, 1e-7, -1)};
    for (int n = 0; n < 4; n++) {
        m.repeat[0] = m.repeat[1] = m.repeat[2] = n >= 2;
        tyn_beam_params params = {.cells = 160};
        tyn_beam_plan(&params, &m, suns, 4);
        for (int k = 0; k < 4; k++) {
            const float *values = (const float *)&params.beams[k];
            for (int i = 0; i < 16; i++) { // rows
                assert_true(isfinite(values[i]));
            }
            for (int i = 0; i < 3; i++) {
                assert_true(isfinite(params.beams[k].clip_scale[i]));
                assert_true(isfinite(params.beams[k].clip_offset[i]));
                assert_true(isfinite(params.beams[k].step_w[i]));
            }
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(extents), cmocka_unit_test(maps),
                                       cmocka_unit_test(odd_directions)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
