// surface_trace.c -- rays and triangles: closed meshes do not leak, surfaces are not left behind, at any scale.
#include "gpu_test.h"
#include "numbers.h"
#include "point_pass.h"
#include "solids.h"
#include "shaders/surfaces/surface_args.h"
#include "surface_trace_eval.comp.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { COUNT = 1 << 12 }; // a run; TYN_LONG=N: N times the runs

typedef struct ray_in {
    float origin[3];
    uint32_t triangle;
    float direction[3], side, barycentric[2];
} ray_in;
typedef struct ray_out {
    float t;
    uint32_t triangle, any;
    float origin[3], direction[3];
} ray_out;

static ray_in rays[COUNT];

static double uniform(void)
{
    static uint64_t state = 88172645463325252ull;
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return (double)(state >> 11) * 0x1p-53;
}

static void sphere_point(double p[3])
{
    double z = 2 * uniform() - 1, phi = 2 * M_PI * uniform(), r = sqrt(1 - z * z);
    p[0] = r * cos(phi);
    p[1] = r * sin(phi);
    p[2] = z;
}

// M -> world: a turn about a skew axis by `angle` and a shift.
static void make_frame(struct surface_block *b, double angle, const float shift[3])
{
    const double k[3] = {2.0 / 3, -1.0 / 3, 2.0 / 3}, c = cos(angle), s = sin(angle);
    const double cross[3][3] = {{0, -k[2], k[1]}, {k[2], 0, -k[0]}, {-k[1], k[0], 0}};
    double r[3][3];
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            r[i][j] = (i == j ? c : 0) + s * cross[i][j] + (1 - c) * k[i] * k[j];
        }
    }
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            b->to_world[i][j] = (float)r[i][j];
            b->from_world[i][j] = (float)r[j][i];
        }
        b->to_world[i][3] = shift[i];
        b->from_world[i][3] = (float)-(r[0][i] * (double)shift[0] + r[1][i] * (double)shift[1] +
                                       r[2][i] * (double)shift[2]);
    }
}

static int effort(int runs)
{
    const char *s = getenv("TYN_LONG");
    return s ? runs * atoi(s) : runs;
}

static void to_m(const struct surface_block *b, const double world[3], float m[3])
{
    for (int i = 0; i < 3; i++) {
        m[i] = (float)((double)b->from_world[i][0] * world[0] +
                       (double)b->from_world[i][1] * world[1] +
                       (double)b->from_world[i][2] * world[2] + (double)b->from_world[i][3]);
    }
}

// How rays find triangles: all of them are tried, by the hierarchy, or as constants of the kernel.
typedef enum tracing { ALL, TREE, FEW } tracing;

static void set_few(struct surface_block *block, const tyn_surfaces *s)
{
    for (uint32_t i = 0; i < s->num_triangles; i++) {
        struct surface_corners *c = &block->few[i];
        float *corners[3] = {c->v0, c->v1, c->v2};
        for (int k = 0; k < 3; k++) {
            memcpy(corners[k], s->vertices[s->triangles[i].vertices[k]].position, sizeof c->v0);
        }
        for (int a = 0; a < 3; a++) {
            const int b = (a + 1) % 3, d = (a + 2) % 3;
            const float p = (c->v1[b] - c->v0[b]) * (c->v2[d] - c->v0[d]),
                        q = (c->v1[d] - c->v0[d]) * (c->v2[b] - c->v0[b]);
            c->normal[a] = p - q;
            c->rounding[a] = 2.3841858e-7f * (fabsf(p) + fabsf(q));
        }
    }
}

