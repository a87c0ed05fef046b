// nodes.c -- parts of a frame that several methods have in common.
#include "methods/nodes.h"
#include "methods/lamps.h"
#include "passes/medium/medium.h"
#include "passes/beam/beam.h"
#include "passes/composite/composite.h"
#include "passes/tonemap/tonemap.h"
#include <tyndall/registry.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void tyn_method_warn(const tyn_job *job, const char *format, ...)
{
    char line[256];
    va_list args;
    va_start(args, format);
    vsnprintf(line, sizeof line, format, args);
    va_end(args);
    if (job->warn) {
        job->warn(job->warn_user, line);
    }
}

void tyn_method_warn_surfaces(const tyn_job *job, const char *what)
{
    if (job->frame->num_triangles) {
        tyn_method_warn(job, "surfaces %s: %u triangles", what, job->frame->num_triangles);
    }
}

tyn_result tyn_method_refuse_repeat(const tyn_job *job, const char *method)
{
    for (uint32_t i = 0; i < job->scene->num_shapes; i++) {
        const bool *repeat = job->scene->shapes[i].repeat;
        if (repeat[0] || repeat[1] || repeat[2]) {
            tyn_log_print(job->log, TYN_LOG_ERROR,
                          "shape %u: method '%s' cannot do periodic media (\"repeat\"); "
                          "'path' can",
                          i, method);
            return TYN_ERR_PARAMS;
        }
    }
    return TYN_OK;
}

uint32_t tyn_method_suns(const tyn_job *job)
{
    const uint32_t suns = job->frame->num_suns + job->frame->num_map_suns;
    return suns < TYN_METHOD_MAX_SUNS ? suns : TYN_METHOD_MAX_SUNS;
}

void tyn_method_warn_suns(const tyn_job *job, const char *what)
{
    const uint32_t suns = job->frame->num_suns + job->frame->num_map_suns;
    const uint32_t used = tyn_method_suns(job);
    double left_out = 0, all = 0;
    for (uint32_t i = 0; i < suns; i++) {
        const float *color = job->frame->suns[i].color;
        const double irradiance = (double)color[0] + (double)color[1] + (double)color[2];
        all += irradiance;
        left_out += i < used ? 0 : irradiance;
    }
    if (left_out > 0) {
        tyn_method_warn(
            job, "%u suns: the %u strongest light %s, %.2g %% of the suns' irradiance is left out",
            suns, used, what, 100 * left_out / all);
    }
}

tyn_result tyn_add_medium(tyn_graph *g, const tyn_job *job, tyn_media_refs *media)
{
    const struct medium_block *block = &job->frame->medium;
    tyn_medium_params params;
    tyn_settings_params(job->settings, &tyn_pass_medium, &params);
    params.mode = block->mode;
    params.direct = job->frame->direct;
    params.emissive = job->frame->emissive;
    memcpy(params.size, block->size, sizeof params.size);
    memcpy(params.bricks, block->bricks, sizeof params.bricks);

    tyn_ref refs[TYN_MAX_PORTS] = {
        [MEDIUM_PORT_ATLAS] = job->refs.atlas,
        [MEDIUM_PORT_SHAPES] = job->refs.shapes,
        [MEDIUM_PORT_MEDIUM] = job->refs.medium,
    };
    tyn_result result = tyn_graph_add(g, &tyn_pass_medium, &params, refs);
    tyn_take(refs, MEDIUM_PORT_MEDIUM, media->medium);
    if (job->frame->direct) {
        media->medium.density = job->refs.atlas;
    }
    media->bricks = refs[MEDIUM_PORT_BRICKS];
    media->distance = refs[MEDIUM_PORT_DISTANCE];
    return result;
}

tyn_result tyn_add_beams(tyn_graph *g, const tyn_job *job, const tyn_medium_refs *medium,
                         uint32_t num_suns, tyn_beam_refs *beams)
{
    *beams = (tyn_beam_refs){{0}};
    if (num_suns == 0) {
        return TYN_OK;
    }
    tyn_beam_params params;
    tyn_settings_params(job->settings, &tyn_pass_beam, &params);
    tyn_beam_plan(&params, &job->frame->medium, job->frame->suns, num_suns);

    tyn_ref refs[TYN_MAX_PORTS] = {{0}};
    tyn_connect(refs, BEAM_PORT_MEDIUM, *medium);
    tyn_result result = tyn_graph_add(g, &tyn_pass_beam, &params, refs);
    tyn_take(refs, BEAM_PORT_BEAMS, *beams);
    return result;
}

// ---- the picture ------------------------------------------------------------------------------

// Is there medium at a face through which a sun shines into the box?
static bool sunlight_enters_through_medium(const tyn_frame_scene *frame, uint32_t num_suns)
{
    uint32_t lit = 0;
    for (uint32_t n = 0; n < num_suns; n++) {
        for (int a = 0; a < 3; a++) {
            float d = frame->suns[n].direction[a];
            lit |= d > 0.0f ? 1u << (2 * a) : d < 0.0f ? 2u << (2 * a) : 0;
        }
    }
    return (lit & frame->open_faces) != 0;
}

