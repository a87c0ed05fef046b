// sky_shadows.c -- the scene's triangles drawn into a map of every direction.
#include "sky_shadows.h"
#include "sky_shadows_corners.comp.h"
#include "sky_shadows_frames.comp.h"
#include "sky_shadows_vertex.vert.h"
#include <stddef.h>
#include <string.h>

static const tyn_port ports[] = {SKY_SHADOWS_PORTS(TYN_PORT_ROW)};

static const tyn_binding attachments[] = {{SKY_SHADOWS_PORT_SKY_ATLAS, TYN_USE_DEPTH, false}};

static const tyn_raster raster = {
    .attachments = attachments,
    .num_attachments = 1,
    .depth = VK_COMPARE_OP_GREATER,
    .clear_depth = 0.0f,
};

enum { KERNEL_CORNERS, KERNEL_FRAMES, KERNEL_DRAW, NUM_KERNELS };

static const tyn_kernel kernels[NUM_KERNELS] = {
    [KERNEL_CORNERS] = TYN_KERNEL(sky_shadows_corners),
    [KERNEL_FRAMES] = TYN_KERNEL(sky_shadows_frames),
    [KERNEL_DRAW] = TYN_DRAW("sky_shadows", sky_shadows_vertex, sky_shadows_vertex, &raster),
};

static const tyn_param params_table[] = {
    {"texels", TYN_PARAM_INT, offsetof(tyn_sky_shadows_params, texels), 256, 16, 512, "texels",
     "side of the depth map of each direction of the sky", NULL},
    {"reach", TYN_PARAM_FLOAT, offsetof(tyn_sky_shadows_params, reach), 3, 0, 1000, "",
     "surfaces that stand more than so many times the longest side of the media's box (without "
     "media: that of most triangles) beyond it have coarser maps, of all surfaces; 0: one map of "
     "all",
     NULL},
};

enum { MAX_MAPS = 2 * TYN_ORDINATES_MAX };

static uint32_t num_maps(const tyn_sky_shadows_params *p)
{
    return p->wide ? 2 * p->count : p->count;
}

// Maps in a row of the atlas.
static uint32_t across(const tyn_sky_shadows_params *p)
{
    uint32_t side = 1;
    while (side * side < num_maps(p)) {
        side++;
    }
    return side;
}

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_sky_shadows_params *p = params;
    const uint32_t maps = num_maps(p), side = across(p), texels = (uint32_t)p->texels;
    if (p->count < 1 || p->count > TYN_ORDINATES_MAX) {
        return TYN_FAULT(tyn_build_log(b), TYN_ERR_PARAMS,
                         "sky_shadows: count is %u; must be 1 to %d directions", p->count,
                         TYN_ORDINATES_MAX);
    }
    if (p->num_vertices > TYN_MOST_INDEX) {
        return TYN_FAULT(tyn_build_log(b), TYN_ERR_PARAMS,
                         "sky_shadows: surfaces have %u vertices; must be at most %u under a sky",
                         p->num_vertices, TYN_MOST_INDEX);
    }
    tyn_build_image(b, SKY_SHADOWS_PORT_SKY_ATLAS,
                    (tyn_extent){side * texels, (maps + side - 1) / side * texels, 1}, 1);
    tyn_build_buffer(b, SKY_SHADOWS_PORT_CORNERS, 3 * sizeof(uint32_t) * p->num_triangles);
    tyn_build_buffer(b, SKY_SHADOWS_PORT_SKY_MAPS, maps * sizeof(struct shadow_light));
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_sky_shadows_params *p = params;
    const uint32_t maps = num_maps(p), side = across(p), texels = (uint32_t)p->texels;
    struct sky_frames_args args = {
        .across = side, .texels = (float)texels, .reach = p->reach, .count = p->count};
    memcpy(args.near_lo, p->near_lo, sizeof args.near_lo);
    memcpy(args.near_hi, p->near_hi, sizeof args.near_hi);
    const struct sky_corners_args triangles = {p->num_triangles};
    TYN_DISPATCH(r, .kernel = KERNEL_CORNERS, .cells = {p->num_triangles, 1, 1},
                 .args = &triangles);
    TYN_DISPATCH(r, .kernel = KERNEL_FRAMES, .cells = {maps, 1, 1}, .args = &args);
    tyn_tile tiles[MAX_MAPS];
    struct sky_draw_args draws[MAX_MAPS];
    for (uint32_t i = 0; i < maps; i++) {
        draws[i] = (struct sky_draw_args){.map = i};
        tiles[i] = (tyn_tile){.x = i % side * texels,
                              .y = i / side * texels,
                              .width = texels,
                              .height = texels,
                              .args = &draws[i]};
    }
    tyn_rec_draw(r, &(tyn_draw){.kernel = KERNEL_DRAW,
                                .vertices = 3 * p->num_triangles,
                                .tiles = tiles,
                                .num_tiles = maps,
                                .indexed = true,
                                .indices = SKY_SHADOWS_PORT_CORNERS});
    tyn_rec_work(r, "triangles", (double)p->num_triangles * maps);
}

const tyn_pass_desc tyn_pass_sky_shadows = {
    .name = "sky_shadows",
    .summary = "what the directions of the sky see of the surfaces",
    .serves = "surfaces under an environment, or under more suns than have beams",
    TYN_PASS_TABLES(tyn_sky_shadows_params),
    TYN_SETTINGS(params_table),
    .debug_port = SKY_SHADOWS_PORT_SKY_ATLAS,
    .debug_meaning = "the maps of all directions: 1 near, 0 far",
};
