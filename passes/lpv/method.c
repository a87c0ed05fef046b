// method.c -- method "lpv": light propagation volumes with a medium (Billeter, Sintorn and Assarsson 2012).
//
// Light that has not scattered is marched sharply, as in "single". What it scatters, and what surfaces reflect of it, starts
// in the cells of a lattice and moves on from cell to cell, in a fixed number of iterations (lpv.md). An environment shines along
// principal ordinates; among surfaces its mean enters the lattice from all sides.
#include <tyndall/extend/limits.h>
#include <tyndall/extend/method.h>
#include "solve.h"

static const uint32_t field_outputs = TYN_OUTPUT_PROBE | TYN_OUTPUT_LIGHT | TYN_OUTPUT_BALANCE;

static void warn_of_surfaces(const tyn_job *job)
{
    if (job->frame->num_triangles) {
        tyn_job_warn_suns(job, "surfaces");
    }
    if (tyn_surfaces_emit(&job->scene->surfaces)) {
        tyn_job_warn(job, "surfaces that emit are seen, but light nothing ('lpv')");
    }
}

static void add_lights(tyn_graph *g, const tyn_job *job, tyn_sources *s)
{
    tyn_add_beams(g, job, s);
    tyn_add_radials(g, job, s);
    tyn_add_shadows(g, job, s);
    tyn_add_surroundings(g, job, false, s);
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
        return TYN_FAULT(
            job->log, TYN_ERR_PARAMS,
            "the scene has no medium: 'lpv' has nothing to probe or to balance; 'path' can");
    }
    tyn_add_medium(g, job, &s);
    add_lights(g, job, &s);
    const bool solve = has_light(job, &s);
    view.mean_in_field = tyn_is_lit(frame->environment.sky);
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
    tyn_add_views(g, job, &view);
    return tyn_graph_status(g);
}

static const char *const passes[] = {
    TYN_MEDIUM_PASSES(TYN_PASS_NAME),
    TYN_SUN_PASSES(TYN_PASS_NAME),
    TYN_SKY_PASSES(TYN_PASS_NAME),
    TYN_LAMP_PASSES(TYN_PASS_NAME),
    TYN_CELL_PASSES(TYN_PASS_NAME),
    "rsm",
    TYN_LPV_PASSES,
    TYN_GATHER_PASSES(TYN_PASS_NAME),
    TYN_SURFACE_PASSES(TYN_PASS_NAME),
    TYN_PICTURE_PASSES(TYN_PASS_NAME),
    TYN_FIELD_PASSES(TYN_PASS_NAME),
    NULL,
};

// As published, with 8 iterations at 32 cells, of the cube in one sun at g 0.
static double few_iterations(const tyn_regime *r)
{
    static const tyn_limit_point curve[] = {
        {0.1, 0.02}, {0.3, 0.054}, {1, 0.16}, {4, 0.41}, {64, 0.67}};
    return tyn_limit_along(curve, sizeof curve / sizeof *curve, r->mean_depth);
}

static double thick(const tyn_regime *r)
{
    static const tyn_limit_point curve[] = {{0.3, 0.085}, {0.7, 0.2}, {2, 0.6}};
    return r->scatterings > 0.05
               ? tyn_limit_along(curve, sizeof curve / sizeof *curve, r->cell_depth)
               : 0;
}

static double lobe(const tyn_regime *r)
{
    static const tyn_limit_point curve[] = {{2, 0.12}, {10, 0.36}};
    const double narrow = 1 / (1 - fmin(fmax(r->most_g, -r->least_g), 0.9));
    return tyn_limit_along(curve, 2, narrow) * fmin(1, r->mean_depth);
}

// A model on floors of 10, 40 and 200 m under an overcast sky: 28 to 30 %. In media 12 to 14 % in the sample scenes.
static double sky(const tyn_regime *r)
{
    return 0.3 * fmin(1, r->sky_on_surfaces);
}

#define CUBES "passes/lpv/lpv.md, \"Cubes\""

