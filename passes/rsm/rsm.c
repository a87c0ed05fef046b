// rsm.c -- see rsm.h.
#include "rsm.h"
#include "rsm_fragment.frag.h"
#include "rsm_sky.comp.h"
#include "rsm_sky_areas.comp.h"
#include "rsm_sky_blocks.comp.h"
#include "rsm_vertex.vert.h"
#include <string.h>

static const tyn_port ports[] = {RSM_PORTS(TYN_PORT_ROW)};

static const tyn_binding attachments[] = {
    {RSM_PORT_RSM_FLUX, TYN_USE_COLOR, false},
    {RSM_PORT_RSM_POSITION, TYN_USE_COLOR, false},
    {RSM_PORT_RSM_NORMAL, TYN_USE_COLOR, false},
    {RSM_PORT_DEPTH, TYN_USE_DEPTH, false},
};

// Depth first, so that what is reflected is computed for what is seen alone.
static const tyn_raster raster_depth = {
    .attachments = &attachments[3],
    .num_attachments = 1,
    .depth = VK_COMPARE_OP_GREATER,
    .clear_depth = 0.0f,
};

static const tyn_raster raster = {
    .fragment = rsm_fragment_spirv,
    .fragment_size = sizeof(rsm_fragment_spirv),
    .attachments = attachments,
    .num_attachments = 4,
    .depth = VK_COMPARE_OP_EQUAL,
};

enum { KERNEL_DEPTH, KERNEL_LIGHT, KERNEL_AREAS, KERNEL_BLOCKS, KERNEL_SKY, NUM_KERNELS };

static const tyn_kernel kernels[NUM_KERNELS] = {
    [KERNEL_DEPTH] = TYN_DRAW("rsm_depth", rsm_vertex, rsm_vertex, &raster_depth),
    [KERNEL_LIGHT] = TYN_DRAW("rsm_light", rsm_vertex, rsm_fragment, &raster),
    [KERNEL_AREAS] = TYN_KERNEL(rsm_sky_areas),
    [KERNEL_BLOCKS] = TYN_KERNEL(rsm_sky_blocks),
    [KERNEL_SKY] = TYN_KERNEL(rsm_sky),
};

static const tyn_param params_table[] = {
    {"sky_texels", TYN_PARAM_INT, offsetof(tyn_rsm_params, sky_texels), 64, 0, 256, "texels",
     "side of the map of places that stand for all surfaces under the sky; rounded to a power of "
     "two, 0: its light is not reflected onto other surfaces",
     NULL},
};

void tyn_rsm_add(tyn_rsm_params *p, const struct rsm_tile *tile, uint32_t kind,
                 const tyn_vec4 clip[4], uint32_t light, float texel)
{
    if (p->num_tiles == TYN_RSM_MAX_TILES) {
        return;
    }
    p->tiles[p->num_tiles] = *tile;
    memset(p->drawn[p->num_tiles], 0, sizeof p->drawn[0]);
    p->drawn[p->num_tiles][0].count = p->num_triangles;
    struct rsm_draw_args *d = &p->draws[p->num_tiles++];
    *d = (struct rsm_draw_args){.texel = texel, .kind = kind, .light = light};
    memcpy(d->clip, clip, sizeof d->clip);
    memcpy(d->extent, p->extent, sizeof d->extent);
}

void tyn_rsm_add_sky(tyn_rsm_params *p, uint32_t fan, const uint32_t cells[3])
{
    uint32_t texels = 16;
    while (2 * texels <= (uint32_t)p->sky_texels) {
        texels *= 2;
    }
    if (p->sky_texels == 0 || p->num_tiles + 2 > TYN_RSM_MAX_TILES) {
        return;
    }
    p->sky = (struct rsm_sky_args){
        .texels = texels, .offset = {0, p->size[1]}, .fan = fan, .triangles = p->num_triangles};
    memcpy(p->sky.extent, p->extent, sizeof p->sky.extent);
    memcpy(p->sky.near_lo, p->near_lo, sizeof p->sky.near_lo);
    memcpy(p->sky.near_hi, p->near_hi, sizeof p->sky.near_hi);
    if (cells) {
        memcpy(p->sky.cells, cells, sizeof p->sky.cells);
    }
    for (uint32_t side = 0; side < 2; side++) {
        p->tiles[p->num_tiles++] =
            (struct rsm_tile){{side * texels, p->size[1]}, texels, TYN_RSM_SKY + side};
    }
    p->size[0] = p->size[0] > 2 * texels ? p->size[0] : 2 * texels;
    p->size[1] += texels;
}

