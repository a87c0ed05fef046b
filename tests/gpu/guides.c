// guides.c -- albedo and normal of first surfaces against what is known of two cards, one of which turns its back.
#include "gpu_test.h"
#include "passes/gbuffer/gbuffer.h"
#include "passes/guides/guides.h"
#include "shaders/common/scene_args.h"
#include "shaders/surfaces/surface_args.h"
#include "solids.h"
#include <math.h>
#include <string.h>

enum { WIDTH = 48, HEIGHT = 32 }; // pixels of 1/8 m, seen along -z without perspective

static const float frame_rows[3][4] = {
    {0.8f, 0, 0.6f, 1}, {0, 1, 0, -0.5f}, {-0.6f, 0, 0.8f, 2}}; // world -> M

static const float left_albedo[3] = {0.5f, 0.25f, 0.125f}, right_albedo[3] = {0.1f, 0.9f, 0.3f};

static void turn(const float v[3], float out[3])
{
    for (int r = 0; r < 3; r++) {
        out[r] = frame_rows[r][0] * v[0] + frame_rows[r][1] * v[1] + frame_rows[r][2] * v[2];
    }
}

static struct surface_block make_block(const tyn_scene *scene)
{
    struct surface_block s = {
        .num_triangles = scene->surfaces.num_triangles, .lo = {-3, -2, -2}, .hi = {3, 2, 2}};
    memcpy(s.from_world, frame_rows, sizeof frame_rows);
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) {
            s.to_world[r][c] = frame_rows[c][r];
            s.to_world[r][3] -= frame_rows[c][r] * frame_rows[c][3];
        }
    }
    return s;
}

static struct camera_block make_camera(void)
{
    struct camera_block c = {
        .orthographic = 1, .half_width = 3, .half_height = 2, .size = {WIDTH, HEIGHT}};
    turn((float[]){0, 0, 5}, c.origin);
    for (int k = 0; k < 3; k++) {
        c.origin[k] += frame_rows[k][3];
    }
    turn((float[]){1, 0, 0}, c.right);
    turn((float[]){0, 1, 0}, c.up);
    turn((float[]){0, 0, -1}, c.forward);
    return c;
}

static void check(const float *found, const float expected[3], int x, int y, const char *what)
{
    for (int c = 0; c < 3; c++) {
        if (!(fabsf(found[c] - expected[c]) <= 1e-4f)) {
            fail_msg("%s of pixel %d, %d: %g %g %g, not %g %g %g", what, x, y, (double)found[0],
                     (double)found[1], (double)found[2], (double)expected[0], (double)expected[1],
                     (double)expected[2]);
        }
    }
}

// A card before the camera that ends in the middle of pixels, and one that is turned by 45 degrees with its back to us.
static void two_cards(void **state)
{
    gpu_test *t = *state;
    const float none[3] = {0}, h = sqrtf(0.5f);
    tyn_scene scene;
    tyn_scene_init(&scene);
    const uint32_t left = solids_material(&scene, left_albedo, none);
    const uint32_t right = solids_material(&scene, right_albedo, none);
    solids_quad(&scene, (float[]){-2, -1, 0}, (float[]){2.0625f, 0, 0}, (float[]){0, 2, 0}, left);
    solids_quad(&scene, (float[]){1, -1, 0}, (float[]){0, 2, 0}, (float[]){1, 0, -1}, right);
    const tyn_surfaces *s = &scene.surfaces;
    const struct surface_block block = make_block(&scene);
    const struct camera_block camera = make_camera();
    tyn_gbuffer_params params;
    tyn_pass_defaults(&tyn_pass_gbuffer, &params);
    params.size[0] = WIDTH;
    params.size[1] = HEIGHT;
    params.num_triangles = s->num_triangles;
    const tyn_guides_params guides = {{WIDTH, HEIGHT}, 0};
    tyn_graph_begin(t->graph);
    tyn_ref refs[GBUFFER_NUM_PORTS] = {
        [GBUFFER_PORT_CAMERA] = gpu_buffer(t, "camera", &camera, sizeof camera),
        [GBUFFER_PORT_SURFACES] = gpu_buffer(t, "surfaces", &block, sizeof block),
        [GBUFFER_PORT_TRIANGLES] =
            gpu_buffer(t, "triangles", s->triangles, s->num_triangles * sizeof *s->triangles),
        [GBUFFER_PORT_VERTICES] =
            gpu_buffer(t, "vertices", s->vertices, s->num_vertices * sizeof *s->vertices),
    };
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_gbuffer, &params, refs), TYN_OK);
    tyn_ref out[GUIDES_NUM_PORTS] = {
        [GUIDES_PORT_CAMERA] = refs[GBUFFER_PORT_CAMERA],
        [GUIDES_PORT_SURFACES] = refs[GBUFFER_PORT_SURFACES],
        [GUIDES_PORT_TRIANGLES] = refs[GBUFFER_PORT_TRIANGLES],
        [GUIDES_PORT_VERTICES] = refs[GBUFFER_PORT_VERTICES],
        [GUIDES_PORT_MATERIALS] =
            gpu_buffer(t, "materials", s->materials, s->num_materials * sizeof *s->materials),
        [GUIDES_PORT_SEEN] = refs[GBUFFER_PORT_SEEN],
    };
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_guides, &guides, out), TYN_OK);
    tyn_graph_output(t->graph, "albedo", out[GUIDES_PORT_ALBEDO], true);
    tyn_graph_output(t->graph, "normal", out[GUIDES_PORT_NORMAL], true);
    gpu_run(t);
    const float *albedo = gpu_map(t, "albedo"), *normal = gpu_map(t, "normal");
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++) {
            const float *a = &albedo[4 * (y * WIDTH + x)], *n = &normal[4 * (y * WIDTH + x)];
            const bool row = y >= 8 && y < 24;
            const float share = !row ? 0 : x >= 8 && x < 24 ? 1 : x == 24 ? 0.5f : 0;
            const bool back = row && x >= 32 && x < 40;
            const float *colour = back ? right_albedo : left_albedo;
            const float s2 = back ? 1 : share;
            const float facing[3] = {back ? h : 0, 0, back ? h : share};
            check(a, (float[]){s2 * colour[0], s2 * colour[1], s2 * colour[2]}, x, y, "albedo");
            check(n, facing, x, y, "normal");
            assert_true(fabsf(a[3] - s2) <= 1e-6f);
        }
    }
    tyn_scene_finish(&scene);
}

// Without surfaces both are 0.
static void none(void **state)
{
    gpu_test *t = *state;
    const struct camera_block camera = make_camera();
    const tyn_guides_params guides = {{WIDTH, HEIGHT}, 0};
    tyn_graph_begin(t->graph);
    tyn_ref out[GUIDES_NUM_PORTS] = {[GUIDES_PORT_CAMERA] =
                                         gpu_buffer(t, "camera", &camera, sizeof camera)};
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_guides, &guides, out), TYN_OK);
    tyn_graph_output(t->graph, "albedo", out[GUIDES_PORT_ALBEDO], true);
    tyn_graph_output(t->graph, "normal", out[GUIDES_PORT_NORMAL], true);
    gpu_run(t);
    const float *albedo = gpu_map(t, "albedo"), *normal = gpu_map(t, "normal");
    for (int i = 0; i < 4 * WIDTH * HEIGHT; i++) {
        assert_true(albedo[i] == 0 && normal[i] == 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_cards),
        cmocka_unit_test(none),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
