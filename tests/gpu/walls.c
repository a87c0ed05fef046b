// walls.c -- which links of the lattice surfaces cut: against brute force, closed, the same from both ends.
#include "bound.h"
#include "gpu_test.h"
#include "point_pass.h"
#include "wall_mesh.h"

#include "shaders/common/scene_args.h"
#include "walls_eval.comp.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- running the pass ---------------------------------------------------------------------------

typedef struct result {
    uint32_t *links;
    struct wall_cell *cells;
} result;

static result run(gpu_test *t, const grid *g, const mesh *m)
{
    size_t n = (size_t)g->n[0] * g->n[1] * g->n[2];
    tyn_graph_begin(t->graph);
    wall_refs r = mesh_walls(t, g, m);
    tyn_graph_output(t->graph, "links", r.links, true);
    tyn_graph_output(t->graph, "cells", r.cells, true);
    gpu_run(t);
    result out = {malloc(n * 4), malloc(n * sizeof *out.cells)};
    memcpy(out.links, gpu_map(t, "links"), n * 4);
    memcpy(out.cells, gpu_map(t, "cells"), n * sizeof *out.cells);
    return out;
}

static void result_free(result *r)
{
    free(r->links);
    free(r->cells);
}

// ---- the same once more -------------------------------------------------------------------------

static int reverse_of(int link)
{
    int d[3], e[3];
    wall_step(link, d);
    for (int i = 0; i < TYN_WALLS_LINKS; i++) {
        wall_step(i, e);
        if (e[0] == -d[0] && e[1] == -d[1] && e[2] == -d[2]) {
            return i;
        }
    }
    return -1;
}

static const double shift[3] = {TYN_WALLS_SHIFT_X, TYN_WALLS_SHIFT_Y, TYN_WALLS_SHIFT_Z};

static double det3(const double a[3], const double b[3], const double c[3])
{
    return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
}

// 1: cut, 0: open, -1: too close to tell in single precision.
static int cuts(double tri[3][3], const double p[3], const double d[3], double dx)
{
    double e1[3], e2[3], s[3];
    for (int a = 0; a < 3; a++) {
        e1[a] = (tri[1][a] - tri[0][a]) / dx;
        e2[a] = (tri[2][a] - tri[0][a]) / dx;
        s[a] = p[a] - tri[0][a] / dx;
    }
    // p + t d = v0 + u e1 + v e2
    double det = -det3(e1, e2, d);
    double margin = 1e-4;
    if (fabs(det) < 1e-6) { // in the plane, or beside it
        double n[3] = {e1[1] * e2[2] - e1[2] * e2[1], e1[2] * e2[0] - e1[0] * e2[2],
                       e1[0] * e2[1] - e1[1] * e2[0]};
        double size = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        return fabs(n[0] * s[0] + n[1] * s[1] + n[2] * s[2]) > margin * size ? 0 : -1;
    }
    double u = -det3(s, e2, d) / det, v = -det3(e1, s, d) / det, t = det3(e1, e2, s) / det;
    double least = fmin(fmin(u, v), fmin(1 - u - v, fmin(t, 1 - t)));
    return least > margin ? 1 : least < -margin ? 0 : -1;
}

