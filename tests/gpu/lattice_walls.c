// lattice_walls.c -- the lattice among walls: against a twin, furnace, closed rooms, darkness, balance.
#include "bound.h"
#include "gpu_test.h"
#include "numbers.h"
#include "wall_mesh.h"
#include "shaders/common/scene_args.h"
#include "passes/lattice/lattice.h"
#include "random_unit.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// What is solved, of one channel, and the solution.
typedef struct problem {
    grid g;
    const mesh *walls; // NULL: none
    float (*cell)[4];  // sigma_s', sigma_a, g', emission
    float (*beam)[4];  // fluence and flux of unscattered light
    float boundary;    // radiance from all sides
    float wall_light;  // radiance that all walls send out
    int sweeps, cycles;
    // Of the device:
    float (*moments)[4];
    uint32_t *links;
    struct wall_cell *cells;
    double leak, absorbed_by_walls, sent_by_walls; // W
    double ms;
    uint32_t non_finite;
} problem;

static int num_cells(const problem *p)
{
    return p->g.n[0] * p->g.n[1] * p->g.n[2];
}

static problem problem_of(grid g, const mesh *walls)
{
    problem p = {.g = g, .walls = walls, .sweeps = 4, .cycles = 2};
    size_t n = (size_t)num_cells(&p);
    p.cell = calloc(n, sizeof *p.cell);
    p.beam = calloc(n, sizeof *p.beam);
    p.moments = calloc(n, sizeof *p.moments);
    p.links = calloc(n, sizeof *p.links);
    p.cells = calloc(n, sizeof *p.cells);
    return p;
}

static void problem_free(problem *p)
{
    free(p->cell);
    free(p->beam);
    free(p->moments);
    free(p->links);
    free(p->cells);
}

static void fill(problem *p, float sigma_s, float sigma_a, float g)
{
    for (int i = 0; i < num_cells(p); i++) {
        p->cell[i][0] = sigma_s;
        p->cell[i][1] = sigma_a;
        p->cell[i][2] = g;
    }
}

static void run(gpu_test *t, problem *p)
{
    size_t n = (size_t)num_cells(p);
    const uint32_t *d = (const uint32_t *)p->g.n;
    tyn_extent texels = {d[0], d[1], d[2]};
    struct env_block env = {.sky = {p->boundary, p->boundary, p->boundary}};
    tyn_lattice_params params;
    tyn_pass_defaults(&tyn_pass_lattice, &params);
    params.shape.channels = 1;
    for (int a = 0; a < 3; a++) {
        params.shape.cells =
            p->g.n[a] > params.shape.cells || a == 0 ? p->g.n[a] : params.shape.cells;
        params.shape.extent[a] = (float)p->g.extent[a];
        params.shape.tint[a] = 1;
    }
    params.sweeps = p->sweeps;
    params.cycles = p->cycles;
    tyn_graph_begin(t->graph);
    tyn_ref refs[64] = {
        [LATTICE_PORT_CELLS] = gpu_image(t, "cells", TYN_IMAGE_3D, texels, 4, &p->cell[0][0]),
        [LATTICE_PORT_SOURCE] = gpu_image(t, "source", TYN_IMAGE_3D, texels, 4, &p->beam[0][0]),
        [LATTICE_PORT_ENVIRONMENT] = gpu_buffer(t, "environment", &env, sizeof env),
    };
    float *light = malloc(n * 12);
    for (size_t i = 0; i < 3 * n; i++) {
        light[i] = p->wall_light;
    }
    if (p->walls) {
        wall_refs w = mesh_walls(t, &p->g, p->walls);
        refs[LATTICE_PORT_WALL_LINKS] = w.links;
        refs[LATTICE_PORT_WALL_CELLS] = w.cells;
        if (p->wall_light != 0) {
            refs[LATTICE_PORT_WALL_LIGHT] = gpu_buffer(t, "wall_light", light, n * 12);
        }
    }
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_lattice, &params, refs), TYN_OK);
    tyn_graph_output(t->graph, "moments", refs[LATTICE_PORT_MOMENTS], true);
    tyn_graph_output(t->graph, "leaks", refs[LATTICE_PORT_LEAKS], true);
    tyn_graph_output(t->graph, "counters", refs[LATTICE_PORT_COUNTERS], true);
    if (p->walls) {
        tyn_graph_output(t->graph, "links", refs[LATTICE_PORT_WALL_LINKS], true);
        tyn_graph_output(t->graph, "wall_cells", refs[LATTICE_PORT_WALL_CELLS], true);
        tyn_graph_output(t->graph, "wall_power", refs[LATTICE_PORT_WALL_POWER], true);
    }
    gpu_run(t);
    memcpy(p->moments, gpu_map(t, "moments"), n * 16);
    tyn_extent bytes;
    const float *leaks = tyn_graph_map(t->graph, "leaks", &bytes, NULL);
    p->leak = p->absorbed_by_walls = p->sent_by_walls = 0;
    for (uint32_t i = 0; i < bytes.x / 4; i++) {
        p->leak += leaks[i];
    }
    if (p->walls) {
        memcpy(p->links, gpu_map(t, "links"), n * 4);
        memcpy(p->cells, gpu_map(t, "wall_cells"), n * sizeof *p->cells);
        const float *power = gpu_map(t, "wall_power");
        for (size_t i = 0; i < n; i++) {
            p->absorbed_by_walls += power[2 * i];
            p->sent_by_walls += power[2 * i + 1];
        }
    }
    p->ms = gpu_ms(t, "lattice");
    p->non_finite = gpu_non_finite(t);
    free(light);
}

