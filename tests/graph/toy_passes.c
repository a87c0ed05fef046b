// toy_passes.c -- see toy_passes.h.
#include "toy_passes.h"

// A module of one OpNop.
static const uint32_t no_spirv[] = {0x07230203, 0x00010300, 0, 1, 0, 0x00010000};
#define KERNEL(text, args, table)                                                                  \
    {                                                                                              \
        .name = text, .spirv = no_spirv, .spirv_size = sizeof no_spirv, .args_size = args,         \
        .local_size = {8, 8, 1}, .bindings = table, .num_bindings = sizeof table / sizeof *table,  \
        .num_spec = 1                                                                              \
    }

// blur: reads an image and perhaps a buffer, writes an image through a ping-pong.
static const tyn_port blur_ports[BLUR_NUM] = {
    {"in", TYN_IN, TYN_IMAGE_2D, 0, false, "what is blurred"},
    {"bias", TYN_IN, TYN_BUFFER, 0, true, "added each time"},
    {"out", TYN_OUT, TYN_IMAGE_2D, VK_FORMAT_R32_SFLOAT, false, "blurred"},
    {"tmp", TYN_SCRATCH, TYN_IMAGE_2D, VK_FORMAT_R32_SFLOAT, false, "every other step"},
};
static const tyn_binding blur_bindings[] = {
    {BLUR_IN, TYN_USE_SAMPLED}, {BLUR_OUT, TYN_USE_STORAGE_WRITE}, {BLUR_BIAS, TYN_USE_UNIFORM}};
static const tyn_kernel blur_kernels[] = {KERNEL("blur", 4, blur_bindings)};

static tyn_result blur_declare(tyn_builder *b, const void *params)
{
    (void)params;
    tyn_build_image(b, BLUR_OUT, tyn_build_extent(b, BLUR_IN), 1);
    tyn_build_image(b, BLUR_TMP, tyn_build_extent(b, BLUR_IN), 1);
    return TYN_OK;
}

static void blur_record(tyn_recorder *r, const void *params)
{
    const node_params *p = params;
    for (int i = 0; i < p->times; i++) {
        uint8_t to = (p->times - 1 - i) % 2 ? BLUR_TMP : BLUR_OUT;
        uint8_t from = i == 0 ? BLUR_IN : to == BLUR_OUT ? BLUR_TMP : BLUR_OUT;
        tyn_rec_dispatch(r, &(tyn_dispatch){.cells = tyn_rec_extent(r, BLUR_OUT),
                                            .args = &p->value,
                                            .ports = (const uint8_t[]){from, to, BLUR_BIAS},
                                            .spec = &p->spec});
    }
}

const tyn_pass_desc toy_blur = {.name = "blur",
                                .summary = "a moving average",
                                .ports = blur_ports,
                                .num_ports = BLUR_NUM,
                                .kernels = blur_kernels,
                                .num_kernels = 1,
                                .params_size = sizeof(node_params),
                                .declare = blur_declare,
                                .record = blur_record,
                                .debug_port = BLUR_OUT};

// add: changes a buffer in place.
static const tyn_port add_ports[ADD_NUM] = {
    {"sum", TYN_INOUT, TYN_BUFFER, 0, false, "grows"},
    {"x", TYN_IN, TYN_IMAGE_2D, 0, false, "what is added"},
};
static const tyn_binding add_bindings[] = {{ADD_SUM, TYN_USE_STORAGE_RW}, {ADD_X, TYN_USE_SAMPLED}};
static const tyn_kernel add_kernels[] = {KERNEL("add", 0, add_bindings)};

static tyn_result nothing_to_declare(tyn_builder *b, const void *params)
{
    (void)b, (void)params;
    return TYN_OK;
}

static void add_record(tyn_recorder *r, const void *params)
{
    const node_params *p = params;
    tyn_rec_dispatch(r, &(tyn_dispatch){.cells = {64, 1, 1}, .spec = &p->spec});
}

const tyn_pass_desc toy_add = {.name = "add",
                               .summary = "adds up",
                               .ports = add_ports,
                               .num_ports = ADD_NUM,
                               .kernels = add_kernels,
                               .num_kernels = 1,
                               .params_size = sizeof(node_params),
                               .declare = nothing_to_declare,
                               .record = add_record};

// count: counts into a buffer and dispatches as many workgroups.
static const tyn_port count_ports[COUNT_NUM] = {
    {"in", TYN_IN, TYN_IMAGE_2D, 0, false, "what is counted"},
    {"groups", TYN_OUT, TYN_BUFFER, 0, false, "workgroups"},
    {"out", TYN_OUT, TYN_IMAGE_2D, VK_FORMAT_R32_SFLOAT, false, "result"},
};
static const tyn_binding count_bindings[] = {{COUNT_IN, TYN_USE_SAMPLED},
                                             {COUNT_GROUPS, TYN_USE_STORAGE_RW}};
