// pop.c -- method "pop": principal ordinates with one lattice for everything that has scattered.
//
// The light of each sun that has not scattered, and what it scattered forward, is followed exactly in
// the sun's own aligned grid. An environment is split: its suns are such suns; its mean enters the
// lattice from all sides; the rest shines along principal ordinates, and what a forward scattering
// medium shows of it is smeared for each pixel (glow). What has left the beams and the ordinates goes
// into one solve on a lattice of cubic cells for all lights together, seen from the camera by merge
// and raymarch. A node that a scene does not need is not declared.
#include <tyndall/extend/limits.h>
#include <tyndall/extend/method.h>
#include "base/fault.h"
#include "passes/methods/view/view.h"
#include <tyndall/registry.h>
#include <math.h>

extern const tyn_limit tyn_limits_pop[]; // pop_limits.c

static const uint32_t field_outputs = TYN_OUTPUT_PROBE | TYN_OUTPUT_LIGHT | TYN_OUTPUT_BALANCE;

// Twice scattered light is about half the scaled scattering depth of that which scattered once: below
// this depth along the longest way through the box the lattice is left out.
static const float thin_depth = 0.05f;

static void warn_of_mixtures(const tyn_job *job)
{
    float least, most;
    tyn_range_of_g(job->scene, &least, &most);
    if (job->frame->medium.mode == TYN_MEDIUM_COEFFICIENTS && least < most) {
        tyn_job_warn(job, "media of different anisotropy: where they overlap their mean weighted "
                          "with sigma_s is used");
    }
}

static bool is_thin(const tyn_frame_scene *frame)
{
    const struct medium_block *m = &frame->medium;
    if (m->mode != TYN_MEDIUM_DENSITY) {
        return false;
    }
    float longest = sqrtf(m->extent[0] * m->extent[0] + m->extent[1] * m->extent[1] +
                          m->extent[2] * m->extent[2]);
    float scattering = 0.0f;
    for (int c = 0; c < 3; c++) {
        const float f = (float)tyn_phase_delta_fraction(m->phase[c]);
        scattering = fmaxf(scattering, (1.0f - f) * m->sigma_s[c]);
    }
    return scattering * m->max_density * longest < thin_depth;
}

// Do all surfaces stand in one period, as those do that repeat with the medium?
static bool fit_a_period(const tyn_frame_scene *frame)
{
    float lo[3], hi[3];
    tyn_surfaces_box(frame, lo, hi);
    bool fit = frame->num_triangles > 0;
    for (int a = 0; a < 3; a++) {
        fit =
            fit && (!frame->medium.repeat[a] || hi[a] - lo[a] <= 1.0001f * frame->medium.extent[a]);
    }
    return fit;
}

// TYN_ERR_PARAMS with a log line where a periodic medium is more than the lattice can do.
static tyn_result check_repeat(const tyn_job *job)
{
    const struct medium_block *m = &job->frame->medium;
    uint32_t axes = m->repeat[0] + m->repeat[1] + m->repeat[2];
    tyn_lattice_params lattice;
    tyn_settings_params(job->settings, &tyn_pass_lattice, &lattice);
    const char *problem = NULL;
    if (axes == 0) {
        return TYN_OK;
    } else if (axes == 3) {
        problem = "repeats along all three axes; no light can come in from anywhere";
    } else if (tyn_is_sheared(job->frame)) {
        problem = "repeats and is sheared; the axes of a periodic box must be at right angles";
    } else if (job->frame->environment.has_map) {
        problem = "repeats under an environment map; give the environment as a constant radiance";
    } else if (tyn_lattice_fit(m->extent, m->repeat, lattice.shape.cells) == 0) {
        problem = "repeats along two sides that are no whole numbers of the same length, or too "
                  "short for \"lattice.cells\"";
    }
    if (problem) {
        return TYN_FAULT(job->log, TYN_ERR_PARAMS, "shape 0 %s ('pop')", problem);
    }
    if (tyn_surfaces_emit(&job->scene->surfaces)) {
        return TYN_FAULT(
            job->log, TYN_ERR_PARAMS,
            "surfaces that emit cannot light periodic media (\"repeat\") with this method; "
            "'path' can");
    }
    if (fit_a_period(job->frame)) {
        tyn_job_warn(job, "surfaces do not repeat with the medium: there is one copy of them, and "
                          "none of what others would hide and reflect; 'path' repeats them");
    }
    return TYN_OK;
}

// The picture of a scene without a medium.
static void add_surfaces_alone(tyn_graph *g, const tyn_job *job, tyn_sources *s,
                               tyn_view_inputs *view)
{
    tyn_add_shadows(g, job, s);
    tyn_add_surroundings(g, job, true, s);
    tyn_add_vpls(g, job, s);
    tyn_add_surfaces(g, job, view);
    tyn_add_picture(g, job, view);
}