static void compare(const grid *g, const mesh *m, const result *r, const char *name)
{
    int checked = 0, unclear = 0, cut = 0;
    for (int i = 0; i < g->n[0] * g->n[1] * g->n[2]; i++) {
        int c[3] = {i % g->n[0], i / g->n[0] % g->n[1], i / g->n[0] / g->n[1]};
        double p[3] = {c[0] + 0.5 + shift[0], c[1] + 0.5 + shift[1], c[2] + 0.5 + shift[2]};
        for (int link = 0; link < TYN_WALLS_LINKS; link++) {
            int e[3], q = i, inside = 1;
            wall_step(link, e);
            double d[3] = {e[0], e[1], e[2]};
            int expect = 0, open = 1;
            for (int k = 0; k < m->n && expect != 1; k++) {
                int one = cuts(m->tri[k], p, d, g->dx);
                expect = one == 1 ? 1 : expect;
                open = open && one == 0;
            }
            for (int a = 0; a < 3; a++) {
                inside = inside && c[a] + e[a] >= 0 && c[a] + e[a] < g->n[a];
            }
            q += (e[2] * g->n[1] + e[1]) * g->n[0] + e[0];
            int is = r->links[i] >> link & 1;
            if (inside) {
                assert_int_equal(is, r->links[q] >> reverse_of(link) & 1);
            }
            if (expect == 0 && !open) {
                unclear++;
                continue;
            }
            assert_int_equal(is, expect);
            checked++;
            cut += is;
        }
    }
    printf("%s: %d links, %d cut, %d too close to tell\n", name, checked, cut, unclear);
    assert_true(cut > 0 && unclear < checked / 20);
}

// ---- tests --------------------------------------------------------------------------------------

static void matches_brute_force(void **state)
{
    grid g = grid_of(12, 9, 7, 0.25);
    mesh meshes[2] = {
        mesh_box((double[]){1.43, 1.11, 0.87}, (double[]){0.81, 0.55, 0.47}, 0.5236),
        mesh_sphere((double[]){1.5, 1.2, 0.9}, 0.71, 2),
    };
    for (int i = 0; i < 2; i++) {
        result r = run(*state, &g, &meshes[i]);
        compare(&g, &meshes[i], &r, i ? "sphere" : "box");
        result_free(&r);
        mesh_free(&meshes[i]);
    }
}

// Nothing gets out of a closed mesh, wherever it lies; what is inside is what is.
static void closed_meshes_are_closed(void **state)
{
    grid g = grid_of(20, 20, 20, 0.05);
    int least = 1 << 30;
    for (int k = 0; k < 24; k++) {
        double c[3] = {0.5 + 0.003 * k, 0.5 - 0.0017 * k, 0.5};
        // Every fourth lies on planes of centres, on faces of cells, or on the lattice's own.
        double on_centres[3] = {0.525, 0.525, 0.525}, h = k % 4 ? 0.25 + 0.001 * k : 0.25;
        mesh m = k % 2 ? mesh_sphere(c, 0.37, k % 6)
                       : mesh_box(k % 4 ? c : on_centres, (double[]){h, h, k == 8 ? 0.475 : 0.25},
                                  k % 4 ? 0.13 * k : 0);
        result r = run(*state, &g, &m);
        bool out;
        int inside = mesh_flood(&g, r.links, (10 * 20 + 10) * 20 + 10, &out);
        assert_false(out);
        least = inside < least ? inside : least;
        assert_true(inside > 500 && inside < 6000);
        result_free(&r);
        mesh_free(&m);
    }
    printf("at least %d cells inside\n", least);
}

// Walls in the planes of centres belong to the cells above them, walls on faces part the cells.
static void walls_on_the_lattice(void **state)
{
    grid g = grid_of(8, 8, 8, 0.5);
    for (int axis = 0; axis < 3; axis++) {
        for (int half = 0; half < 2; half++) {
            double at = half ? 2.25 : 2.0; // centres of layer 4; faces between 3 and 4
            double v[4][3];
            for (int i = 0; i < 4; i++) {
                v[i][axis] = at;
                v[i][(axis + 1) % 3] = i & 1 ? 9 : -5;
                v[i][(axis + 2) % 3] = i & 2 ? 9 : -5;
            }
            mesh m = {0};
            mesh_add(&m, v[0], v[1], v[2], 0.5f);
            mesh_add(&m, v[3], v[2], v[1], 0.5f);
            result r = run(*state, &g, &m);
            for (int i = 0; i < 512; i++) {
                int c[3] = {i % 8, i / 8 % 8, i / 64};
                for (int link = 0; link < TYN_WALLS_LINKS; link++) {
                    int e[3];
                    wall_step(link, e);
                    int expect = (c[axis] >= 4) != (c[axis] + e[axis] >= 4);
                    assert_int_equal(r.links[i] >> link & 1, expect);
                }
                bool beside = c[axis] == 3 || c[axis] == 4;
                assert_true(fabs(r.cells[i].area - (beside ? 0.05 + 4 * 0.0875 / sqrt(3) : 0)) <
                            1e-6);
                assert_true(fabs(r.cells[i].albedo[1] - (beside ? 0.5 : 0)) < 1e-6);
            }
            result_free(&r);
            mesh_free(&m);
        }
    }
}

