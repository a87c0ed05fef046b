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

static void add_wall_light(tyn_graph *g, const tyn_job *job, uint32_t num_suns, bool vpls,
                           tyn_sources *s)
{
    const bool sky = s->sky.seen.sky_seen.resource && !s->surface_light.of_sky;
    if (!s->walls.cut.wall_links.resource || (num_suns == 0 && !sky && !vpls)) {
        return;
    }
    tyn_wall_light_params params;
    tyn_settings_params(job->settings, &tyn_pass_wall_light, &params);
    params.mode = job->frame->medium.mode;
    params.num_suns = num_suns;
    tyn_put_lattice(&s->lattice.shape, params.extent, params.dims);
    tyn_ref refs[TYN_MAX_PORTS] = {
        [WALL_LIGHT_PORT_MEDIUM] = job->refs.medium,
        [WALL_LIGHT_PORT_LIGHTS] = job->refs.suns,
        [WALL_LIGHT_PORT_HITS] = s->walls.hits,
        [WALL_LIGHT_PORT_ROOMS] = s->surface_light.rooms,
        [WALL_LIGHT_PORT_VPL_DISTANCES] = s->surface_light.vpls.vpl_distances,
    };
    tyn_connect(refs, WALL_LIGHT_PORT_BEAMS, s->beams);
    if (vpls) { // not lamps alone, whose light VPLs reflect
        tyn_connect(refs, WALL_LIGHT_PORT_RADIALS, s->lamps.radials);
    }
    params.sky_whole = !s->sky.split;
    if (sky) {
        tyn_connect(refs, WALL_LIGHT_PORT_ORDINATES, s->sky.columns);
        tyn_connect(refs, WALL_LIGHT_PORT_SKY_SEEN, s->sky.seen);
    }
    tyn_connect(refs, WALL_LIGHT_PORT_WALL_LINKS, s->walls.cut);
    tyn_connect(refs, WALL_LIGHT_PORT_SURFACES, job->refs.geometry);
    tyn_graph_add(g, &tyn_pass_wall_light, &params, refs);
    s->walls.light = refs[WALL_LIGHT_PORT_WALL_LIGHT];
    s->walls.light_power = refs[WALL_LIGHT_PORT_POWER];
}

// Second reflections, of what the VPLs send. In a periodic medium also sunlight: light from single points on walls knows
// no periods. And light of the sky, if there are no VPLs of it.
void tyn_add_wall_light(tyn_graph *g, const tyn_job *job, tyn_sources *s)
{
    // VPLs may carry what walls reflect of theirs.
    const bool bounce = s->surface_light.vpls.vpls.resource && s->surface_light.bounces;
    add_wall_light(g, job, tyn_is_periodic(job->frame) ? s->num_suns : 0, s->lamps.vpls && !bounce,
                   s);
}
