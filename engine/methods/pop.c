// pop.c -- method "pop": principal ordinates with one lattice for everything that has scattered.
//
// The light of each sun that has not scattered, and what it scattered forward, is followed exactly in
// the sun's own aligned grid. An environment is split: its suns are such suns; its mean enters the
// lattice from all sides; the rest shines along principal ordinates, and what a forward scattering
// medium shows of it is smeared for each pixel (glow). What has left the beams and the ordinates goes
// into one solve on a lattice of cubic cells for all lights together, seen from the camera by merge
// and raymarch. A node that a scene does not need is not declared.
#include "methods/lamps.h"
#include "methods/shading.h"
#include "methods/sky.h"
#include "methods/walls.h"
#include "passes/medium/medium.h"
#include "passes/beam/beam.h"
#include "passes/columns/columns.h"
#include "passes/env_glow/env_glow.h"
#include "passes/env_importance/env_importance.h"
#include "passes/importance/importance.h"
#include "passes/ordinates/ordinates.h"
#include "passes/scatter_lut/scatter_lut.h"
#include "passes/gbuffer/gbuffer.h"
#include "passes/rsm/rsm.h"
#include "passes/shade/shade.h"
#include "passes/shadow_map/shadow_map.h"
#include "passes/vpl/vpl.h"
#include "passes/lattice/lattice.h"
#include "passes/merge/merge.h"
#include "passes/probe/probe.h"
#include "passes/radial_beam/radial_beam.h"
#include "passes/walls/walls.h"
#include "passes/composite/composite.h"
#include "passes/tonemap/tonemap.h"
#include <tyndall/registry.h>
#include <math.h>
#include <string.h>

static const uint32_t field_outputs = TYN_OUTPUT_PROBE | TYN_OUTPUT_BALANCE;

// Twice scattered light is about half the scaled scattering depth of that which scattered once: below
// this depth along the longest way through the box the lattice is left out.
static const float thin_depth = 0.05f;

// What the nodes of one frame share.
typedef struct field {
    tyn_lattice_shape shape;
    tyn_picture_inputs picture;
    tyn_sky_refs sky;
    tyn_ref tms, columns;
    tyn_ref cells, source, power, lamp_power, vpl_light, moments, leaks, wall_power;
    tyn_wall_refs walls; // surfaces on the lattice; {0} without
    tyn_ref wall_light;  // what they reflect of light that is not the lattice's; {0} if nothing
    bool from_all_sides; // the mean of the environment lights the medium
} field;

static bool any_positive(const float v[3])
{
    return v[0] > 0.0f || v[1] > 0.0f || v[2] > 0.0f;
}

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

// One channel is solved if medium and light allow it.
static void choose_channels(field *f, const tyn_scene *scene, const tyn_frame_scene *frame)
{
    bool grey = frame->grey; // and so are the walls
    float colors[2 * TYN_LIGHTS_MAX + 2][3];
    uint32_t count = 0;
    for (uint32_t i = 0; i < frame->num_suns + frame->num_map_suns; i++) {
        memcpy(colors[count++], frame->suns[i].color, sizeof colors[0]);
    }
    for (uint32_t i = frame->num_suns; i < frame->num_lights; i++) {
        memcpy(colors[count++], frame->lights[i].color, sizeof colors[0]);
    }
    memcpy(colors[count++], frame->environment.sky, sizeof colors[0]);
    memcpy(colors[count++], frame->medium.emission, sizeof colors[0]);
    // A map may have another colour in every direction.
    const tyn_surfaces *surfaces = &scene->surfaces;
    bool walls = tyn_has_walls(frame);
    for (uint32_t i = 0; walls && i < surfaces->num_materials; i++) {
        const tyn_surface_material *m = &surfaces->materials[i];
        grey = grey && m->texture == TYN_NO_TEXTURE && m->albedo[0] == m->albedo[1] &&
               m->albedo[1] == m->albedo[2] && !any_positive(m->emission);
    }
    bool one = tyn_lattice_tint((const float(*)[3])colors, count, f->shape.tint) &&
               !f->sky.sky.resource && !f->picture.lamps.vpls; // which have the colours of surfaces
    f->shape.channels = one && grey ? 1 : 3;
    if (f->shape.channels == 3) {
        f->shape.tint[0] = f->shape.tint[1] = f->shape.tint[2] = 1.0f;
    }
}

