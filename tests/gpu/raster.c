// raster.c -- raster kernels on a device: attachments, tiles, depth, culling, what is kept, what is read
// afterwards; all with synchronization validation.
#include "gpu_test.h"
#include "raster_test_depth.comp.h"
#include "raster_test_fragment.frag.h"
#include "raster_test_vertex.vert.h"
#include <math.h>
#include <string.h>

enum { CORNERS, ADDITION, COLOR, FACING, DEPTH, INDICES };
enum { SIZE = 16 };

static const tyn_port ports[] = {
    {"corners", TYN_IN, TYN_BUFFER, 0, false, "position and colour of triangle corners"},
    {"addition", TYN_IN, TYN_IMAGE_2D, 0, true, "added to the colour"},
    {"color", TYN_OUT, TYN_IMAGE_2D, VK_FORMAT_R32G32B32A32_SFLOAT, false, "picture"},
    {"facing", TYN_OUT, TYN_IMAGE_2D, VK_FORMAT_R32G32_SFLOAT, false, "front or back, depth"},
    {"depth", TYN_OUT, TYN_IMAGE_2D, VK_FORMAT_D32_SFLOAT, false, "1 near, 0 far"},
    {"indices", TYN_IN, TYN_BUFFER, 0, true, "corners of an indexed draw"},
};
static const tyn_binding bindings[] = {{CORNERS, TYN_USE_STORAGE_READ},
                                       {ADDITION, TYN_USE_SAMPLED}};
static const tyn_binding attachments[] = {
    {COLOR, TYN_USE_COLOR}, {FACING, TYN_USE_COLOR}, {DEPTH, TYN_USE_DEPTH}};
static const tyn_raster both_sides = {.fragment = raster_test_fragment_spirv,
                                      .fragment_size = sizeof raster_test_fragment_spirv,
                                      .attachments = attachments,
                                      .num_attachments = 3,
                                      .depth = VK_COMPARE_OP_GREATER,
                                      .clear_depth = 0.0f};
static const tyn_raster front_only = {.fragment = raster_test_fragment_spirv,
                                      .fragment_size = sizeof raster_test_fragment_spirv,
                                      .attachments = attachments,
                                      .num_attachments = 3,
                                      .depth = VK_COMPARE_OP_GREATER,
                                      .clear_depth = 0.25f,
                                      .cull = VK_CULL_MODE_BACK_BIT};
static const tyn_raster depth_alone = {
    .attachments = &attachments[2], .num_attachments = 1, .depth = VK_COMPARE_OP_GREATER};
static const tyn_kernel kernels[] = {
    {"triangles",
     raster_test_vertex_spirv,
     sizeof raster_test_vertex_spirv,
     12,
     {0},
     bindings,
     2,
     1,
     &both_sides},
    {"front",
     raster_test_vertex_spirv,
     sizeof raster_test_vertex_spirv,
     12,
     {0},
     bindings,
     2,
     1,
     &front_only},
    {"depth",
     raster_test_vertex_spirv,
     sizeof raster_test_vertex_spirv,
     12,
     {0},
     bindings,
     1,
     0,
     &depth_alone},
};

typedef struct args {
    float shift[2], brightness;
} args;

typedef struct draw_params {
    uint32_t kernel, vertices, tiles, again, flat, indexed, indices;
} draw_params;

static tyn_result declare(tyn_builder *b, const void *params)
{
    const draw_params *p = params;
    if (p->kernel < 2) {
        tyn_build_image(b, COLOR, (tyn_extent){SIZE, SIZE, 1}, 1);
        tyn_build_image(b, FACING, (tyn_extent){SIZE, SIZE, 1}, 1);
    }
    tyn_build_image(b, DEPTH, (tyn_extent){SIZE, SIZE, 1}, 1);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const draw_params *p = params;
    const args plain = {{0, 0}, 1}, bright = {{0, 0}, 4}, right = {{1, 0}, 8};
    // The left upper and the right lower quarter.
    const tyn_tile tiles[2] = {{0, 0, SIZE / 2, SIZE / 2, &plain},
                               {SIZE / 2, SIZE / 2, SIZE / 2, SIZE / 2, &bright}};
    tyn_rec_draw(r, &(tyn_draw){.kernel = p->kernel,
                                .vertices = p->vertices,
                                .tiles = p->tiles ? tiles : NULL,
                                .num_tiles = p->tiles,
                                .args = &plain,
                                .indexed = p->indexed,
                                .indices = (uint8_t)p->indices,
                                .spec = (const uint32_t[]){p->flat}});
    if (p->again) {
        tyn_rec_draw(r, &(tyn_draw){.kernel = p->kernel,
                                    .vertices = p->vertices,
                                    .args = &right,
                                    .keep = true,
                                    .spec = (const uint32_t[]){p->flat}});
    }
}