static const tyn_binding draw_bindings[] = {{COUNT_IN, TYN_USE_SAMPLED},
                                            {COUNT_OUT, TYN_USE_STORAGE_WRITE}};
static const tyn_kernel count_kernels[] = {KERNEL("count", 0, count_bindings),
                                           KERNEL("draw", 0, draw_bindings)};

static tyn_result count_declare(tyn_builder *b, const void *params)
{
    (void)params;
    tyn_build_buffer(b, COUNT_GROUPS, 12);
    tyn_build_image(b, COUNT_OUT, tyn_build_extent(b, COUNT_IN), 1);
    return TYN_OK;
}

static void count_record(tyn_recorder *r, const void *params)
{
    const node_params *p = params;
    tyn_rec_fill(r, COUNT_GROUPS, 1);
    tyn_rec_dispatch(
        r, &(tyn_dispatch){.kernel = 0, .cells = tyn_rec_extent(r, COUNT_IN), .spec = &p->spec});
    tyn_rec_dispatch_indirect(r, &(tyn_dispatch){.kernel = 1, .spec = &p->spec}, COUNT_GROUPS, 0);
}

const tyn_pass_desc toy_count = {.name = "count",
                                 .summary = "draws as much as it counts",
                                 .ports = count_ports,
                                 .num_ports = COUNT_NUM,
                                 .kernels = count_kernels,
                                 .num_kernels = 2,
                                 .params_size = sizeof(node_params),
                                 .declare = count_declare,
                                 .record = count_record,
                                 .debug_port = COUNT_OUT};

// draw: triangles into two tiles, then over them, and a depth image that is sampled afterwards.
static const tyn_port draw_ports[DRAW_NUM] = {
    {"corners", TYN_IN, TYN_BUFFER, 0, false, "corners of triangles"},
    {"texture", TYN_IN, TYN_IMAGE_2D, 0, true, "what is on them"},
    {"color", TYN_OUT, TYN_IMAGE_2D, VK_FORMAT_R32G32B32A32_SFLOAT, false, "picture"},
    {"depth", TYN_OUT, TYN_IMAGE_2D, VK_FORMAT_D32_SFLOAT, false, "depth"},
};
static const tyn_binding pull_bindings[] = {{DRAW_CORNERS, TYN_USE_STORAGE_READ},
                                            {DRAW_TEXTURE, TYN_USE_SAMPLED}};
static const tyn_binding draw_attachments[] = {{DRAW_COLOR, TYN_USE_COLOR},
                                               {DRAW_DEPTH, TYN_USE_DEPTH}};
static const tyn_raster draw_raster = {.fragment = no_spirv,
                                       .fragment_size = sizeof no_spirv,
                                       .attachments = draw_attachments,
                                       .num_attachments = 2,
                                       .depth = VK_COMPARE_OP_GREATER};
static const tyn_kernel draw_kernels[] = {{.name = "corners",
                                           .spirv = no_spirv,
                                           .spirv_size = sizeof no_spirv,
                                           .args_size = 4,
                                           .bindings = pull_bindings,
                                           .num_bindings = 2,
                                           .raster = &draw_raster}};

static tyn_result draw_declare(tyn_builder *b, const void *params)
{
    const node_params *p = params;
    tyn_build_image(b, DRAW_COLOR, (tyn_extent){64, 32, 1}, 1);
    tyn_build_image(b, DRAW_DEPTH, (tyn_extent){64, p->value ? 16 : 32, 1}, 1);
    return TYN_OK;
}

static void draw_record(tyn_recorder *r, const void *params)
{
    const node_params *p = params;
    const tyn_tile tiles[2] = {{0, 0, 32, 32, &p->times}, {32, 0, 32, 32, &p->times}};
    tyn_rec_draw(r, &(tyn_draw){.vertices = 6, .tiles = tiles, .num_tiles = 2});
    tyn_rec_draw(r, &(tyn_draw){.vertices = 3, .args = &p->times, .keep = true, .label = "again"});
}

const tyn_pass_desc toy_draw = {.name = "draw",
                                .summary = "draws triangles",
                                .ports = draw_ports,
                                .num_ports = DRAW_NUM,
                                .kernels = draw_kernels,
                                .num_kernels = 1,
                                .params_size = sizeof(node_params),
                                .declare = draw_declare,
                                .record = draw_record,
                                .debug_port = DRAW_COLOR};