static tyn_result add_lut(tyn_graph *g, const tyn_job *job, field *f)
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
static tyn_result add_glow(tyn_graph *g, const tyn_job *job, field *f)
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

static tyn_result add_cells(tyn_graph *g, const tyn_job *job, field *f)
{
    tyn_lattice_cells_params params;
    tyn_settings_params(job->settings, &tyn_pass_lattice_cells, &params);
    params.shape = f->shape;
    params.mode = job->frame->medium.mode;
    const tyn_media_refs *media = &f->picture.media;
    tyn_ref refs[TYN_MAX_PORTS] = {
        [LATTICE_CELLS_PORT_MEDIUM] = job->refs.medium,
        [LATTICE_CELLS_PORT_DENSITY] = media->density,
        [LATTICE_CELLS_PORT_SIGMA_A] = media->sigma_a,
        [LATTICE_CELLS_PORT_G] = media->g,
        [LATTICE_CELLS_PORT_EMISSION] = media->emission,
    };
    tyn_result result = tyn_graph_add(g, &tyn_pass_lattice_cells, &params, refs);
    f->cells = refs[LATTICE_CELLS_PORT_CELLS];
    return result;
}

static tyn_result add_walls(tyn_graph *g, const tyn_job *job, field *f)
{
    tyn_result result = tyn_add_walls(g, job, &f->shape, &f->walls);
    f->picture.wall_links = f->walls.links;
    f->picture.wall_cells = f->walls.cells;
    return result;
}

// What walls reflect of light that is not the lattice's: second reflections, of what the VPLs send. In a periodic
// medium also sunlight: light from single points on walls knows no periods.
static tyn_result add_wall_light(tyn_graph *g, const tyn_job *job, field *f)
{
    if (f->picture.vpls.lights.resource && tyn_vpls_bounce(job)) {
        return TYN_OK; // VPLs carry what walls reflect of theirs
    }
    const uint32_t *repeat = f->shape.repeat;
    uint32_t suns = repeat[0] || repeat[1] || repeat[2] ? f->picture.num_suns : 0;
    return tyn_add_wall_light(g, job, &f->shape, &f->walls, &f->picture.beams, suns,
                              &f->picture.lamps, &f->wall_light);
}

static tyn_result add_source(tyn_graph *g, const tyn_job *job, field *f)
{
    tyn_lattice_source_params params;
    tyn_settings_params(job->settings, &tyn_pass_lattice_source, &params);
    params.shape = f->shape;
    params.mode = job->frame->medium.mode;
    params.num_suns = f->picture.num_suns;
    const tyn_beam_refs *beams = &f->picture.beams;
    tyn_ref refs[TYN_MAX_PORTS] = {
        [LATTICE_SOURCE_PORT_MEDIUM] = job->refs.medium,
        [LATTICE_SOURCE_PORT_LIGHTS] = job->refs.suns,
        [LATTICE_SOURCE_PORT_CELLS] = f->cells,
        [LATTICE_SOURCE_PORT_DENSITY] = f->picture.media.density,
        [LATTICE_SOURCE_PORT_G] = f->picture.media.g,
        [LATTICE_SOURCE_PORT_BEAMS] = beams->beams,
        [LATTICE_SOURCE_PORT_COLUMN] = beams->column,
        [LATTICE_SOURCE_PORT_TAU_A] = beams->tau_a,
        [LATTICE_SOURCE_PORT_TAU_P] = beams->tau_p,
        [LATTICE_SOURCE_PORT_WALL_LINKS] = f->walls.links,
        [LATTICE_SOURCE_PORT_WALL_CELLS] = f->walls.cells,
        [LATTICE_SOURCE_PORT_SHADOW_ATLAS] = f->picture.shadows.atlas,
        [LATTICE_SOURCE_PORT_SHADOWS] = f->picture.shadows.lights,
    };
    tyn_result result = tyn_graph_add(g, &tyn_pass_lattice_source, &params, refs);
    f->source = refs[LATTICE_SOURCE_PORT_SOURCE];
    f->power = refs[LATTICE_SOURCE_PORT_POWER];
    return result;
}