static const tyn_pass_desc triangles = {.name = "triangles",
                                        .summary = "draws triangles",
                                        .ports = ports,
                                        .num_ports = 6,
                                        .kernels = kernels,
                                        .num_kernels = 3,
                                        .params_size = sizeof(draw_params),
                                        .declare = declare,
                                        .record = record,
                                        .debug_port = COLOR};

// A compute pass that samples the depth image.
static const tyn_port copy_ports[] = {
    {"depth", TYN_IN, TYN_IMAGE_2D, 0, false, "a depth image"},
    {"copy", TYN_OUT, TYN_IMAGE_2D, VK_FORMAT_R32_SFLOAT, false, "its values"},
};
static const tyn_binding copy_bindings[] = {{0, TYN_USE_SAMPLED}, {1, TYN_USE_STORAGE_WRITE}};
static const tyn_kernel copy_kernels[] = {{"copy",
                                           raster_test_depth_spirv,
                                           sizeof raster_test_depth_spirv,
                                           0,
                                           {8, 8, 1},
                                           copy_bindings,
                                           2,
                                           0,
                                           NULL}};

static tyn_result copy_declare(tyn_builder *b, const void *params)
{
    (void)params;
    tyn_build_image(b, 1, tyn_build_extent(b, 0), 1);
    return TYN_OK;
}

static void copy_record(tyn_recorder *r, const void *params)
{
    (void)params;
    tyn_rec_dispatch(r, &(tyn_dispatch){.cells = tyn_rec_extent(r, 1)});
}

static const tyn_pass_desc copy = {.name = "copy",
                                   .summary = "copies depth",
                                   .ports = copy_ports,
                                   .num_ports = 2,
                                   .kernels = copy_kernels,
                                   .num_kernels = 1,
                                   .declare = copy_declare,
                                   .record = copy_record,
                                   .debug_port = 1};

typedef struct corner {
    float position[3], color[3];
} corner;

// Two triangles over the left half of clip space: counter-clockwise on the screen (y down), depth 0.5,
// and one of the other sense over the upper half, at `depth`.
static void corners(corner out[12], float depth)
{
    const corner c[12] = {
        {{-1, -1, 0.5f}, {1, 0, 0}},  {{-1, 1, 0.5f}, {1, 0, 0}},  {{0, 1, 0.5f}, {1, 0, 0}},
        {{-1, -1, 0.5f}, {1, 0, 0}},  {{0, 1, 0.5f}, {1, 0, 0}},   {{0, -1, 0.5f}, {1, 0, 0}},
        {{-1, -1, depth}, {0, 1, 0}}, {{1, -1, depth}, {0, 1, 0}}, {{1, 0, depth}, {0, 1, 0}},
        {{-1, -1, depth}, {0, 1, 0}}, {{1, 0, depth}, {0, 1, 0}},  {{-1, 0, depth}, {0, 1, 0}},
    };
    memcpy(out, c, sizeof c);
}

static const uint32_t upper_half[6] = {6, 7, 8, 6, 8, 11}; // the triangles over the upper half

typedef struct pictures {
    const float (*color)[4], (*facing)[2];
    const float *depth, *copied;
} pictures;

static pictures draw(gpu_test *t, draw_params params, float depth, const float *addition)
{
    corner c[12];
    corners(c, depth);
    tyn_graph_begin(t->graph);
    tyn_ref refs[6] = {gpu_buffer(t, "corners", c, sizeof c)};
    if (params.indexed) {
        refs[INDICES] = gpu_buffer(t, "indices", upper_half, sizeof upper_half);
    }
    if (addition) {
        refs[ADDITION] = gpu_image(t, "addition", TYN_IMAGE_2D, (tyn_extent){1, 1, 1}, 4, addition);
    }
    assert_int_equal(tyn_graph_add(t->graph, &triangles, &params, refs), TYN_OK);
    tyn_ref copies[2] = {refs[DEPTH]};
    assert_int_equal(tyn_graph_add(t->graph, &copy, NULL, copies), TYN_OK);
    if (params.kernel < 2) {
        tyn_graph_output(t->graph, "color", refs[COLOR], true);
        tyn_graph_output(t->graph, "facing", refs[FACING], true);
    }
    tyn_graph_output(t->graph, "depth", refs[DEPTH], true);
    tyn_graph_output(t->graph, "copied", copies[1], true);
    gpu_run(t);
    pictures p = {.depth = gpu_map(t, "depth"), .copied = gpu_map(t, "copied")};
    if (params.kernel < 2) {
        p.color = (const float(*)[4])gpu_map(t, "color");
        p.facing = (const float(*)[2])gpu_map(t, "facing");
    }
    return p;
}

