// pop.c -- method "pop": principal ordinates with one lattice for everything that has scattered.
//
// The light of each sun that has not scattered, and what it scattered forward, is followed exactly in
// the sun's own aligned grid. An environment is split: its suns are such suns; its mean enters the
// lattice from all sides; the rest shines along principal ordinates, and what a forward scattering
// medium shows of it is smeared for each pixel (glow). What has left the beams and the ordinates goes
// into one solve on a lattice of cubic cells for all lights together, seen from the camera by merge
// and raymarch. A node that a scene does not need is not declared.
#include "methods/field.h"
#include "methods/limits.h"
#include "methods/lamps.h"
#include "methods/shading.h"
#include "methods/sky.h"
#include "methods/walls.h"
#include "passes/medium/medium.h"
#include "passes/beam/beam.h"
#include "passes/columns/columns.h"
#include "passes/columns_average/columns_average.h"
#include "passes/env_glow/env_glow.h"
#include "passes/env_importance/env_importance.h"
#include "passes/importance/importance.h"
#include "passes/ordinates/ordinates.h"
#include "passes/scatter_lut/scatter_lut.h"
#include "passes/gbuffer/gbuffer.h"
#include "passes/rsm/rsm.h"
#include "passes/shade/shade.h"
#include "passes/light_cells/light_cells.h"
#include "passes/shadow_map/shadow_map.h"
#include "passes/vpl/vpl.h"
#include "passes/lattice_cells/lattice_cells.h"
#include "passes/lattice_source/lattice_source.h"
#include "passes/lattice_ordinates/lattice_ordinates.h"
#include "passes/lattice_lamps/lattice_lamps.h"
#include "passes/lattice/lattice.h"
#include "passes/lattice_recall/lattice_recall.h"
#include "passes/lattice_keep/lattice_keep.h"
#include "passes/merge/merge.h"
#include "passes/probe/probe.h"
#include "passes/balance/balance.h"
#include "passes/radial_beam/radial_beam.h"
#include "passes/walls/walls.h"
#include "passes/wall_light/wall_light.h"
#include "passes/rooms/rooms.h"
#include "passes/composite/composite.h"
#include "passes/tonemap/tonemap.h"
#include <tyndall/registry.h>
#include <math.h>
#include <string.h>

static const uint32_t field_outputs = TYN_OUTPUT_PROBE | TYN_OUTPUT_BALANCE;

// Twice scattered light is about half the scaled scattering depth of that which scattered once: below
// this depth along the longest way through the box the lattice is left out.
static const float thin_depth = 0.05f;

// Least and largest g of what scatters in the scene; 0 and 0 if nothing does.
static void range_of_g(const tyn_scene *scene, float *least, float *most)
{
    *least = 1.0f;
    *most = -1.0f;
    for (uint32_t i = 0; i < scene->num_shapes; i++) {
        const tyn_medium *m = &scene->media[scene->shapes[i].medium];
        for (int c = 0; c < 3; c++) {
            if (m->sigma_s[c] * m->density_scale > 0.0f) {
                *least = fminf(*least, m->g[c]);
                *most = fmaxf(*most, m->g[c]);
            }
        }
    }
    if (*least > *most) {
        *least = *most = 0.0f;
    }
}

static float largest_g(const tyn_job *job)
{
    float least, most;
    range_of_g(job->scene, &least, &most);
    return most;
}