// The medium as columns see it: averaged if it is much finer than they are.
static tyn_result average_medium(tyn_graph *g, const tyn_job *job, const uint32_t dims[3],
                                 tyn_media_refs *media)
{
    const struct medium_block *m = &job->frame->medium;
    tyn_columns_average_params params;
    tyn_settings_params(job->settings, &tyn_pass_columns_average, &params);
    params.mode = m->mode;
    if (!tyn_columns_average_size(m, dims, params.size)) {
        return TYN_OK;
    }
    tyn_ref refs[TYN_MAX_PORTS] = {
        [COLUMNS_AVERAGE_PORT_DENSITY] = media->density,
        [COLUMNS_AVERAGE_PORT_SIGMA_A] = media->sigma_a,
        [COLUMNS_AVERAGE_PORT_G] = media->g,
    };
    tyn_result result = tyn_graph_add(g, &tyn_pass_columns_average, &params, refs);
    media->density = m->mode == TYN_MEDIUM_COEFFICIENTS ? refs[COLUMNS_AVERAGE_PORT_MEAN_SIGMA_S]
                                                        : refs[COLUMNS_AVERAGE_PORT_MEAN_DENSITY];
    media->sigma_a = refs[COLUMNS_AVERAGE_PORT_MEAN_SIGMA_A];
    media->g = refs[COLUMNS_AVERAGE_PORT_MEAN_G];
    return result;
}

static tyn_result add_columns(tyn_graph *g, const tyn_job *job, field *f)
{
    tyn_extent dims = tyn_lattice_dims(f->shape.extent, f->shape.cells);
    tyn_columns_params params;
    tyn_settings_params(job->settings, &tyn_pass_columns, &params);
    memcpy(params.extent, f->shape.extent, sizeof params.extent);
    params.dims[0] = dims.x;
    params.dims[1] = dims.y;
    params.dims[2] = dims.z;
    params.mode = job->frame->medium.mode;
    params.count = f->sky.count;
    tyn_media_refs media = f->picture.media;
    tyn_result result = average_medium(g, job, params.dims, &media);
    if (result != TYN_OK) {
        return result;
    }
    tyn_ref refs[TYN_MAX_PORTS] = {
        [COLUMNS_PORT_MEDIUM] = job->refs.medium,    [COLUMNS_PORT_DENSITY] = media.density,
        [COLUMNS_PORT_SIGMA_A] = media.sigma_a,      [COLUMNS_PORT_G] = media.g,
        [COLUMNS_PORT_ORDINATES] = f->sky.ordinates,
    };
    result = tyn_graph_add(g, &tyn_pass_columns, &params, refs);
    f->columns = refs[COLUMNS_PORT_COLUMNS];
    return result;
}

// The solution of the last frame: what is remembered, and what light puts in now.
typedef struct memory {
    tyn_lattice_recall_params params;
    tyn_ref history, power;
} memory;

// `solve` are the refs of the lattice, which gets the guess.
static tyn_result add_recall(tyn_graph *g, const tyn_job *job, const field *f, tyn_ref *solve,
                             memory *m)
{
    m->params = (tyn_lattice_recall_params){.shape = f->shape};
    // The inverse of a rigid matrix (column-major): its transpose turns back.
    const float *from = job->frame->m_from_world;
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) {
            m->params.world[i][k] = from[4 * i + k];
            m->params.world[i][3] -= from[4 * i + k] * from[12 + k];
        }
    }
    m->history = tyn_graph_history_buffer(
        g, "lattice_memory", tyn_lattice_memory_size(f->shape.cells, f->shape.channels),
        job->view->cut);
    tyn_ref refs[TYN_MAX_PORTS] = {
        [LATTICE_RECALL_PORT_MEMORY] = m->history,
        [LATTICE_RECALL_PORT_CELLS] = solve[LATTICE_PORT_CELLS],
        [LATTICE_RECALL_PORT_SOURCE] = solve[LATTICE_PORT_SOURCE],
        [LATTICE_RECALL_PORT_ENVIRONMENT] = solve[LATTICE_PORT_ENVIRONMENT],
    };
    tyn_result result = tyn_graph_add(g, &tyn_pass_lattice_recall, &m->params, refs);
    solve[LATTICE_PORT_GUESS] = refs[LATTICE_RECALL_PORT_GUESS];
    m->power = refs[LATTICE_RECALL_PORT_POWER];
    return result;
}