// ---- the same once more, in double precision, without acceleration ------------------------------

static const double pi = 3.14159265358979323846;

typedef struct twin {
    double (*m)[4];
    double *wall; // radiance that walls send out
} twin;

static int link_of(const int d[3])
{
    int axes = abs(d[0]) + abs(d[1]) + abs(d[2]);
    if (axes == 1) {
        int a = d[0] ? 0 : d[1] ? 1 : 2;
        return 2 * a + (d[a] < 0);
    }
    return 6 + (d[0] < 0) + 2 * (d[1] < 0) + 4 * (d[2] < 0);
}

static double source(const problem *p, const twin *w, int i, const double o[3])
{
    double phi = w->m[i][0] + p->beam[i][0], f = 0;
    for (int a = 0; a < 3; a++) {
        f += o[a] * (w->m[i][a + 1] + p->beam[i][a + 1]);
    }
    return (phi + 3 * p->cell[i][2] * f) / (4 * pi);
}

// One sweep; returns the largest change of the fluence.
static double twin_sweep(const problem *p, twin *w)
{
    const int *n = p->g.n, cells = num_cells(p);
    double(*m)[4] = calloc((size_t)cells, sizeof *m), *arriving = calloc((size_t)cells, 8);
    double *psi_out = calloc((size_t)cells, 8), dx = p->g.dx;
    for (int dir = 0; dir < 27; dir++) {
        int d[3] = {dir % 3 - 1, dir / 3 % 3 - 1, dir / 9 - 1};
        int axes = abs(d[0]) + abs(d[1]) + abs(d[2]);
        if (axes != 1 && axes != 3) {
            continue;
        }
        int back[3] = {-d[0], -d[1], -d[2]};
        uint32_t forward_bit = 1u << link_of(d), back_bit = 1u << link_of(back);
        double length = dx * sqrt(axes), weight = axes == 1 ? 0.05 : 0.0875, o[3];
        for (int a = 0; a < 3; a++) {
            o[a] = d[a] / sqrt(axes);
        }
        int step = (d[2] * n[1] + d[1]) * n[0] + d[0];
        for (int k = 0; k < cells; k++) {
            int c[3] = {k % n[0], k / n[0] % n[1], k / n[0] / n[1]};
            bool up = true, down = true;
            for (int a = 0; a < 3; a++) {
                c[a] = d[a] < 0 ? n[a] - 1 - c[a] : c[a];
                up = up && c[a] - d[a] >= 0 && c[a] - d[a] < n[a];
                down = down && c[a] + d[a] >= 0 && c[a] + d[a] < n[a];
            }
            int i = (c[2] * n[1] + c[1]) * n[0] + c[0];
            bool from_wall = p->links[i] & back_bit, to_wall = p->links[i] & forward_bit;
            double psi = from_wall ? w->wall[i] : up ? psi_out[i - step] : p->boundary;
            up = up && !from_wall;
            down = down && !to_wall;
            double s = source(p, w, i, o), before = up ? source(p, w, i - step, o) : s,
                   behind = down ? source(p, w, i + step, o) : s;
            double slope = (behind - before) / (up && down ? 2 : 1);
            slope = fmin(fmax(slope, -2 * fabs(s)), 2 * fabs(s));
            double tau = (p->cell[i][0] + (double)p->cell[i][1]) * length, e = exp(-tau);
            double a0 = tau > 1e-6 ? -expm1(-tau) / tau : 1 - tau / 2;
            double a1 = tau > 1e-3 ? (1 - a0) / tau : 0.5 - tau / 6 + tau * tau / 24;
            double w1 = tau > 0.05 ? a1 - a0 / 2 : tau * (1. / 12 - tau / 24 + tau * tau / 80);
            double b1 = tau > 0.05 ? -w1 / tau : -(1. / 12 - tau / 24 + tau * tau / 80);
            double q = length * p->cell[i][0], j = length * p->cell[i][3];
            double mean = psi * a0 + q * (s * a1 + slope * b1) + j * a1;
            psi_out[i] = psi * e + q * (s * a0 + slope * w1) + j * a0;
            m[i][0] += 4 * pi * weight * mean;
            for (int a = 0; a < 3; a++) {
                m[i][a + 1] += 4 * pi * weight * mean * o[a];
            }
            if (to_wall) {
                arriving[i] += weight * dx / length * psi_out[i];
            }
        }
    }
    double change = 0, most = 1e-30;
    for (int i = 0; i < cells; i++) {
        change = maximum(change, fabs(m[i][0] - w->m[i][0]));
        most = maximum(most, fabs(m[i][0]));
        const struct wall_cell *wall = &p->cells[i];
        if (wall->area > 0) {
            w->wall[i] = wall->albedo[0] * arriving[i] / wall->area + p->wall_light;
        }
    }
    memcpy(w->m, m, (size_t)cells * sizeof *m);
    free(m);
    free(arriving);
    free(psi_out);
    return change / most;
}

