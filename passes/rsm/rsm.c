// rsm.c -- the scene's surfaces drawn as every light sees them, with what they reflect.
#include "rsm.h"
#include "rsm_fragment.frag.h"
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

enum { KERNEL_DEPTH, KERNEL_LIGHT, NUM_KERNELS };

static const tyn_kernel kernels[NUM_KERNELS] = {
    [KERNEL_DEPTH] = TYN_DRAW("rsm_depth", rsm_vertex, rsm_vertex, &raster_depth),
    [KERNEL_LIGHT] = TYN_DRAW("rsm_light", rsm_vertex, rsm_fragment, &raster),
};

static const tyn_param params_table[] = {
    {"sun_texels", TYN_PARAM_INT, offsetof(tyn_rsm_params, sun_texels), 256, 16, 1024, "texels",
     "side of the map of a directional light; rounded to a power of two", NULL},
    {"lamp_texels", TYN_PARAM_INT, offsetof(tyn_rsm_params, lamp_texels), 64, 16, 512, "texels",
     "side of each of a point light's six maps; less for more than four lamps", NULL},
};

void tyn_rsm_add(tyn_rsm_params *p, const struct rsm_tile *tile, uint32_t kind,
                 const tyn_vec4 clip[4], const struct light_block *light, float texel)
{
    if (p->num_tiles == TYN_RSM_MAX_TILES) {
        return;
    }
    p->tiles[p->num_tiles] = *tile;
    memset(p->drawn[p->num_tiles], 0, sizeof p->drawn[0]);
    p->drawn[p->num_tiles][0].count = p->num_triangles;
    struct rsm_draw_args *d = &p->draws[p->num_tiles++];
    *d = (struct rsm_draw_args){
        .kind = kind, .cos_inner = -2.0f, .cos_outer = -2.0f, .texel = texel};
    memcpy(d->clip, clip, sizeof d->clip);
    memcpy(d->extent, p->extent, sizeof d->extent);
    for (int c = 0; c < 3; c++) {
        d->flux[c] = light->color[c] * texel;
        d->origin[c] =
            light->kind == TYN_LIGHT_KIND_DIRECTIONAL ? light->direction[c] : light->position[c];
        d->axis[c] = light->direction[c];
    }
    if (light->kind == TYN_LIGHT_KIND_SPOT) {
        d->cos_inner = light->cos_inner;
        d->cos_outer = light->cos_outer;
    }
}

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_rsm_params *p = params;
    const tyn_extent size = {p->size[0], p->size[1], 1};
    for (uint8_t port = RSM_PORT_RSM_FLUX; port <= RSM_PORT_DEPTH; port++) {
        tyn_build_image(b, port, size, 1);
    }
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_rsm_params *p = params;
    tyn_tile tiles[TYN_RSM_MAX_TILES * TYN_SURFACE_RANGES];
    uint32_t num_tiles = 0, drawn = 0;
    for (uint32_t i = 0; i < p->num_tiles; i++) {
        const struct rsm_tile *t = &p->tiles[i];
        for (uint32_t k = 0; k < TYN_SURFACE_RANGES && p->drawn[i][k].count; k++) {
            const struct surface_range *d = &p->drawn[i][k];
            tiles[num_tiles++] = (tyn_tile){t->offset[0], t->offset[1], t->texels,   t->texels,
                                            &p->draws[i], 3 * d->first, 3 * d->count};
            drawn += d->count;
        }
    }
    for (uint32_t kernel = 0; kernel < NUM_KERNELS; kernel++) {
        tyn_rec_draw(r, &(tyn_draw){.kernel = kernel,
                                    .vertices = 3 * p->num_triangles,
                                    .tiles = tiles,
                                    .num_tiles = num_tiles,
                                    .keep_depth = kernel == KERNEL_LIGHT});
    }
    tyn_rec_work(r, "triangles", drawn);
}

const tyn_pass_desc tyn_pass_rsm = {
    .name = "rsm",
    .summary = "what surfaces reflect of each light",
    .serves = "surfaces that suns or lamps shine on, with virtual point lights",
    TYN_PASS_TABLES(tyn_rsm_params),
    .params = params_table,
    .num_params = TYN_COUNT(params_table),
    .debug_port = RSM_PORT_RSM_FLUX,
    .debug_meaning = "power reflected in the texels of all lights' maps, W",
};
