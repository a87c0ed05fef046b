// propagate_rect.c -- the six-neighbour propagation against reference states, a CPU twin in double
// precision, and what must hold for any reading of the paper.
#include "bound.h"
#include "numbers.h"
#include "propagate_run.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- reference states -------------------------------------------------------------------------

static double values[6][STATE_TOTAL];

static void state_density(const state_record *records, int num, const state_record *r,
                          float *density)
{
    const state_record *blobs = states_find(records, num, "sigma_t", "blobs_g60", 0);
    for (int q = 0; q < STATE_TOTAL; q++) {
        density[q] = r->sigma_t < 0 ? blobs->values[0][q] : (float)r->sigma_t;
    }
}

static void reference_states(void **state)
{
    static float density[STATE_TOTAL];
    const float to_eye[3] = {sqrtf(0.5f), 0, sqrtf(0.5f)};
    state_record *records;
    int num = states_load(&records), compared = 0;
    for (int i = 0; i < num; i++) {
        const state_record *r = &records[i];
        bool inscatter = strcmp(r->kind, "inscatter") == 0;
        if (strcmp(r->kind, "state") != 0 && !inscatter) {
            continue;
        }
        state_density(records, num, r, density);
        setup s = unit_cube(density, 1, (float)r->g, to_eye);
        s.params.iterations = r->iteration;
        outcome o = propagate_run(*state, &s);
        for (int q = 0; q < STATE_TOTAL; q++) {
            double kept = kept_cosine(&o, q, false);
            values[0][q] = inscatter ? o.seen[q] : light_of(&o, q, 1);
            values[1][q] = kept > 0 ? (1.0 - (double)o.state[q].c[3]) / kept : 0;
            values[2][q] = r->values[0][q];
            values[3][q] = r->values[1][q];
        }
        double light = worst(values[0], values[2], STATE_TOTAL, values[2]);
        double cosine = inscatter ? 0 : worst(values[1], values[3], STATE_TOTAL, values[2]);
        print_message("%-9s %s, iteration %2d: largest difference of L %.1e, of a %.1e\n", r->kind,
                      r->name, r->iteration, light, cosine);
        assert_true(light < 1e-4 && cosine < 1e-4);
        compared++;
    }
    assert_int_equal(compared, 13);
    free(records);
}

// ---- all readings, oblique coloured light, perspective -----------------------------------------

static void every_reading(void **state)
{
    static float density[12 * 16 * 10];
    setup s = oblique(density);
    for (int reading = 0; reading < 16; reading++) {
        s.params.init = reading & 3;
        s.params.rate = reading >> 2 & 1;
        s.params.last_event = (uint32_t)(reading >> 3);
        outcome o = propagate_run(*state, &s);
        double difference = 0;
        for (int sun = 0; sun < MAX_SUNS; sun++) {
            for (int c = 0; c < 3; c++) {
                difference = maximum(difference, compare_channel(&s, &o, sun, c));
            }
        }
        print_message("init %d, rate %d, last event %u: largest difference %.1e\n", s.params.init,
                      s.params.rate, s.params.last_event, difference);
        assert_true(difference < 1e-4);
    }
}

// ---- surfaces -----------------------------------------------------------------------------------

// x of the middle of a texel of the first sun's map.
static double texel_x(int i)
{
    return -1.5 + (i + 0.5) * 4 / ATLAS;
}

// Does the plate stop light of a sun on its way to a point? In the map, as far as a texel shows it beside the point.
static bool in_shadow(const struct propagate_grid *grid, const double p[3], bool mapped)
{
    double t = (p[1] - 0.7) / grid->direction[1]; // since the plate's plane
    double x = p[0] - t * grid->direction[0];
    if (mapped) {
        x = texel_x((int)floor((p[0] + 1.5) / 4 * ATLAS - 0.5));
    }
    return t > 0 && x < 0.5;
}

