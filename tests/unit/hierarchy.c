// hierarchy.c -- the ray hierarchy: every triangle in one leaf, boxes around what is below, and rays
// that find through it what they find one by one. Exit 77: built without Embree.
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "io_test.h"
#include "skip.h"
#include "solids.h"

static const float grey[3] = {0.5f, 0.5f, 0.5f}, dark[3] = {0, 0, 0};

static uint32_t random_state;

static float random_float(void) // [-1, 1)
{
    random_state = random_state * 1664525u + 1013904223u;
    return (float)(random_state >> 8) / 8388608.0f - 1;
}

// Triangles of all sizes, some of them flat or a point.
static void scatter(tyn_scene *scene, uint32_t count, uint32_t seed)
{
    tyn_surfaces *s = &scene->surfaces;
    tyn_scene_init(scene);
    random_state = seed;
    solids_material(scene, grey, dark);
    s->num_vertices = 3 * count;
    s->num_triangles = count;
    s->vertices = calloc(s->num_vertices, sizeof *s->vertices);
    s->triangles = calloc(count, sizeof *s->triangles);
    for (uint32_t i = 0; i < count; i++) {
        const float size = i % 50 == 0 ? 0 : 0.01f * expf(2 * random_float());
        float centre[3];
        for (int a = 0; a < 3; a++) {
            centre[a] = random_float();
        }
        for (uint32_t k = 0; k < 3; k++) {
            tyn_surface_vertex *v = &s->vertices[3 * i + k];
            v->normal[1] = 1;
            for (int a = 0; a < 3; a++) {
                v->position[a] = centre[a] + size * random_float();
            }
            s->triangles[i].vertices[k] = 3 * i + k;
        }
    }
}

static void build(tyn_scene *scene)
{
    io_log log;
    io_log_init(&log);
    assert_int_equal(tyn_surfaces_build_nodes(&scene->surfaces, &log.log), TYN_OK);
    assert_int_equal(tyn_scene_check(scene, &log.log), TYN_OK);
    assert_int_equal(log.errors, 0);
}

static bool inside(const float p[3], const tyn_surface_node *n)
{
    return p[0] >= n->lo[0] && p[0] <= n->hi[0] && p[1] >= n->lo[1] && p[1] <= n->hi[1] &&
           p[2] >= n->lo[2] && p[2] <= n->hi[2];
}

// Leaves partition the triangles in order; children lie in their parents.
static void check_tree(const tyn_surfaces *s)
{
    uint8_t *held = calloc(s->num_triangles, 1);
    for (uint32_t i = 0; i < s->num_nodes; i++) {
        const tyn_surface_node *n = &s->nodes[i];
        for (uint32_t k = 0; !n->count && k < 2; k++) {
            assert_true(inside(s->nodes[n->first + k].lo, n));
            assert_true(inside(s->nodes[n->first + k].hi, n));
        }
        assert_true(n->count <= 4);
        for (uint32_t k = n->first; k < n->first + n->count; k++) {
            assert_int_equal(held[k]++, 0);
            for (int c = 0; c < 3; c++) {
                assert_true(inside(s->vertices[s->triangles[k].vertices[c]].position, n));
            }
        }
    }
    for (uint32_t i = 0; i < s->num_triangles; i++) {
        assert_int_equal(held[i], 1);
    }
    free(held);
}

// Distance to a triangle along a ray (Moeller and Trumbore), or FLT_MAX.
static float hit_triangle(const tyn_surfaces *s, uint32_t i, const float o[3], const float d[3])
{
    const float *p[3];
    double e[2][3], h[3], t[3], q[3];
    for (int k = 0; k < 3; k++) {
        p[k] = s->vertices[s->triangles[i].vertices[k]].position;
    }
    for (int a = 0; a < 3; a++) {
        e[0][a] = (double)p[1][a] - p[0][a];
        e[1][a] = (double)p[2][a] - p[0][a];
        t[a] = (double)o[a] - p[0][a];
    }
    double det = 0, u = 0, v = 0, distance = 0;
    for (int a = 0; a < 3; a++) {
        const int b = (a + 1) % 3, c = (a + 2) % 3;
        h[a] = d[b] * e[1][c] - d[c] * e[1][b];
        q[a] = t[b] * e[0][c] - t[c] * e[0][b];
        det += e[0][a] * h[a];
        u += t[a] * h[a];
    }
    for (int a = 0; a < 3; a++) {
        v += d[a] * q[a];
        distance += e[1][a] * q[a];
    }
    bool hit = det != 0 && u / det >= 0 && v / det >= 0 && (u + v) / det <= 1 && distance / det > 0;
    return hit ? (float)(distance / det) : FLT_MAX;
}