static const ray_out *trace(gpu_test *t, const tyn_scene *scene, struct surface_block *block,
                            bool from_surface, tracing how)
{
    static const point_input inputs[] = {
        {"surfaces", TYN_BUFFER, TYN_USE_UNIFORM},
        {"vertices", TYN_BUFFER, TYN_USE_TEXELS_VEC4},
        {"triangles", TYN_BUFFER, TYN_USE_TEXELS_UVEC4},
        {"nodes", TYN_BUFFER, TYN_USE_TEXELS_UVEC4},
    };
    static point_pass pass;
    const tyn_surfaces *s = &scene->surfaces;
    point_pass_init(&pass, surface_trace_eval_spirv, sizeof surface_trace_eval_spirv, inputs, 4);
    block->num_triangles = s->num_triangles;
    tyn_surface_node leaf = {
        .lo = {-1e3f, -1e3f, -1e3f}, .hi = {1e3f, 1e3f, 1e3f}, .count = s->num_triangles};
    const tyn_surface_node *nodes = how == TREE ? s->nodes : &leaf;
    block->num_nodes = how == TREE ? s->num_nodes : 1;
    uint32_t few = how == FEW ? s->num_triangles : 0;
    assert_in_range(few, 0, TYN_SURFACE_FEW);
    if (few) {
        set_few(block, s);
    }
    tyn_graph_begin(t->graph);
    tyn_ref refs[6] = {
        gpu_buffer(t, "surfaces", block, sizeof *block),
        gpu_buffer(t, "vertices", s->vertices, s->num_vertices * sizeof *s->vertices),
        gpu_buffer(t, "triangles", s->triangles, s->num_triangles * sizeof *s->triangles),
        gpu_buffer(t, "nodes", nodes, block->num_nodes * sizeof *nodes),
        gpu_buffer(t, "points", rays, sizeof rays),
    };
    point_pass_params params = {COUNT, sizeof(ray_out), from_surface + 2 * few, pass.results};
    assert_int_equal(tyn_graph_add(t->graph, &pass.desc, &params, refs), TYN_OK);
    tyn_graph_output(t->graph, "results", refs[pass.results], true);
    gpu_run(t);
    return gpu_map(t, "results");
}

// A point of the mesh as the shader finds it: vertices, edges, and inside.
static void aim(const tyn_surfaces *s, int kind, double p[3])
{
    const tyn_surface_triangle *t = &s->triangles[(uint32_t)(uniform() * s->num_triangles)];
    double b1 = kind == 0   ? 0
                : kind == 1 ? 0
                            : uniform(),
           b2 = kind == 0 ? 0 : uniform() * (1 - b1);
    for (int a = 0; a < 3; a++) {
        p[a] = (1 - b1 - b2) * (double)s->vertices[t->vertices[0]].position[a] +
               b1 * (double)s->vertices[t->vertices[1]].position[a] +
               b2 * (double)s->vertices[t->vertices[2]].position[a];
    }
}

// From inside a sphere every ray meets it: at vertices and edges too, far from the origin too.
static void closed_meshes(void **state)
{
    long met = 0;
    for (int i = 0; i < effort(12); i++) {
        const float scale = (const float[]){1, 1e-3f, 1e5f}[i % 3];
        const float centre[3] = {i % 2 ? 20 * scale : 0, i % 2 ? -3 * scale : 0, 0};
        const uint32_t rings = i / 6 % 2 ? 40 : 3;
        tyn_scene scene;
        tyn_scene_init(&scene);
        uint32_t m = solids_material(&scene, (float[]){0, 0, 0}, (float[]){0, 0, 0});
        solids_sphere(&scene, centre, scale, rings, i % 4 > 1, m);
        solids_hierarchy(&scene, 2);
        struct surface_block block = {.num_triangles = 0};
        make_frame(&block, i % 5 * 0.7, i % 5 ? (float[]){3 * scale, scale, -scale} : centre);
        for (int k = 0; k < COUNT; k++) {
            double from[3], to[3], d[3], length = 0;
            sphere_point(from);
            double r =
                0.7 * cbrt(uniform()) * (double)scale; // 3 rings: within the inscribed sphere
            for (int a = 0; a < 3; a++) {
                from[a] = (double)centre[a] + r * (rings == 3 ? 0.5 : 1) * from[a];
            }
            aim(&scene.surfaces, k % 4, to);
            to_m(&block, from, rays[k].origin);
            float target[3];
            to_m(&block, to, target);
            for (int a = 0; a < 3; a++) {
                d[a] = (double)target[a] - (double)rays[k].origin[a];
                length += d[a] * d[a];
            }
            for (int a = 0; a < 3; a++) {
                rays[k].direction[a] = (float)(d[a] / sqrt(length));
            }
        }
        const ray_out *out = trace(*state, &scene, &block, false, rings == 3 && i % 2 ? FEW : TREE);
        int leaks = 0, wrong = 0;
        for (int k = 0; k < COUNT; k++) {
            leaks += !(out[k].t < 4 * scale);
            wrong += !out[k].any;
        }
        assert_int_equal(leaks, 0);
        assert_int_equal(wrong, 0);
        met += COUNT;
        tyn_scene_finish(&scene);
    }
    printf("%ld rays: no leak\n", met);
}