// What a plate leaves of the light, by looks at a shadow map for the first sun and by rays for the second; and the
// propagation with that.
static void surfaces_stop_light(void **state)
{
    static float density[12 * 16 * 10], atlas[ATLAS * ATLAS];
    setup s = oblique(density);
    struct light_block down = s.suns[1];
    s.suns[1] = s.suns[0];
    s.suns[0] = down;
    for (int q = 0; q < ATLAS * ATLAS; q++) { // depth (y + 1) / 3
        atlas[q] = texel_x(q % ATLAS) < 0.5 ? 1.7f / 3 : 0;
    }
    s.atlas = atlas;
    s.map = (struct shadow_light){
        .rows = {{0.5f, 0, 0, -0.25f}, {0, 0, 0.5f, -0.25f}, {0, 1 / 3.0f, 0, 1 / 3.0f}},
        .texels = ATLAS,
        .kind = TYN_SHADOW_SUN};
    s.params.num_mapped = 1;
    s.params.num_triangles = 2;
    for (s.params.init = 0; s.params.init < 4; s.params.init++) {
        outcome o = propagate_run(*state, &s);
        int partly = 0, dark = 0;
        double off = 0, difference = 0;
        for (int sun = 0; sun < MAX_SUNS; sun++) {
            const struct propagate_grid *grid = &o.grids[sun];
            for (int column = 0; column < N * N; column++) {
                const int i = column % N, j = column / N;
                double found = 1;
                for (int k = 0; k < N; k++) {
                    double expected = 1;
                    for (int look = 0; look < PROPAGATE_RECT_LOOKS * PROPAGATE_RECT_LOOKS; look++) {
                        double p[3];
                        to_m(grid,
                             (double[]){
                                 i + (look % PROPAGATE_RECT_LOOKS + 0.5) / PROPAGATE_RECT_LOOKS,
                                 j + (look / PROPAGATE_RECT_LOOKS + 0.5) / PROPAGATE_RECT_LOOKS,
                                 k + 0.5},
                             p);
                        expected -= in_shadow(grid, p, sun == 0)
                                        ? 1.0 / (PROPAGATE_RECT_LOOKS * PROPAGATE_RECT_LOOKS)
                                        : 0;
                    }
                    found *= o.lit[((sun * N + k) * N + j) * N + i];
                    if (i < (int)grid->size[0] && j < (int)grid->size[1]) {
                        off = maximum(off, fabs(found - expected));
                        partly += expected > 0.01 && expected < 0.99;
                        dark += expected < 0.01;
                    }
                }
            }
            for (int c = 0; c < 3; c++) {
                difference = maximum(difference, compare_channel(&s, &o, sun, c));
            }
        }
        print_message("init %d: %d cells dark, %d in part; lit off by %.1e, states by %.1e\n",
                      s.params.init, dark, partly, off, difference);
        assert_true(dark > 100 && partly > 20);
        assert_true(off < 1e-5);
        assert_true(difference < 1e-4);
    }
}

// ---- ordinates --------------------------------------------------------------------------------

static uint32_t dispatches_of(gpu_test *t)
{
    const tyn_node_stats *stats;
    uint32_t count = tyn_graph_stats(t->graph, &stats);
    for (uint32_t i = 0; i < count; i++) {
        if (!strcmp(stats[i].name, "propagate_rect")) {
            return stats[i].dispatches;
        }
    }
    return 0;
}

// A grid for each, behind those of the suns, with light that starts as the prefilter says.
static void ordinates(void **state)
{
    static float density[12 * 16 * 10];
    setup s = oblique(density);
    outcome o = propagate_run(*state, &s);
    uint32_t dispatches = dispatches_of(*state);
    for (int32_t filter = 0; filter < 3; filter++) {
        s.params.prefilter = filter;
        s.params.beta = 3;
        s.params.init = filter == 1 ? TYN_PROPAGATE_INIT_FIRST_COLLISION : TYN_PROPAGATE_INIT_ENTRY;
        set_ordinates(&s, 9);
        o = propagate_run(*state, &s);
        assert_int_equal(dispatches_of(*state), dispatches);
        double difference = 0;
        for (int n = 0; n < 9; n++) {
            const struct propagate_grid *grid = &o.grids[MAX_SUNS + n];
            double share = fmin((n % 2 ? 0.5 : 1.5) / 9 * 11, 1); // of 11 with the suns
            double expected = filter == 0   ? 1
                              : filter == 1 ? pow(1 - share / 11, 3)
                                            : (double)s.ordinates.list[n].mean_cosine;
            assert_near(grid->mean_cosine, expected, 1e-6);
            assert_memory_equal(grid->irradiance, s.ordinates.list[n].irradiance,
                                sizeof grid->irradiance);
            difference = maximum(difference, compare_channel(&s, &o, MAX_SUNS + n, n % 3));
        }
        print_message("prefilter %d: largest difference %.1e\n", filter, difference);
        assert_true(difference < 1e-4);
    }
    // Fewer than there is room for: the rest is dark.
    s.ordinates.count = 4;
    o = propagate_run(*state, &s);
    for (int q = (MAX_SUNS + 4) * 3 * CELLS; q < (MAX_SUNS + 9) * 3 * CELLS; q++) {
        assert_true(sent(&o, q) == 0 && o.seen[q] == 0);
    }
}

