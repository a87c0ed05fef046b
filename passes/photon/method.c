// method.c -- method "photon": temporally coherent photon mapping (Elek, Ritschel, Wilkie and Seidel 2012).
//
// Photons of all lights are traced through the medium, a generation in each frame; a coarse cache holds the light of the last
// ones, as lobes about its net flux. It is upsampled with the medium as guide, and marched, with what suns and lamps have
// scattered forward alone along their beams (passes/photon/photon.md).
#include <tyndall/extend/limits.h>
#include <tyndall/extend/method.h>
#include "solve.h"
#include <math.h>
#include <string.h>

static const uint32_t field_outputs = TYN_OUTPUT_PROBE | TYN_OUTPUT_LIGHT;

static void warn_of_light(const tyn_job *job)
{
    if (job->frame->emissive) {
        tyn_job_warn(job, "emission is seen, but does not light the medium");
    }
    if (job->frame->num_triangles && !tyn_can_trace(job)) {
        tyn_job_warn(job, "the surfaces have no hierarchy: tracing photons among them is slow");
    }
}

static bool has_light(const tyn_frame_scene *frame)
{
    return frame->lights.num_directional || frame->lights.num_lamps || frame->emitters > 0 ||
           tyn_is_lit(frame->environment.mean);
}

// Suns and lamps whose first scattering the march follows along the camera's rays; and what of all light only scatters forward.
// Of surfaces that reach far beyond the cells virtual lights, for surfaces alone.
static void add_marched(tyn_graph *g, const tyn_job *job, tyn_sources *s, tyn_view_inputs *view)
{
    tyn_add_beams(g, job, s);
    if (job->frame->num_triangles && job->outputs & TYN_PICTURE_OUTPUTS &&
        tyn_surfaces_beyond(job)) {
        tyn_add_vpls(g, job, s);
    }
    tyn_add_radials(g, job, s);
    s->lamps.vpls = false; // their light is in the cells
    tyn_add_shadows(g, job, s);
    view->sources = s;
    view->num_marched_lamps = s->lamps.num_lamps;
    if (job->outputs & TYN_PICTURE_OUTPUTS) {
        view->mean_in_field = tyn_is_lit(job->frame->environment.sky);
        tyn_add_forward_tables(g, job, view);
        tyn_add_glow(g, job, view);
    }
}

