// virtual.c -- virtual point lights: what surfaces reflect and emit.
#include "light/shadow_cull.h"
#include "light/sources.h"
#include <tyndall/registry.h>
#include <math.h>
#include <string.h>

_Static_assert(2 * TYN_SHADOW_VIEWS <= TYN_VIEWS_SEEN, "a place for each view of both passes");

// 0: nothing emits; 2: some materials on both sides.
static uint32_t emitters(const tyn_surfaces *surfaces)
{
    uint32_t most = 0;
    for (uint32_t i = 0; i < surfaces->num_materials; i++) {
        const tyn_surface_material *m = &surfaces->materials[i];
        if (m->emission[0] + m->emission[1] + m->emission[2] > 0.0f) {
            const uint32_t sides = m->flags & TYN_SURFACE_EMITS_BOTH_SIDES ? 2 : 1;
            most = most > sides ? most : sides;
        }
    }
    return most;
}

bool tyn_vpls_bounce(const tyn_job *job)
{
    const tyn_frame_scene *frame = job->frame;
    if (frame->empty) {
        return true;
    }
    const float *m = frame->m_from_world, *extent = frame->medium.extent;
    const float margin = 0.15f * fmaxf(extent[0], fmaxf(extent[1], extent[2]));
    bool beyond = false;
    for (int corner = 0; corner < 8; corner++) {
        float p[3];
        for (int a = 0; a < 3; a++) {
            p[a] = corner >> a & 1 ? frame->surfaces.hi[a] : frame->surfaces.lo[a];
        }
        for (int a = 0; a < 3; a++) {
            float x = m[a] * p[0] + m[4 + a] * p[1] + m[8 + a] * p[2] + m[12 + a];
            beyond = beyond || x < -margin || x > extent[a] + margin;
        }
    }
    return beyond;
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

void tyn_add_rsm(tyn_graph *g, const tyn_job *job, tyn_rsm *rsm)
{
    const tyn_frame_scene *frame = job->frame;
    const struct light_block *lamps = tyn_first_lamp(&frame->lights);
    const uint32_t num_suns = tyn_num_beams(&frame->lights), num_lamps = frame->lights.num_lamps;
    memset(rsm, 0, sizeof *rsm);
    if (!frame->num_triangles || num_suns + num_lamps == 0) {
        return;
    }
    tyn_rsm_params params;
    tyn_settings_params(job->settings, &tyn_pass_rsm, &params);
    // The same views as those of the shadow maps, smaller.
    tyn_shadow_map_params views = {.sun_texels = params.sun_texels,
                                   .lamp_texels = params.lamp_texels};
    tyn_shadow_map_plan(&views, frame->lights.suns, num_suns, lamps, num_lamps, &frame->surfaces);
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
                    v->light < TYN_SHADOW_SUNS ? &frame->lights.suns[v->light]
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
    tyn_graph_add(g, &tyn_pass_rsm, &params, refs);
    tyn_take(refs, RSM_PORT_RSM_FLUX, rsm->maps);
}

void tyn_add_vpls(tyn_graph *g, const tyn_job *job, tyn_sources *s)
{
    if (!job->frame->num_triangles) {
        return;
    }
    tyn_vpl_params params;
    tyn_settings_params(job->settings, &tyn_pass_vpl, &params);
    params.mode = job->frame->medium.mode;
    params.num_suns = job->frame->lights.num_directional;
    params.num_triangles = job->frame->num_triangles;
    params.emitters = emitters(&job->scene->surfaces);
    params.bounces = tyn_vpls_bounce(job);
    if (params.count == 0) {
        return;
    }
    tyn_rsm rsm;
    tyn_add_rsm(g, job, &rsm);
    if (rsm.num_tiles + params.emitters == 0) {
        return;
    }
    if (!tyn_can_trace(job)) {
        tyn_job_warn(job, "the surfaces have no hierarchy: light that they reflect passes "
                          "through other surfaces");
        params.visibility = 0;
    }
    params.num_tiles = rsm.num_tiles;
    memcpy(params.tiles, rsm.tiles, sizeof params.tiles);

    tyn_ref refs[TYN_MAX_PORTS] = {
        [VPL_PORT_SUNS] = job->refs.suns,
        [VPL_PORT_LIGHTS] = job->refs.lights,
    };
    tyn_connect(refs, VPL_PORT_RSM_FLUX, rsm.maps);
    tyn_connect(refs, VPL_PORT_MEDIUM, s->medium);
    refs[VPL_PORT_MEDIUM] = job->refs.medium; // also without media
    tyn_connect(refs, VPL_PORT_SURFACES, job->refs.geometry);
    tyn_connect(refs, VPL_PORT_MATERIALS, job->refs.materials);
    tyn_graph_add(g, &tyn_pass_vpl, &params, refs);
    tyn_take(refs, VPL_PORT_VPLS, s->surface_light.vpls);
}