static bool has_spots(const tyn_frame_scene *frame)
{
    bool spots = false;
    for (uint32_t i = frame->num_suns; i < frame->num_lights; i++) {
        spots = spots || frame->lights[i].kind == TYN_LIGHT_KIND_SPOT;
    }
    return spots;
}

// TYN_SHAPE_KIND_* of all of them, or TYN_SHAPE_KIND_ANY.
static uint32_t kind_of_shapes(const tyn_frame_scene *frame, uint32_t count)
{
    for (uint32_t i = 1; i < count; i++) {
        if (frame->shapes[i].kind != frame->shapes[0].kind) {
            return TYN_SHAPE_KIND_ANY;
        }
    }
    return frame->shapes[0].kind;
}

static void set_march_params(tyn_raymarch_params *params, const tyn_job *job,
                             const tyn_picture_inputs *in)
{
    const tyn_frame_scene *frame = job->frame;
    const struct medium_block *block = &frame->medium;
    tyn_settings_params(job->settings, &tyn_pass_raymarch, params);
    params->grey = frame->grey && block->mode == TYN_MEDIUM_DENSITY;
    params->mode = block->mode;
    params->num_suns = in->num_suns;
    params->num_lamps = in->num_marched_lamps;
    params->num_near_lamps = in->inscatter.resource ? in->num_near_lamps : 0;
    params->reach = TYN_METHOD_LAMP_REACH * in->cell;
    params->spots = params->num_lamps + params->num_near_lamps > 0 && has_spots(frame);
    params->kernels = in->lut.resource != 0;
    params->mean = in->mean_in_field;
    params->field = in->field;
    params->one_channel = in->one_channel;
    memcpy(params->tint, in->tint, sizeof params->tint);
    params->emissive = frame->emissive;
    params->width = job->view->width;
    params->height = job->view->height;
    memcpy(params->extent, block->extent, sizeof params->extent);
    params->majorant = block->sigma_t_max * block->max_density;
    params->longest_step = tyn_raymarch_longest_step(params->majorant, in->cell, block);
    params->num_shapes = block->num_shapes;
    params->kind = kind_of_shapes(frame, block->num_shapes);
    params->closed = !sunlight_enters_through_medium(frame, in->num_suns) ||
                     block->size[0] * block->size[1] * block->size[2] == 1;
    params->repeat = block->repeat[0] || block->repeat[1] || block->repeat[2];
    if (!frame->open_faces || params->repeat) {
        params->antialias = 0; // the box that the rays may miss has nothing at its faces
    }
    if (!params->repeat) { // else it is to be seen everywhere
        tyn_raymarch_window(params, &frame->camera);
        if (frame->empty) { // nothing to march through: a pixel, as no window would mean all
            params->first[0] = params->first[1] = 0;
            params->end[0] = params->end[1] = 1;
        }
    }

    const struct env_block *env = &frame->environment;
    bool surroundings =
        env->has_map || env->radiance[0] + env->radiance[1] + env->radiance[2] > 0.0f;
    // Over a host's picture only the medium is laid.
    params->background =
        surroundings && !job->view->no_background && !(job->outputs & TYN_OUTPUT_COMPOSITE);
    params->surfaces = !job->view->no_background && !(job->outputs & TYN_OUTPUT_COMPOSITE);
    if (job->outputs & (TYN_OUTPUT_TRANSMITTANCE | TYN_OUTPUT_COMPOSITE)) {
        params->layers |= RAYMARCH_LAYER_TRANSMITTANCE;
    }
    params->layers |= job->outputs & TYN_OUTPUT_DEPTH ? RAYMARCH_LAYER_DEPTH : 0;
    params->layers |= job->outputs & TYN_OUTPUT_SINGLE ? RAYMARCH_LAYER_SINGLE : 0;
    params->layers |= job->outputs & TYN_OUTPUT_MULTIPLE ? RAYMARCH_LAYER_MULTIPLE : 0;
    if (job->refs.depth.resource) {
        const float *m = job->view_to_clip;
        const float depth[4] = {m[10], m[14], m[11], m[15]};
        memcpy(params->depth, depth, sizeof depth);
    }
}

tyn_result tyn_add_display(tyn_graph *g, const tyn_job *job, tyn_ref radiance)
{
    tyn_tonemap_params params;
    tyn_settings_params(job->settings, &tyn_pass_tonemap, &params);
    params.exposure_ev = job->view->exposure_ev;
    params.opaque = !job->view->no_background;
    tyn_ref refs[TYN_MAX_PORTS] = {[TONEMAP_PORT_RADIANCE] = radiance};
    tyn_result result = tyn_graph_add(g, &tyn_pass_tonemap, &params, refs);
    if (result == TYN_OK) {
        tyn_job_output(g, job, TYN_OUTPUT_DISPLAY, refs[TONEMAP_PORT_DISPLAY]);
    }
    return result;
}