static tyn_result add_keep(tyn_graph *g, const field *f, const memory *m)
{
    tyn_ref refs[TYN_MAX_PORTS] = {
        [LATTICE_KEEP_PORT_MOMENTS] = f->moments,
        [LATTICE_KEEP_PORT_POWER] = m->power,
        [LATTICE_KEEP_PORT_MEMORY] = m->history,
    };
    tyn_result result = tyn_graph_add(g, &tyn_pass_lattice_keep, &m->params, refs);
    if (result == TYN_OK) {
        tyn_graph_output(g, "lattice_memory", refs[LATTICE_KEEP_PORT_MEMORY], false);
    }
    return result;
}

static tyn_result add_ordinates(tyn_graph *g, const tyn_job *job, field *f)
{
    tyn_lattice_ordinates_params params;
    tyn_settings_params(job->settings, &tyn_pass_lattice_ordinates, &params);
    params.shape = f->shape;
    params.mode = job->frame->medium.mode;
    params.grey = job->frame->grey;
    params.count = f->sky.count;
    tyn_ref refs[TYN_MAX_PORTS] = {
        [LATTICE_ORDINATES_PORT_MEDIUM] = job->refs.medium,
        [LATTICE_ORDINATES_PORT_ORDINATES] = f->sky.ordinates,
        [LATTICE_ORDINATES_PORT_COLUMNS] = f->columns,
        [LATTICE_ORDINATES_PORT_CELLS] = f->cells,
        [LATTICE_ORDINATES_PORT_SUNLIGHT] = f->source,
    };
    tyn_result result = tyn_graph_add(g, &tyn_pass_lattice_ordinates, &params, refs);
    f->source = refs[LATTICE_ORDINATES_PORT_SOURCE];
    return result;
}

static tyn_result add_lamps(tyn_graph *g, const tyn_job *job, field *f)
{
    const tyn_radial_refs *lamps = &f->picture.lamps;
    tyn_lattice_lamps_params params;
    tyn_settings_params(job->settings, &tyn_pass_lattice_lamps, &params);
    params.shape = f->shape;
    params.mode = job->frame->medium.mode;
    params.num_fine = lamps->num_fine;
    params.num_lamps = lamps->num_lamps;
    params.vpls = lamps->vpls;
    tyn_ref refs[TYN_MAX_PORTS] = {
        [LATTICE_LAMPS_PORT_MEDIUM] = job->refs.medium,
        [LATTICE_LAMPS_PORT_CELLS] = f->cells,
        [LATTICE_LAMPS_PORT_DENSITY] = f->picture.media.density,
        [LATTICE_LAMPS_PORT_G] = f->picture.media.g,
        [LATTICE_LAMPS_PORT_RADIALS] = lamps->radials,
        [LATTICE_LAMPS_PORT_COLUMN] = lamps->column,
        [LATTICE_LAMPS_PORT_TAU_A] = lamps->tau_a,
        [LATTICE_LAMPS_PORT_TAU_P] = lamps->tau_p,
        [LATTICE_LAMPS_PORT_WALL_LINKS] = f->walls.links,
        [LATTICE_LAMPS_PORT_WALL_CELLS] = f->walls.cells,
        [LATTICE_LAMPS_PORT_SHADOW_ATLAS] = f->picture.shadows.atlas,
        [LATTICE_LAMPS_PORT_SHADOWS] = f->picture.shadows.lights,
        [LATTICE_LAMPS_PORT_VPL_DISTANCES] = f->picture.vpls.distances,
        [LATTICE_LAMPS_PORT_OTHERS] = f->source,
    };
    tyn_result result = tyn_graph_add(g, &tyn_pass_lattice_lamps, &params, refs);
    f->source = refs[LATTICE_LAMPS_PORT_SOURCE];
    f->lamp_power = refs[LATTICE_LAMPS_PORT_POWER];
    f->vpl_light = refs[LATTICE_LAMPS_PORT_VPL_LIGHT];
    return result;
}

