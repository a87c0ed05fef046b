// method.c -- method "shdom": spherical harmonics and discrete ordinates (Evans 1998), to be compared with.
//
// Suns, lamps and principal ordinates of an environment light the cells of a lattice; what scatters is solved for there in a
// few bands of spherical harmonics. The march adds what scatters once of suns and lamps, sharply (passes/shdom/shdom.md).
#include <tyndall/extend/limits.h>
#include <tyndall/extend/method.h>
#include "solve.h"

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
        return TYN_FAULT(job->log, TYN_ERR_PARAMS,
                         "the scene has no medium: 'shdom' has nothing to probe; 'path' can");
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

static const char *const passes[] = {
    TYN_MEDIUM_PASSES(TYN_PASS_NAME),
    TYN_SUN_PASSES(TYN_PASS_NAME),
    TYN_SKY_PASSES(TYN_PASS_NAME),
    TYN_LAMP_PASSES(TYN_PASS_NAME),
    TYN_CELL_PASSES(TYN_PASS_NAME),
    TYN_SHDOM_PASSES,
    TYN_PICTURE_PASSES(TYN_PASS_NAME),
    "probe",
    NULL,
};

// Half-spaces and cubes of the stress suite, 5 bands.
static double thick(const tyn_regime *r)
{
    static const tyn_limit_point curve[] = {{0.15, 0.02}, {1, 0.15}, {3, 0.5}, {100, 0.85}};
    return r->scatterings > 0.05
               ? tyn_limit_along(curve, sizeof curve / sizeof *curve, r->cell_depth)
               : 0;
}

static double forward(const tyn_regime *r)
{
    static const tyn_limit_point curve[] = {{10, 0.04}, {100, 0.18}, {10000, 1}};
    return tyn_limit_along(curve, 3, 1 / fmax(1 - r->most_g, 1e-4)) * fmin(1, r->mean_depth);
}

static double backward(const tyn_regime *r)
{
    static const tyn_limit_point curve[] = {{2, 0.02}, {100, 0.67}};
    return tyn_limit_along(curve, 2, 1 / fmax(1 + r->least_g, 1e-4)) * fmin(1, r->mean_depth);
}

static double flat(const tyn_regime *r)
{
    return r->scatterings > 0.05 ? 0.2 : 0;
}

#define STRESS "passes/shdom/shdom.md, \"Limits\""

static double without_surfaces(const tyn_regime *r)
{
    return r->surfaces;
}

static const tyn_limit limits[] = {
    TYN_LIMIT_NOT_PERIODIC(STRESS),
    {.key = "thick cells",
     .where = {TYN_ABOVE(cell_depth, 0.15), TYN_ABOVE(scatterings, 0.05)},
     .error = thick,
     .advice = {"cells: %.2g mean free paths (delta scaled) across a dense one (about %g %% off): "
                "-D shdom.cells",
                {TYN_FIGURE(cell_depth), TYN_LIMIT_ERROR}},
     .source = STRESS,
     .warned = {TYN_ABOVE(cell_depth, 0.5)},
     .warning = {"accuracy: where the medium is dense a cell is %.3g mean free paths (delta "
                 "scaled) wide; ordinates are followed from cell to cell (-D shdom.cells)",
                 {TYN_FIGURE(cell_depth)}}},
    {.key = "flat media",
     .where = {TYN_BELOW(cells_through, 4), TYN_ABOVE(mean_depth, 0)},
     .error = flat,
     .level = TYN_LIMIT_STRAINED,
     .advice = {"cells: %.2g through the shortest side (about %g %% off): -D shdom.cells",
                {TYN_FIGURE(cells_through), TYN_LIMIT_ERROR}},
     .source = STRESS,
     .warned = {TYN_ABOVE(cells_through, 0)},
     .warning = {"accuracy: there are %.2g cells through the medium's shortest side "
                 "(-D shdom.cells)",
                 {TYN_FIGURE(cells_through)}}},
    {.key = "a narrow lobe",
     .where = {TYN_ABOVE(most_g, 0.8), TYN_ABOVE(mean_depth, 0)},
     .error = forward,
     .advice = {"forward lobe: bands of spherical harmonics do not hold it (about %g %% off with "
                "five): -D shdom.bands",
                {TYN_LIMIT_ERROR}},
     .source = STRESS,
     .warned = {TYN_ABOVE(most_g, 0.95)},
     .warning = {"accuracy: g is %.6g; bands of spherical harmonics do not hold such a lobe "
                 "(-D shdom.bands)",
                 {TYN_FIGURE(most_g)}}},
    {.key = "a narrow lobe",
     .where = {TYN_BELOW(least_g, -0.5), TYN_ABOVE(mean_depth, 0)},
     .error = backward,
     .advice = {"backward peak: bands of spherical harmonics do not hold it (about %g %% off with "
                "five at depth 4): -D shdom.bands",
                {TYN_LIMIT_ERROR}},
     .source = STRESS,
     .warned = {TYN_BELOW(least_g, -0.7)},
     .warning = {"accuracy: g is %.3g; bands of spherical harmonics do not hold a backward peak",
                 {TYN_FIGURE(least_g)}}},
    {.key = "surfaces",
     .where = {TYN_ABOVE(surfaces, 0)},
     .error = without_surfaces,
     .level = TYN_LIMIT_BREAKS,
     .advice = {"surfaces are left out: they stop no light, reflect none and are not seen (room "
                "88 %% off, cornell-smoke 100 %%, fog-hall 1400 %%)"},
     .source = "passes/shdom/shdom.md, \"Limits\""},
    TYN_LIMIT_FLOATS,
    {NULL},
};

static const tyn_promise promise = {.cube_isotropic = 0.04};

const tyn_method tyn_method_shdom = {
    .info = {.name = "shdom",
             .summary = "spherical harmonics and discrete ordinates (1998), to be compared with",
             .outputs = TYN_OUTPUT_PROBE |
                        (TYN_PICTURE_OUTPUTS &
                         ~(uint32_t)(TYN_OUTPUT_SINGLE | TYN_OUTPUT_MULTIPLE | TYN_GUIDE_OUTPUTS)),
             .limits = limits,
             .promise = &promise},
    .passes = passes,
    .declare = declare,
};