static const tyn_limit limits[] = {
    TYN_LIMIT_NOT_PERIODIC("passes/lpv/lpv.md, \"Limits\""),
    {.key = "few iterations",
     .where = {TYN_ABOVE(mean_depth, 0.1), TYN_ABOVE(all_scatterings, 0.05)},
     .error = few_iterations,
     .level = TYN_LIMIT_BREAKS,
     .advice = {"iterations: light moves on by 8 cells, as published, and what lies farther is "
                "dark (about %g %% off); -D lpv.iterations=128 -D lpv.bounces=all gives 2 to 9 %% "
                "up to depth 10",
                {TYN_LIMIT_ERROR}},
     .source = CUBES},
    {.key = "thick cells",
     .where = {TYN_ABOVE(cell_depth, 0.3), TYN_ABOVE(scatterings, 0.05)},
     .error = thick,
     .level = TYN_LIMIT_STRAINED,
     .advice = {"cells: %.2g mean free paths (delta scaled) across a dense one; light leaves each "
                "in every iteration, however thick it is (about %g %% off)",
                {TYN_FIGURE(cell_depth), TYN_LIMIT_ERROR}},
     .source = CUBES,
     .warned = {TYN_ABOVE(cell_depth, 0.706)},
     .warning = {"accuracy: where the medium is dense a cell is %.3g mean free paths (delta "
                 "scaled) wide: from 0.7 on the published extinction is bounded, and light moves "
                 "on too fast (-D lpv.cells)",
                 {TYN_FIGURE(cell_depth)}}},
    {.key = "a narrow lobe",
     .where = {TYN_ABOVE(most_g, 0.4999), TYN_ABOVE(mean_depth, 0)},
     .error = lobe,
     .level = TYN_LIMIT_STRAINED,
     .advice = {"forward lobe: two bands do not hold it (a cube of depth 4, 128 iterations: 12 %% "
                "off at g 0.5, 36 %% at 0.9)"},
     .source = CUBES},
    {.key = "a narrow lobe",
     .where = {TYN_BELOW(least_g, -0.4999), TYN_ABOVE(mean_depth, 0)},
     .error = lobe,
     .level = TYN_LIMIT_STRAINED,
     .advice = {"backward peak: two bands do not hold it (a cube of depth 4, 128 iterations: 9 %% "
                "off at g -0.5, 66 %% at -0.9)"},
     .source = CUBES,
     .warned = {TYN_BELOW(least_g, -0.75)},
     .warning = {"accuracy: g is %.3g; two bands of spherical harmonics do not hold a backward "
                 "peak: 9 %% off at -0.5, 66 %% at -0.9",
                 {TYN_FIGURE(least_g)}}},
    {.key = "surfaces",
     .where = {TYN_ABOVE(surfaces, 0)},
     .level = TYN_LIMIT_STRAINED,
     .advice = {"surfaces: one reflection, as published (fog-hall 22 %% off, room 56 %%); with "
                "-D lpv.bounces=all and 128 iterations 9 and 6 %%; those beyond the medium's box "
                "reflect nothing"},
     .source = "passes/lpv/lpv.md, \"Scenes\""},
    {.key = "the sky among surfaces",
     .where = {TYN_ABOVE(sky_on_surfaces, 0.05)},
     .error = sky,
     .level = TYN_LIMIT_BREAKS,
     .advice = {"sky among surfaces: it lights the medium by its mean and suns alone, and no "
                "surface lights another with it (about %g %% off)",
                {TYN_LIMIT_ERROR}},
     .source = "passes/lpv/lpv.md, \"Limits\""},
    TYN_LIMIT_FLOATS,
    {NULL},
};

static const tyn_promise promise = {.cube_as_recorded = 0.01, .cube_recorded = 0.0372323};

const tyn_method tyn_method_lpv = {
    .info = {.name = "lpv",
             .summary = "light propagation volumes: scattered light moves on from cell to cell",
             .outputs =
                 TYN_PICTURE_OUTPUTS | TYN_OUTPUT_PROBE | TYN_OUTPUT_LIGHT | TYN_OUTPUT_BALANCE,
             .phases = TYN_PHASES_ONE,
             .limits = limits,
             .promise = &promise},
    .passes = passes,
    .declare = declare,
};