// What all grids sent to the eye and still hold, whatever number of them is done at a time.
static void batches(void **state)
{
    static float density[12 * 16 * 10], once[2][4 * 9 * 3 * CELLS];
    setup s = oblique(density);
    s.num_suns = 0;
    s.params.keep_light = 1;
    s.params.mode = TYN_MEDIUM_DENSITY;
    set_ordinates(&s, 9);
    for (int32_t batch = 9; batch > 0; batch -= 4) { // 9, 5 + 4, nine times 1
        s.params.buffer_bytes = (uint32_t)batch * 3 * CELLS * 16;
        propagate_run(*state, &s);
        for (int i = 0; i < 2; i++) {
            tyn_extent size;
            const char *name = i ? "light" : "seen";
            const float *found = tyn_graph_map(((gpu_test *)*state)->graph, name, &size, NULL);
            size_t texels = (size_t)size.x * size.y * size.z;
            assert_true(found && texels <= sizeof once[0] / sizeof(float));
            if (batch == 9) {
                memcpy(once[i], found, texels * sizeof(float));
            }
            assert_memory_equal(found, once[i], texels * sizeof(float));
        }
    }
}

// The configuration of the paper's section 7.
static void many_ordinates(void **state)
{
    static float density[32 * 32 * 32];
    for (int q = 0; q < 32 * 32 * 32; q++) {
        density[q] = 1;
    }
    setup s = unit_cube(density, 4, 0.9f, (float[]){1, 0, 0});
    set_medium(&s, (float[]){1, 1, 1}, (uint32_t[]){32, 32, 32}, density);
    memcpy(s.params.size, s.medium.size, sizeof s.params.size);
    s.params.cells = 20;
    s.params.iterations = 10;
    s.num_suns = 0;
    set_ordinates(&s, 64);
    outcome o = propagate_run(*state, &s);
    for (int n = 0; n < 64; n++) {
        double power = total(&o, n * 8000, 8000) / o.grids[n].size[0] / o.grids[n].size[1];
        assert_true(power > 0.5 && power < 1.00001);
    }
    print_message("64 ordinates, 20^3, 10 iterations: %u dispatches, %.0f ms\n",
                  dispatches_of(*state), gpu_ms(*state, "propagate_rect"));
}

// ---- the grids --------------------------------------------------------------------------------

static void grids_span_the_medium(void **state)
{
    static float density[12 * 16 * 10];
    setup s = oblique(density);
    outcome o = propagate_run(*state, &s);
    for (int sun = 0; sun < MAX_SUNS; sun++) {
        const struct propagate_grid *grid = &o.grids[sun];
        const float *axes[3] = {grid->across_u, grid->across_v, grid->direction};
        double side[3], longest = 0;
        for (int a = 0; a < 3; a++) {
            double lo = 1e9, hi = -1e9;
            for (int corner = 0; corner < 8; corner++) {
                double at = 0;
                for (int x = 0; x < 3; x++) {
                    double p = corner >> x & 1 ? s.medium.extent[x] : 0;
                    at += axes[a][x] * (p - grid->origin[x]);
                }
                lo = fmin(lo, at);
                hi = fmax(hi, at);
            }
            assert_true(lo > -1e-5 && hi < grid->size[a] * grid->cell + 1e-5);
            side[a] = hi - lo;
            longest = fmax(longest, side[a]);
            assert_true((grid->size[a] - 1) * grid->cell < side[a]); // no layer too many
        }
        assert_near(grid->cell * N, longest, 1e-5);
        for (int x = 0; x < 3; x++) {
            assert_near(grid->direction[x], s.suns[sun].direction[x], 1e-6);
        }
        // The cells hold all of the medium. White noise is the hardest case for the samples in a cell.
        double cells = 0, voxels = 0;
        for (int q = 0; q < CELLS; q++) {
            cells += o.cells[(3 * sun + 1) * CELLS + q].c[0] * pow(grid->cell, 2);
        }
        for (int q = 0; q < 12 * 16 * 10; q++) {
            voxels += density[q] * s.medium.sigma_s[1] * s.medium.voxel[0] * s.medium.voxel[1] *
                      s.medium.voxel[2];
        }
        print_message("sun %d: medium in the cells / in the voxels = %.4f\n", sun, cells / voxels);
        assert_within(fabs(cells / voxels - 1), 5e-3, NULL);
    }
}