static void expect(const pictures *p, uint32_t x, uint32_t y, float red, float green, float facing,
                   float depth)
{
    const uint32_t i = y * SIZE + x;
    if (p->color) {
        if (p->color[i][0] != red || p->color[i][1] != green || p->facing[i][0] != facing) {
            fail_msg("(%u, %u): %g %g facing %g", x, y, (double)p->color[i][0],
                     (double)p->color[i][1], (double)p->facing[i][0]);
        }
        assert_true(p->color[i][3] == (facing != 0 ? 1 : 0));
        assert_true(fabsf(p->facing[i][1] - (facing != 0 ? depth : 0)) < 1e-6f);
    }
    assert_true(fabsf(p->depth[i] - depth) < 1e-6f);
    assert_true(p->copied[i] == p->depth[i]);
}

static void nearest_triangle_wins(void **state)
{
    gpu_test *t = *state;
    for (int behind = 0; behind < 2; behind++) {
        const float depth = behind ? 0.375f : 0.75f;
        pictures p = draw(t, (draw_params){.kernel = 0, .vertices = 12}, depth, NULL);
        for (uint32_t y = 0; y < SIZE; y++) {
            for (uint32_t x = 0; x < SIZE; x++) {
                bool left = x < SIZE / 2, upper = y < SIZE / 2;
                if (upper && !(left && behind)) {
                    expect(&p, x, y, 0, 1, -1, depth);
                } else if (left) {
                    expect(&p, x, y, 1, 0, 1, 0.5f);
                } else {
                    expect(&p, x, y, 0, 0, 0, 0);
                }
            }
        }
    }
}

static void back_faces_are_culled(void **state)
{
    pictures p = draw(*state, (draw_params){.kernel = 1, .vertices = 12}, 0.75f, NULL);
    for (uint32_t y = 0; y < SIZE; y++) {
        for (uint32_t x = 0; x < SIZE; x++) {
            bool left = x < SIZE / 2;
            expect(&p, x, y, left, 0, left, left ? 0.5f : 0.25f);
        }
    }
}

static void tiles_have_their_own_constants(void **state)
{
    gpu_test *t = *state;
    const float addition[4] = {0, 0.5f, 0, 0};
    pictures p = draw(t, (draw_params){.kernel = 0, .vertices = 6, .tiles = 2}, 0, addition);
    for (uint32_t y = 0; y < SIZE; y++) {
        for (uint32_t x = 0; x < SIZE; x++) {
            const uint32_t half = SIZE / 2;
            bool first = x < half && y < half, second = x >= half && y >= half;
            if ((first || second) && x % half < half / 2) {
                expect(&p, x, y, first ? 1 : 4, 0.5f, 1, 0.5f);
            } else {
                expect(&p, x, y, 0, 0, 0, 0);
            }
        }
    }
    const tyn_node_stats *stats;
    assert_true(tyn_graph_stats(t->graph, &stats) == 2);
    assert_int_equal(stats[0].dispatches, 2);
    assert_int_equal(stats[0].state, TYN_NODE_RAN);
}

static void indices_choose_the_corners(void **state)
{
    pictures p =
        draw(*state, (draw_params){.vertices = 6, .indexed = 1, .indices = INDICES}, 0.75f, NULL);
    for (uint32_t y = 0; y < SIZE; y++) {
        for (uint32_t x = 0; x < SIZE; x++) {
            const bool drawn = y < SIZE / 2;
            expect(&p, x, y, 0, drawn, drawn ? -1 : 0, drawn ? 0.75f : 0);
        }
    }
}