// What the lattice is given of the environment: its mean from all sides.
static tyn_ref environment_of(const tyn_job *job, const field *f)
{
    return f->from_all_sides ? job->refs.environment : (tyn_ref){0};
}

static tyn_result add_solve(tyn_graph *g, const tyn_job *job, field *f)
{
    tyn_lattice_params params;
    tyn_settings_params(job->settings, &tyn_pass_lattice, &params);
    params.shape = f->shape;
    tyn_ref refs[TYN_MAX_PORTS] = {
        [LATTICE_PORT_CELLS] = f->cells,
        [LATTICE_PORT_SOURCE] = f->source,
        [LATTICE_PORT_ENVIRONMENT] = environment_of(job, f),
        [LATTICE_PORT_WALL_LINKS] = f->walls.links,
        [LATTICE_PORT_WALL_CELLS] = f->walls.cells,
        [LATTICE_PORT_WALL_LIGHT] = f->wall_light,
    };
    memory last = {0};
    tyn_result result = params.warm ? add_recall(g, job, f, refs, &last) : TYN_OK;
    if (result == TYN_OK) {
        result = tyn_graph_add(g, &tyn_pass_lattice, &params, refs);
    }
    f->moments = refs[LATTICE_PORT_MOMENTS];
    f->leaks = refs[LATTICE_PORT_LEAKS];
    f->wall_power = f->walls.links.resource ? refs[LATTICE_PORT_WALL_POWER] : (tyn_ref){0};
    tyn_job_counters(g, job, "lattice", refs[LATTICE_PORT_COUNTERS]);
    return result == TYN_OK && params.warm ? add_keep(g, f, &last) : result;
}

static tyn_result add_merge(tyn_graph *g, const tyn_job *job, field *f)
{
    tyn_merge_params params;
    tyn_settings_params(job->settings, &tyn_pass_merge, &params);
    params.channels = f->shape.channels;
    memcpy(params.repeat, f->shape.repeat, sizeof params.repeat);
    memcpy(params.tint, f->shape.tint, sizeof params.tint);
    params.mode = job->frame->medium.mode;
    params.grey = job->frame->grey;
    tyn_ref refs[TYN_MAX_PORTS] = {
        [MERGE_PORT_MEDIUM] = job->refs.medium,
        [MERGE_PORT_CAMERA] = job->refs.camera,
        [MERGE_PORT_CELLS] = f->cells,
        [MERGE_PORT_MOMENTS] = f->moments,
    };
    if (f->sky.ordinates.resource) {
        refs[MERGE_PORT_ORDINATES] = f->sky.ordinates;
        refs[MERGE_PORT_COLUMNS] = f->columns;
        refs[MERGE_PORT_TMS] = f->tms;
        refs[MERGE_PORT_LUT_BLOCK] = f->picture.lut_block;
    }
    const tyn_radial_refs *lamps = &f->picture.lamps;
    params.marched_lamps = f->picture.num_marched_lamps;
    refs[MERGE_PORT_VPL_LIGHT] = f->vpl_light;
    if (lamps->num_lamps > params.marched_lamps) {
        refs[MERGE_PORT_RADIALS] = lamps->radials;
        refs[MERGE_PORT_RADIAL_COLUMN] = lamps->column;
        refs[MERGE_PORT_RADIAL_TAU_A] = lamps->tau_a;
        refs[MERGE_PORT_RADIAL_TAU_P] = lamps->tau_p;
        refs[MERGE_PORT_LUT] = f->picture.lut;
        refs[MERGE_PORT_LUT_BLOCK] = f->picture.lut_block;
        refs[MERGE_PORT_SHADOW_ATLAS] = f->picture.shadows.atlas;
        refs[MERGE_PORT_SHADOWS] = f->picture.shadows.lights;
    }
    tyn_result result = tyn_graph_add(g, &tyn_pass_merge, &params, refs);
    tyn_job_counters(g, job, "merge", refs[MERGE_PORT_COUNTERS]);
    f->picture.inscatter = refs[MERGE_PORT_INSCATTER];
    f->picture.one_channel = f->shape.channels == 1;
    memcpy(f->picture.tint, f->shape.tint, sizeof f->picture.tint);
    return result;
}