static tyn_result add_composite(tyn_graph *g, const tyn_job *job, tyn_ref radiance,
                                tyn_ref transmittance)
{
    tyn_composite_params params = {
        .half_color = tyn_graph_format(g, job->refs.color) == VK_FORMAT_R16G16B16A16_SFLOAT,
    };
    tyn_ref refs[TYN_MAX_PORTS] = {
        [COMPOSITE_PORT_RADIANCE] = radiance,
        [COMPOSITE_PORT_TRANSMITTANCE] = transmittance,
        [COMPOSITE_PORT_COLOR] = job->refs.color,
    };
    tyn_result result = tyn_graph_add(g, &tyn_pass_composite, &params, refs);
    if (result == TYN_OK) {
        tyn_job_output(g, job, TYN_OUTPUT_COMPOSITE, refs[COMPOSITE_PORT_COLOR]);
    }
    return result;
}

tyn_result tyn_add_picture(tyn_graph *g, const tyn_job *job, const tyn_picture_inputs *in)
{
    static const tyn_picture_inputs nothing = {.num_suns = 0};
    if (!in) {
        in = &nothing;
    }
    tyn_raymarch_params params;
    set_march_params(&params, job, in);
    tyn_ref refs[TYN_MAX_PORTS] = {
        [RAYMARCH_PORT_DISTANCE] = in->media.distance,
        [RAYMARCH_PORT_SHAPES] = job->refs.shapes,
        [RAYMARCH_PORT_LIGHTS] = job->refs.suns,
        [RAYMARCH_PORT_LUT] = in->lut,
        [RAYMARCH_PORT_LUT_BLOCK] = in->lut_block,
        [RAYMARCH_PORT_INSCATTER] = in->inscatter,
        [RAYMARCH_PORT_ROOMS] = in->rooms,
        [RAYMARCH_PORT_CAMERA] = job->refs.camera,
        [RAYMARCH_PORT_ENVIRONMENT] = job->refs.environment,
        [RAYMARCH_PORT_ENV_MAP] = job->refs.env_map,
        [RAYMARCH_PORT_GLOW] = in->glow,
        [RAYMARCH_PORT_HOST_DEPTH] = job->refs.depth,
        [RAYMARCH_PORT_SURFACE] = in->surface,
        [RAYMARCH_PORT_DISTANCES] = in->distances,
    };
    tyn_connect(refs, RAYMARCH_PORT_MEDIUM, in->media.medium);
    refs[RAYMARCH_PORT_MEDIUM] = job->refs.medium; // also without media
    tyn_connect(refs, RAYMARCH_PORT_BEAMS, in->beams);
    tyn_connect(refs, RAYMARCH_PORT_RADIALS, in->lamps.radials);
    tyn_connect(refs, RAYMARCH_PORT_WALL_LINKS, in->walls);
    if (in->num_suns || in->num_marched_lamps) { // light that surfaces may stop
        tyn_connect(refs, RAYMARCH_PORT_SHADOW_ATLAS, in->shadows);
        // A lamp that shines all around leaves little in the dark: the cubes would cost more than they save.
        if (in->num_suns || params.spots) {
            refs[RAYMARCH_PORT_LIGHT_CELLS] = in->light_cells;
        }
    }
    tyn_result result = tyn_graph_add(g, &tyn_pass_raymarch, &params, refs);
    if (result != TYN_OK) {
        return result;
    }
    static const struct {
        tyn_output output;
        uint8_t port;
    } images[] = {
        {TYN_OUTPUT_RADIANCE, RAYMARCH_PORT_RADIANCE},
        {TYN_OUTPUT_TRANSMITTANCE, RAYMARCH_PORT_TRANSMITTANCE},
        {TYN_OUTPUT_DEPTH, RAYMARCH_PORT_DEPTH},
        {TYN_OUTPUT_SINGLE, RAYMARCH_PORT_SINGLE},
        {TYN_OUTPUT_MULTIPLE, RAYMARCH_PORT_MULTIPLE},
    };
    for (size_t i = 0; i < sizeof images / sizeof images[0]; i++) {
        tyn_job_output(g, job, images[i].output, refs[images[i].port]);
    }
    tyn_job_counters(g, job, "raymarch", refs[RAYMARCH_PORT_COUNTERS]);
    if (result == TYN_OK && job->outputs & TYN_OUTPUT_DISPLAY) {
        result = tyn_add_display(g, job, refs[RAYMARCH_PORT_RADIANCE]);
    }
    if (result == TYN_OK && job->outputs & TYN_OUTPUT_COMPOSITE) {
        result =
            add_composite(g, job, refs[RAYMARCH_PORT_RADIANCE], refs[RAYMARCH_PORT_TRANSMITTANCE]);
    }
    return result;
}