// All walls on the faces of the box: what leaves the lattice is cut, nothing within it.
static void box_is_the_room(void **state)
{
    grid g = grid_of(6, 5, 4, 0.37);
    double c[3], h[3];
    for (int a = 0; a < 3; a++) {
        c[a] = h[a] = g.extent[a] / 2;
    }
    mesh m = mesh_box(c, h, 0);
    result r = run(*state, &g, &m);
    bool out;
    assert_int_equal(mesh_flood(&g, r.links, 0, &out), 120);
    assert_false(out);
    for (int i = 0; i < 120; i++) {
        assert_int_equal(r.links[i] & TYN_WALLS_NEAR, 0);
    }
    result_free(&r);
    mesh_free(&m);
}

// A field that is 1 outside a turned box and 0 inside is 0 at every point inside and 1 outside.
static void blends_on_one_side(void **state)
{
    gpu_test *t = *state;
    grid g = grid_of(16, 16, 16, 1.0 / 16);
    size_t n = 16 * 16 * 16;
    enum { POINTS = 20000 };
    const double centre[3] = {0.51, 0.48, 0.53}, h[3] = {0.27, 0.22, 0.25}, angle = 0.5236;
    mesh m = mesh_box(centre, h, angle);
    result r = run(t, &g, &m);
    // Inside: in the box's own frame.
    const double *x0 = m.tri[0][0];
    double axes[3][3];
    for (int a = 0; a < 3; a++) {
        axes[1][a] = (m.tri[0][1][a] - x0[a]) / (2 * h[1]); // 0 -> 2: along y
        axes[2][a] = (m.tri[1][0][a] - x0[a]) / (2 * h[2]); // 0 -> 4: along z
    }
    for (int a = 0; a < 3; a++) {
        axes[0][a] = axes[1][(a + 1) % 3] * axes[2][(a + 2) % 3] -
                     axes[1][(a + 2) % 3] * axes[2][(a + 1) % 3];
    }
    float *field = calloc(n, 16), (*points)[3] = malloc(POINTS * sizeof *points);
    for (size_t i = 0; i < n + POINTS; i++) {
        double p[3], depth = 1;
        for (int a = 0; a < 3; a++) {
            size_t k = i / (a == 0 ? 1 : a == 1 ? 16 : 256) % 16;
            p[a] = i < n ? (k + 0.5 + shift[a]) / 16 : 0.02 + 0.96 * rand() / RAND_MAX;
        }
        for (int a = 0; a < 3; a++) {
            double d = 0;
            for (int b = 0; b < 3; b++) {
                d += (p[b] - centre[b]) * axes[a][b];
            }
            depth = fmin(depth, h[a] - fabs(d));
        }
        if (i < n) {
            field[4 * i] = depth > 0 ? 0.0f : 1.0f;
        } else {
            for (int a = 0; a < 3; a++) {
                points[i - n][a] = (float)p[a];
            }
        }
    }
    tyn_graph_begin(t->graph);
    wall_refs w = mesh_walls(t, &g, &m);
    struct {
        float extent[3];
        uint32_t dims[3];
    } setup = {{1, 1, 1}, {16, 16, 16}};
    const point_input inputs[] = {
        {"wall_links", TYN_BUFFER, TYN_USE_STORAGE_READ},
        {"wall_cells", TYN_BUFFER, TYN_USE_STORAGE_READ},
        {"field", TYN_IMAGE_3D, TYN_USE_SAMPLED},
        {"setup", TYN_BUFFER, TYN_USE_STORAGE_READ},
    };
    point_pass pass;
    point_pass_init(&pass, walls_eval_spirv, sizeof walls_eval_spirv, inputs, 4);
    point_pass_params params = {.count = POINTS, .result_size = 16, .results = pass.results};
    tyn_ref p[POINT_PASS_INPUTS + 2] = {
        w.links, w.cells, gpu_image(t, "field", TYN_IMAGE_3D, (tyn_extent){16, 16, 16}, 4, field),
        gpu_buffer(t, "setup", &setup, sizeof setup),
        gpu_buffer(t, "points", points, POINTS * sizeof *points)};
    assert_int_equal(tyn_graph_add(t->graph, &pass.desc, &params, p), TYN_OK);
    tyn_graph_output(t->graph, "results", p[pass.results], true);
    gpu_run(t);
    const float(*results)[4] = (const float(*)[4])gpu_map(t, "results");
    int wrong_in = 0, wrong_out = 0, in = 0, near = 0, seen = 0, within = 0;
    for (int i = 0; i < POINTS; i++) {
        double depth = 1;
        for (int a = 0; a < 3; a++) {
            double d = 0;
            for (int b = 0; b < 3; b++) {
                d += (points[i][b] - centre[b]) * axes[a][b];
            }
            depth = fmin(depth, h[a] - fabs(d));
        }
        if (fabs(depth) < 1e-5) {
            continue;
        }
        near += results[i][1] > 0;
        // Cells see each other only if both are inside or both are not; inside, as it is convex, they do.
        const float *q = points[(i + 1) % POINTS];
        float both[2];
        for (int k = 0; k < 2; k++) {
            const float *x = k ? q : points[i];
            int c[3] = {(int)(x[0] * 16), (int)(x[1] * 16), (int)(x[2] * 16)};
            both[k] = field[4 * ((c[2] * 16 + c[1]) * 16 + c[0])];
        }
        assert_true(results[i][3] < 0 || both[0] == both[1]);
        within += both[0] == 0 && both[1] == 0;
        seen += both[0] == 0 && both[1] == 0 && results[i][3] >= 0;
        in += depth > 0;
        wrong_in += depth > 0 && !(results[i][0] <= 1e-6);
        wrong_out += depth < 0 && !(results[i][0] >= 1 - 1e-6);
    }
    printf(
        "%d points inside, %d in cells with walls: %d see light from outside; %d outside see the "
        "dark\n",
        in, near, wrong_in, wrong_out);
    printf("%d of %d pairs of cells inside see each other\n", seen, within);
    assert_true(within > 100 && seen > 0.97 * within);
    assert_int_equal(wrong_in, 0);
    assert_true(wrong_out < POINTS / 500);
    free(field);
    free(points);
    result_free(&r);
    mesh_free(&m);
}

static void many_triangles(void **state)
{
    grid g = grid_of(32, 32, 32, 1.0 / 32);
    mesh m = mesh_sphere((double[]){0.5, 0.5, 0.5}, 0.4, 7); // 131072
    result r = run(*state, &g, &m);
    bool out;
    int inside = mesh_flood(&g, r.links, (16 * 32 + 16) * 32 + 16, &out);
    assert_false(out);
    double sphere = 4. / 3 * M_PI * pow(0.4 * 32, 3);
    printf("%d triangles: %.1f ms; %d cells inside, the sphere's volume is %.0f\n", m.n,
           gpu_ms(*state, "walls"), inside, sphere);
    assert_within(fabs(inside / sphere - 1), 0.01, NULL);
    result again = run(*state, &g, &m);
    assert_memory_equal(r.cells, again.cells, 32768 * sizeof *r.cells);
    result_free(&r);
    result_free(&again);
    mesh_free(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(matches_brute_force),  cmocka_unit_test(closed_meshes_are_closed),
        cmocka_unit_test(walls_on_the_lattice), cmocka_unit_test(box_is_the_room),
        cmocka_unit_test(blends_on_one_side),   cmocka_unit_test(many_triangles),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