static void matches_twin(void **state)
{
    grid g = grid_of(13, 11, 9, 0.1);
    mesh m = mesh_box((double[]){0.67, 0.52, 0.43}, (double[]){0.31, 0.23, 0.21}, 0.5236);
    m.albedo[3][0] = 0.9f;
    problem p = problem_of(g, &m);
    uint32_t seed = 3;
    for (int i = 0; i < num_cells(&p); i++) {
        p.cell[i][0] = (float)(6 * random_unit(&seed));
        p.cell[i][1] = (float)random_unit(&seed);
        p.cell[i][2] = (float)(0.8 * random_unit(&seed) - 0.3);
        p.cell[i][3] = (float)(0.1 * random_unit(&seed));
        p.beam[i][0] = (float)random_unit(&seed);
        p.beam[i][1] = 0.7f * p.beam[i][0];
    }
    p.boundary = 0.25f;
    p.wall_light = 0.1f;
    p.sweeps = 24;
    run(*state, &p);
    twin w = {calloc((size_t)num_cells(&p), 32), calloc((size_t)num_cells(&p), 8)};
    int sweeps = 0;
    while (twin_sweep(&p, &w) > 1e-9 && sweeps < 2000) {
        sweeps++;
    }
    double worst = 0, scale = 0;
    for (int i = 0; i < num_cells(&p); i++) {
        scale = fmax(scale, w.m[i][0]);
        for (int k = 0; k < 4; k++) {
            worst = maximum(worst, fabs(p.moments[i][k] - w.m[i][k]));
        }
    }
    printf("twin converged in %d sweeps; largest difference %.1e\n", sweeps, worst / scale);
    assert_true(worst / scale < 1e-4);
    free(w.m);
    free(w.wall);
    problem_free(&p);
    mesh_free(&m);
}

static void set_albedo(mesh *m, float albedo)
{
    for (int i = 0; i < m->n; i++) {
        m->albedo[i][0] = m->albedo[i][1] = m->albedo[i][2] = albedo;
    }
}

static bool in_box(const problem *p, int i, const double centre[3], double h)
{
    int c[3] = {i % p->g.n[0], i / p->g.n[0] % p->g.n[1], i / p->g.n[0] / p->g.n[1]};
    double r = 0;
    for (int a = 0; a < 3; a++) {
        double x = (c[a] + 0.5) * p->g.dx - centre[a];
        r += x * x;
    }
    return r < h * h;
}

