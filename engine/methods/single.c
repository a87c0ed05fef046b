// single.c -- method "single": light that has scattered exactly once, and emission.
#include "methods/lamps.h"
#include "methods/limits.h"
#include "passes/medium/medium.h"
#include "passes/beam/beam.h"
#include "passes/radial_beam/radial_beam.h"
#include "passes/composite/composite.h"
#include "passes/light_cells/light_cells.h"
#include "passes/shadow_map/shadow_map.h"
#include "passes/tonemap/tonemap.h"
#include <tyndall/registry.h>
#include <string.h>

// Of the suns those of the scene alone: none of the environment's map.
static void leave_out_map_suns(tyn_job *job, tyn_frame_scene *frame)
{
    *frame = *job->frame;
    memcpy(frame->suns, frame->lights, sizeof frame->suns);
    frame->num_map_suns = 0;
    job->frame = frame;
    job->refs.suns = job->refs.lights;
}

static tyn_result declare(tyn_graph *g, const tyn_job *given)
{
    tyn_job own = *given;
    const tyn_job *job = &own;
    tyn_frame_scene frame;
    if (own.frame->num_map_suns) {
        leave_out_map_suns(&own, &frame);
    }
    tyn_result result = tyn_method_refuse_repeat(job, "single");
    if (result != TYN_OK) {
        return result;
    }
    tyn_method_warn_surfaces(job, "cast shadows, but are not seen");
    if (job->frame->empty) {
        return tyn_add_picture(g, job, NULL);
    }
    if (job->frame->environment.mean[0] + job->frame->environment.mean[1] +
            job->frame->environment.mean[2] >
        0.0f) {
        tyn_method_warn(job, "the environment is seen, but does not light the medium");
    }
    tyn_limits_single(job);
    tyn_limits_rays(job);
    tyn_picture_inputs in = {.num_suns = tyn_method_suns(job)};
    tyn_method_warn_suns(job, "the medium");
    result = tyn_add_medium(g, job, &in.media);
    if (result == TYN_OK) {
        result = tyn_add_beams(g, job, &in.media.medium, in.num_suns, &in.beams);
    }
    if (result == TYN_OK) {
        result = tyn_add_shadows(g, job, in.num_suns, &in.shadows, &in.light_cells);
    }
    if (result == TYN_OK) {
        result = tyn_add_radials(g, job, &in.media.medium, (tyn_ref){0}, &in.lamps);
        in.num_marched_lamps = in.lamps.num_lamps;
    }
    return result == TYN_OK ? tyn_add_picture(g, job, &in) : result;
}

static const tyn_pass_desc *const passes[] = {
    &tyn_pass_medium,      &tyn_pass_beam,        &tyn_pass_shadow_map,
    &tyn_pass_light_cells, &tyn_pass_radial_beam, &tyn_pass_raymarch,
    &tyn_pass_composite,   &tyn_pass_tonemap,     NULL,
};

const tyn_method tyn_method_single = {
    .name = "single",
    .summary = "light that has scattered exactly once",
    .passes = passes,
    .outputs = TYN_PICTURE_OUTPUTS,
    .declare = declare,
};
