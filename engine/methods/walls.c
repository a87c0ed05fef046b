// walls.c -- surfaces as the lattice sees them.
#include "methods/walls.h"
#include "passes/walls/walls.h"
#include "passes/wall_light/wall_light.h"
#include "passes/rooms/rooms.h"
#include <tyndall/registry.h>
#include <math.h>
#include <string.h>

bool tyn_has_walls(const tyn_frame_scene *frame)
{
    if (frame->num_triangles == 0) {
        return false;
    }
    // The surfaces' box in M, and the media's with the cells beside it, which are at most a quarter of it.
    const float *m = frame->m_from_world, *extent = frame->medium.extent;
    float longest = fmaxf(extent[0], fmaxf(extent[1], extent[2]));
    for (int axis = 0; axis < 3; axis++) {
        float lo = m[12 + axis], hi = lo;
        for (int k = 0; k < 3; k++) {
            float a = m[4 * k + axis] * frame->surfaces.lo[k],
                  b = m[4 * k + axis] * frame->surfaces.hi[k];
            lo += fminf(a, b);
            hi += fmaxf(a, b);
        }
        if (hi < -0.25f * longest || lo > extent[axis] + 0.25f * longest) {
            return false;
        }
    }
    return true;
}

static void put_lattice(const tyn_lattice_shape *shape, float extent[3], uint32_t dims[3])
{
    const tyn_extent size = tyn_lattice_dims(shape->extent, shape->cells);
    dims[0] = size.x;
    dims[1] = size.y;
    dims[2] = size.z;
    memcpy(extent, shape->extent, sizeof shape->extent);
}

tyn_result tyn_add_walls(tyn_graph *g, const tyn_job *job, const tyn_lattice_shape *shape,
                         tyn_wall_refs *walls, tyn_ref *hits)
{
    *walls = (tyn_wall_refs){{0}};
    *hits = (tyn_ref){0};
    if (!tyn_has_walls(job->frame)) {
        return TYN_OK;
    }
    tyn_walls_params params;
    tyn_settings_params(job->settings, &tyn_pass_walls, &params);
    put_lattice(shape, params.extent, params.dims);
    tyn_ref refs[TYN_MAX_PORTS] = {{0}};
    tyn_connect(refs, WALLS_PORT_SURFACES, job->refs.geometry);
    tyn_connect(refs, WALLS_PORT_MATERIALS, job->refs.materials);
    tyn_result result = tyn_graph_add(g, &tyn_pass_walls, &params, refs);
    tyn_take(refs, WALLS_PORT_WALL_LINKS, *walls);
    *hits = refs[WALLS_PORT_HITS];
    return result;
}

tyn_result tyn_add_wall_light(tyn_graph *g, const tyn_job *job, const tyn_lattice_shape *shape,
                              const tyn_picture_inputs *in, tyn_ref hits, uint32_t num_suns,
                              tyn_ref *light)
{
    *light = (tyn_ref){0};
    if (!in->walls.wall_links.resource || (num_suns == 0 && !in->lamps.vpls)) {
        return TYN_OK;
    }
    tyn_wall_light_params params;
    tyn_settings_params(job->settings, &tyn_pass_wall_light, &params);
    params.mode = job->frame->medium.mode;
    params.num_suns = num_suns;
    put_lattice(shape, params.extent, params.dims);
    tyn_ref refs[TYN_MAX_PORTS] = {
        [WALL_LIGHT_PORT_MEDIUM] = job->refs.medium,
        [WALL_LIGHT_PORT_LIGHTS] = job->refs.suns,
        [WALL_LIGHT_PORT_HITS] = hits,
        [WALL_LIGHT_PORT_ROOMS] = in->rooms,
        [WALL_LIGHT_PORT_DISTANCES] = in->vpls.vpl_distances,
    };
    tyn_connect(refs, WALL_LIGHT_PORT_BEAMS, in->beams);
    tyn_connect(refs, WALL_LIGHT_PORT_RADIALS, in->lamps.radials);
    if (!in->lamps.vpls) { // lamps alone, whose light VPLs reflect
        refs[WALL_LIGHT_PORT_RADIALS] = (tyn_ref){0};
    }
    tyn_connect(refs, WALL_LIGHT_PORT_WALL_LINKS, in->walls);
    tyn_connect(refs, WALL_LIGHT_PORT_SURFACES, job->refs.geometry);
    tyn_result result = tyn_graph_add(g, &tyn_pass_wall_light, &params, refs);
    *light = refs[WALL_LIGHT_PORT_LIGHT];
    tyn_job_counters(g, job, "wall_light", refs[WALL_LIGHT_PORT_POWER]);
    return result;
}

tyn_result tyn_add_rooms(tyn_graph *g, const tyn_job *job, const tyn_lattice_shape *shape,
                         const tyn_wall_refs *walls, const tyn_vpl_refs *vpls, tyn_ref *rooms)
{
    *rooms = (tyn_ref){0};
    if (!walls->wall_links.resource || !vpls->vpl_distances.resource) {
        return TYN_OK;
    }
    tyn_rooms_params params;
    tyn_settings_params(job->settings, &tyn_pass_rooms, &params);
    put_lattice(shape, params.extent, params.dims);
    tyn_ref refs[TYN_MAX_PORTS] = {
        [ROOMS_PORT_LINKS] = walls->wall_links,
        [ROOMS_PORT_VPLS] = vpls->vpls,
        [ROOMS_PORT_DISTANCES] = vpls->vpl_distances,
    };
    tyn_result result = tyn_graph_add(g, &tyn_pass_rooms, &params, refs);
    *rooms = refs[ROOMS_PORT_ROOMS];
    return result;
}
