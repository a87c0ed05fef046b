// surfaces.c -- the surfaces' part of a frame.
#include "methods/surfaces.h"
#include "passes/shadow_map/shadow_map.h"
#include <tyndall/registry.h>

tyn_result tyn_add_shadows(tyn_graph *g, const tyn_job *job, uint32_t num_suns,
                           tyn_shadow_refs *shadows)
{
    const tyn_frame_scene *frame = job->frame;
    const uint32_t num_lamps = frame->num_lights - frame->num_suns;
    *shadows = (tyn_shadow_refs){{0}};
    if (!frame->num_triangles || num_suns + num_lamps == 0) {
        return TYN_OK;
    }
    tyn_shadow_map_params params;
    tyn_settings_params(job->settings, &tyn_pass_shadow_map, &params);
    tyn_shadow_map_plan(&params, frame->suns, num_suns, frame->lights + frame->num_suns, num_lamps,
                        &frame->surfaces);
    tyn_ref refs[TYN_MAX_PORTS] = {
        [SHADOW_MAP_PORT_TRIANGLES] = job->refs.triangles,
        [SHADOW_MAP_PORT_VERTICES] = job->refs.vertices,
    };
    tyn_result result = tyn_graph_add(g, &tyn_pass_shadow_map, &params, refs);
    *shadows = (tyn_shadow_refs){refs[SHADOW_MAP_PORT_ATLAS], refs[SHADOW_MAP_PORT_SHADOWS]};
    return result;
}