static void warn_of_mixtures(const tyn_job *job)
{
    float least, most;
    range_of_g(job->scene, &least, &most);
    if (job->frame->medium.mode == TYN_MEDIUM_COEFFICIENTS && least < most) {
        tyn_method_warn(job,
                        "media of different anisotropy: where they overlap their mean weighted "
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
        float forward = fmaxf(m->g[c], 0.0f);
        scattering = fmaxf(scattering, (1.0f - forward * forward) * m->sigma_s[c]);
    }
    return scattering * m->max_density * longest < thin_depth;
}

static tyn_result add_lut(tyn_graph *g, const tyn_job *job, tyn_field *f)
{
    const struct medium_block *m = &job->frame->medium;
    tyn_scatter_lut_params params;
    tyn_settings_params(job->settings, &tyn_pass_scatter_lut, &params);
    params.mode = m->mode;
    memcpy(params.g, m->g, sizeof params.g);
    params.g_max = largest_g(job);
    params.num_suns = f->picture.num_suns;
    for (uint32_t n = 0; n < params.num_suns; n++) {
        params.mean_cosine[n] = job->frame->suns[n].mean_cosine;
    }
    params.tms = f->sky.ordinates.resource != 0;
    tyn_ref refs[TYN_MAX_PORTS] = {{0}};
    tyn_result result = tyn_graph_add(g, &tyn_pass_scatter_lut, &params, refs);
    f->tms = refs[SCATTER_LUT_PORT_TMS];
    f->picture.lut = refs[SCATTER_LUT_PORT_LUT];
    f->picture.lut_block = refs[SCATTER_LUT_PORT_LUT_BLOCK];
    return result;
}

// What the map looks like behind a medium that scatters forward.
static tyn_result add_glow(tyn_graph *g, const tyn_job *job, tyn_field *f)
{
    const struct medium_block *m = &job->frame->medium;
    float largest = largest_g(job);
    tyn_env_glow_params params;
    tyn_settings_params(job->settings, &tyn_pass_env_glow, &params);
    for (int c = 0; c < 3; c++) {
        params.g[c] = m->mode == TYN_MEDIUM_DENSITY ? m->g[c] : largest;
    }
    tyn_ref refs[TYN_MAX_PORTS] = {[ENV_GLOW_PORT_SKY] = f->sky.sky};
    tyn_result result = tyn_graph_add(g, &tyn_pass_env_glow, &params, refs);
    f->picture.glow = refs[ENV_GLOW_PORT_GLOW];
    return result;
}

static tyn_result add_lights(tyn_graph *g, const tyn_job *job, tyn_field *f)
{
    tyn_result result =
        tyn_add_beams(g, job, &f->picture.media.medium, f->picture.num_suns, &f->picture.beams);
    const uint32_t *repeat = job->frame->medium.repeat;
    if (result == TYN_OK && !repeat[0] && !repeat[1] && !repeat[2]) {
        result =
            tyn_add_vpls(g, job, &f->picture.media.medium, f->picture.num_suns, &f->picture.vpls);
    }
    if (result == TYN_OK) {
        result = tyn_add_radials(g, job, &f->picture.media.medium, f->picture.vpls.vpls,
                                 &f->picture.lamps);
        f->picture.num_marched_lamps = f->picture.lamps.num_fine;
    }
    if (result == TYN_OK) {
        result = tyn_add_shadows(g, job, f->picture.num_suns, &f->picture.shadows,
                                 &f->picture.light_cells);
    }
    const bool walls = tyn_has_walls(job->frame);
    if (job->frame->num_triangles) {
        tyn_method_warn_suns(job, walls ? "surfaces and the medium among them" : "surfaces");
    }
    if (result == TYN_OK && walls) {
        // Ordinates know of no walls; the mean of the sky comes in along the lattice's lines, which do.
        if (job->frame->environment.has_map) {
            tyn_method_warn(job,
                            "among surfaces the medium is lit by the mean of the environment map "
                            "and by its suns");
        }
        return result;
    }
    return result == TYN_OK
               ? tyn_add_sky(g, job, &f->picture.media.medium, f->picture.num_suns, true, &f->sky)
               : result;
}

// Are the axes of the only shape not those of M?
static bool is_sheared(const tyn_frame_scene *frame)
{
    bool sheared = false;
    for (int i = 0; i < 9; i++) {
        float across = fabsf(frame->shapes[0].rows[i / 3][i % 3]) * frame->medium.extent[i % 3];
        sheared = sheared || (i / 3 != i % 3 && across > 1e-4f);
    }
    return sheared;
}

static bool any_emits(const tyn_surfaces *s)
{
    bool emits = false;
    for (uint32_t i = 0; i < s->num_triangles; i++) {
        const float *e = s->materials[s->triangles[i].material].emission;
        emits = emits || e[0] > 0 || e[1] > 0 || e[2] > 0;
    }
    return emits;
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
    } else if (is_sheared(job->frame)) {
        problem = "repeats and is sheared; the axes of a periodic box must be at right angles";
    } else if (job->frame->environment.has_map) {
        problem = "repeats under an environment map; give the environment as a constant radiance";
    } else if (tyn_lattice_fit(m->extent, m->repeat, lattice.shape.cells) == 0) {
        problem = "repeats along two sides that are no whole numbers of the same length, or too "
                  "short for \"lattice.cells\"";
    }
    if (problem) {
        tyn_log_print(job->log, TYN_LOG_ERROR, "shape 0 %s ('pop')", problem);
        return TYN_ERR_PARAMS;
    }
    if (any_emits(&job->scene->surfaces)) {
        tyn_log_print(
            job->log, TYN_LOG_ERROR,
            "surfaces that emit cannot light periodic media (\"repeat\") with this method; "
            "'path' can");
        return TYN_ERR_PARAMS;
    }
    if (fit_a_period(job->frame)) {
        tyn_method_warn(job,
                        "surfaces do not repeat with the medium: there is one copy of them, and "
                        "none of what others would hide and reflect; 'path' repeats them");
    }
    return TYN_OK;
}