static uint32_t points_outside(const tyn_job *job)
{
    const float *m = job->frame->m_from_world, *extent = job->frame->medium.extent;
    uint32_t count = 0;
    for (uint32_t i = 0; i < job->view->num_points; i++) {
        const float *p = job->view->points[i];
        bool outside = false;
        for (int a = 0; a < 3; a++) {
            float x = m[a] * p[0] + m[4 + a] * p[1] + m[8 + a] * p[2] + m[12 + a];
            outside = outside || (!job->frame->medium.repeat[a] &&
                                  (x < -1e-3f * extent[a] || x > 1.001f * extent[a]));
        }
        count += outside;
    }
    return count;
}

static tyn_result add_probe(tyn_graph *g, const tyn_job *job, field *f)
{
    tyn_probe_params params;
    tyn_settings_params(job->settings, &tyn_pass_probe, &params);
    params.mode = job->frame->medium.mode;
    params.channels = f->shape.channels;
    memcpy(params.tint, f->shape.tint, sizeof params.tint);
    params.num_suns = f->picture.num_suns;
    params.num_ordinates = f->sky.count;
    params.local_lights = f->picture.lamps.radials.resource != 0;
    params.scattered_only = job->view->scattered_only;
    for (int axis = 0; axis < 3; axis++) {
        memcpy(params.world[axis], job->frame->m_from_world + 4 * axis, sizeof params.world[axis]);
    }
    uint32_t outside = points_outside(job);
    if (outside > 0) {
        tyn_method_warn(job,
                        "probe: %u of %u points lie outside the media's box; there the scattered "
                        "light is the nearest face's, too much",
                        outside, job->view->num_points);
    }
    const tyn_beam_refs *beams = &f->picture.beams;
    tyn_ref refs[TYN_MAX_PORTS] = {
        [PROBE_PORT_MEDIUM] = job->refs.medium,
        [PROBE_PORT_LIGHTS] = job->refs.suns,
        [PROBE_PORT_MOMENTS] = f->moments,
        [PROBE_PORT_CELLS] = f->cells,
        [PROBE_PORT_BEAMS] = beams->beams,
        [PROBE_PORT_COLUMN] = beams->column,
        [PROBE_PORT_TAU_A] = beams->tau_a,
        [PROBE_PORT_TAU_P] = beams->tau_p,
        [PROBE_PORT_RADIALS] = f->picture.lamps.radials,
        [PROBE_PORT_RADIAL_COLUMN] = f->picture.lamps.column,
        [PROBE_PORT_RADIAL_TAU_A] = f->picture.lamps.tau_a,
        [PROBE_PORT_RADIAL_TAU_P] = f->picture.lamps.tau_p,
        [PROBE_PORT_POINTS] = job->refs.points,
        [PROBE_PORT_SHADOW_ATLAS] = f->picture.shadows.atlas,
        [PROBE_PORT_SHADOWS] = f->picture.shadows.lights,
        [PROBE_PORT_WALL_LINKS] = f->walls.links,
        [PROBE_PORT_WALL_CELLS] = f->walls.cells,
        [PROBE_PORT_ENVIRONMENT] = environment_of(job, f),
        [PROBE_PORT_ORDINATES] = f->sky.ordinates,
        [PROBE_PORT_COLUMNS] = f->columns,
    };
    tyn_result result = tyn_graph_add(g, &tyn_pass_probe, &params, refs);
    if (result == TYN_OK) {
        tyn_job_output(g, job, TYN_OUTPUT_PROBE, refs[PROBE_PORT_RESULTS]);
    }
    return result;
}