// The hierarchy finds what trying all triangles finds.
static void same_as_all(void **state)
{
    static float all[COUNT];
    tyn_scene scene;
    tyn_scene_init(&scene);
    uint32_t m = solids_material(&scene, (float[]){0, 0, 0}, (float[]){0, 0, 0});
    solids_box(&scene, (float[]){-1, -1, -1}, (float[]){1, 1, 1}, 0.3f, false, m);
    solids_sphere(&scene, (float[]){0.4f, 0, 0.2f}, 0.8f, 5, false, m);
    solids_quad(&scene, (float[]){-5, -1, -5}, (float[]){0, 0, 10}, (float[]){10, 0, 0}, m);
    solids_hierarchy(&scene, 3);
    struct surface_block block = {.num_triangles = 0};
    make_frame(&block, 0, (float[]){0, 0, 0});
    for (int k = 0; k < COUNT; k++) {
        double d[3];
        sphere_point(d);
        for (int a = 0; a < 3; a++) {
            rays[k].direction[a] = (float)d[a];
            rays[k].origin[a] = (float)(4 * uniform() - 2);
        }
        for (int a = 0; k % 8 == 0 && a < 3; a++) { // along an axis
            rays[k].direction[a] = a == k / 8 % 3 ? (k / 24 % 2 ? 1 : -1) : 0;
        }
    }
    const ray_out *out = trace(*state, &scene, &block, false, ALL);
    int hits = 0;
    for (int k = 0; k < COUNT; k++) {
        all[k] = out[k].t;
        hits += out[k].t < 1e30f;
    }
    out = trace(*state, &scene, &block, false, TREE);
    for (int k = 0; k < COUNT; k++) {
        if (!(fabsf(all[k] - out[k].t) <= 1e-6f * all[k])) {
            fail_msg("ray %d: %.9g of all, %.9g by the hierarchy", k, (double)all[k],
                     (double)out[k].t);
        }
        assert_true(out[k].any);
    }
    printf("%d rays, %d hits\n", COUNT, hits);
    assert_in_range(hits, COUNT / 4, COUNT);
    tyn_scene_finish(&scene);
}