// The picture of a scene without a medium.
static tyn_result add_surfaces_alone(tyn_graph *g, const tyn_job *job)
{
    const tyn_medium_refs no_medium = {{0}};
    tyn_picture_inputs in = {.num_suns = 0};
    uint32_t num_suns = tyn_method_suns(job);
    if (job->frame->num_triangles) {
        tyn_method_warn_suns(job, "surfaces");
    }
    tyn_result result = tyn_add_shadows(g, job, num_suns, &in.shadows, &in.light_cells);
    if (result == TYN_OK) {
        result = tyn_add_vpls(g, job, &no_medium, num_suns, &in.vpls);
    }
    if (result == TYN_OK) {
        result = tyn_add_surfaces(g, job, (tyn_ref){0}, num_suns, &in);
    }
    return result == TYN_OK ? tyn_add_picture(g, job, &in) : result;
}

static tyn_result add_surfaces(tyn_graph *g, const tyn_job *job, tyn_field *f)
{
    return tyn_add_surfaces(g, job, f->moments, f->picture.num_suns, &f->picture);
}

static tyn_result declare(tyn_graph *g, const tyn_job *job)
{
    const tyn_frame_scene *frame = job->frame;
    tyn_result result = check_repeat(job);
    if (result != TYN_OK) {
        return result;
    }
    warn_of_mixtures(job);
    bool picture = job->outputs & TYN_PICTURE_OUTPUTS;
    if (frame->empty && !(job->outputs & field_outputs)) {
        return add_surfaces_alone(g, job);
    }
    if (job->scene->num_shapes == 0) {
        tyn_log_print(
            job->log, TYN_LOG_ERROR,
            "the scene has no medium: 'pop' has nothing to probe or to balance; 'path' can");
        return TYN_ERR_PARAMS;
    }

    tyn_limits_rays(job);
    tyn_field f = {.picture.num_suns = tyn_method_suns(job)};
    result = tyn_add_medium(g, job, &f.picture.media);
    if (result == TYN_OK) {
        result = add_lights(g, job, &f);
    }
    const float *sky = frame->environment.sky;
    bool lit = sky[0] > 0.0f || sky[1] > 0.0f || sky[2] > 0.0f;
    f.from_all_sides = lit && (f.sky.split || !f.sky.ordinates.resource);
    // What is scattered forward of a constant environment, whoever carries the rest.
    f.picture.mean_in_field = lit;
    bool lit_by_environment = f.from_all_sides || f.sky.ordinates.resource;
    bool lamps = f.picture.lamps.radials.radials.resource != 0;
    bool scattered_light = f.picture.num_suns || lamps || lit_by_environment || frame->emissive;
    // Walls reflect more than thin media scatter.
    bool solve = scattered_light && (lit_by_environment || f.picture.lamps.vpls ||
                                     tyn_has_walls(frame) || !is_thin(frame));
    if (!solve) {
        f.picture.num_marched_lamps = f.picture.lamps.num_lamps;
    }
    const tyn_field_step steps[] = {
        {picture && (f.picture.num_suns || lamps || f.sky.ordinates.resource), add_lut},
        {picture && f.sky.sky.resource, add_glow},
        {solve || (job->outputs & field_outputs), tyn_add_field},
        {picture, add_surfaces},
    };
    if (result == TYN_OK) {
        result = tyn_add_steps(g, job, &f, steps, sizeof steps / sizeof steps[0]);
    }
    return result == TYN_OK && picture ? tyn_add_picture(g, job, &f.picture) : result;
}

static const tyn_pass_desc *const passes[] = {
    &tyn_pass_medium,
    &tyn_pass_beam,
    &tyn_pass_shadow_map,
    &tyn_pass_light_cells,
    &tyn_pass_rsm,
    &tyn_pass_vpl,
    &tyn_pass_env_importance,
    &tyn_pass_importance,
    &tyn_pass_ordinates,
    &tyn_pass_radial_beam,
    &tyn_pass_scatter_lut,
    &tyn_pass_env_glow,
    &tyn_pass_lattice_cells,
    &tyn_pass_walls,
    &tyn_pass_wall_light,
    &tyn_pass_rooms,
    &tyn_pass_columns_average,
    &tyn_pass_columns,
    &tyn_pass_lattice_source,
    &tyn_pass_lattice_ordinates,
    &tyn_pass_lattice_lamps,
    &tyn_pass_lattice_recall,
    &tyn_pass_lattice,
    &tyn_pass_lattice_keep,
    &tyn_pass_merge,
    &tyn_pass_gbuffer,
    &tyn_pass_shade,
    &tyn_pass_raymarch,
    &tyn_pass_composite,
    &tyn_pass_tonemap,
    &tyn_pass_probe,
    &tyn_pass_balance,
    NULL,
};

const tyn_method tyn_method_pop = {
    .name = "pop",
    .summary = "principal ordinates: exact beams, one lattice for scattered light",
    .passes = passes,
    .outputs = TYN_PICTURE_OUTPUTS | TYN_OUTPUT_PROBE | TYN_OUTPUT_BALANCE,
    .traces_rays = true, // virtual lights see what stands around them
    .declare = declare,
};