// Uniform surroundings, white walls, no absorption: nothing is to be seen. In what is closed it is dark.
static void furnace_and_darkness(void **state)
{
    const double centre[3] = {1.03, 0.98, 1.01};
    for (int k = 0; k < 4; k++) {
        mesh m = mesh_box(centre, (double[]){0.42, 0.45, 0.4}, 0.5236);
        set_albedo(&m, k % 2 ? 0.5f : 1.0f);
        problem p = problem_of(grid_of(20, 20, 20, 0.1), &m);
        fill(&p, k / 2 ? 10.0f : 1.0f, 0, 0.3f);
        p.boundary = 1;
        for (p.sweeps = 4; p.sweeps <= 16; p.sweeps += 12) {
            run(*state, &p);
            double inside = 0, wrong = 0, least = 1e9;
            for (int i = 0; i < num_cells(&p); i++) {
                if (in_box(&p, i, centre, 0.38)) {
                    inside = maximum(inside, fabs(p.moments[i][0]));
                } else if (!in_box(&p, i, centre, 0.75)) {
                    wrong = maximum(wrong, fabs(p.moments[i][0] / (4 * pi) - 1));
                    least = minimum(least, p.moments[i][0]);
                }
            }
            printf("sigma_s %g, albedo %g: %d sweeps, furnace off by %.1e, inside %.1e\n",
                   p.cell[0][0], m.albedo[0][0], p.sweeps, wrong, inside);
            assert_true(inside < 1e-4 && least > 0);
            if (k % 2 == 0) {
                assert_true(p.sweeps == 4 ? within(wrong, 0.03, NULL, "furnace, 4 sweeps")
                                          : wrong < 1e-4);
            }
        }
        problem_free(&p);
        mesh_free(&m);
    }
}

// A closed room whose walls shine: L = L_e / (1 - albedo) everywhere.
static void closed_rooms(void **state)
{
    for (int k = 0; k < 6; k++) {
        float albedo = k % 2 ? 0.75f : 0.9f, sigma = k / 2 == 0 ? 0 : k / 2 == 1 ? 0.3f : 10;
        grid g = grid_of(16, 12, 16, 0.25);
        double c[3] = {2, 1.5, 2}, h[3] = {1.9, 1.4, 1.9};
        for (int a = 0; a < 3 && k % 4 != 3; a++) {
            c[a] = h[a] = g.extent[a] / 2; // the walls are the faces of the box
        }
        mesh m = mesh_box(c, h, 0);
        set_albedo(&m, albedo);
        problem p = problem_of(g, &m);
        fill(&p, sigma, 0, 0.2f);
        p.wall_light = 1;
        for (p.sweeps = 2; p.sweeps <= 16; p.sweeps *= 2) {
            run(*state, &p);
            double wrong = 0;
            for (int i = 0; i < num_cells(&p); i++) {
                if (in_box(&p, i, c, 1.3)) {
                    wrong = maximum(wrong, fabs(p.moments[i][0] / (4 * pi) * (1 - albedo) - 1));
                }
            }
            printf("albedo %g, sigma_s %g: %d sweeps, off by %.1e; walls absorb %.6g of %.6g W\n",
                   albedo, sigma, p.sweeps, wrong, p.absorbed_by_walls, p.sent_by_walls);
            // White walls among which nothing scatters take the longest.
            const double after_8[6] = {5e-3, 4e-4, 6e-4, 3e-4, 1.5e-4, 2.5e-4};
            assert_true(p.sweeps != 8 ||
                        within(wrong, after_8[k], NULL, "closed room %d, 8 sweeps", k));
            assert_true(p.sweeps != 16 || k > 0 ||
                        within(wrong, 3e-4, NULL, "closed room, 16 sweeps"));
            assert_true(p.sweeps != 16 || k == 0 || wrong <= 1.5e-5);
        }
        problem_free(&p);
        mesh_free(&m);
    }
}