static bool hit_box(const tyn_surface_node *n, const float o[3], const float d[3], float limit)
{
    double near = 0, far = limit;
    for (int a = 0; a < 3; a++) {
        double t0 = ((double)n->lo[a] - o[a]) / d[a], t1 = ((double)n->hi[a] - o[a]) / d[a];
        near = fmax(near, fmin(t0, t1));
        far = fmin(far, fmax(t0, t1));
    }
    return near <= far;
}

static float cast_ray(const tyn_surfaces *s, const float o[3], const float d[3], uint32_t *visits)
{
    uint32_t stack[TYN_SURFACE_MAX_DEPTH], top = 0;
    float nearest = FLT_MAX;
    stack[top++] = 0;
    while (top) {
        const tyn_surface_node *n = &s->nodes[stack[--top]];
        ++*visits;
        if (!hit_box(n, o, d, nearest)) {
            continue;
        }
        for (uint32_t k = n->first; k < n->first + n->count; k++) {
            nearest = fminf(nearest, hit_triangle(s, k, o, d));
        }
        if (!n->count) {
            assert_true(top + 2 <= TYN_SURFACE_MAX_DEPTH);
            stack[top++] = n->first + 1;
            stack[top++] = n->first;
        }
    }
    return nearest;
}

static void rays(void **state)
{
    enum { TRIANGLES = 5000, RAYS = 2000 };
    tyn_scene scene;
    uint32_t visits = 0, hits = 0;
    (void)state;
    scatter(&scene, TRIANGLES, 1);
    build(&scene);
    const tyn_surfaces *s = &scene.surfaces;
    check_tree(s);
    for (int r = 0; r < RAYS; r++) {
        float o[3], d[3], nearest = FLT_MAX;
        for (int a = 0; a < 3; a++) {
            o[a] = 1.5f * random_float();
            d[a] = random_float();
        }
        for (uint32_t i = 0; i < s->num_triangles; i++) {
            nearest = fminf(nearest, hit_triangle(s, i, o, d));
        }
        assert_true(cast_ray(s, o, d, &visits) == nearest);
        hits += nearest < FLT_MAX;
    }
    // A good tree: a ray looks at a small part of it.
    assert_true(hits > RAYS / 20 && visits / RAYS < s->num_nodes / 20);
    tyn_scene_finish(&scene);
}

static void sizes(void **state)
{
    (void)state;
    for (uint32_t count = 1; count < 40; count++) {
        tyn_scene scene;
        scatter(&scene, count, count);
        build(&scene);
        check_tree(&scene.surfaces);
        tyn_scene_finish(&scene);
    }
    tyn_scene scene;
    io_log log;
    io_log_init(&log);
    tyn_scene_init(&scene); // nothing: nothing to do
    assert_int_equal(tyn_surfaces_build_nodes(&scene.surfaces, &log.log), TYN_OK);
    assert_null(scene.surfaces.nodes);
    // All in one place: no heuristic can tell them apart.
    scatter(&scene, 1000, 3);
    for (uint32_t i = 0; i < scene.surfaces.num_vertices; i++) {
        scene.surfaces.vertices[i].position[0] = scene.surfaces.vertices[i].position[1] =
            scene.surfaces.vertices[i].position[2] = (float)(i % 3);
    }
    build(&scene);
    check_tree(&scene.surfaces);
    tyn_scene_finish(&scene);
}

// The same input gives the same tree; a hash that the host set changes.
static void repeats(void **state)
{
    tyn_scene a, b;
    (void)state;
    scatter(&a, 3000, 9);
    scatter(&b, 3000, 9);
    a.surfaces.hash = 5;
    build(&a);
    build(&b);
    assert_true(a.surfaces.hash != 5 && a.surfaces.hash != 0 && b.surfaces.hash == 0);
    assert_int_equal(a.surfaces.num_nodes, b.surfaces.num_nodes);
    assert_memory_equal(a.surfaces.nodes, b.surfaces.nodes,
                        a.surfaces.num_nodes * sizeof *a.surfaces.nodes);
    assert_memory_equal(a.surfaces.triangles, b.surfaces.triangles,
                        3000 * sizeof *a.surfaces.triangles);
    tyn_scene_finish(&a);
    tyn_scene_finish(&b);
}

int main(void)
{
    tyn_scene scene;
    io_log log;
    io_log_init(&log);
    scatter(&scene, 1, 1);
    tyn_result result = tyn_surfaces_build_nodes(&scene.surfaces, &log.log);
    tyn_scene_finish(&scene);
    if (result == TYN_ERR_UNSUPPORTED) {
        skip_all("built without Embree");
    }
    const struct CMUnitTest tests[] = {cmocka_unit_test(rays), cmocka_unit_test(sizes),
                                       cmocka_unit_test(repeats)};
    return run_cases(tests, NULL, NULL);
}