static void indices_must_be_a_buffer(void **state)
{
    gpu_test *t = *state;
    t->quiet = true;
    corner c[12];
    corners(c, 0);
    const float texel[4] = {0};
    for (int image = 0; image < 2; image++) {
        tyn_graph_begin(t->graph);
        tyn_ref refs[6] = {gpu_buffer(t, "corners", c, sizeof c)};
        if (image) {
            refs[ADDITION] =
                gpu_image(t, "addition", TYN_IMAGE_2D, (tyn_extent){1, 1, 1}, 4, texel);
        }
        const draw_params params = {
            .vertices = 3, .indexed = 1, .indices = image ? ADDITION : INDICES};
        assert_int_equal(tyn_graph_add(t->graph, &triangles, &params, refs), TYN_OK);
        tyn_graph_output(t->graph, "color", refs[COLOR], true);
        assert_int_equal(gpu_try(t), TYN_ERR_PARAMS);
        assert_non_null(strstr(t->last_error, "must be a buffer of uint32_t"));
    }
    t->quiet = false;
}

static void second_draw_keeps_the_first(void **state)
{
    gpu_test *t = *state;
    // Once more, moved to the right half; both in the colour of a specialisation constant, then not.
    for (uint32_t flat = 0; flat < 2; flat++) {
        pictures p = draw(
            t, (draw_params){.kernel = 0, .vertices = 6, .again = 1, .flat = flat * 3}, 0, NULL);
        for (uint32_t y = 0; y < SIZE; y++) {
            for (uint32_t x = 0; x < SIZE; x++) {
                float red = x < SIZE / 2 ? 1 : 8;
                expect(&p, x, y, flat ? 3 : red, flat ? 3 : 0, 1, 0.5f);
            }
        }
    }
}

static void depth_alone_is_drawn(void **state)
{
    pictures p = draw(*state, (draw_params){.kernel = 2, .vertices = 6}, 0, NULL);
    for (uint32_t y = 0; y < SIZE; y++) {
        for (uint32_t x = 0; x < SIZE; x++) {
            expect(&p, x, y, 0, 0, 0, x < SIZE / 2 ? 0.5f : 0);
        }
    }
    p = draw(*state, (draw_params){.kernel = 2, .vertices = 0}, 0, NULL); // cleared all the same
    for (uint32_t i = 0; i < SIZE * SIZE; i++) {
        assert_true(p.depth[i] == 0 && p.copied[i] == 0);
    }
}

static void queues_without_graphics_are_refused(void **state)
{
    gpu_test *t = *state;
    tyn_pipelines_destroy(t->dev);
    t->dev->graphics = false;
    t->quiet = true;
    corner c[12];
    corners(c, 0);
    tyn_graph_begin(t->graph);
    tyn_ref refs[6] = {gpu_buffer(t, "corners", c, sizeof c)};
    assert_int_equal(tyn_graph_add(t->graph, &triangles, &(draw_params){.vertices = 3}, refs),
                     TYN_OK);
    tyn_graph_output(t->graph, "color", refs[COLOR], true);
    assert_int_equal(gpu_try(t), TYN_ERR_UNSUPPORTED);
    assert_non_null(strstr(t->last_error, "no pipeline for kernel"));
    t->dev->graphics = true;
    t->quiet = false;
}

static void targets_beyond_the_limits_are_refused(void **state)
{
    gpu_test *t = *state;
    uint32_t *const most = &t->dev->properties.limits.maxFramebufferHeight, before = *most;
    tyn_graph *used = t->graph; // has images already
    assert_int_equal(tyn_graph_create(t->dev, 1, &t->graph), TYN_OK);
    t->quiet = true;
    *most = SIZE - 1;
    corner c[12];
    corners(c, 0);
    tyn_graph_begin(t->graph);
    tyn_ref refs[6] = {gpu_buffer(t, "corners", c, sizeof c)};
    assert_int_equal(tyn_graph_add(t->graph, &triangles, &(draw_params){.vertices = 3}, refs),
                     TYN_OK);
    tyn_graph_output(t->graph, "color", refs[COLOR], true);
    assert_int_equal(gpu_try(t), TYN_ERR_UNSUPPORTED);
    assert_non_null(strstr(t->last_error, "the device draws at most"));
    *most = before;
    t->quiet = false;
    tyn_graph_destroy(&t->graph);
    t->graph = used;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nearest_triangle_wins),
        cmocka_unit_test(back_faces_are_culled),
        cmocka_unit_test(tiles_have_their_own_constants),
        cmocka_unit_test(indices_choose_the_corners),
        cmocka_unit_test(indices_must_be_a_buffer),
        cmocka_unit_test(second_draw_keeps_the_first),
        cmocka_unit_test(depth_alone_is_drawn),
        cmocka_unit_test(queues_without_graphics_are_refused),
        cmocka_unit_test(targets_beyond_the_limits_are_refused),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