// Surfaces have what suns and lamps bring straight, and, if the cells hold all other light, that of the cells in front of them;
// far beyond the cells that of virtual lights instead.
static void add_surfaces(tyn_graph *g, const tyn_job *job, tyn_sources s, const tyn_walls *walls,
                         bool first_in_beams, tyn_view_inputs *view)
{
    if (!first_in_beams || !view->field->moments.resource) {
        tyn_add_surfaces_apart(g, job, s, view);
        return;
    }
    tyn_job_warn_suns(job, "surfaces");
    const tyn_field no_field = {0};
    const bool beyond = tyn_surfaces_beyond(job);
    if (beyond && tyn_is_lit(job->frame->environment.sky)) {
        tyn_job_warn(job,
                     "the environment does not light surfaces that reach far beyond the media");
    }
    if (beyond) {
        s.lamps.vpls = s.surface_light.vpls.vpls.resource != 0;
    } else {
        s.walls = *walls; // tell which cells are in front
    }
    tyn_view_inputs surfaces = {
        .sources = &s, .field = beyond ? &no_field : view->field, .no_sky_on_surfaces = true};
    tyn_add_surfaces(g, job, &surfaces);
    view->surface = surfaces.surface;
    view->seen = surfaces.seen;
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
    tyn_photon_trace_params trace;
    tyn_settings_params(job->settings, &tyn_pass_photon_trace, &trace);
    // Of suns and lamps it is not in the cells, where they have beams.
    const bool straight = trace.first == TYN_PHOTON_FIRST_CACHE || frame->emitters > 0 ||
                          tyn_is_lit(frame->environment.sky) ||
                          frame->lights.num_suns > tyn_num_beams(&frame->lights);
    if (job->outputs & TYN_OUTPUT_PROBE && job->view->scattered_only && straight) {
        return TYN_FAULT(
            job->log, TYN_ERR_PARAMS,
            "'photon' keeps light of the sky and of surfaces that has not scattered with "
            "all other (and "
            "that of suns and lamps with photon_trace.first=cache): probes cannot leave "
            "it out; 'pop' and 'path' can");
    }
    if (job->outputs & TYN_OUTPUT_LIGHT && !job->light->unscattered && straight) {
        tyn_job_warn(job, "the light field holds light that has not scattered, too ('photon')");
    }
    warn_of_light(job);
    if (job->scene->num_shapes == 0 && job->outputs & field_outputs) {
        return TYN_FAULT(job->log, TYN_ERR_PARAMS,
                         "the scene has no medium: 'photon' has nothing to probe; 'path' can");
    }
    tyn_sources marched = {0}; // with the light that is not in the cells
    if (!frame->empty || job->outputs & field_outputs) {
        tyn_add_medium(g, job, &s);
        marched = s;
        if (frame->environment
                .has_map) { // its regions' directions, and what it is without its suns
            tyn_add_sky(g, job, frame->lights.num_suns, true, &marched);
        }
        if (trace.first == TYN_PHOTON_FIRST_BEAMS) {
            add_marched(g, job, &marched, &view);
        }
        if (has_light(frame) || job->outputs & field_outputs) {
            tyn_add_cells(g, job, trace.shape.cells, "photon_trace.cells", &s);
            tyn_limits_warn(job, s.lattice.side);
            tyn_solve_photon(g, job, &s, &marched, &field);
            marched.lattice = s.lattice;
        }
    }
    // Photons know the surfaces themselves: there are no walls.
    marched.sky.count = 0;
    view.sources = &marched;
    if (job->outputs & TYN_OUTPUT_PROBE) {
        tyn_add_probe(g, job, &view);
    }
    if (job->outputs & TYN_OUTPUT_LIGHT) {
        tyn_add_light_field(g, job, &view);
    }
    if (picture) {
        tyn_gather(g, job, &view);
        if (!marched.shadows.shadow_atlas.resource) {
            tyn_add_shadows(g, job, &marched);
        }
        add_surfaces(g, job, marched, &s.walls, trace.first == TYN_PHOTON_FIRST_BEAMS, &view);
        tyn_add_picture(g, job, &view);
    }
    return tyn_graph_status(g);
}

static const char *const passes[] = {
    TYN_MEDIUM_PASSES(TYN_PASS_NAME),
    TYN_SUN_PASSES(TYN_PASS_NAME),
    TYN_LAMP_PASSES(TYN_PASS_NAME),
    TYN_VIRTUAL_LIGHT_PASSES(TYN_PASS_NAME),
    TYN_SKY_PASSES(TYN_PASS_NAME),
    TYN_CELL_PASSES(TYN_PASS_NAME),
    TYN_PHOTON_PASSES,
    TYN_GATHER_PASSES(TYN_PASS_NAME),
    TYN_SURFACE_PASSES(TYN_PASS_NAME),
    TYN_PICTURE_PASSES(TYN_PASS_NAME),
    "light_points",
    "probe",
    "light_field",
    NULL,
};

// Of cubes of depth 4 and 16 in the sun.
static double lobe(const tyn_regime *r)
{
    static const tyn_limit_point curve[] = {{1.05, 0.02}, {2, 0.03}, {10, 0.15}};
    const double narrow = 1 / (1 - fmin(fmax(r->most_g, 0), 0.9999));
    return tyn_limit_along(curve, sizeof curve / sizeof *curve, narrow) *
           fmin(1.4, sqrt(fmax(r->mean_depth, 0) / 4));
}

static double backward(const tyn_regime *r)
{
    static const tyn_limit_point curve[] = {{1.05, 0.02}, {2, 0.05}, {10, 0.4}, {100, 6.6}};
    const double narrow = 1 / (1 - fmin(fmax(-r->least_g, 0), 0.99));
    return tyn_limit_along(curve, sizeof curve / sizeof *curve, narrow) *
           fmin(1, sqrt(fmax(r->mean_depth, 0) / 4));
}

