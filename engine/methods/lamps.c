// lamps.c -- local lights: their grids.
#include "methods/lamps.h"
#include "passes/radial_beam/radial_beam.h"
#include <tyndall/registry.h>
#include <math.h>

static float strength(const struct radial_light *lamp)
{
    return fmaxf(lamp->intensity[0], fmaxf(lamp->intensity[1], lamp->intensity[2]));
}

// Of many lamps those that are followed everywhere have nearly a third of what all have, so that equal ones are
// treated alike, whatever their order. `lamps` are sorted.
static uint32_t num_fine(const struct radial_light *lamps, uint32_t count)
{
    float sum = 0.0f;
    for (uint32_t i = 0; i < count; i++) {
        sum += strength(&lamps[i]);
    }
    uint32_t fine = 0;
    while (fine < count &&
           (count <= TYN_METHOD_FINE_LAMPS || strength(&lamps[fine]) > 0.3f * sum)) {
        fine++;
    }
    return fine;
}

tyn_result tyn_add_radials(tyn_graph *g, const tyn_job *job, const tyn_media_refs *media,
                           tyn_ref vpls, tyn_radial_refs *out)
{
    const tyn_frame_scene *frame = job->frame;
    *out = (tyn_radial_refs){.vpls = vpls.resource != 0};
    tyn_radial_beam_params params;
    tyn_settings_params(job->settings, &tyn_pass_radial_beam, &params);
    tyn_radial_beam_plan(&params, &frame->medium, frame->lights, frame->num_suns, frame->num_lights,
                         TYN_RADIAL_LAMPS_MAX, out->vpls ? TYN_RADIAL_VPLS_MAX : 0);
    params.num_fine = num_fine(params.lamps, params.num_lamps);
    if (params.num_lamps == 0 && !out->vpls) {
        return TYN_OK;
    }
    const uint32_t *repeat = frame->medium.repeat;
    if (repeat[0] || repeat[1] || repeat[2]) {
        tyn_log_print(job->log, TYN_LOG_ERROR,
                      "point and spot lights cannot light periodic media (\"repeat\") with this "
                      "method; 'path' can");
        return TYN_ERR_PARAMS;
    }
    bool coefficients = frame->medium.mode == TYN_MEDIUM_COEFFICIENTS;
    tyn_ref refs[TYN_MAX_PORTS] = {
        [RADIAL_BEAM_PORT_MEDIUM] = job->refs.medium,
        [RADIAL_BEAM_PORT_DENSITY] = media->density,
        [RADIAL_BEAM_PORT_SIGMA_A] = media->sigma_a,
        [RADIAL_BEAM_PORT_G] = media->g,
        [RADIAL_BEAM_PORT_VPLS] = vpls,
    };
    tyn_result result = tyn_graph_add(g, &tyn_pass_radial_beam, &params, refs);
    out->radials = refs[RADIAL_BEAM_PORT_RADIALS];
    out->column = refs[coefficients ? RADIAL_BEAM_PORT_TAU_S : RADIAL_BEAM_PORT_COLUMN];
    out->tau_a = refs[RADIAL_BEAM_PORT_TAU_A];
    out->tau_p = refs[RADIAL_BEAM_PORT_TAU_P];
    out->num_lamps = params.num_lamps;
    out->num_fine = params.num_fine;
    return result;
}

uint32_t tyn_radial_groups(const tyn_radial_refs *radials)
{
    return radials->num_fine + (radials->num_lamps > radials->num_fine) + radials->vpls;
}