// Rays that leave a convex body from its outside never meet it; from its inside they meet it once, as far away
// as geometry says.
static void from_surfaces(void **state)
{
    for (int i = 0; i < effort(16); i++) {
        const float scale = (const float[]){1, 1e-3f, 1e5f, 30}[i % 4];
        const bool inside = i / 4 % 2, box = i / 8 % 2;
        const float centre[3] = {i % 3 ? -4 * scale : 0, i % 3 * scale, 2 * scale};
        tyn_scene scene;
        tyn_scene_init(&scene);
        uint32_t m = solids_material(&scene, (float[]){0, 0, 0}, (float[]){0, 0, 0});
        if (box) {
            float lo[3], hi[3];
            for (int a = 0; a < 3; a++) {
                lo[a] = centre[a] - scale * (const float[]){1, 0.2f, 3}[a];
                hi[a] = centre[a] + scale * (const float[]){1, 0.2f, 3}[a];
            }
            solids_box(&scene, lo, hi, 0.1f * (float)i, false, m);
        } else {
            solids_sphere(&scene, centre, scale, 12, false, m);
        }
        solids_hierarchy(&scene, 2);
        struct surface_block block = {.num_triangles = 0};
        make_frame(&block, i % 5 * 0.5, i % 5 ? centre : (float[]){0, 0, 0});
        for (int k = 0; k < COUNT; k++) {
            double d[3], u = uniform(), v = uniform();
            sphere_point(d);
            if (k % 3 == 0) { // grazing, on the whole
                d[0] *= 1e-3;
            }
            rays[k].triangle = (uint32_t)(uniform() * scene.surfaces.num_triangles);
            rays[k].barycentric[0] = (float)(sqrt(u) * (1 - v));
            rays[k].barycentric[1] = (float)(sqrt(u) * v);
            rays[k].side = inside ? -1 : 1;
            double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
            for (int a = 0; a < 3; a++) {
                rays[k].direction[a] = (float)(d[a] / length);
            }
        }
        const ray_out *out = trace(*state, &scene, &block, true, box && i % 2 ? FEW : TREE);
        int wrong = 0, none = 0;
        for (int k = 0; k < COUNT; k++) {
            bool hit = out[k].t < 1e30f;
            none += !hit;
            wrong += inside ? hit && out[k].triangle == rays[k].triangle : hit;
        }
        printf("%s, scale %g, %s: %d of %d wrong, %d without a hit\n", box ? "box" : "sphere",
               (double)scale, inside ? "inside" : "outside", wrong, COUNT, none);
        assert_int_equal(wrong, 0);
        // Next to an edge the origin may be moved through the neighbour.
        assert_true(inside ? none <= 1 : none == COUNT);
        tyn_scene_finish(&scene);
    }
}

// Only boxes that a ray meets are opened, also as long as nothing has been hit: a quad that stands in its way but
// outside its leaf's box is not seen.
static void only_boxes_met(void **state)
{
    tyn_scene scene;
    tyn_scene_init(&scene);
    uint32_t m = solids_material(&scene, (float[]){0, 0, 0}, (float[]){0, 0, 0});
    solids_quad(&scene, (float[]){-1, -1, 2}, (float[]){2, 0, 0}, (float[]){0, 2, 0}, m);
    solids_quad(&scene, (float[]){-1, -1, 5}, (float[]){2, 0, 0}, (float[]){0, 2, 0}, m);
    tyn_surface_node nodes[3] = {
        {.lo = {-1, -1, 1}, .hi = {9, 9, 5}, .first = 1},
        {.lo = {5, 5, 1}, .hi = {9, 9, 3}, .first = 0, .count = 2},
        {.lo = {-1, -1, 5}, .hi = {1, 1, 5}, .first = 2, .count = 2},
    };
    scene.surfaces.nodes = nodes;
    scene.surfaces.num_nodes = 3;
    struct surface_block block = {.num_triangles = 0};
    make_frame(&block, 0, (float[]){0, 0, 0});
    for (int k = 0; k < COUNT; k++) {
        const float origin[3] = {(float)(uniform() - 0.5), (float)(uniform() - 0.5), 0};
        memcpy(rays[k].origin, origin, sizeof origin);
        memcpy(rays[k].direction, (float[]){0, 0, k % 2 ? 1 : -1}, sizeof origin);
    }
    const ray_out *out = trace(*state, &scene, &block, false, TREE);
    for (int k = 0; k < COUNT; k++) {
        if (k % 2) {
            assert_near(out[k].t, 5, 1e-5);
        } else {
            assert_true(out[k].t > 1e37f); // nothing is met
        }
    }
    scene.surfaces.nodes = NULL;
    tyn_scene_finish(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(closed_meshes),
        cmocka_unit_test(same_as_all),
        cmocka_unit_test(from_surfaces),
        cmocka_unit_test(only_boxes_met),
    };
    setvbuf(stdout, NULL, _IOLBF, 0);
    cmocka_set_test_filter(getenv("TYN_TEST_FILTER"));
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