// The cloud with 28, 16 and 8 cells; half-spaces of the stress suite.
static double thick(const tyn_regime *r)
{
    static const tyn_limit_point curve[] = {
        {0.25, 0.02}, {1.1, 0.07}, {1.9, 0.1}, {3.8, 0.17}, {600, 1}};
    return r->scatterings > 0.05
               ? tyn_limit_along(curve, sizeof curve / sizeof *curve, r->cell_depth)
               : 0;
}

#define MEASURED "passes/photon/photon.md, \"Measured\""

static const tyn_limit limits[] = {
    TYN_LIMIT_NOT_PERIODIC("passes/photon/photon.md, \"Limits\""),
    {.key = "lobes",
     .where = {TYN_ABOVE(most_g, 0.05), TYN_ABOVE(mean_depth, 0)},
     .error = lobe,
     .level = TYN_LIMIT_STRAINED,
     .advice = {"forward lobe: what has left it is held as a lobe about its net flux: about %g %% "
                "off (cubes of depth 4: 3 %% at g 0.5, 15 %% at 0.9)",
                {TYN_LIMIT_ERROR}},
     .source = MEASURED,
     .warned = {TYN_ABOVE(most_g, 0.8), TYN_ABOVE(mean_depth, 0.7)},
     .warning =
         {"accuracy: g is %.3g; light that has left the forward lobe is held as a lobe about "
          "its net flux: 3 %% off at 0.5, 15 %% at 0.9",
          {TYN_FIGURE(most_g)}}},
    {.key = "lobes",
     .where = {TYN_BELOW(least_g, -0.05), TYN_ABOVE(mean_depth, 0)},
     .error = backward,
     .level = TYN_LIMIT_BREAKS,
     .advice =
         {"backward peak: one lobe does not hold light that goes to and fro (cubes of depth 4 "
          "and 16: 2 to 5 %% off at g -0.5, 40 %% at -0.9, a factor of 7 at -0.99)"},
     .source = MEASURED,
     .warned = {TYN_BELOW(least_g, -0.5), TYN_ABOVE(mean_depth, 0.3)},
     .warning = {"accuracy: g is %.3g; one lobe does not hold light that goes to and fro: 5 %% off "
                 "at -0.5, 40 %% at -0.9, a factor of 7 at -0.99",
                 {TYN_FIGURE(least_g)}}},
    {.key = "thick cells",
     .where = {TYN_ABOVE(cell_depth, 0.25), TYN_ABOVE(scatterings, 0.05)},
     .error = thick,
     .level = TYN_LIMIT_STRAINED,
     .advice = {"cells: %.2g mean free paths (delta scaled) across a dense one: about %g %% off "
                "(-D photon_trace.cells)",
                {TYN_FIGURE(cell_depth), TYN_LIMIT_ERROR}},
     .source = MEASURED,
     .warned = {TYN_ABOVE(cell_depth, 1.9)},
     .warning = {"accuracy: where the medium is dense a cell of the cache is %.3g mean free paths "
                 "(delta scaled) wide: 10 %% off at 1.9, 17 %% at 3.8, 99 %% at 600 "
                 "(-D photon_trace.cells)",
                 {TYN_FIGURE(cell_depth)}}},
    {.key = "surfaces",
     .where = {TYN_ABOVE(surfaces, 0)},
     .level = TYN_LIMIT_STRAINED,
     .advice =
         {"surfaces have the light of the cells in front of them (10 generations: room 8 %% off, "
          "fog-hall 11 %%, vpl-cave 20 %%)"},
     .source = "passes/photon/photon.md, \"Limits\""},
    TYN_LIMIT_FLOATS,
    {NULL},
};

static const tyn_promise promise = {.cube_as_recorded = 0.01, .cube_recorded = 0.06386};

const tyn_method tyn_method_photon = {
    .info = {.name = "photon",
             .summary = "photons in a coarse cache that is renewed from frame to frame",
             .outputs =
                 (TYN_PICTURE_OUTPUTS & ~(uint32_t)(TYN_OUTPUT_SINGLE | TYN_OUTPUT_MULTIPLE)) |
                 TYN_OUTPUT_PROBE | TYN_OUTPUT_LIGHT,
             .traces_rays = true,
             .limits = limits,
             .promise = &promise},
    .reads_env_cdf = true,
    .passes = passes,
    .declare = declare,
};