// Where the medium is much finer than the cells they are made from one shrunk to suit: with the same mean
// coefficients.
static void shrunk_medium(void **state)
{
    enum { X = 40, Y = 30, Z = 22, VOXELS = X * Y * Z, C = 6 };
    static float density[VOXELS], sigma_s[4 * VOXELS], sigma_a[4 * VOXELS], g[4 * VOXELS];
    setup s = {.suns = {{.color = {1, 1, 1}, .direction = {0.48f, 0.6f, 0.64f}}},
               .num_suns = 1,
               .camera = {.orthographic = 1, .forward = {0, 0, -1}},
               .medium = {.sigma_s = {2, 5, 9},
                          .sigma_a = {3, 2, 1},
                          .phase = {{.g = 0.8f}, {.g = 0}, {.g = -0.3f}}}};
    double sums[3][3] = {{0}}; // sigma_s, sigma_a, sigma_s g of the voxels
    srand(5);
    for (int q = 0; q < VOXELS; q++) {
        density[q] = (float)(rand() % 1000) * 1e-3f;
        for (int c = 0; c < 4; c++) {
            sigma_s[4 * q + c] = (float)(rand() % 1000) * 1e-3f;
            sigma_a[4 * q + c] = (float)(rand() % 1000) * 1e-3f;
            g[4 * q + c] = q % X < X / 2 ? 0.9f : 0.1f;
        }
    }
    tyn_pass_defaults(&tyn_pass_propagate_rect, &s.params);
    s.params.cells = C;
    s.params.iterations = 1;
    s.params.channels = 3;
    for (uint32_t mode = 0; mode < 2; mode++) {
        set_medium(&s, (float[]){1, 0.75f, 0.55f}, (uint32_t[]){X, Y, Z}, mode ? sigma_s : density);
        s.sigma_a = mode ? sigma_a : NULL;
        s.g = mode ? g : NULL;
        s.params.mode = mode;
        memcpy(s.params.extent, s.medium.extent, sizeof s.params.extent);
        memcpy(s.params.size, s.medium.size, sizeof s.params.size);
        memset(sums, 0, sizeof sums);
        const double voxel = 1.0 / (40 * 40 * 40);
        for (int q = 0; q < VOXELS; q++) {
            for (int c = 0; c < 3; c++) {
                double scattering = mode ? sigma_s[4 * q + c] : density[q] * s.medium.sigma_s[c];
                sums[0][c] += voxel * scattering;
                sums[1][c] +=
                    voxel * (mode ? sigma_a[4 * q + c] : density[q] * s.medium.sigma_a[c]);
                sums[2][c] += voxel * scattering * (mode ? g[4 * q + c] : s.medium.phase[c].g);
            }
        }
        outcome o = propagate_run(*state, &s);
        double area = o.grids[0].cell * o.grids[0].cell, worst = 0;
        for (int c = 0; c < 3; c++) {
            double found[3] = {0};
            for (int q = c * C * C * C; q < (c + 1) * C * C * C; q++) {
                const float *cell = o.cells[q].c;
                found[0] += area * cell[0];
                found[1] += area * cell[1];
                found[2] += area * cell[0] * cell[2];
            }
            for (int i = 0; i < 3; i++) {
                double difference = fabs(found[i] - sums[i][c]);
                worst = maximum(worst, difference / fmax(fabs(sums[i][c]), 1e-3));
                assert_true(isfinite(found[i]));
            }
        }
        print_message("mode %u: sums over cells differ from those over voxels by %.1e\n", mode,
                      worst);
        assert_within(worst, 0.01, NULL);
    }
}

