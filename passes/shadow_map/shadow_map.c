// shadow_map.c -- the scene's triangles drawn into every light's map.
#include "shadow_map.h"
#include "shadow_map_vertex.vert.h"

static const tyn_port ports[] = {SHADOW_MAP_PORTS(TYN_PORT_ROW)};

static const tyn_binding attachments[] = {{SHADOW_MAP_PORT_SHADOW_ATLAS, TYN_USE_DEPTH, false}};

static const tyn_raster raster = {
    .attachments = attachments,
    .num_attachments = 1,
    .depth = VK_COMPARE_OP_GREATER,
    .clear_depth = 0.0f,
};

static const tyn_kernel kernels[] = {
    TYN_DRAW("shadow_map", shadow_map_vertex, shadow_map_vertex, &raster),
};

static const tyn_param params_table[] = {
    {"sun_texels", TYN_PARAM_INT, offsetof(tyn_shadow_map_params, sun_texels), 2048, 16, 8192,
     "texels",
     "side of the map of a directional light, over all surfaces; rounded to a power of two", NULL},
    {"lamp_texels", TYN_PARAM_INT, offsetof(tyn_shadow_map_params, lamp_texels), 512, 16, 2048,
     "texels",
     "side of each of a point light's six maps, half of that of a spot's one; less for more than "
     "four lamps",
     NULL},
};

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_shadow_map_params *p = params;
    tyn_build_image(b, SHADOW_MAP_PORT_SHADOW_ATLAS, (tyn_extent){p->size[0], p->size[1], 1}, 1);
    tyn_build_buffer(b, SHADOW_MAP_PORT_SHADOWS, sizeof p->lights);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_shadow_map_params *p = params;
    tyn_tile tiles[TYN_SHADOW_VIEWS * TYN_SURFACE_RANGES];
    uint32_t num_tiles = 0, drawn = 0;
    for (uint32_t i = 0; i < p->num_views; i++) {
        const tyn_shadow_view *v = &p->views[i];
        for (uint32_t k = 0; k < TYN_SURFACE_RANGES && v->drawn[k].count; k++) {
            tiles[num_tiles++] = (tyn_tile){
                v->place[0],           v->place[1],          v->texels, v->texels, &v->args,
                3 * v->drawn[k].first, 3 * v->drawn[k].count};
            drawn += v->drawn[k].count;
        }
    }
    tyn_rec_update(r, SHADOW_MAP_PORT_SHADOWS, 0, p->lights, sizeof p->lights);
    tyn_rec_draw(r, &(tyn_draw){.kernel = 0,
                                .vertices = 3 * p->num_triangles,
                                .tiles = tiles,
                                .num_tiles = num_tiles});
    tyn_rec_work(r, "triangles", drawn);
}

const tyn_pass_desc tyn_pass_shadow_map = {
    .name = "shadow_map",
    .summary = "what each light sees of the surfaces",
    .serves = "surfaces that suns or lamps shine on",
    TYN_PASS_TABLES(tyn_shadow_map_params),
    TYN_SETTINGS(params_table),
    .debug_port = SHADOW_MAP_PORT_SHADOW_ATLAS,
    .debug_meaning = "the maps of all lights: 1 near, 0 far",
};
