// surfaces.c -- the surfaces' part of a frame.
#include "methods/surfaces.h"
#include "methods/nodes.h"
#include "methods/views.h"
#include "passes/gbuffer/gbuffer.h"
#include "passes/light_cells/light_cells.h"
#include "passes/rsm/rsm.h"
#include "passes/shadow_map/shadow_map.h"
#include <tyndall/registry.h>
#include <math.h>
#include <string.h>

_Static_assert(2 * TYN_SHADOW_VIEWS <= TYN_VIEWS_SEEN, "a place for each view of both passes");

static tyn_result add_light_cells(tyn_graph *g, const tyn_job *job, uint32_t num_suns,
                                  uint32_t num_lamps, const tyn_shadow_refs *shadows,
                                  tyn_ref *cells)
{
    tyn_light_cells_params params;
    tyn_settings_params(job->settings, &tyn_pass_light_cells, &params);
    memcpy(params.extent, job->frame->medium.extent, sizeof params.extent);
    params.num_suns = num_suns;
    params.num_lamps = num_lamps;
    tyn_ref refs[TYN_MAX_PORTS] = {{0}};
    tyn_connect(refs, LIGHT_CELLS_PORT_SHADOW_ATLAS, *shadows);
    tyn_result result = tyn_graph_add(g, &tyn_pass_light_cells, &params, refs);
    *cells = refs[LIGHT_CELLS_PORT_CELLS];
    return result;
}

tyn_result tyn_add_shadows(tyn_graph *g, const tyn_job *job, uint32_t num_suns,
                           tyn_shadow_refs *shadows, tyn_ref *cells)
{
    const tyn_frame_scene *frame = job->frame;
    const uint32_t num_lamps = frame->num_lights - frame->num_suns;
    *shadows = (tyn_shadow_refs){{0}};
    *cells = (tyn_ref){0};
    if (!frame->num_triangles || num_suns + num_lamps == 0) {
        return TYN_OK;
    }
    tyn_shadow_map_params params;
    tyn_settings_params(job->settings, &tyn_pass_shadow_map, &params);
    tyn_shadow_map_plan(&params, frame->suns, num_suns, frame->lights + frame->num_suns, num_lamps,
                        &frame->surfaces);
    const tyn_surfaces *surfaces = &job->scene->surfaces;
    for (uint32_t i = 0; i < params.num_views; i++) {
        tyn_shadow_view *v = &params.views[i];
        tyn_view_cull_seen(frame->seen, i, surfaces, frame->below, (const tyn_vec4 *)v->args.clip,
                           v->drawn);
    }
    tyn_ref refs[TYN_MAX_PORTS] = {
        [SHADOW_MAP_PORT_TRIANGLES] = job->refs.geometry.triangles,
        [SHADOW_MAP_PORT_VERTICES] = job->refs.geometry.vertices,
    };
    tyn_result result = tyn_graph_add(g, &tyn_pass_shadow_map, &params, refs);
    tyn_take(refs, SHADOW_MAP_PORT_SHADOW_ATLAS, *shadows);
    const uint32_t *repeat = frame->medium.repeat;
    if (result == TYN_OK && !frame->empty && !repeat[0] && !repeat[1] && !repeat[2]) {
        result = add_light_cells(g, job, num_suns, num_lamps, shadows, cells);
    }
    return result;
}

// All samples of a picture are in one image, which has no more texels along a side than the device can draw.
static void fit_samples(tyn_gbuffer_params *params, uint32_t side, const tyn_job *job)
{
    const uint32_t longest = params->size[0] > params->size[1] ? params->size[0] : params->size[1];
    const int32_t most = (int32_t)(side / longest), asked = params->samples;
    if (asked > most && asked > 1) {
        params->samples = most > 1 ? most : 1;
        tyn_method_warn(job,
                        "%u x %u pixels with %d x %d samples of the surfaces are more than this "
                        "device draws (%u along a side): %d x %d, edges are less smooth",
                        params->size[0], params->size[1], asked, asked, side, params->samples,
                        params->samples);
    }
}

tyn_result tyn_add_gbuffer(tyn_graph *g, const tyn_job *job, tyn_gbuffer_refs *gbuffer)
{
    *gbuffer = (tyn_gbuffer_refs){{0}};
    if (!job->frame->num_triangles) {
        return TYN_OK;
    }
    tyn_gbuffer_params params;
    tyn_settings_params(job->settings, &tyn_pass_gbuffer, &params);
    params.size[0] = job->view->width;
    params.size[1] = job->view->height;
    fit_samples(&params, tyn_graph_drawn_side(g), job);
    params.num_triangles = job->frame->num_triangles;
    params.textured = job->frame->num_textures > 0;
    tyn_ref refs[TYN_MAX_PORTS] = {
        [GBUFFER_PORT_CAMERA] = job->refs.camera,
    };
    tyn_connect(refs, GBUFFER_PORT_SURFACES, job->refs.geometry);
    tyn_connect(refs, GBUFFER_PORT_MATERIALS, job->refs.materials);
    tyn_result result = tyn_graph_add(g, &tyn_pass_gbuffer, &params, refs);
    *gbuffer = (tyn_gbuffer_refs){refs[GBUFFER_PORT_DISTANCES], refs[GBUFFER_PORT_FACING],
                                  refs[GBUFFER_PORT_COLOURS], refs[GBUFFER_PORT_EDGE_COUNT],
                                  refs[GBUFFER_PORT_EDGES]};
    return result;
}