// The six fractions sum to 1: one cell of light in the middle, all of it is in its neighbours after one
// hop, whatever its mean cosine.
static void fractions_sum_to_one(void **state)
{
    static float density[STATE_TOTAL];
    const float cosines[] = {-0.999f, -0.5f, -1e-8f, 0, 1e-8f, 1e-3f, 0.5f, 0.9f, 0.999f, 0.99999f};
    memset(density, 0, sizeof density);
    density[(8 * STATE_CELLS + 8) * STATE_CELLS + 8] = 1;
    for (size_t i = 0; i < sizeof cosines / sizeof *cosines; i++) {
        setup s = unit_cube(density, 0.5f, cosines[i], (float[]){1, 0, 0});
        s.params.iterations = 1;
        s.params.init = TYN_PROPAGATE_INIT_FIRST_COLLISION;
        outcome o = propagate_run(*state, &s);
        double injected = -expm1(-0.5 / STATE_CELLS);
        double sum = total(&o, 0, STATE_TOTAL) / injected;
        print_message("a = %g: sum of fractions - 1 = %.1e\n", cosines[i], sum - 1);
        assert_near(sum, 1, 1e-6);
    }
}

// What enters is the light's irradiance times the area of the grid, and stays so in vacuum.
static void injected_power_is_one(void **state)
{
    static float density[STATE_TOTAL];
    memset(density, 0, sizeof density);
    setup s = unit_cube(density, 1, 0.6f, (float[]){1, 0, 0});
    for (s.params.iterations = 1; s.params.iterations < STATE_CELLS; s.params.iterations += 7) {
        outcome o = propagate_run(*state, &s);
        assert_near(total(&o, 0, STATE_TOTAL) / (STATE_CELLS * STATE_CELLS), 1, 1e-6);
    }
}

// Extreme media: nothing but finite, non-negative numbers, and no light gained.
static void extremes(void **state)
{
    static float density[STATE_TOTAL];
    const float sigmas[] = {1e-6f, 1, 1e3f, 1e5f, 1e8f};
    const float cosines[] = {-0.999f, -0.5f, 0, 1e-8f, 0.9f, 0.9999f};
    for (int q = 0; q < STATE_TOTAL; q++) {
        density[q] = (q ^ q >> 4 ^ q >> 8) & 1; // checkerboard
    }
    for (int i = 0; i < 5 * 6; i++) {
        setup s = unit_cube(density, sigmas[i % 5], cosines[i / 5], (float[]){0, 0, 1});
        s.medium.sigma_a[1] = sigmas[i % 5]; // the second channel absorbs as well
        s.params.channels = 3;
        s.params.rate = i & 1;
        outcome o = propagate_run(*state, &s);
        for (int q = 0; q < 3 * STATE_TOTAL; q++) {
            const float *c = o.state[q].c;
            assert_true(c[0] >= 0 && c[1] >= 0 && c[2] >= 0 && isfinite(c[0] + c[1] + c[2]));
            assert_true(c[3] >= 0 && c[3] <= 2.00001f);
            assert_true(o.seen[q] >= 0 && isfinite(o.seen[q]));
        }
        for (int c = 0; c < 3; c++) {
            assert_true(total(&o, c * STATE_TOTAL, STATE_TOTAL) <=
                        STATE_CELLS * STATE_CELLS * (1 + 1e-5));
        }
    }
}

// The grid of a light of another colour is the same: only its irradiance differs.
static void colour_of_the_light(void **state)
{
    static float density[STATE_TOTAL];
    for (int q = 0; q < STATE_TOTAL; q++) {
        density[q] = 1;
    }
    setup s = unit_cube(density, 3, 0.5f, (float[]){1, 0, 0});
    s.suns[0].color[1] = 0;
    s.suns[0].color[2] = 7;
    outcome o = propagate_run(*state, &s);
    assert_near(o.grids[0].irradiance[1], 0, 0);
    assert_near(o.grids[0].irradiance[2], 7, 0);
    assert_int_equal(o.grids[0].channels, 1);
    assert_true(total(&o, 0, STATE_TOTAL) > 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reference_states),
        cmocka_unit_test(every_reading),
        cmocka_unit_test(grids_span_the_medium),
        cmocka_unit_test(fractions_sum_to_one),
        cmocka_unit_test(injected_power_is_one),
        cmocka_unit_test(extremes),
        cmocka_unit_test(colour_of_the_light),
        cmocka_unit_test(surfaces_stop_light),
        cmocka_unit_test(ordinates),
        cmocka_unit_test(batches),
        cmocka_unit_test(shrunk_medium),
        cmocka_unit_test(many_ordinates),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