static uint32_t num_blocks(const tyn_rsm_params *p)
{
    return (p->sky.triangles + RSM_SKY_BLOCK - 1) / RSM_SKY_BLOCK;
}

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_rsm_params *p = params;
    const tyn_extent size = {p->size[0], p->size[1], 1};
    for (uint8_t port = RSM_PORT_RSM_FLUX; port <= RSM_PORT_DEPTH; port++) {
        tyn_build_image(b, port, size, 1);
    }
    tyn_build_buffer(b, RSM_PORT_AREAS,
                     (uint64_t)(num_blocks(p) + 1) * RSM_SKY_BLOCK * sizeof(float));
    tyn_build_buffer(b, RSM_PORT_AREA_BLOCKS, (num_blocks(p) + 1) * sizeof(float));
    return TYN_OK;
}

static void record_sky(tyn_recorder *r, const tyn_rsm_params *p)
{
    const struct rsm_sky_args *args = &p->sky;
    TYN_DISPATCH(r, .kernel = KERNEL_AREAS, .cells = {num_blocks(p) * RSM_SKY_BLOCK, 1, 1},
                 .args = args);
    TYN_DISPATCH(r, .kernel = KERNEL_BLOCKS, .cells = {RSM_SKY_BLOCK, 1, 1}, .args = args);
    TYN_DISPATCH(r, .kernel = KERNEL_SKY, .cells = {args->texels * args->texels, 1, 1},
                 .args = args, .spec = &p->mode);
    tyn_rec_work(r, "places", (double)args->texels * args->texels);
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_rsm_params *p = params;
    tyn_tile tiles[TYN_RSM_MAX_TILES * TYN_SURFACE_RANGES];
    uint32_t num_tiles = 0, drawn = 0;
    const uint32_t num_maps = p->num_tiles - (p->sky.texels ? 2 : 0);
    for (uint32_t i = 0; i < num_maps; i++) {
        const struct rsm_tile *t = &p->tiles[i];
        for (uint32_t k = 0; k < TYN_SURFACE_RANGES && p->drawn[i][k].count; k++) {
            const struct surface_range *d = &p->drawn[i][k];
            tiles[num_tiles++] = (tyn_tile){t->offset[0], t->offset[1], t->texels,   t->texels,
                                            &p->draws[i], 3 * d->first, 3 * d->count};
            drawn += d->count;
        }
    }
    for (uint32_t kernel = KERNEL_DEPTH; kernel <= KERNEL_LIGHT && num_maps; kernel++) {
        tyn_rec_draw(r, &(tyn_draw){.kernel = kernel,
                                    .vertices = 3 * p->num_triangles,
                                    .tiles = tiles,
                                    .num_tiles = num_tiles,
                                    .keep_depth = kernel == KERNEL_LIGHT});
    }
    tyn_rec_work(r, "triangles", drawn);
    if (p->sky.texels) {
        record_sky(r, p);
    }
}

const tyn_pass_desc tyn_pass_rsm = {
    .name = "rsm",
    .summary = "what surfaces reflect of each light, and of the sky",
    .serves = "surfaces that suns, lamps or the sky shine on, with virtual point lights",
    TYN_PASS_TABLES(tyn_rsm_params),
    TYN_SETTINGS(params_table),
    .debug_port = RSM_PORT_RSM_FLUX,
    .debug_meaning = "power reflected in the texels of all lights' maps, W",
};
