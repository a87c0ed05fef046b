// lpv.c -- method "lpv": light propagation volumes with a medium (Billeter, Sintorn and Assarsson 2012).
//
// Light that has not scattered is marched sharply, as in "single". What it scatters, and what surfaces reflect of it, starts
// in the cells of a lattice and moves on from cell to cell, in a fixed number of iterations (docs/lpv.md). An environment shines along
// principal ordinates; among surfaces its mean enters the lattice from all sides.
#include "light/sources.h"
#include "methods/limits.h"
#include "methods/method.h"
#include "solve/lpv.h"
#include "view/view.h"
#include <tyndall/registry.h>

static const uint32_t field_outputs = TYN_OUTPUT_PROBE | TYN_OUTPUT_BALANCE;

static bool is_lit(const float radiance[3])
{
    return radiance[0] > 0.0f || radiance[1] > 0.0f || radiance[2] > 0.0f;
}

static bool any_emits(const tyn_surfaces *s)
{
    bool emits = false;
    for (uint32_t i = 0; i < s->num_triangles; i++) {
        emits = emits || is_lit(s->materials[s->triangles[i].material].emission);
    }
    return emits;
}

static void warn_of_surfaces(const tyn_job *job)
{
    if (job->frame->num_triangles) {
        tyn_job_warn_suns(job, "surfaces");
    }
    if (any_emits(&job->scene->surfaces)) {
        tyn_job_warn(job, "surfaces that emit are seen, but light nothing ('lpv')");
    }
}

static void add_lights(tyn_graph *g, const tyn_job *job, tyn_sources *s)
{
    const tyn_frame_scene *frame = job->frame;
    tyn_add_beams(g, job, s);
    tyn_add_radials(g, job, s);
    tyn_add_shadows(g, job, s);
    if (!tyn_has_walls(frame)) {
        tyn_add_sky(g, job, s->num_suns, false, s);
    } else if (frame->environment.has_map) {
        tyn_job_warn(
            job,
            "among surfaces the medium is lit by the mean of the environment map and by its suns");
    }
    s->mean_from_all_sides =
        is_lit(frame->environment.sky) && (s->sky.split || !s->sky.ordinates.resource);
}

static bool has_light(const tyn_job *job, const tyn_sources *s)
{
    return s->num_suns || s->lamps.radials.radials.resource || s->mean_from_all_sides ||
           s->sky.ordinates.resource || job->frame->emissive;
}

static tyn_result declare(tyn_graph *g, const tyn_job *job)
{
    const tyn_frame_scene *frame = job->frame;
    const bool picture = job->outputs & TYN_PICTURE_OUTPUTS;
    tyn_sources s = {0};
    tyn_field field = {0};
    tyn_view_inputs view = {.sources = &s, .field = &field};
    if (!tyn_job_refuse_repeat(job)) {
        return TYN_ERR_PARAMS;
    }
    warn_of_surfaces(job);
    if (frame->empty && !(job->outputs & field_outputs)) {
        tyn_add_shadows(g, job, &s);
        tyn_add_surfaces(g, job, &view);
        tyn_add_picture(g, job, &view);
        return tyn_graph_status(g);
    }
    if (job->scene->num_shapes == 0) {
        tyn_log_print(
            job->log, TYN_LOG_ERROR,
            "the scene has no medium: 'lpv' has nothing to probe or to balance; 'path' can");
        return TYN_ERR_PARAMS;
    }
    tyn_add_medium(g, job, &s);
    add_lights(g, job, &s);
    const bool solve = has_light(job, &s);
    view.mean_in_field = is_lit(frame->environment.sky);
    view.num_marched_lamps = solve ? s.lamps.num_fine : s.lamps.num_lamps;
    if (picture) {
        tyn_add_forward_tables(g, job, &view);
        tyn_add_glow(g, job, &view);
    }
    if (solve || job->outputs & field_outputs) {
        tyn_lpv_params lpv;
        tyn_settings_params(job->settings, &tyn_pass_lpv, &lpv);
        tyn_add_cells(g, job, lpv.shape.cells, "lpv.cells", &s);
        tyn_limits_warn(job, s.lattice.side);
        tyn_solve_lpv(g, job, &s, &field);
    }
    if (picture) {
        tyn_gather(g, job, &view);
    }
    if (job->outputs & TYN_OUTPUT_PROBE) {
        tyn_add_probe(g, job, &view);
    }
    if (job->outputs & TYN_OUTPUT_BALANCE) {
        tyn_add_balance(g, job, &view);
    }
    if (picture) {
        tyn_add_surfaces(g, job, &view);
        tyn_add_picture(g, job, &view);
    }
    return tyn_graph_status(g);
}

static const tyn_pass_desc *const passes[] = {
    TYN_MEDIUM_PASSES,  TYN_SUN_PASSES,     TYN_SKY_PASSES,   TYN_LAMP_PASSES,
    TYN_CELL_PASSES,    &tyn_pass_rsm,      TYN_LPV_PASSES,   TYN_GATHER_PASSES,
    TYN_SURFACE_PASSES, TYN_PICTURE_PASSES, TYN_FIELD_PASSES, NULL,
};

static const tyn_limit limits[] = {
    {.key = "periodic media",
     .where = {TYN_ABOVE(repeats, 0)},
     .level = TYN_LIMIT_REFUSED,
     .advice = {"media that repeat: refused"},
     .source = "docs/lpv.md, \"Limits\""},
    TYN_LIMIT_FLOATS,
    {NULL},
};

const tyn_method tyn_method_lpv = {
    .info = {.name = "lpv",
             .summary = "light propagation volumes: scattered light moves on from cell to cell",
             .passes = passes,
             .outputs = TYN_PICTURE_OUTPUTS | TYN_OUTPUT_PROBE | TYN_OUTPUT_BALANCE,
             .limits = limits},
    .declare = declare,
};
