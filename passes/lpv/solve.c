// solve.c -- see solve.h.
#include "solve.h"
#include <tyndall/extend/limits.h>
#include <string.h>

// What surfaces reflect of suns and lamps; {0} if there is nothing of that.
static tyn_ref add_reflected(tyn_graph *g, const tyn_job *job, const tyn_sources *s)
{
    tyn_rsm rsm;
    tyn_add_rsm(g, job, &rsm);
    if (rsm.num_tiles == 0) {
        return (tyn_ref){0};
    }
    tyn_lpv_reflect_params params;
    tyn_settings_params(job->settings, &tyn_pass_lpv_reflect, &params);
    params.shape = s->lattice.shape;
    params.mode = job->frame->medium.mode;
    params.num_tiles = rsm.num_tiles;
    memcpy(params.tiles, rsm.tiles, sizeof params.tiles);
    tyn_ref refs[TYN_MAX_PORTS] = {{0}};
    tyn_connect(refs, LPV_REFLECT_PORT_MEDIUM, s->medium);
    tyn_connect(refs, LPV_REFLECT_PORT_BEAMS, s->beams);
    tyn_connect(refs, LPV_REFLECT_PORT_RADIALS, s->lamps.radials);
    tyn_connect(refs, LPV_REFLECT_PORT_RSM_FLUX, rsm.maps);
    tyn_connect(refs, LPV_REFLECT_PORT_WALL_LINKS, s->walls.cut);
    tyn_graph_add(g, &tyn_pass_lpv_reflect, &params, refs);
    return refs[LPV_REFLECT_PORT_REFLECTED];
}

// Light of suns and lamps that scatters first, by samples along their rays.
static tyn_ref add_scattered(tyn_graph *g, const tyn_job *job, const tyn_sources *s)
{
    const tyn_lights *lights = &job->frame->lights;
    tyn_lpv_scatter_params params;
    tyn_settings_params(job->settings, &tyn_pass_lpv_scatter, &params);
    params.shape = s->lattice.shape;
    params.mode = job->frame->medium.mode;
    tyn_lpv_scatter_plan(&params, s->lattice.shape.extent, job->frame->majorant, lights->suns,
                         s->num_suns, tyn_first_lamp(lights), s->lamps.num_lamps);
    tyn_ref refs[TYN_MAX_PORTS] = {[LPV_SCATTER_PORT_LIGHTS] = job->refs.suns};
    tyn_connect(refs, LPV_SCATTER_PORT_MEDIUM, s->medium);
    tyn_connect(refs, LPV_SCATTER_PORT_BEAMS, s->beams);
    tyn_connect(refs, LPV_SCATTER_PORT_RADIALS, s->lamps.radials);
    tyn_connect(refs, LPV_SCATTER_PORT_SHADOW_ATLAS, s->shadows);
    tyn_connect(refs, LPV_SCATTER_PORT_WALL_LINKS, s->walls.cut);
    tyn_graph_add(g, &tyn_pass_lpv_scatter, &params, refs);
    return refs[LPV_SCATTER_PORT_SCATTERED];
}

// Surfaces as six maps along the axes see them, as blockers.
static tyn_ref add_blockers(tyn_graph *g, const tyn_job *job, const tyn_sources *s)
{
    tyn_lpv_blockers_params params;
    tyn_settings_params(job->settings, &tyn_pass_lpv_blockers, &params);
    params.shape = s->lattice.shape;
    tyn_rsm_view views[TYN_LPV_BLOCKERS_MAPS];
    for (uint32_t i = 0; i < TYN_LPV_BLOCKERS_MAPS; i++) {
        tyn_lpv_blockers_view(&params, i, views[i].offset, views[i].rows);
    }
    tyn_rsm_refs maps;
    tyn_add_rsm_views(g, job, views, TYN_LPV_BLOCKERS_MAPS, (uint32_t)params.texels, &maps);
    tyn_ref own[TYN_MAX_PORTS] = {{0}};
    tyn_connect(own, LPV_BLOCKERS_PORT_RSM_FLUX, maps);
    tyn_graph_add(g, &tyn_pass_lpv_blockers, &params, own);
    return own[LPV_BLOCKERS_PORT_BLOCKING];
}

// Light that has not got anywhere after the last iteration is not in the field. Where hardly any scatters there is none to miss.
static void warn_of_iterations(const tyn_job *job, const tyn_lpv_params *params)
{
    const tyn_extent n = tyn_lattice_dims(params->shape.extent, params->shape.cells);
    const uint32_t most = n.x > n.y ? n.x : n.y, longest = most > n.z ? most : n.z;
    if ((uint32_t)params->iterations < 2 * longest && tyn_limit_scatterings(job) > 0.05f) {
        tyn_job_warn(job,
                     "accuracy: light moves on by a cell an iteration: it gets %d of %u cells far "
                     "(-D lpv.iterations)",
                     (int)params->iterations, longest);
    }
}

void tyn_solve_lpv(tyn_graph *g, const tyn_job *job, const tyn_sources *s, tyn_field *field)
{
    tyn_lpv_params params;
    tyn_settings_params(job->settings, &tyn_pass_lpv, &params);
    params.shape = s->lattice.shape;
    warn_of_iterations(job, &params);
    params.balance = (job->outputs & TYN_OUTPUT_BALANCE) != 0;
    tyn_ref refs[TYN_MAX_PORTS] = {
        [LPV_PORT_CELLS] = s->lattice.cells,
        [LPV_PORT_SOURCE] = s->lattice.source,
        [LPV_PORT_ENVIRONMENT] = tyn_mean_environment(job, s),
    };
    if (params.reflect) {
        refs[LPV_PORT_REFLECTED] = add_reflected(g, job, s);
    }
    if (params.blockers == TYN_LPV_BLOCKERS_EXACT) {
        tyn_connect(refs, LPV_PORT_WALL_LINKS, s->walls.cut);
    } else if (params.blockers == TYN_LPV_BLOCKERS_FUZZY && s->walls.cut.wall_links.resource) {
        refs[LPV_PORT_BLOCKING] = add_blockers(g, job, s);
    }
    if (params.inject == TYN_LPV_INJECT_NONE) {
        refs[LPV_PORT_SOURCE] = (tyn_ref){0};
    } else if (params.inject == TYN_LPV_INJECT_SHADOW_MAP && s->sky.ordinates.resource) {
        tyn_job_warn(job, "lpv.inject is shadow_map, which knows suns and lamps only: the "
                          "environment's light is integrated over cells");
    } else if (params.inject == TYN_LPV_INJECT_SHADOW_MAP) {
        refs[LPV_PORT_SOURCE] = (tyn_ref){0};
        refs[LPV_PORT_SCATTERED] = add_scattered(g, job, s);
    }
    tyn_graph_add(g, &tyn_pass_lpv, &params, refs);
    const bool blocked = refs[LPV_PORT_WALL_LINKS].resource || refs[LPV_PORT_BLOCKING].resource;
    field->moments = refs[LPV_PORT_MOMENTS];
    field->leaks = refs[LPV_PORT_LEAKS];
    field->wall_power = blocked ? refs[LPV_PORT_WALL_POWER] : (tyn_ref){0};
    field->cell = s->lattice.side;
    field->one_channel = s->lattice.shape.channels == 1;
    memcpy(field->tint, s->lattice.shape.tint, sizeof field->tint);
}
