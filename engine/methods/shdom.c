// shdom.c -- method "shdom": spherical harmonics and discrete ordinates (Evans 1998), to be compared with.
//
// Suns, lamps and principal ordinates of an environment light the cells of a lattice; what scatters is solved for there in a
// few bands of spherical harmonics. The march adds what scatters once of suns and lamps, sharply (docs/shdom.md).
#include "light/sources.h"
#include <tyndall/extend/limits.h>
#include <tyndall/extend/method.h>
#include "solve/shdom.h"
#include "view/view.h"
#include <tyndall/registry.h>

static tyn_result declare(tyn_graph *g, const tyn_job *given)
{
    tyn_job own = *given;
    const tyn_job *job = &own;
    tyn_frame_scene without; // surfaces
    if (!tyn_job_refuse_repeat(job)) {
        return TYN_ERR_PARAMS;
    }
    if (own.frame->num_triangles) {
        tyn_job_warn_surfaces(job, "are left out: they stop no light, and are not seen");
        without = *own.frame;
        without.num_triangles = 0;
        own.frame = &without;
    }
    const tyn_frame_scene *frame = job->frame;
    const bool picture = job->outputs & TYN_PICTURE_OUTPUTS;
    tyn_sources s = {0};
    tyn_field probes = {0}, field = {.inscatter_is = TYN_INSCATTER_PLAIN};
    tyn_view_inputs view = {.sources = &s, .field = &field};
    if (frame->empty && picture) {
        tyn_add_picture(g, job, &view);
        return tyn_graph_status(g);
    }
    if (job->scene->num_shapes == 0) {
        tyn_log_print(job->log, TYN_LOG_ERROR,
                      "the scene has no medium: 'shdom' has nothing to probe; 'path' can");
        return TYN_ERR_PARAMS;
    }
    tyn_add_medium(g, job, &s);
    tyn_add_sky(g, job, 0, false, &s);
    tyn_add_radials(g, job, &s);
    tyn_sources marched = s;
    if (picture) {
        tyn_add_beams(g, job, &marched);
    }
    if (s.sky.ordinates.resource || s.lamps.num_lamps || frame->emissive ||
        (job->outputs & TYN_OUTPUT_PROBE)) {
        tyn_shdom_params params;
        tyn_settings_params(job->settings, &tyn_pass_shdom, &params);
        tyn_add_cells(g, job, params.shape.cells, "shdom.cells", &s);
        tyn_limits_warn(job, s.lattice.side);
        tyn_solve_shdom(g, job, &s, marched.num_suns, &probes, &field);
    }
    if (job->outputs & TYN_OUTPUT_PROBE) {
        const tyn_view_inputs points = {.sources = &s, .field = &probes};
        tyn_add_probe(g, job, &points);
    }
    if (picture) {
        view.sources = &marched;
        view.num_marched_lamps = marched.lamps.num_lamps;
        tyn_gather(g, job, &view);
        tyn_add_picture(g, job, &view);
    }
    return tyn_graph_status(g);
}

static const tyn_pass_desc *const passes[] = {
    TYN_MEDIUM_PASSES(TYN_PASS_ADDRESS),
    TYN_SUN_PASSES(TYN_PASS_ADDRESS),
    TYN_SKY_PASSES(TYN_PASS_ADDRESS),
    TYN_LAMP_PASSES(TYN_PASS_ADDRESS),
    TYN_CELL_PASSES(TYN_PASS_ADDRESS),
    TYN_SHDOM_PASSES,
    TYN_PICTURE_PASSES(TYN_PASS_ADDRESS),
    &tyn_pass_probe,
    NULL,
};

static const tyn_limit limits[] = {
    TYN_LIMIT_NOT_PERIODIC("docs/shdom.md, \"Limits\""),
    {.key = "surfaces",
     .where = {TYN_ABOVE(surfaces, 0)},
     .level = TYN_LIMIT_BREAKS,
     .advice = {"surfaces are left out: they stop no light, reflect none and are not seen"},
     .source = "docs/shdom.md, \"Limits\""},
    TYN_LIMIT_FLOATS,
    {NULL},
};

const tyn_method tyn_method_shdom = {
    .info = {.name = "shdom",
             .summary = "spherical harmonics and discrete ordinates (1998), to be compared with",
             .passes = passes,
             .outputs = TYN_OUTPUT_PROBE | (TYN_PICTURE_OUTPUTS &
                                            ~(uint32_t)(TYN_OUTPUT_SINGLE | TYN_OUTPUT_MULTIPLE)),
             .limits = limits},
    .declare = declare,
};