// The area of a sun's texel across the light; the solid angle of a lamp's in the middle of its map.
static float texel_of(const struct shadow_light *l)
{
    if (l->kind != TYN_SHADOW_SUN) {
        const float side = 2.0f / (l->texels * l->scale);
        return side * side;
    }
    float area = 1.0f;
    for (int r = 0; r < 2; r++) {
        const float *row = l->rows[r];
        area *= 2.0f / (l->texels * sqrtf(row[0] * row[0] + row[1] * row[1] + row[2] * row[2]));
    }
    return area;
}

tyn_result tyn_add_rsm(tyn_graph *g, const tyn_job *job, uint32_t num_suns, tyn_rsm *rsm)
{
    const tyn_frame_scene *frame = job->frame;
    const struct light_block *lamps = frame->lights + frame->num_suns;
    const uint32_t num_lamps = frame->num_lights - frame->num_suns;
    memset(rsm, 0, sizeof *rsm);
    if (!frame->num_triangles || num_suns + num_lamps == 0) {
        return TYN_OK;
    }
    tyn_rsm_params params;
    tyn_settings_params(job->settings, &tyn_pass_rsm, &params);
    // The same views as those of the shadow maps, smaller.
    tyn_shadow_map_params views = {.sun_texels = params.sun_texels,
                                   .lamp_texels = params.lamp_texels};
    tyn_shadow_map_plan(&views, frame->suns, num_suns, lamps, num_lamps, &frame->surfaces);
    memcpy(params.size, views.size, sizeof params.size);
    params.num_triangles = frame->num_triangles;
    if (!frame->empty) {
        memcpy(params.extent, frame->medium.extent, sizeof params.extent);
    }
    const tyn_surfaces *surfaces = &job->scene->surfaces;
    for (uint32_t i = 0; i < views.num_views; i++) {
        const tyn_shadow_view *v = &views.views[i];
        const struct shadow_light *l = &views.lights[v->light];
        const struct rsm_tile tile = {{v->place[0], v->place[1]}, v->texels, v->light};
        tyn_rsm_add(&params, &tile, l->kind, v->args.clip,
                    v->light < TYN_SHADOW_SUNS ? &frame->suns[v->light]
                                               : &lamps[v->light - TYN_SHADOW_SUNS],
                    texel_of(l));
        tyn_view_cull_seen(frame->seen, TYN_SHADOW_VIEWS + i, surfaces, frame->below, v->args.clip,
                           params.drawn[i]);
    }
    rsm->num_tiles = params.num_tiles;
    memcpy(rsm->tiles, params.tiles, sizeof rsm->tiles);
    tyn_ref refs[TYN_MAX_PORTS] = {{0}};
    tyn_connect(refs, RSM_PORT_SURFACES, job->refs.geometry);
    tyn_connect(refs, RSM_PORT_MATERIALS, job->refs.materials);
    tyn_result result = tyn_graph_add(g, &tyn_pass_rsm, &params, refs);
    tyn_take(refs, RSM_PORT_FLUX, rsm->maps);
    return result;
}

void tyn_surfaces_box(const tyn_frame_scene *frame, float lo[3], float hi[3])
{
    const struct surface_block *s = &frame->surfaces;
    for (int a = 0; a < 3; a++) {
        float centre = s->from_world[a][3], reach = 0;
        for (int w = 0; w < 3; w++) {
            centre += s->from_world[a][w] * 0.5f * (s->lo[w] + s->hi[w]);
            reach += fabsf(s->from_world[a][w]) * 0.5f * (s->hi[w] - s->lo[w]);
        }
        lo[a] = centre - reach;
        hi[a] = centre + reach;
    }
}

static void include(float lo[3], float hi[3], const float p[3])
{
    for (int a = 0; a < 3; a++) {
        lo[a] = fminf(lo[a], p[a]);
        hi[a] = fmaxf(hi[a], p[a]);
    }
}

void tyn_scene_box(const tyn_frame_scene *frame, float lo[3], float hi[3])
{
    const struct medium_block *m = &frame->medium;
    float corners[2][3], size = 0;
    memset(lo, 0, 3 * sizeof *lo);
    memcpy(hi, m->extent, 3 * sizeof *hi);
    tyn_surfaces_box(frame, corners[0], corners[1]);
    include(lo, hi, corners[0]);
    include(lo, hi, corners[1]);
    for (uint32_t i = frame->num_suns; i < frame->num_lights; i++) {
        include(lo, hi, frame->lights[i].position);
    }
    for (int a = 0; a < 3; a++) {
        size = fmaxf(size, hi[a] - lo[a]);
    }
    for (int a = 0; a < 3; a++) {
        lo[a] = m->repeat[a] ? 0 : lo[a] - 0.05f * size;
        hi[a] = m->repeat[a] ? m->extent[a] : hi[a] + 0.05f * size;
    }
}
