// lamps.c -- local lights: their grids.
#include "passes/methods/light/sources.h"
#include <tyndall/registry.h>
#include <math.h>

enum { FINE_LAMPS = 2 }; // so many are always followed everywhere

static float largest(const float color[4])
{
    return fmaxf(color[0], fmaxf(color[1], color[2]));
}

// Of many lamps those that are followed everywhere have nearly a third of what all have, so that equal ones are
// treated alike, whatever their order. `colors` are sorted.
static uint32_t num_fine(float (*colors)[4], uint32_t count)
{
    float sum = 0.0f;
    for (uint32_t i = 0; i < count; i++) {
        sum += largest(colors[i]);
    }
    uint32_t fine = 0;
    while (fine < count && (count <= FINE_LAMPS || largest(colors[fine]) > 0.3f * sum)) {
        fine++;
    }
    return fine;
}

void tyn_add_radials(tyn_graph *g, const tyn_job *job, tyn_sources *s)
{
    const tyn_frame_scene *frame = job->frame;
    tyn_lamps *out = &s->lamps;
    const tyn_ref vpls = s->surface_light.vpls.vpls;
    out->vpls = vpls.resource != 0;
    tyn_radial_beam_params params;
    tyn_radial_lights_params lights = {0};
    tyn_settings_params(job->settings, &tyn_pass_radial_beam, &params);
    tyn_radial_beam_plan(&params, lights.colors, &frame->medium, tyn_first_lamp(&frame->lights),
                         frame->lights.num_lamps, TYN_RADIAL_LAMPS_MAX,
                         out->vpls ? TYN_RADIAL_VPLS_MAX : 0);
    params.num_fine = num_fine(lights.colors, params.num_lamps);
    if (params.num_lamps == 0 && !out->vpls) {
        return;
    }
    if (tyn_is_periodic(frame)) {
        tyn_graph_refuse(
            g, TYN_FAULT(job->log, TYN_ERR_PARAMS,
                         "point and spot lights cannot light periodic media (\"repeat\") with this "
                         "method; 'path' can"));
        return;
    }
    tyn_ref refs[TYN_MAX_PORTS] = {[RADIAL_BEAM_PORT_VPLS] = vpls};
    tyn_connect(refs, RADIAL_BEAM_PORT_MEDIUM, s->medium);
    tyn_graph_add(g, &tyn_pass_radial_beam, &params, refs);
    lights.num_lamps = params.num_lamps;
    lights.max_vpls = params.max_vpls;
    tyn_ref shining[TYN_MAX_PORTS] = {[RADIAL_LIGHTS_PORT_GRIDS] = refs[RADIAL_BEAM_PORT_GRIDS]};
    tyn_graph_add(g, &tyn_pass_radial_lights, &lights, shining);
    refs[RADIAL_BEAM_PORT_GRIDS] = shining[RADIAL_LIGHTS_PORT_RADIALS];
    tyn_take(refs, RADIAL_BEAM_PORT_GRIDS, out->radials);
    out->num_lamps = params.num_lamps;
    out->num_fine = params.num_fine;
}

uint32_t tyn_radial_groups(const tyn_lamps *lamps)
{
    return lamps->num_fine + (lamps->num_lamps > lamps->num_fine) + lamps->vpls;
}
