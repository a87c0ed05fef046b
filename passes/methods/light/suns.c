// suns.c -- beams of the strongest suns, and shadow maps of suns and lamps.
#include "frame/shadow_cull.h"
#include "passes/methods/light/sources.h"
#include <tyndall/registry.h>
#include <string.h>

void tyn_add_beams(tyn_graph *g, const tyn_job *job, tyn_sources *s)
{
    s->num_suns = tyn_num_beams(&job->frame->lights);
    if (s->num_suns == 0) {
        return;
    }
    tyn_beam_params params;
    tyn_settings_params(job->settings, &tyn_pass_beam, &params);
    tyn_beam_plan(&params, &job->frame->medium, job->frame->lights.suns, s->num_suns);

    tyn_ref refs[TYN_MAX_PORTS] = {{0}};
    tyn_connect(refs, BEAM_PORT_MEDIUM, s->medium);
    tyn_graph_add(g, &tyn_pass_beam, &params, refs);
    tyn_take(refs, BEAM_PORT_BEAMS, s->beams);
}

void tyn_add_shadows(tyn_graph *g, const tyn_job *job, tyn_sources *s)
{
    const tyn_frame_scene *frame = job->frame;
    const uint32_t num_suns = tyn_num_beams(&frame->lights), num_lamps = frame->lights.num_lamps;
    if (!frame->num_triangles || num_suns + num_lamps == 0) {
        return;
    }
    tyn_shadow_map_params params;
    tyn_settings_params(job->settings, &tyn_pass_shadow_map, &params);
    tyn_shadow_map_plan(&params, frame->lights.suns, num_suns, tyn_first_lamp(&frame->lights),
                        num_lamps, &frame->surfaces);
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
    tyn_graph_add(g, &tyn_pass_shadow_map, &params, refs);
    tyn_take(refs, SHADOW_MAP_PORT_SHADOW_ATLAS, s->shadows);
}
