// method.c -- method "diffusion": light that has scattered, by the diffusion approximation on the lattice.
//
// Sources and views are the library's: suns, lamps and surroundings are followed sharply until they first scatter; what is
// new is the solver between them, which fills the field from the lattice's cells. Surfaces are seen, and cast shadows, but
// stop no light that has scattered.
#include "method.h"
#include "diffusion/diffusion.h"
#include <string.h>

static void solve(tyn_graph *g, const tyn_job *job, const tyn_sources *s, tyn_field *field)
{
    diffusion_params params;
    tyn_settings_params(job->settings, &pass_diffusion, &params);
    params.shape = s->lattice.shape;
    tyn_ref refs[DIFFUSION_NUM_PORTS] = {
        [DIFFUSION_PORT_CELLS] = s->lattice.cells,
        [DIFFUSION_PORT_SOURCE] = s->lattice.source,
        [DIFFUSION_PORT_ENVIRONMENT] = tyn_mean_environment(job, s),
    };
    tyn_graph_add(g, &pass_diffusion, &params, refs);
    field->moments = refs[DIFFUSION_PORT_MOMENTS];
    field->cell = s->lattice.side;
    field->one_channel = s->lattice.shape.channels == 1;
    memcpy(field->tint, s->lattice.shape.tint, sizeof field->tint);
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
    tyn_job_warn_surfaces(job, "stop no light that has scattered ('diffusion')");
    if (frame->empty && picture) { // surfaces and sky alone
        tyn_add_shadows(g, job, &s);
        tyn_add_surfaces(g, job, &view);
        tyn_add_picture(g, job, &view);
        return tyn_graph_status(g);
    }
    if (job->scene->num_shapes == 0) {
        tyn_log_print(job->log, TYN_LOG_ERROR,
                      "the scene has no medium: 'diffusion' has nothing to probe; 'path' can");
        return TYN_ERR_PARAMS;
    }
    tyn_add_medium(g, job, &s);
    tyn_add_beams(g, job, &s);
    tyn_add_radials(g, job, &s);
    tyn_add_shadows(g, job, &s);
    tyn_add_surroundings(g, job, true, &s);
    view.mean_in_field = tyn_is_lit(frame->environment.sky);
    view.num_marched_lamps = s.lamps.num_fine;
    if (picture) {
        tyn_add_forward_tables(g, job, &view);
        tyn_add_glow(g, job, &view);
    }
    diffusion_params params;
    tyn_settings_params(job->settings, &pass_diffusion, &params);
    tyn_add_cells(g, job, params.shape.cells, "diffusion.cells", &s);
    tyn_limits_warn(job, s.lattice.side);
    solve(g, job, &s, &field);
    tyn_add_views(g, job, &view);
    return tyn_graph_status(g);
}

static const char *const passes[] = {
    TYN_MEDIUM_PASSES(TYN_PASS_NAME),
    TYN_SUN_PASSES(TYN_PASS_NAME),
    TYN_SKY_PASSES(TYN_PASS_NAME),
    TYN_LAMP_PASSES(TYN_PASS_NAME),
    TYN_CELL_PASSES(TYN_PASS_NAME),
    "diffusion",
    TYN_GATHER_PASSES(TYN_PASS_NAME),
    TYN_SURFACE_PASSES(TYN_PASS_NAME),
    TYN_PICTURE_PASSES(TYN_PASS_NAME),
    "probe",
    NULL,
};

// Measured against "path": `cube` at 32 cells, by its depth of 1, 4, 16 and 64; see docs/writing-a-plugin.md.
static double thick(const tyn_regime *r)
{
    static const tyn_limit_point curve[] = {{0.5, 0.037}, {2, 0.4}};
    return tyn_limit_along(curve, sizeof curve / sizeof *curve, r->cell_depth);
}

static double near_boundaries(const tyn_regime *r)
{
    return 0.07 * fmin(1, r->mean_depth);
}

static const tyn_limit limits[] = {
    TYN_LIMIT_NOT_PERIODIC("docs/writing-a-plugin.md"),
    {.key = "thick cells",
     .where = {TYN_ABOVE(cell_depth, 0.5)},
     .error = thick,
     .advice = {"cells: %.2g mean free paths (delta scaled) across a dense one (about %g %% off); "
                "-D diffusion.cells",
                {TYN_FIGURE(cell_depth), TYN_LIMIT_ERROR}},
     .source = "docs/writing-a-plugin.md, \"Limits\""},
    {.key = "boundaries and empty space",
     .where = {TYN_ABOVE(mean_depth, 0)},
     .error = near_boundaries,
     .level = TYN_LIMIT_STRAINED,
     .advice =
         {"diffusion: wrong where light has scattered a few times only, near faces and around "
          "empty space (cubes 4 to 7 %% off, a plume 11 %%)"},
     .source = "docs/writing-a-plugin.md, \"Limits\""},
    {.key = "surfaces",
     .where = {TYN_ABOVE(surfaces, 0)},
     .level = TYN_LIMIT_BREAKS,
     .advice = {"surfaces stop no light that has scattered, and send none on"},
     .source = "docs/writing-a-plugin.md, \"Limits\""},
    TYN_LIMIT_FLOATS,
    {NULL},
};

const tyn_method method_diffusion = {
    .info = {.name = "diffusion",
             .summary = "sharp beams, and diffusion of what they scatter",
             .outputs = TYN_PICTURE_OUTPUTS | TYN_OUTPUT_PROBE,
             .limits = limits},
    .passes = passes,
    .declare = declare,
};
