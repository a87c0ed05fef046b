// field.c -- the lattice of method "pop": everything that has scattered, for all lights together.
#include "methods/field.h"
#include "methods/limits.h"
#include "methods/lamps.h"
#include "methods/shading.h"
#include "passes/columns/columns.h"
#include "passes/columns_average/columns_average.h"
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
#include <tyndall/registry.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static bool emits(const tyn_surface_material *m)
{
    return m->emission[0] > 0.0f || m->emission[1] > 0.0f || m->emission[2] > 0.0f;
}

// One channel is solved if medium and light allow it.
static void choose_channels(tyn_field *f, const tyn_scene *scene, const tyn_frame_scene *frame)
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
               m->albedo[1] == m->albedo[2] && !emits(m);
    }
    bool one = tyn_lattice_tint((const float(*)[3])colors, count, f->shape.tint) &&
               !f->sky.sky.resource && !f->picture.lamps.vpls; // which have the colours of surfaces
    f->shape.channels = one && grey ? 1 : 3;
    if (f->shape.channels == 3) {
        f->shape.tint[0] = f->shape.tint[1] = f->shape.tint[2] = 1.0f;
    }
}

static tyn_result add_cells(tyn_graph *g, const tyn_job *job, tyn_field *f)
{
    tyn_lattice_cells_params params;
    tyn_settings_params(job->settings, &tyn_pass_lattice_cells, &params);
    params.shape = f->shape;
    params.mode = job->frame->medium.mode;
    tyn_ref refs[TYN_MAX_PORTS] = {{0}};
    tyn_connect(refs, LATTICE_CELLS_PORT_MEDIUM, f->picture.media.medium);
    tyn_result result = tyn_graph_add(g, &tyn_pass_lattice_cells, &params, refs);
    f->cells = refs[LATTICE_CELLS_PORT_CELLS];
    return result;
}

static tyn_result add_walls(tyn_graph *g, const tyn_job *job, tyn_field *f)
{
    return tyn_add_walls(g, job, &f->shape, &f->picture.walls, &f->wall_hits);
}

static tyn_result add_rooms(tyn_graph *g, const tyn_job *job, tyn_field *f)
{
    return tyn_add_rooms(g, job, &f->shape, &f->picture.walls, &f->picture.vpls, &f->picture.rooms);
}

// What walls reflect of light that is not the lattice's: second reflections, of what the VPLs send. In a periodic
// medium also sunlight: light from single points on walls knows no periods.
static tyn_result add_wall_light(tyn_graph *g, const tyn_job *job, tyn_field *f)
{
    if (f->picture.vpls.vpls.resource && tyn_vpls_bounce(job)) {
        return TYN_OK; // VPLs carry what walls reflect of theirs
    }
    const uint32_t *repeat = f->shape.repeat;
    uint32_t suns = repeat[0] || repeat[1] || repeat[2] ? f->picture.num_suns : 0;
    return tyn_add_wall_light(g, job, &f->shape, &f->picture, f->wall_hits, suns, &f->wall_light);
}

static tyn_result add_source(tyn_graph *g, const tyn_job *job, tyn_field *f)
{
    tyn_lattice_source_params params;
    tyn_settings_params(job->settings, &tyn_pass_lattice_source, &params);
    params.shape = f->shape;
    params.mode = job->frame->medium.mode;
    params.num_suns = f->picture.num_suns;
    tyn_ref refs[TYN_MAX_PORTS] = {
        [LATTICE_SOURCE_PORT_LIGHTS] = job->refs.suns,
        [LATTICE_SOURCE_PORT_CELLS] = f->cells,
    };
    tyn_connect(refs, LATTICE_SOURCE_PORT_MEDIUM, f->picture.media.medium);
    tyn_connect(refs, LATTICE_SOURCE_PORT_BEAMS, f->picture.beams);
    tyn_connect(refs, LATTICE_SOURCE_PORT_WALL_LINKS, f->picture.walls);
    tyn_connect(refs, LATTICE_SOURCE_PORT_SHADOW_ATLAS, f->picture.shadows);
    tyn_result result = tyn_graph_add(g, &tyn_pass_lattice_source, &params, refs);
    f->source = refs[LATTICE_SOURCE_PORT_SOURCE];
    f->power = refs[LATTICE_SOURCE_PORT_POWER];
    return result;
}

