// walls.c -- surfaces as the lattice sees them.
#include "methods/walls.h"
#include "passes/walls/walls.h"
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
                         tyn_wall_refs *walls)
{
    *walls = (tyn_wall_refs){{0}};
    if (!tyn_has_walls(job->frame)) {
        return TYN_OK;
    }
    tyn_walls_params params;
    tyn_settings_params(job->settings, &tyn_pass_walls, &params);
    put_lattice(shape, params.extent, params.dims);
    tyn_ref refs[TYN_MAX_PORTS] = {
        [WALLS_PORT_SURFACES] = job->refs.surfaces,   [WALLS_PORT_VERTICES] = job->refs.vertices,
        [WALLS_PORT_TRIANGLES] = job->refs.triangles, [WALLS_PORT_MATERIALS] = job->refs.materials,
        [WALLS_PORT_TEXTURES] = job->refs.textures,   [WALLS_PORT_TEXELS] = job->refs.texels,
    };
    tyn_result result = tyn_graph_add(g, &tyn_pass_walls, &params, refs);
    *walls = (tyn_wall_refs){refs[WALLS_PORT_LINKS], refs[WALLS_PORT_CELLS], refs[WALLS_PORT_HITS]};
    return result;
}

tyn_result tyn_add_wall_light(tyn_graph *g, const tyn_job *job, const tyn_lattice_shape *shape,
                              const tyn_wall_refs *walls, const tyn_beam_refs *beams,
                              uint32_t num_suns, const tyn_radial_refs *radials, tyn_ref distances,
                              tyn_ref rooms, tyn_ref *light)
{
    *light = (tyn_ref){0};
    if (!walls->links.resource || (num_suns == 0 && !radials->vpls)) {
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
        [WALL_LIGHT_PORT_BEAMS] = beams->beams,
        [WALL_LIGHT_PORT_COLUMN] = beams->column,
        [WALL_LIGHT_PORT_TAU_A] = beams->tau_a,
        [WALL_LIGHT_PORT_TAU_P] = beams->tau_p,
        [WALL_LIGHT_PORT_RADIALS] = radials->vpls ? radials->radials : (tyn_ref){0},
        [WALL_LIGHT_PORT_RADIAL_COLUMN] = radials->column,
        [WALL_LIGHT_PORT_RADIAL_TAU_A] = radials->tau_a,
        [WALL_LIGHT_PORT_RADIAL_TAU_P] = radials->tau_p,
        [WALL_LIGHT_PORT_SURFACES] = job->refs.surfaces,
        [WALL_LIGHT_PORT_VERTICES] = job->refs.vertices,
        [WALL_LIGHT_PORT_TRIANGLES] = job->refs.triangles,
        [WALL_LIGHT_PORT_LINKS] = walls->links,
        [WALL_LIGHT_PORT_CELLS] = walls->cells,
        [WALL_LIGHT_PORT_HITS] = walls->hits,
        [WALL_LIGHT_PORT_ROOMS] = rooms,
        [WALL_LIGHT_PORT_DISTANCES] = distances,
    };
    tyn_result result = tyn_graph_add(g, &tyn_pass_wall_light, &params, refs);
    *light = refs[WALL_LIGHT_PORT_LIGHT];
    tyn_job_counters(g, job, &tyn_pass_wall_light, refs[WALL_LIGHT_PORT_POWER]);
    return result;
}

tyn_result tyn_add_rooms(tyn_graph *g, const tyn_job *job, const tyn_lattice_shape *shape,
                         const tyn_wall_refs *walls, const tyn_vpl_refs *vpls, tyn_ref *rooms)
{
    *rooms = (tyn_ref){0};
    if (!walls->links.resource || !vpls->distances.resource) {
        return TYN_OK;
    }
    tyn_rooms_params params;
    tyn_settings_params(job->settings, &tyn_pass_rooms, &params);
    put_lattice(shape, params.extent, params.dims);
    tyn_ref refs[TYN_MAX_PORTS] = {
        [ROOMS_PORT_LINKS] = walls->links,
        [ROOMS_PORT_VPLS] = vpls->lights,
        [ROOMS_PORT_DISTANCES] = vpls->distances,
    };
    tyn_result result = tyn_graph_add(g, &tyn_pass_rooms, &params, refs);
    *rooms = refs[ROOMS_PORT_ROOMS];
    return result;
}