// What light brings is absorbed by medium and walls, or leaves.
static void conserves(void **state)
{
    static const float media[][3] = {{1, 0, 0}, {8, 0, 0.4f}, {0.3f, 0.02f, 0.375f}, {30, 0.3f, 0}};
    for (int k = 0; k < 8; k++) {
        mesh m = mesh_box((double[]){0.53, 0.47, 0.5}, (double[]){0.3, 0.22, 0.25}, 0.3);
        set_albedo(&m, k < 4 ? 0.75f : 0);
        m.n -= 4; // open on two sides
        problem p = problem_of(grid_of(24, 24, 24, 1.0 / 24), &m);
        fill(&p, media[k % 4][0], media[k % 4][1], media[k % 4][2]);
        for (int i = 0; i < num_cells(&p); i++) {
            p.beam[i][0] = p.beam[i][3] = i / 576 < 4 ? 1 : 0.1f;
        }
        for (p.sweeps = 4; p.sweeps <= 16; p.sweeps *= 2) {
            run(*state, &p);
            double made = 0, absorbed = 0, volume = pow(p.g.dx, 3), least = 0;
            for (int i = 0; i < num_cells(&p); i++) {
                made += volume * p.cell[i][0] * p.beam[i][0];
                absorbed += volume * p.cell[i][1] * p.moments[i][0];
                least = minimum(least, p.moments[i][0]);
            }
            double missing = 1 - (p.leak + absorbed + p.absorbed_by_walls) / made;
            printf("albedo %g, sigma_s %g: %d sweeps, %.1e missing; walls %.2f, medium %.2f, "
                   "escaped %.2f\n",
                   (double)m.albedo[0][0], media[k % 4][0], p.sweeps, missing,
                   p.absorbed_by_walls / made, absorbed / made, p.leak / made);
            // Black walls: next to nothing is left to be reflected after four sweeps.
            const double white_8[4] = {2e-4, 6e-5, 3e-4, 5e-6};
            const double black_4[4] = {1e-4, 1e-3, 2e-6, 1e-3};
            const double white = p.sweeps == 4   ? k % 4 == 3 ? 6e-4 : 0.02
                                 : p.sweeps == 8 ? white_8[k % 4]
                                                 : 2e-6;
            const double black = p.sweeps == 4 ? black_4[k % 4] : p.sweeps == 8 ? 5e-5 : 2e-6;
            const double bound = k < 4 ? white : black;
            assert_true(bound > 1e-4
                            ? within(fabs(missing), bound, NULL, "%s walls, medium %d, %d sweeps",
                                     k < 4 ? "white" : "black", k % 4, p.sweeps)
                            : fabs(missing) < bound);
            assert_true(least > -1e-4);
        }
        problem_free(&p);
        mesh_free(&m);
    }
}

// What walls send out that is not finite is counted, beside the cells where it arrives.
static void not_finite(void **state)
{
    mesh m = mesh_box((double[]){0.5, 0.5, 0.5}, (double[]){0.4, 0.4, 0.4}, 0);
    problem p = problem_of(grid_of(16, 16, 16, 1.0 / 16), &m);
    fill(&p, 4, 0, 0);
    p.sweeps = 1;
    p.cycles = 0;
    p.wall_light = 1;
    run(*state, &p);
    assert_int_equal(p.non_finite, 0);
    p.wall_light = NAN;
    run(*state, &p);
    uint32_t walls = 0;
    for (int i = 0; i < num_cells(&p); i++) {
        walls += p.cells[i].area > 0;
        assert_true(isfinite(p.moments[i][0]));
    }
    assert_true(walls > 0);
    assert_int_equal(p.non_finite, walls + (uint32_t)num_cells(&p));
    problem_free(&p);
    mesh_free(&m);
}

static void costs(void **state)
{
    mesh m = mesh_box((double[]){0.5, 0.5, 0.5}, (double[]){0.4, 0.4, 0.4}, 0.5);
    problem p = problem_of(grid_of(32, 32, 32, 1.0 / 32), NULL);
    fill(&p, 4, 0, 0);
    p.boundary = 1;
    double ms[2] = {1e9, 1e9};
    for (int i = 0; i < 6; i++) {
        p.walls = i % 2 ? &m : NULL;
        p.boundary = (float)(1 + i);
        run(*state, &p);
        ms[i % 2] = fmin(ms[i % 2], p.ms);
    }
    printf("32^3 cells, 4 sweeps: %.1f ms without walls, %.1f with\n", ms[0], ms[1]);
    problem_free(&p);
    mesh_free(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(matches_twin), cmocka_unit_test(furnace_and_darkness),
        cmocka_unit_test(closed_rooms), cmocka_unit_test(conserves),
        cmocka_unit_test(not_finite),   cmocka_unit_test(costs),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