// The medium as columns see it: averaged if it is much finer than they are.
static tyn_result average_medium(tyn_graph *g, const tyn_job *job, const uint32_t dims[3],
                                 tyn_medium_refs *medium)
{
    const struct medium_block *m = &job->frame->medium;
    tyn_columns_average_params params;
    tyn_settings_params(job->settings, &tyn_pass_columns_average, &params);
    params.mode = m->mode;
    if (!tyn_columns_average_size(m, dims, params.size)) {
        return TYN_OK;
    }
    tyn_ref refs[TYN_MAX_PORTS] = {
        [COLUMNS_AVERAGE_PORT_DENSITY] = medium->density,
        [COLUMNS_AVERAGE_PORT_SIGMA_A] = medium->sigma_a,
        [COLUMNS_AVERAGE_PORT_G] = medium->g,
    };
    tyn_result result = tyn_graph_add(g, &tyn_pass_columns_average, &params, refs);
    medium->density = m->mode == TYN_MEDIUM_COEFFICIENTS ? refs[COLUMNS_AVERAGE_PORT_MEAN_SIGMA_S]
                                                         : refs[COLUMNS_AVERAGE_PORT_MEAN_DENSITY];
    medium->sigma_a = refs[COLUMNS_AVERAGE_PORT_MEAN_SIGMA_A];
    medium->g = refs[COLUMNS_AVERAGE_PORT_MEAN_G];
    return result;
}

static tyn_result add_columns(tyn_graph *g, const tyn_job *job, tyn_field *f)
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
    tyn_medium_refs medium = f->picture.media.medium;
    tyn_result result = average_medium(g, job, params.dims, &medium);
    if (result != TYN_OK) {
        return result;
    }
    tyn_ref refs[TYN_MAX_PORTS] = {[COLUMNS_PORT_ORDINATES] = f->sky.ordinates};
    tyn_connect(refs, COLUMNS_PORT_MEDIUM, medium);
    result = tyn_graph_add(g, &tyn_pass_columns, &params, refs);
    tyn_take(refs, COLUMNS_PORT_ORDINATES, f->columns);
    return result;
}

// The solution of the last frame: what is remembered, and what light puts in now.
typedef struct memory {
    tyn_lattice_recall_params params;
    tyn_ref history, power;
} memory;

