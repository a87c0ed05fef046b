// views.c -- what views leave out: no triangle that is in them, most of those that are not. Exit 77: built without
// Embree.
#include "io_test.h"
#include "frame/shadow_cull.h"
#include "skip.h"
#include "solids.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// A cloud of small spheres and a large floor.
static void fill(tyn_scene *scene)
{
    tyn_scene_init(scene);
    const uint32_t m = solids_material(scene, (float[]){0, 0, 0}, (float[]){0, 0, 0});
    solids_quad(scene, (float[]){-9, -1, -9}, (float[]){0, 0, 18}, (float[]){18, 0, 0}, m);
    for (int i = 0; i < 60; i++) {
        const float t = 2.4f * (float)i, centre[3] = {5 * cosf(t), 0.06f * (float)i, 5 * sinf(t)};
        solids_sphere(scene, centre, 0.4f, 5, false, m);
    }
}

// Rows of a cube's face around `eye`, as those of shadow maps; a depth of 0 is infinitely far.
static void face_of(int face, const float eye[3], tyn_vec4 clip[4])
{
    const int w = face / 2;
    memset(clip, 0, 4 * sizeof *clip);
    for (int r = 0; r < 3; r++) {
        const int axis = r < 2 ? (w + 1 + r) % 3 : w;
        float *row = clip[r < 2 ? r : 3];
        row[axis] = r < 2 || face % 2 == 0 ? 1.0f : -1.0f;
        row[3] = -row[axis] * eye[axis];
    }
    clip[2][3] = 0.01f;
}

// Is a point of a lattice on the triangle in the view?
static bool in_view(const tyn_surfaces *s, const tyn_surface_triangle *t, const tyn_vec4 clip[4])
{
    enum { N = 12 };
    for (int i = 0; i <= N; i++) {
        for (int k = 0; k + i <= N; k++) {
            const double b[3] = {1 - (i + k) / (double)N, i / (double)N, k / (double)N};
            double p[4] = {0, 0, 0, 1}, c[4];
            for (int a = 0; a < 3; a++) {
                for (int v = 0; v < 3; v++) {
                    p[a] += b[v] * (double)s->vertices[t->vertices[v]].position[a];
                }
            }
            for (int r = 0; r < 4; r++) {
                c[r] = 0;
                for (int a = 0; a < 4; a++) {
                    c[r] += (double)clip[r][a] * p[a];
                }
            }
            if (fabs(c[0]) <= c[3] && fabs(c[1]) <= c[3] && c[2] >= 0 && c[2] <= c[3]) {
                return true;
            }
        }
    }
    return false;
}

static void nothing_is_lost(void **state)
{
    (void)state;
    tyn_scene scene;
    fill(&scene);
    tyn_surfaces *s = &scene.surfaces;
    io_log log;
    io_log_init(&log);
    assert_int_equal(tyn_surfaces_build_nodes(s, &log.log), TYN_OK);
    struct surface_range *below = tyn_views_prepare(s), drawn[TYN_SURFACE_RANGES];
    assert_non_null(below);
    assert_int_equal(below[0].first, 0);
    assert_int_equal(below[0].count, s->num_triangles);
    const float eyes[3][3] = {{0, 1, 0}, {5.5f, 2, 1}, {-40, 0, 3}};
    uint8_t *taken = malloc(s->num_triangles);
    double all = 0, used = 0, needed = 0;
    for (int v = 0; v < 18; v++) {
        tyn_vec4 clip[4];
        face_of(v % 6, eyes[v / 6], clip);
        tyn_view_cull(s, below, (const tyn_vec4 *)clip, drawn);
        memset(taken, 0, s->num_triangles);
        for (int k = 0; k < TYN_SURFACE_RANGES; k++) {
            assert_true(drawn[k].first + drawn[k].count <= s->num_triangles);
            for (uint32_t i = 0; i < drawn[k].count; i++) {
                assert_int_equal(taken[drawn[k].first + i]++, 0); // none is drawn twice
                used++;
            }
        }
        for (uint32_t i = 0; i < s->num_triangles; i++) {
            const bool seen = in_view(s, &s->triangles[i], (const tyn_vec4 *)clip);
            assert_true(!seen || taken[i]);
            needed += seen;
        }
        all += s->num_triangles;
    }
    print_message("%.3f of the triangles are in view, %.3f are drawn\n", needed / all, used / all);
    assert_true(needed > 0.1 * all && used < 2 * needed);
    // Without a hierarchy all are drawn.
    tyn_vec4 clip[4];
    face_of(0, eyes[0], clip);
    tyn_view_cull(s, NULL, (const tyn_vec4 *)clip, drawn);
    assert_int_equal(drawn[0].count, s->num_triangles);
    assert_int_equal(drawn[1].count, 0);
    free(taken);
    free(below);
    tyn_scene_finish(&scene);
}

