// method.c -- method "pop-paper": principal-ordinates propagation as published in 2014.
//
// The light of each sun, ordinate and lamp, scattered or not, moves from cell to cell of its own aligned grid;
// what all of them send to the eye is merged into one grid, upsampled with the medium as guide and
// marched. Kept as it was published (the readings are settings of propagate_rect): the baseline of
// method "pop".
#include <tyndall/extend/limits.h>
#include <tyndall/extend/method.h>
#include "importance/importance.h"
#include "solve.h"

// Where light counts for the picture (section 5.2 of the paper).
static void add_importance(tyn_graph *g, const tyn_job *job, tyn_sources *s)
{
    tyn_importance_params params;
    tyn_settings_params(job->settings, &tyn_pass_importance, &params);
    if (!params.on || !tyn_is_lit(job->frame->environment.sky) ||
        !(job->outputs & TYN_PICTURE_OUTPUTS)) {
        return;
    }
    params.mode = job->frame->medium.mode;
    params.time = params.smoothing > 0.0f ? (uint32_t)job->view->time_index : 0;
    tyn_ref refs[TYN_MAX_PORTS] = {
        [IMPORTANCE_PORT_CAMERA] = job->refs.camera,
        [IMPORTANCE_PORT_HISTORY] = tyn_graph_history_buffer(
            g, "importance_history", sizeof(struct importance_history), job->view->cut),
    };
    tyn_connect(refs, IMPORTANCE_PORT_MEDIUM, s->medium);
    tyn_graph_add(g, &tyn_pass_importance, &params, refs);
    s->sky.importance = refs[IMPORTANCE_PORT_IMPORTANCE];
}

static tyn_result declare(tyn_graph *g, const tyn_job *job)
{
    const tyn_frame_scene *frame = job->frame;
    tyn_sources s = {0};
    tyn_field field = {.inscatter_is = TYN_INSCATTER_PLAIN};
    tyn_view_inputs view = {.sources = &s, .field = &field};
    if (!tyn_job_refuse_repeat(job)) {
        return TYN_ERR_PARAMS;
    }
    if (frame->empty) {
        tyn_job_warn_surfaces(job, "are left out");
        tyn_add_picture(g, job, &view);
        return tyn_graph_status(g);
    }
    if (frame->emissive) {
        tyn_job_warn(job, "emission is seen, but does not light the medium");
    }
    tyn_job_warn_surfaces(job, "stop light that goes straight alone, not what the medium scatters");
    tyn_add_medium(g, job, &s);
    add_importance(g, job, &s);
    tyn_add_sky(g, job, 0, false, &s);
    tyn_add_vpls(g, job, &s);
    tyn_sources shadowed = s;
    tyn_add_shadows(g, job, &shadowed);
    tyn_solve_propagation(g, job, &shadowed, &field);
    if (field.cell > 0) {
        tyn_limits_warn(job, field.cell);
    }
    tyn_gather(g, job, &view);
    tyn_add_surfaces_apart(g, job, shadowed, &view);
    tyn_add_picture(g, job, &view);
    return tyn_graph_status(g);
}

static const char *const passes[] = {
    TYN_MEDIUM_PASSES(TYN_PASS_NAME),
    TYN_SUN_PASSES(TYN_PASS_NAME),
    TYN_VIRTUAL_LIGHT_PASSES(TYN_PASS_NAME),
    TYN_SKY_PASSES(TYN_PASS_NAME),
    TYN_PROPAGATION_PASSES,
    TYN_LAMP_PASSES(TYN_PASS_NAME),
    TYN_SURFACE_PASSES(TYN_PASS_NAME),
    TYN_PICTURE_PASSES(TYN_PASS_NAME),
    NULL,
};

static double hops(const tyn_regime *r)
{
    return r->scatterings > 0.05 ? 0.2 : 0;
}

static const tyn_limit limits[] = {
    TYN_LIMIT_NOT_PERIODIC("passes/pop_paper/pop-paper.md, \"Measured\""),
    {.key = "propagation as published",
     .where = {TYN_ABOVE(mean_depth, 0)},
     .error = hops,
     .level = TYN_LIMIT_BREAKS,
     .advice = {"propagation as published: light that is moved without being lost adds up (cubes "
                "of depth 0.1 to 10: 28 to 79 %% off); it is here to be compared with"},
     .source = "passes/pop_paper/pop-paper.md, \"Measured\"",
     .warned = {TYN_ABOVE(all_scatterings, 0.05), TYN_ABOVE(cell_transport, 0)},
     .warning = {"accuracy: the published propagation turns light at every hop whether it has "
                 "scattered or not, as if a hop were 2 transport mean free paths; here it is "
                 "%.2g: errors of tens of per cent and more",
                 {TYN_FIGURE(cell_transport)}}},
    {.key = "surfaces",
     .where = {TYN_ABOVE(surfaces, 0)},
     .level = TYN_LIMIT_BREAKS,
     .advice = {"surfaces stop what goes straight alone: light that has turned goes through walls "
                "(fog-hall 39 %% off, vpl-cave 42 %%, room 19 %%, lantern 12 %%)"},
     .source = "passes/pop_paper/pop-paper.md, \"Surfaces\""},
    TYN_LIMIT_FLOATS,
    {NULL},
};

static const tyn_promise promise = {.cube_as_recorded = 0.01, .cube_recorded = 0.0576494};

const tyn_method tyn_method_pop_paper = {
    .info = {.name = "pop-paper",
             .summary = "principal-ordinates propagation as published in 2014, cell by cell",
             .outputs = TYN_PICTURE_OUTPUTS & ~(uint32_t)(TYN_OUTPUT_SINGLE | TYN_OUTPUT_MULTIPLE),
             .limits = limits,
             .promise = &promise},
    .passes = passes,
    .declare = declare,
};