static tyn_result add_balance(tyn_graph *g, const tyn_job *job, field *f)
{
    if (job->scene->num_shapes != 1 || job->scene->shapes[0].kind != TYN_SHAPE_BOX) {
        tyn_method_warn(job,
                        "the balance is that of the box around the media: light that misses them "
                        "inside it counts as entering and as escaped");
    }
    tyn_balance_params params;
    tyn_settings_params(job->settings, &tyn_pass_balance, &params);
    params.channels = f->shape.channels;
    memcpy(params.tint, f->shape.tint, sizeof params.tint);
    params.num_suns = f->picture.num_suns;
    params.num_groups = tyn_radial_groups(&f->picture.lamps);
    tyn_ref refs[TYN_MAX_PORTS] = {
        [BALANCE_PORT_MEDIUM] = job->refs.medium,
        [BALANCE_PORT_ENVIRONMENT] = environment_of(job, f),
        [BALANCE_PORT_ORDINATES] = f->sky.ordinates,
        [BALANCE_PORT_LIGHTS] = job->refs.suns,
        [BALANCE_PORT_CELLS] = f->cells,
        [BALANCE_PORT_MOMENTS] = f->moments,
        [BALANCE_PORT_SOURCE] = f->source,
        [BALANCE_PORT_POWER] = f->power,
        [BALANCE_PORT_LEAKS] = f->leaks,
        [BALANCE_PORT_WALL_POWER] = f->wall_power,
        [BALANCE_PORT_LAMP_POWER] = f->lamp_power,
    };
    tyn_follow_lights(job, &f->picture, &params, refs);
    tyn_result result = tyn_graph_add(g, &tyn_pass_balance, &params, refs);
    if (result == TYN_OK) {
        tyn_job_output(g, job, TYN_OUTPUT_BALANCE, refs[BALANCE_PORT_BALANCE]);
    }
    return result;
}

// Runs the steps in order until one fails.
typedef tyn_result (*step_fn)(tyn_graph *g, const tyn_job *job, field *f);
typedef struct step {
    bool wanted;
    step_fn add;
} step;

static tyn_result add_steps(tyn_graph *g, const tyn_job *job, field *f, const step *steps, size_t n)
{
    tyn_result result = TYN_OK;
    for (size_t i = 0; result == TYN_OK && i < n; i++) {
        result = steps[i].wanted ? steps[i].add(g, job, f) : TYN_OK;
    }
    return result;
}
#define ADD_STEPS(g, job, f, steps) add_steps(g, job, f, steps, sizeof steps / sizeof steps[0])