static void remembered(void **state)
{
    (void)state;
    tyn_scene scene;
    fill(&scene);
    tyn_surfaces *s = &scene.surfaces;
    io_log log;
    io_log_init(&log);
    assert_int_equal(tyn_surfaces_build_nodes(s, &log.log), TYN_OK);
    struct surface_range *below = tyn_views_prepare(s);
    struct surface_range drawn[TYN_SURFACE_RANGES], exact[TYN_SURFACE_RANGES];
    tyn_views_seen *seen = calloc(1, sizeof *seen);
    assert_true(below && seen);
    const float eyes[2][3] = {{0, 1, 0}, {5.5f, 2, 1}};
    // Of two views the second one changes, then both are as they were.
    const int eye_of[4][2] = {{0, 0}, {0, 1}, {0, 1}, {0, 0}};
    for (int frame = 0; frame < 4; frame++) {
        for (uint32_t v = 0; v < 2; v++) {
            tyn_vec4 clip[4];
            face_of((int)v, eyes[eye_of[frame][v]], clip);
            tyn_view_cull(s, below, (const tyn_vec4 *)clip, exact);
            tyn_view_cull_seen(seen, v, s, below, (const tyn_vec4 *)clip, drawn);
            assert_memory_equal(drawn, exact, sizeof exact);
        }
    }
    // Nothing is looked for again: a planted range stays.
    tyn_vec4 clip[4];
    face_of(0, eyes[0], clip);
    seen->views[0].drawn[0].count = 1;
    tyn_view_cull_seen(seen, 0, s, below, (const tyn_vec4 *)clip, drawn);
    assert_int_equal(drawn[0].count, 1);
    // More views than there are places for.
    tyn_view_cull(s, below, (const tyn_vec4 *)clip, exact);
    tyn_view_cull_seen(seen, TYN_VIEWS_SEEN, s, below, (const tyn_vec4 *)clip, drawn);
    assert_memory_equal(drawn, exact, sizeof exact);
    free(seen);
    free(below);
    tyn_scene_finish(&scene);
}

static void ranges_in_any_order(void **state)
{
    (void)state;
    // A hierarchy made by hand may have its triangles in any order: leaves 2, 0 and 1.
    tyn_surface_node nodes[5] = {
        {.lo = {0, 0, 0}, .hi = {9, 1, 1}, .first = 1},
        {.lo = {6, 0, 0}, .hi = {7, 1, 1}, .first = 4, .count = 2},
        {.lo = {0, 0, 0}, .hi = {4, 1, 1}, .first = 3},
        {.lo = {0, 0, 0}, .hi = {1, 1, 1}, .first = 0, .count = 2},
        {.lo = {3, 0, 0}, .hi = {4, 1, 1}, .first = 2, .count = 2},
    };
    const tyn_surfaces s = {.nodes = nodes, .num_nodes = 5, .num_triangles = 6};
    struct surface_range *below = tyn_views_prepare(&s), drawn[TYN_SURFACE_RANGES];
    const tyn_vec4 whole[4] = {{0.01f, 0, 0, 0}, {0, 0.01f, 0, 0}, {0, 0, 0, 0.5f}, {0, 0, 0, 1}};
    tyn_view_cull(&s, below, whole, drawn);
    assert_int_equal(drawn[0].first, 0);
    assert_int_equal(drawn[0].count, 6);
    const tyn_vec4 ends[4] = {{1, 0, 0, -6.5f}, {0, 0.01f, 0, 0}, {0, 0, 0, 0.5f}, {0, 0, 0, 1}};
    tyn_view_cull(&s, below, ends, drawn); // x from 5.5 to 7.5
    assert_int_equal(drawn[0].first, 4);
    assert_int_equal(drawn[0].count, 2);
    assert_int_equal(drawn[1].count, 0);
    const tyn_vec4 beside[4] = {{1, 0, 0, 9}, {0, 1, 0, 0}, {0, 0, 0, 0.5f}, {0, 0, 0, 1}};
    tyn_view_cull(&s, below, beside, drawn);
    assert_int_equal(drawn[0].count, 0);
    free(below);
}

int main(void)
{
    tyn_scene scene;
    io_log log;
    io_log_init(&log);
    fill(&scene);
    const tyn_result result = tyn_surfaces_build_nodes(&scene.surfaces, &log.log);
    tyn_scene_finish(&scene);
    if (result == TYN_ERR_UNSUPPORTED) {
        skip_all("built without Embree");
    }
    const struct CMUnitTest tests[] = {cmocka_unit_test(nothing_is_lost),
                                       cmocka_unit_test(remembered),
                                       cmocka_unit_test(ranges_in_any_order)};
    return run_cases(tests, NULL, NULL);
}
