// balance.c -- where the energy of the lattice goes.
#include "passes/methods/view/view.h"
#include <tyndall/registry.h>
#include <string.h>

// What a balance needs to follow unscattered light to surfaces, if there are any: ports of the pass in `refs`.
static void follow_lights(const tyn_job *job, const tyn_view_inputs *in, tyn_balance_params *params,
                          tyn_ref *refs)
{
    const bool follow = job->frame->num_triangles && !tyn_is_periodic(job->frame);
    if (follow && !tyn_can_trace(job)) {
        tyn_job_warn(job, "the surfaces have no hierarchy: light that meets them without having "
                          "scattered counts as escaped in the balance");
    } else if (follow) {
        params->mode = job->frame->medium.mode;
        tyn_scene_box(job->frame, params->box[0], params->box[1]);
        tyn_connect(refs, BALANCE_PORT_BEAMS, in->sources->beams);
        tyn_connect(refs, BALANCE_PORT_RADIALS, in->sources->lamps.radials);
        tyn_connect(refs, BALANCE_PORT_SURFACES, job->refs.geometry);
        tyn_connect(refs, BALANCE_PORT_MATERIALS, job->refs.materials);
        refs[BALANCE_PORT_EMITTERS] = job->refs.emitters;
        if (in->sources->sky.maps.sky_maps.resource) {
            refs[BALANCE_PORT_DIRECTIONS] = in->sources->sky.directions;
        }
    }
}

void tyn_add_balance(tyn_graph *g, const tyn_job *job, const tyn_view_inputs *in)
{
    if (job->scene->num_shapes != 1 || job->scene->shapes[0].kind != TYN_SHAPE_BOX) {
        tyn_job_warn(job, "the balance is that of the box around the media: light that misses them "
                          "inside it counts as entering and as escaped");
    }
    tyn_balance_params params;
    tyn_settings_params(job->settings, &tyn_pass_balance, &params);
    params.channels = in->sources->lattice.shape.channels;
    memcpy(params.tint, in->sources->lattice.shape.tint, sizeof params.tint);
    params.num_suns = in->sources->num_suns;
    params.num_groups = tyn_radial_groups(&in->sources->lamps);
    params.vpls = in->sources->lamps.vpls;
    tyn_ref refs[TYN_MAX_PORTS] = {
        [BALANCE_PORT_MEDIUM] = job->refs.medium,
        [BALANCE_PORT_ENVIRONMENT] = tyn_mean_environment(job, in->sources),
        [BALANCE_PORT_ORDINATES] = in->sources->sky.ordinates,
        [BALANCE_PORT_LIGHTS] = job->refs.suns,
        [BALANCE_PORT_CELLS] = in->sources->lattice.cells,
        [BALANCE_PORT_MOMENTS] = in->field->moments,
        [BALANCE_PORT_SOURCE] = in->sources->lattice.source,
        [BALANCE_PORT_POWER] = in->sources->lattice.sun_power,
        [BALANCE_PORT_LEAKS] = in->field->leaks,
        [BALANCE_PORT_WALL_POWER] = in->field->wall_power,
        [BALANCE_PORT_LAMP_POWER] = in->sources->lattice.lamp_power,
    };
    follow_lights(job, in, &params, refs);
    tyn_graph_add(g, &tyn_pass_balance, &params, refs);
    tyn_job_output(g, job, TYN_OUTPUT_BALANCE, refs[BALANCE_PORT_BALANCE]);
}
