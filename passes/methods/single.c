// single.c -- method "single": light that has scattered exactly once, and emission.
#include <tyndall/extend/limits.h>
#include <tyndall/extend/method.h>
#include "passes/methods/view/view.h"
#include <tyndall/registry.h>
#include <string.h>

// Of the suns those of the scene alone: none of the environment's map.
static void leave_out_map_suns(tyn_job *job, tyn_frame_scene *frame)
{
    *frame = *job->frame;
    memcpy(frame->lights.suns, frame->lights.scene, sizeof frame->lights.suns);
    frame->lights.num_suns = frame->lights.num_directional;
    job->frame = frame;
    job->refs.suns = job->refs.lights;
}

static tyn_result declare(tyn_graph *g, const tyn_job *given)
{
    tyn_job own = *given;
    const tyn_job *job = &own;
    tyn_frame_scene frame;
    if (own.frame->lights.num_suns > own.frame->lights.num_directional) {
        leave_out_map_suns(&own, &frame);
    }
    tyn_sources s = {0};
    const tyn_field no_field = {0};
    tyn_view_inputs view = {.sources = &s, .field = &no_field};
    if (!tyn_job_refuse_repeat(job)) {
        return TYN_ERR_PARAMS;
    }
    tyn_job_warn_surfaces(job, "cast shadows, but are not seen");
    if (job->frame->empty) {
        tyn_add_picture(g, job, &view);
        return tyn_graph_status(g);
    }
    const float *mean = job->frame->environment.mean;
    if (mean[0] + mean[1] + mean[2] > 0.0f) {
        tyn_job_warn(job, "the environment is seen, but does not light the medium");
    }
    if (job->frame->emissive) {
        tyn_job_warn(job, "emission is seen, but does not light the medium");
    }
    tyn_job_warn_suns(job, "the medium");
    tyn_add_medium(g, job, &s);
    tyn_add_beams(g, job, &s);
    tyn_add_shadows(g, job, &s);
    tyn_add_radials(g, job, &s);
    view.num_marched_lamps = s.lamps.num_lamps;
    tyn_add_picture(g, job, &view);
    return tyn_graph_status(g);
}

static const char *const passes[] = {
    TYN_MEDIUM_PASSES(TYN_PASS_NAME),
    TYN_SUN_PASSES(TYN_PASS_NAME),
    TYN_LAMP_PASSES(TYN_PASS_NAME),
    TYN_PICTURE_PASSES(TYN_PASS_NAME),
    NULL,
};

static const tyn_limit limits[] = {
    TYN_LIMIT_NOT_PERIODIC("docs/method.md"),
    TYN_LIMIT_ONE_SCATTERING("docs/choosing.md, \"Single scattering\""),
    {.key = "a narrow forward lobe", // HG_MAX of shaders/phase/hg.glsl
     .where = {TYN_ABOVE(most_g, 0.995)},
     .warning = {"accuracy: g is %.6g; beyond 0.995 the medium counts as one of 0.995 that "
                 "scatters less, so that what is scattered by hardly any angle is not lost",
                 {TYN_FIGURE(most_g)}},
     .source = "docs/stress.md, \"What is found\""},
    {.key = "surfaces",
     .where = {TYN_ABOVE(surfaces, 0)},
     .level = TYN_LIMIT_BREAKS,
     .advice = {"surfaces: their shadows alone are drawn"},
     .source = "docs/method.md, \"single\""},
    TYN_LIMIT_FLOATS,
    {NULL},
};

static const tyn_promise promise = {.cube_once = 0.01, .airlight = 0.01};

const tyn_method tyn_method_single = {
    .info = {.name = "single",
             .summary = "light that has scattered exactly once",
             .outputs = TYN_PICTURE_OUTPUTS & ~(uint32_t)TYN_GUIDE_OUTPUTS,
             .single_only = true,
             .phases = TYN_PHASES_ONE,
             .limits = limits,
             .promise = &promise},
    .passes = passes,
    .declare = declare,
};
