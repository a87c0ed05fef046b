// surfaces.c -- the surfaces' part of a frame.
#include "methods/surfaces.h"
#include "passes/gbuffer/gbuffer.h"
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
    params.num_triangles = job->frame->num_triangles;
    tyn_ref refs[TYN_MAX_PORTS] = {
        [GBUFFER_PORT_CAMERA] = job->refs.camera,
        [GBUFFER_PORT_SURFACES] = job->refs.surfaces,
        [GBUFFER_PORT_TRIANGLES] = job->refs.triangles,
        [GBUFFER_PORT_VERTICES] = job->refs.vertices,
        [GBUFFER_PORT_MATERIALS] = job->refs.materials,
        [GBUFFER_PORT_TEXTURES] = job->refs.textures,
        [GBUFFER_PORT_TEXELS] = job->refs.texels,
    };
    tyn_result result = tyn_graph_add(g, &tyn_pass_gbuffer, &params, refs);
    *gbuffer = (tyn_gbuffer_refs){refs[GBUFFER_PORT_SURFACE], refs[GBUFFER_PORT_ALBEDO],
                                  refs[GBUFFER_PORT_EMISSION]};
    return result;
}
