// path_distance.c -- distances to surfaces, against rays through all triangles in double precision.
#include "gpu_test.h"
#include "passes/path_distance/path_distance.h"
#include "shaders/common/scene_args.h"
#include "solids.h"
#include "shaders/surfaces/surface_args.h"
#include "vector.h"
#include <string.h>

enum { WIDTH = 40, HEIGHT = 24 };

// World -> M: turned about y and moved.
static const float rows[3][4] = {{0.8f, 0, 0.6f, 1}, {0, 1, 0, -0.5f}, {-0.6f, 0, 0.8f, 2}};

static void make_scene(tyn_scene *scene)
{
    tyn_scene_init(scene);
    const uint32_t m = solids_material(scene, (float[3]){0.5f, 0.5f, 0.5f}, (float[3]){0});
    solids_quad(scene, (float[]){-3, 0, -3}, (float[]){0, 0, 6}, (float[]){6, 0, 0}, m);
    solids_box(scene, (float[]){-1, 0.5f, -1}, (float[]){1, 1.5f, 0.5f}, 0.5f, false, m);
    solids_sphere(scene, (float[]){1.5f, 0.6f, 1}, 0.5f, 8, false, m);
}

// Cosine between a ray and a triangle's facet.
static double slant(const tyn_surfaces *s, int triangle, const double d[3])
{
    const uint32_t *v = s->triangles[triangle].vertices;
    double e[2][3], n[3];
    for (int k = 0; k < 3; k++) {
        e[0][k] = (double)(s->vertices[v[1]].position[k] - s->vertices[v[0]].position[k]);
        e[1][k] = (double)(s->vertices[v[2]].position[k] - s->vertices[v[0]].position[k]);
    }
    vector_cross(e[0], e[1], n);
    vector_normalise(n);
    return fabs(vector_dot(n, d));
}

static void distances(void **state)
{
    gpu_test *t = *state;
    const tyn_pass_desc *pass = &tyn_pass_path_distance;
    for (int variant = 0; variant < 4; variant++) {
        tyn_scene scene;
        make_scene(&scene);
        solids_hierarchy(&scene, 2);
        const tyn_surfaces *s = &scene.surfaces;
        struct surface_block block = {
            .num_triangles = s->num_triangles, .lo = {-3, 0, -3}, .hi = {3, 2, 3}};
        block.num_nodes = s->num_nodes;
        memcpy(block.from_world, rows, sizeof rows);
        for (int r = 0; r < 3; r++) {
            for (int c = 0; c < 3; c++) {
                block.to_world[r][c] = rows[c][r];
                block.to_world[r][3] -= rows[c][r] * rows[c][3];
            }
        }
        const bool parallel = variant % 2, within = variant / 2;
        struct camera_block camera = {.orthographic = parallel,
                                      .half_width = parallel ? 3 : 0.8f,
                                      .half_height = parallel ? 1.8f : 0.48f,
                                      .size = {WIDTH, HEIGHT},
                                      .shift = {0.1f, -0.2f}};
        // In M; within the box, or from above and aside.
        const float at[2][3] = {{5, 2.5f, 3.5f}, {1, 0.5f, 2}};
        memcpy(camera.origin, at[within], sizeof camera.origin);
        memcpy(camera.forward, (float[]){-0.8f, -0.6f, -0.1f}, sizeof camera.forward);
        vector_normalisef(camera.forward);
        vector_crossf(camera.forward, (float[]){0, 1, 0}, camera.right);
        vector_normalisef(camera.right);
        vector_crossf(camera.right, camera.forward, camera.up);
        tyn_ref refs[TYN_MAX_PORTS] = {{0}};
        tyn_graph_begin(t->graph);
        *gpu_port(pass, refs, "camera") = gpu_buffer(t, "camera", &camera, sizeof camera);
        *gpu_port(pass, refs, "surfaces") = gpu_buffer(t, "surfaces", &block, sizeof block);
        *gpu_port(pass, refs, "vertices") =
            gpu_buffer(t, "vertices", s->vertices, s->num_vertices * sizeof *s->vertices);
        *gpu_port(pass, refs, "triangles") =
            gpu_buffer(t, "triangles", s->triangles, s->num_triangles * sizeof *s->triangles);
        *gpu_port(pass, refs, "nodes") =
            gpu_buffer(t, "nodes", s->nodes, s->num_nodes * sizeof *s->nodes);
        const tyn_path_distance_params params = {WIDTH, HEIGHT};
        assert_int_equal(tyn_graph_add(t->graph, pass, &params, refs), TYN_OK);
        tyn_graph_output(t->graph, "seen", *gpu_port(pass, refs, "seen"), true);
        tyn_graph_output(t->graph, "radiance", *gpu_port(pass, refs, "radiance"), true);
        gpu_run(t);
        const uint32_t *seen = gpu_map(t, "seen");
        const uint32_t(*light)[4] = (const uint32_t(*)[4])gpu_map(t, "radiance");
        int hits = 0, skipped = 0;
        for (int i = 0; i < WIDTH * HEIGHT; i++) {
            const double u = 2 * (i % WIDTH + 0.5) / WIDTH - 1 + (double)camera.shift[0];
            const double v = 1 - 2 * (i / WIDTH + 0.5) / HEIGHT + (double)camera.shift[1];
            double m[2][3], o[3], d[3];
            for (int k = 0; k < 3; k++) {
                const double across = u * (double)(camera.half_width * camera.right[k]) +
                                      v * (double)(camera.half_height * camera.up[k]);
                m[0][k] = (double)camera.origin[k] - (double)rows[k][3] + (parallel ? across : 0);
                m[1][k] = (double)camera.forward[k] + (parallel ? 0 : across);
            }
            vector_normalise(m[1]);
            for (int k = 0; k < 3; k++) { // the inverse of the turn
                o[k] = d[k] = 0;
                for (int j = 0; j < 3; j++) {
                    o[k] += (double)rows[j][k] * m[0][j];
                    d[k] += (double)rows[j][k] * m[1][j];
                }
            }
            const solids_hit hit = solids_ray(s, o, d);
            const double right = hit.triangle < 0 ? 0 : hit.distance;
            // A pixel's place is a quotient along each axis; it shows most on what is seen edge-on.
            const double place = 2 * gpu_ulps(t, GPU_QUOTIENT);
            const double moved = right + (parallel ? (double)camera.half_width : 0);
            const double off = right > 0 ? place * moved / slant(s, hit.triangle, d) : 0;
            assert_true(light[i][0] == 0 && (light[i][1] & 0x3fffff) == 0);
            assert_true(hit.doubtful || seen[i] == (uint32_t)(hit.triangle + 1));
            float found;
            memcpy(&found, &light[i][2], sizeof found);
            skipped += hit.doubtful;
            hits += right > 0;
            if (!hit.doubtful && !(fabs((double)found - right) <= 1e-5 * right + 2e-6 + off)) {
                fail_msg("pixel %d: %g, not %g", i, (double)found, right);
            }
        }
        print_message("%d pixels show surfaces, %d too close to an edge to tell\n", hits, skipped);
        assert_true(hits > WIDTH * HEIGHT / 4 && skipped < WIDTH * HEIGHT / 10);
        tyn_scene_finish(&scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(distances)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