static tyn_result add_lights(tyn_graph *g, const tyn_job *job, field *f)
{
    tyn_result result =
        tyn_add_beams(g, job, &f->picture.media, f->picture.num_suns, &f->picture.beams);
    const uint32_t *repeat = job->frame->medium.repeat;
    if (result == TYN_OK && !repeat[0] && !repeat[1] && !repeat[2]) {
        result = tyn_add_vpls(g, job, &f->picture.media, f->picture.num_suns, &f->picture.vpls);
    }
    if (result == TYN_OK) {
        result =
            tyn_add_radials(g, job, &f->picture.media, f->picture.vpls.lights, &f->picture.lamps);
        f->picture.num_marched_lamps = f->picture.lamps.num_fine;
    }
    if (result == TYN_OK) {
        result = tyn_add_shadows(g, job, f->picture.num_suns, &f->picture.shadows);
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
               ? tyn_add_sky(g, job, &f->picture.media, f->picture.num_suns, true, &f->sky)
               : result;
}

static tyn_result add_field(tyn_graph *g, const tyn_job *job, field *f)
{
    const tyn_frame_scene *frame = job->frame;
    tyn_lattice_params lattice;
    tyn_settings_params(job->settings, &tyn_pass_lattice, &lattice);
    memcpy(f->shape.extent, frame->medium.extent, sizeof f->shape.extent);
    memcpy(f->shape.repeat, frame->medium.repeat, sizeof f->shape.repeat);
    f->shape.cells =
        tyn_lattice_fit(frame->medium.extent, frame->medium.repeat, lattice.shape.cells);
    choose_channels(f, job->scene, frame);
    float longest = fmaxf(f->shape.extent[0], fmaxf(f->shape.extent[1], f->shape.extent[2]));
    f->picture.cell = longest / (float)f->shape.cells;
    const bool ordinates = f->sky.ordinates.resource != 0;
    const step steps[] = {
        {true, add_cells},
        {true, add_walls},
        {ordinates, add_columns},
        {f->picture.num_suns, add_source},
        {ordinates, add_ordinates},
        {f->picture.lamps.radials.resource, add_lamps},
        {true, add_wall_light},
        {true, add_solve},
        {job->outputs & TYN_PICTURE_OUTPUTS, add_merge},
        {job->outputs & TYN_OUTPUT_PROBE, add_probe},
        {job->outputs & TYN_OUTPUT_BALANCE, add_balance},
    };
    return ADD_STEPS(g, job, f, steps);
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
    return TYN_OK;
}

// The picture of a scene without a medium.
static tyn_result add_surfaces_alone(tyn_graph *g, const tyn_job *job)
{
    const tyn_media_refs no_media = {{0}};
    tyn_picture_inputs in = {.num_suns = 0};
    uint32_t num_suns = tyn_method_suns(job);
    if (job->frame->num_triangles) {
        tyn_method_warn_suns(job, "surfaces");
    }
    tyn_result result = tyn_add_shadows(g, job, num_suns, &in.shadows);
    if (result == TYN_OK) {
        result = tyn_add_vpls(g, job, &no_media, num_suns, &in.vpls);
    }
    if (result == TYN_OK) {
        result = tyn_add_surfaces(g, job, (tyn_ref){0}, num_suns, &in);
    }
    return result == TYN_OK ? tyn_add_picture(g, job, &in) : result;
}

static tyn_result add_surfaces(tyn_graph *g, const tyn_job *job, field *f)
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

    field f = {.picture.num_suns = tyn_method_suns(job)};
    result = tyn_add_medium(g, job, &f.picture.media);
    if (result == TYN_OK) {
        result = add_lights(g, job, &f);
    }
    f.from_all_sides =
        any_positive(frame->environment.sky) && (f.sky.split || !f.sky.ordinates.resource);
    // What is scattered forward of a constant environment, whoever carries the rest.
    f.picture.mean_in_field = any_positive(frame->environment.sky);
    bool lit_by_environment = f.from_all_sides || f.sky.ordinates.resource;
    bool lamps = f.picture.lamps.radials.resource != 0;
    bool scattered_light = f.picture.num_suns || lamps || lit_by_environment || frame->emissive;
    // Walls reflect more than thin media scatter.
    bool solve = scattered_light && (lit_by_environment || f.picture.lamps.vpls ||
                                     tyn_has_walls(frame) || !is_thin(frame));
    if (!solve) {
        f.picture.num_marched_lamps = f.picture.lamps.num_lamps;
    }
    const step steps[] = {
        {picture && (f.picture.num_suns || lamps || f.sky.ordinates.resource), add_lut},
        {picture && f.sky.sky.resource, add_glow},
        {solve || (job->outputs & field_outputs), add_field},
        {picture, add_surfaces},
    };
    if (result == TYN_OK) {
        result = ADD_STEPS(g, job, &f, steps);
    }
    return result == TYN_OK && picture ? tyn_add_picture(g, job, &f.picture) : result;
}

static const tyn_pass_desc *const passes[] = {
    &tyn_pass_medium,
    &tyn_pass_beam,
    &tyn_pass_shadow_map,
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