static void add_lights(tyn_graph *g, const tyn_job *job, tyn_sources *s)
{
    const tyn_frame_scene *frame = job->frame;
    tyn_lattice_params lattice;
    tyn_settings_params(job->settings, &tyn_pass_lattice, &lattice);
    tyn_add_beams(g, job, s);
    tyn_add_shadows(g, job, s);
    if (frame->num_triangles && tyn_is_periodic(frame)) {
        tyn_job_warn_suns(job,
                          tyn_has_walls(frame) ? "surfaces and the medium among them" : "surfaces");
    }
    tyn_add_surroundings(g, job, true, s);
    if (!tyn_is_periodic(frame)) {
        if (s->sky.maps.sky_maps.resource) {
            tyn_add_columns(g, job, lattice.shape.cells, s);
        }
        tyn_add_vpls(g, job, s);
    }
    tyn_add_radials(g, job, s);
}

// Is there light that the lattice has to carry on?
static bool wants_solve(const tyn_job *job, const tyn_sources *s)
{
    const tyn_frame_scene *frame = job->frame;
    const bool environment = s->mean_from_all_sides || s->sky.ordinates.resource;
    const bool lamps = s->lamps.radials.radials.resource != 0;
    // Walls reflect more than thin media scatter.
    const bool thick = environment || s->lamps.vpls || tyn_has_walls(frame) || !is_thin(frame);
    return (s->num_suns || lamps || environment || frame->emissive) && thick;
}

static tyn_result declare(tyn_graph *g, const tyn_job *job)
{
    const tyn_frame_scene *frame = job->frame;
    const bool picture = job->outputs & TYN_PICTURE_OUTPUTS;
    tyn_sources s = {0};
    tyn_field field = {0};
    tyn_view_inputs view = {.sources = &s, .field = &field};
    TYN_TRY(check_repeat(job));
    warn_of_mixtures(job);
    if (frame->empty && !(job->outputs & field_outputs)) {
        add_surfaces_alone(g, job, &s, &view);
        return tyn_graph_status(g);
    }
    if (job->scene->num_shapes == 0) {
        return TYN_FAULT(
            job->log, TYN_ERR_PARAMS,
            "the scene has no medium: 'pop' has nothing to probe or to balance; 'path' can");
    }
    tyn_add_medium(g, job, &s);
    add_lights(g, job, &s);
    const bool solve = wants_solve(job, &s);
    view.mean_in_field =
        tyn_is_lit(frame->environment.sky); // scattered forward, whoever carries the rest
    view.num_marched_lamps = solve ? s.lamps.num_fine : s.lamps.num_lamps;
    if (picture) {
        tyn_add_forward_tables(g, job, &view);
        tyn_add_glow(g, job, &view);
    }
    if (solve || job->guide || job->outputs & field_outputs) {
        tyn_lattice_params lattice;
        tyn_settings_params(job->settings, &tyn_pass_lattice, &lattice);
        tyn_add_cells(g, job, lattice.shape.cells, "lattice.cells", &s);
        tyn_limits_warn(job, s.lattice.side);
        tyn_solve_lattice(g, job, &s, &field);
    }
    tyn_add_views(g, job, &view);
    return tyn_graph_status(g);
}

static const char *const passes[] = {
    TYN_MEDIUM_PASSES(TYN_PASS_NAME),        TYN_SUN_PASSES(TYN_PASS_NAME),
    TYN_VIRTUAL_LIGHT_PASSES(TYN_PASS_NAME), TYN_SKY_PASSES(TYN_PASS_NAME),
    TYN_LAMP_PASSES(TYN_PASS_NAME),          TYN_CELL_PASSES(TYN_PASS_NAME),
    TYN_LATTICE_PASSES(TYN_PASS_NAME),       TYN_GATHER_PASSES(TYN_PASS_NAME),
    TYN_SURFACE_PASSES(TYN_PASS_NAME),       TYN_PICTURE_PASSES(TYN_PASS_NAME),
    TYN_FIELD_PASSES(TYN_PASS_NAME),         NULL,
};

static const tyn_promise promise = {.furnace = 0.005,
                                    .cube_isotropic = 0.03,
                                    .slabs = 0.02,
                                    .half_space = 0.04,
                                    .point_source = 0.05,
                                    .energy = 0.01,
                                    .wide_ground = true};

const tyn_method tyn_method_pop = {
    .info = {.name = "pop",
             .summary = "principal ordinates: exact beams, one lattice for scattered light",
             .outputs =
                 TYN_PICTURE_OUTPUTS | TYN_OUTPUT_PROBE | TYN_OUTPUT_LIGHT | TYN_OUTPUT_BALANCE,
             .traces_rays = true, // virtual lights see what stands around them
             .phases = TYN_PHASES_ONE,
             .limits = tyn_limits_pop,
             .promise = &promise},
    .passes = passes,
    .declare = declare,
};