// `solve` are the refs of the lattice, which gets the guess.
static tyn_result add_recall(tyn_graph *g, const tyn_job *job, const tyn_field *f, tyn_ref *solve,
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

static tyn_result add_keep(tyn_graph *g, const tyn_field *f, const memory *m)
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

static tyn_result add_ordinates(tyn_graph *g, const tyn_job *job, tyn_field *f)
{
    tyn_lattice_ordinates_params params;
    tyn_settings_params(job->settings, &tyn_pass_lattice_ordinates, &params);
    params.shape = f->shape;
    params.mode = job->frame->medium.mode;
    params.grey = job->frame->grey;
    params.count = f->sky.count;
    tyn_ref refs[TYN_MAX_PORTS] = {
        [LATTICE_ORDINATES_PORT_MEDIUM] = job->refs.medium,
        [LATTICE_ORDINATES_PORT_CELLS] = f->cells,
        [LATTICE_ORDINATES_PORT_SUNLIGHT] = f->source,
    };
    tyn_connect(refs, LATTICE_ORDINATES_PORT_ORDINATES, f->columns);
    tyn_result result = tyn_graph_add(g, &tyn_pass_lattice_ordinates, &params, refs);
    f->source = refs[LATTICE_ORDINATES_PORT_SOURCE];
    return result;
}

static tyn_result add_lamps(tyn_graph *g, const tyn_job *job, tyn_field *f)
{
    const tyn_lamps *lamps = &f->picture.lamps;
    tyn_lattice_lamps_params params;
    tyn_settings_params(job->settings, &tyn_pass_lattice_lamps, &params);
    params.shape = f->shape;
    params.mode = job->frame->medium.mode;
    params.num_fine = lamps->num_fine;
    params.num_lamps = lamps->num_lamps;
    params.vpls = lamps->vpls;
    tyn_ref refs[TYN_MAX_PORTS] = {
        [LATTICE_LAMPS_PORT_CELLS] = f->cells,
        [LATTICE_LAMPS_PORT_VPL_DISTANCES] = f->picture.vpls.vpl_distances,
        [LATTICE_LAMPS_PORT_ROOMS] = f->picture.rooms,
        [LATTICE_LAMPS_PORT_OTHERS] = f->source,
    };
    tyn_connect(refs, LATTICE_LAMPS_PORT_MEDIUM, f->picture.media.medium);
    tyn_connect(refs, LATTICE_LAMPS_PORT_RADIALS, f->picture.lamps.radials);
    tyn_connect(refs, LATTICE_LAMPS_PORT_WALL_LINKS, f->picture.walls);
    tyn_connect(refs, LATTICE_LAMPS_PORT_SHADOW_ATLAS, f->picture.shadows);
    tyn_result result = tyn_graph_add(g, &tyn_pass_lattice_lamps, &params, refs);
    f->source = refs[LATTICE_LAMPS_PORT_SOURCE];
    f->lamp_power = refs[LATTICE_LAMPS_PORT_POWER];
    f->vpl_light = refs[LATTICE_LAMPS_PORT_VPL_LIGHT];
    return result;
}

// What the lattice is given of the environment: its mean from all sides.
static tyn_ref environment_of(const tyn_job *job, const tyn_field *f)
{
    return f->from_all_sides ? job->refs.environment : (tyn_ref){0};
}

static tyn_result add_solve(tyn_graph *g, const tyn_job *job, tyn_field *f)
{
    tyn_lattice_params params;
    tyn_settings_params(job->settings, &tyn_pass_lattice, &params);
    params.shape = f->shape;
    tyn_ref refs[TYN_MAX_PORTS] = {
        [LATTICE_PORT_CELLS] = f->cells,
        [LATTICE_PORT_SOURCE] = f->source,
        [LATTICE_PORT_ENVIRONMENT] = environment_of(job, f),
        [LATTICE_PORT_WALL_LIGHT] = f->wall_light,
    };
    tyn_connect(refs, LATTICE_PORT_WALL_LINKS, f->picture.walls);
    memory last = {0};
    tyn_result result = params.warm ? add_recall(g, job, f, refs, &last) : TYN_OK;
    if (result == TYN_OK) {
        result = tyn_graph_add(g, &tyn_pass_lattice, &params, refs);
    }
    f->moments = refs[LATTICE_PORT_MOMENTS];
    f->leaks = refs[LATTICE_PORT_LEAKS];
    f->wall_power =
        f->picture.walls.wall_links.resource ? refs[LATTICE_PORT_WALL_POWER] : (tyn_ref){0};
    tyn_job_counters(g, job, "lattice", refs[LATTICE_PORT_COUNTERS]);
    return result == TYN_OK && params.warm ? add_keep(g, f, &last) : result;
}

static tyn_result add_merge(tyn_graph *g, const tyn_job *job, tyn_field *f)
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
        tyn_connect(refs, MERGE_PORT_ORDINATES, f->columns);
        refs[MERGE_PORT_TMS] = f->tms;
        refs[MERGE_PORT_LUT_BLOCK] = f->picture.lut_block;
    }
    const tyn_lamps *lamps = &f->picture.lamps;
    params.marched_lamps = f->picture.num_marched_lamps;
    refs[MERGE_PORT_VPL_LIGHT] = f->vpl_light;
    if (lamps->num_lamps > params.marched_lamps) {
        f->picture.num_near_lamps = lamps->num_lamps - params.marched_lamps;
        params.reach = TYN_METHOD_LAMP_REACH * f->picture.cell;
        tyn_connect(refs, MERGE_PORT_RADIALS, lamps->radials);
        refs[MERGE_PORT_LUT] = f->picture.lut;
        refs[MERGE_PORT_LUT_BLOCK] = f->picture.lut_block;
        tyn_connect(refs, MERGE_PORT_SHADOW_ATLAS, f->picture.shadows);
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

static tyn_result add_probe(tyn_graph *g, const tyn_job *job, tyn_field *f)
{
    tyn_probe_params params;
    tyn_settings_params(job->settings, &tyn_pass_probe, &params);
    params.mode = job->frame->medium.mode;
    params.channels = f->shape.channels;
    memcpy(params.tint, f->shape.tint, sizeof params.tint);
    params.num_suns = f->picture.num_suns;
    params.num_ordinates = f->sky.count;
    params.local_lights = f->picture.lamps.radials.radials.resource != 0;
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
    tyn_ref refs[TYN_MAX_PORTS] = {
        [PROBE_PORT_MEDIUM] = job->refs.medium,
        [PROBE_PORT_LIGHTS] = job->refs.suns,
        [PROBE_PORT_MOMENTS] = f->moments,
        [PROBE_PORT_CELLS] = f->cells,
        [PROBE_PORT_POINTS] = job->refs.points,
        [PROBE_PORT_VPL_DISTANCES] = f->picture.vpls.vpl_distances,
        [PROBE_PORT_ROOMS] = f->picture.rooms,
        [PROBE_PORT_ENVIRONMENT] = environment_of(job, f),
    };
    tyn_connect(refs, PROBE_PORT_ORDINATES, f->columns);
    tyn_connect(refs, PROBE_PORT_BEAMS, f->picture.beams);
    tyn_connect(refs, PROBE_PORT_RADIALS, f->picture.lamps.radials);
    tyn_connect(refs, PROBE_PORT_WALL_LINKS, f->picture.walls);
    tyn_connect(refs, PROBE_PORT_SHADOW_ATLAS, f->picture.shadows);
    tyn_result result = tyn_graph_add(g, &tyn_pass_probe, &params, refs);
    if (result == TYN_OK) {
        tyn_job_output(g, job, TYN_OUTPUT_PROBE, refs[PROBE_PORT_RESULTS]);
    }
    return result;
}

static tyn_result add_balance(tyn_graph *g, const tyn_job *job, tyn_field *f)
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

tyn_result tyn_add_steps(tyn_graph *g, const tyn_job *job, tyn_field *f,
                         const tyn_field_step *steps, size_t count)
{
    tyn_result result = TYN_OK;
    for (size_t i = 0; result == TYN_OK && i < count; i++) {
        result = steps[i].wanted ? steps[i].add(g, job, f) : TYN_OK;
    }
    return result;
}

// A lattice may be as long as a row of clouds, but not have more cells than a cube of 64.
static void warn_of_cells(const tyn_job *job, const tyn_field *f, int32_t asked)
{
    const tyn_extent n = tyn_lattice_dims(f->shape.extent, asked);
    if ((uint64_t)n.x * n.y * n.z > TYN_LATTICE_MAX_ALL) {
        char line[160];
        snprintf(line, sizeof line,
                 "pop: lattice.cells is %d, which makes more than %d cells; %d are used",
                 (int)asked, TYN_LATTICE_MAX_ALL, (int)f->shape.cells);
        job->warn(job->warn_user, line);
    }
}

tyn_result tyn_add_field(tyn_graph *g, const tyn_job *job, tyn_field *f)
{
    const tyn_frame_scene *frame = job->frame;
    tyn_lattice_params lattice;
    tyn_settings_params(job->settings, &tyn_pass_lattice, &lattice);
    memcpy(f->shape.extent, frame->medium.extent, sizeof f->shape.extent);
    memcpy(f->shape.repeat, frame->medium.repeat, sizeof f->shape.repeat);
    f->shape.cells =
        tyn_lattice_fit(frame->medium.extent, frame->medium.repeat, lattice.shape.cells);
    warn_of_cells(job, f, lattice.shape.cells);
    choose_channels(f, job->scene, frame);
    float longest = fmaxf(f->shape.extent[0], fmaxf(f->shape.extent[1], f->shape.extent[2]));
    f->picture.cell = longest / (float)f->shape.cells;
    tyn_limits_lattice(job, f->picture.cell);
    const bool ordinates = f->sky.ordinates.resource != 0;
    const tyn_field_step steps[] = {
        {true, add_cells},
        {true, add_walls},
        {f->picture.lamps.vpls, add_rooms},
        {ordinates, add_columns},
        {f->picture.num_suns, add_source},
        {ordinates, add_ordinates},
        {f->picture.lamps.radials.radials.resource, add_lamps},
        {true, add_wall_light},
        {true, add_solve},
        {job->outputs & TYN_PICTURE_OUTPUTS, add_merge},
        {job->outputs & TYN_OUTPUT_PROBE, add_probe},
        {job->outputs & TYN_OUTPUT_BALANCE, add_balance},
    };
    return tyn_add_steps(g, job, f, steps, sizeof steps / sizeof steps[0]);
}
