// lpv.c -- see lpv.h.
#include "solve/lpv.h"
#include "passes/lpv/lpv_args.h"
#include <tyndall/registry.h>
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
    tyn_graph_add(g, &tyn_pass_lpv_reflect, &params, refs);
    tyn_job_counters(g, job, &tyn_pass_lpv_reflect, refs[LPV_REFLECT_PORT_COUNTERS]);
    return refs[LPV_REFLECT_PORT_REFLECTED];
}

void tyn_solve_lpv(tyn_graph *g, const tyn_job *job, const tyn_sources *s, tyn_field *field)
{
    tyn_lpv_params params;
    tyn_settings_params(job->settings, &tyn_pass_lpv, &params);
    params.shape = s->lattice.shape;
    params.balance = (job->outputs & TYN_OUTPUT_BALANCE) != 0;
    tyn_ref refs[TYN_MAX_PORTS] = {
        [LPV_PORT_CELLS] = s->lattice.cells,
        [LPV_PORT_SOURCE] = s->lattice.source,
        [LPV_PORT_ENVIRONMENT] = tyn_mean_environment(job, s),
    };
    if (params.reflect) {
        refs[LPV_PORT_REFLECTED] = add_reflected(g, job, s);
    }
    if (params.blockers == LPV_BLOCKERS_EXACT) {
        refs[LPV_PORT_WALL_LINKS] = s->walls.cut.wall_links;
    }
    tyn_graph_add(g, &tyn_pass_lpv, &params, refs);
    tyn_job_counters(g, job, &tyn_pass_lpv, refs[LPV_PORT_COUNTERS]);
    const bool blocked = refs[LPV_PORT_WALL_LINKS].resource || refs[LPV_PORT_BLOCKING].resource;
    field->moments = refs[LPV_PORT_MOMENTS];
    field->leaks = refs[LPV_PORT_LEAKS];
    field->wall_power = blocked ? refs[LPV_PORT_WALL_POWER] : (tyn_ref){0};
    field->cell = s->lattice.side;
    field->one_channel = s->lattice.shape.channels == 1;
    memcpy(field->tint, s->lattice.shape.tint, sizeof field->tint);
}
