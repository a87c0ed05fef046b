// walls.c -- surfaces as the lattice sees them.
#include "passes/methods/light/sources.h"
#include <tyndall/registry.h>

static void add_walls(tyn_graph *g, const tyn_job *job, tyn_sources *s)
{
    if (!tyn_has_walls(job->frame)) {
        return;
    }
    tyn_walls_params params;
    tyn_settings_params(job->settings, &tyn_pass_walls, &params);
    tyn_put_lattice(&s->lattice.shape, params.extent, params.dims);
    tyn_ref refs[TYN_MAX_PORTS] = {{0}};
    tyn_connect(refs, WALLS_PORT_SURFACES, job->refs.geometry);
    tyn_connect(refs, WALLS_PORT_MATERIALS, job->refs.materials);
    tyn_graph_add(g, &tyn_pass_walls, &params, refs);
    tyn_take(refs, WALLS_PORT_WALL_LINKS, s->walls.cut);
    s->walls.hits = refs[WALLS_PORT_HITS];
}

static void add_rooms(tyn_graph *g, const tyn_job *job, tyn_sources *s)
{
    if (!s->walls.cut.wall_links.resource || !s->surface_light.vpls.vpl_distances.resource) {
        return;
    }
    tyn_rooms_params params;
    tyn_settings_params(job->settings, &tyn_pass_rooms, &params);
    tyn_put_lattice(&s->lattice.shape, params.extent, params.dims);
    tyn_ref refs[TYN_MAX_PORTS] = {
        [ROOMS_PORT_WALL_LINKS] = s->walls.cut.wall_links,
        [ROOMS_PORT_VPLS] = s->surface_light.vpls.vpls,
        [ROOMS_PORT_VPL_DISTANCES] = s->surface_light.vpls.vpl_distances,
    };
    tyn_graph_add(g, &tyn_pass_rooms, &params, refs);
    s->surface_light.rooms = refs[ROOMS_PORT_ROOMS];
}

void tyn_add_walls(tyn_graph *g, const tyn_job *job, tyn_sources *s)
{
    add_walls(g, job, s);
    if (s->lamps.vpls) {
        add_rooms(g, job, s);
    }
}

// Virtual point lights, which carry reflections elsewhere, know no periods.
void tyn_add_wall_light(tyn_graph *g, const tyn_job *job, tyn_sources *s)
{
    if (!s->walls.cut.wall_links.resource || !tyn_is_periodic(job->frame) || s->num_suns == 0) {
        return;
    }
    tyn_wall_light_params params;
    tyn_settings_params(job->settings, &tyn_pass_wall_light, &params);
    params.mode = job->frame->medium.mode;
    params.num_suns = s->num_suns;
    tyn_put_lattice(&s->lattice.shape, params.extent, params.dims);
    tyn_ref refs[TYN_MAX_PORTS] = {
        [WALL_LIGHT_PORT_MEDIUM] = job->refs.medium,
        [WALL_LIGHT_PORT_LIGHTS] = job->refs.suns,
        [WALL_LIGHT_PORT_HITS] = s->walls.hits,
    };
    tyn_connect(refs, WALL_LIGHT_PORT_BEAMS, s->beams);
    tyn_connect(refs, WALL_LIGHT_PORT_WALL_LINKS, s->walls.cut);
    tyn_connect(refs, WALL_LIGHT_PORT_SURFACES, job->refs.geometry);
    tyn_graph_add(g, &tyn_pass_wall_light, &params, refs);
    s->walls.light = refs[WALL_LIGHT_PORT_WALL_LIGHT];
}
