// gbuffer.c -- the surfaces drawn as the camera sees them.
#include "gbuffer.h"
#include "shaders/surfaces/gbuffer_edge_args.h"
#include "gbuffer_mixed.comp.h"
#include "gbuffer_fragment.frag.h"
#include "gbuffer_resolve.comp.h"
#include "gbuffer_vertex.vert.h"

static const tyn_port ports[] = {GBUFFER_PORTS(TYN_PORT_ROW)};

static const tyn_binding attachments[] = {
    {GBUFFER_PORT_SEEN, TYN_USE_COLOR, false},
    {GBUFFER_PORT_DEPTH, TYN_USE_DEPTH, false},
};

static const tyn_raster raster = {
    .fragment = gbuffer_fragment_spirv,
    .fragment_size = sizeof(gbuffer_fragment_spirv),
    .attachments = attachments,
    .num_attachments = 2,
    .depth = VK_COMPARE_OP_GREATER,
    .clear_depth = 0.0f,
};

enum { KERNEL_DRAW, KERNEL_RESOLVE, KERNEL_MIXED, NUM_KERNELS };

static const tyn_kernel kernels[NUM_KERNELS] = {
    [KERNEL_DRAW] = TYN_DRAW("gbuffer_draw", gbuffer_vertex, gbuffer_vertex, &raster),
    [KERNEL_RESOLVE] = TYN_KERNEL(gbuffer_resolve),
    [KERNEL_MIXED] = TYN_KERNEL(gbuffer_mixed),
};

static const tyn_param params_table[] = {
    {"samples", TYN_PARAM_INT, offsetof(tyn_gbuffer_params, samples), 2, 1, 4, "",
     "samples of the surfaces along each side of a pixel: how smooth their edges are", NULL},
};

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_gbuffer_params *p = params;
    const tyn_extent size = {p->size[0] * (uint32_t)p->samples, p->size[1] * (uint32_t)p->samples,
                             1};
    tyn_build_buffer(b, GBUFFER_PORT_MIXED_COUNT, sizeof(struct gbuffer_edge_count));
    tyn_build_buffer(b, GBUFFER_PORT_MIXED, sizeof(uint32_t) * p->size[0] * p->size[1]);
    tyn_build_image(b, GBUFFER_PORT_SEEN, size, 1);
    tyn_build_image(b, GBUFFER_PORT_DEPTH, size, 1);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_gbuffer_params *p = params;
    const uint32_t spec[2] = {(uint32_t)p->samples, p->row ? p->row : GBUFFER_ROW};
    tyn_rec_draw(r, &(tyn_draw){.kernel = KERNEL_DRAW, .vertices = 3 * p->num_triangles});
    tyn_rec_fill(r, GBUFFER_PORT_MIXED_COUNT, 0);
    tyn_dispatch d = {.kernel = KERNEL_RESOLVE, .cells = {p->size[0], p->size[1], 1}, .spec = spec};
    tyn_rec_dispatch(r, &d);
    if (p->samples > 1) {
        d.kernel = KERNEL_MIXED;
        tyn_rec_dispatch_indirect(r, &d, GBUFFER_PORT_MIXED_COUNT, 0);
    }
    tyn_rec_work(r, "triangles", p->num_triangles);
}

const tyn_pass_desc tyn_pass_gbuffer = {
    .name = "gbuffer",
    .summary = "surfaces as the camera sees them",
    .serves = "pictures of surfaces",
    TYN_PASS_TABLES(tyn_gbuffer_params),
    .of_pixels = true,
    TYN_SETTINGS(params_table),
    .debug_port = GBUFFER_PORT_SEEN,
    .debug_meaning = "triangles that the camera sees",
};
