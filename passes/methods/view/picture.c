// picture.c -- the picture: the march along the rays of the camera, and what is made of it.
#include "passes/methods/view/view.h"
#include <tyndall/registry.h>
#include <math.h>
#include <string.h>

// Is there medium at a face through which a sun shines into the box?
static bool sunlight_enters_through_medium(const tyn_frame_scene *frame, uint32_t num_suns)
{
    uint32_t lit = 0;
    for (uint32_t n = 0; n < num_suns; n++) {
        for (int a = 0; a < 3; a++) {
            float d = frame->lights.suns[n].direction[a];
            lit |= d > 0.0f ? 1u << (2 * a) : d < 0.0f ? 2u << (2 * a) : 0;
        }
    }
    return (lit & frame->open_faces) != 0;
}

static bool has_lobes(const tyn_frame_scene *frame)
{
    bool lobes = false;
    for (uint32_t i = 0; i < frame->lights.num_lamps; i++) {
        lobes = lobes || tyn_first_lamp(&frame->lights)[i].kind != TYN_LIGHT_KIND_POINT;
    }
    return lobes;
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

// Over a host's picture only the medium is laid.
static bool is_background_seen(const tyn_job *job)
{
    const struct env_block *env = &job->frame->environment;
    const bool surroundings = env->has_map || tyn_is_lit(env->radiance);
    return surroundings && !job->view->no_background && !(job->outputs & TYN_OUTPUT_COMPOSITE);
}

// Light changes no faster than cells and depth allow. Matters for media of few voxels; else steps are as long as voxels.
float tyn_longest_step(const tyn_frame_scene *frame, float cell)
{
    const struct medium_block *medium = &frame->medium;
    const float sigma_t = frame->majorant;
    const float *extent = medium->extent;
    float side = fmaxf(extent[0], fmaxf(extent[1], extent[2]));
    float voxel = fminf(medium->voxel[0], fminf(medium->voxel[1], medium->voxel[2]));
    // Light that falls off as e^-x over a step of depth x comes out x^2 / 24 too dark. Voxels resolve it
    // as well as the medium itself; a medium of few or one voxel is no reason for long steps.
    bool homogeneous = medium->size[0] * medium->size[1] * medium->size[2] == 1;
    float shortest = homogeneous ? side / 512.0f : fminf(voxel, side / 64.0f);
    float by_depth = sigma_t > 0.0f ? fmaxf(0.1f / sigma_t, shortest) : side;
    return fminf(fminf(by_depth, side / 8.0f), cell > 0.0f ? cell : side);
}

static void set_march_params(tyn_raymarch_params *params, const tyn_job *job,
                             const tyn_view_inputs *in)
{
    const tyn_frame_scene *frame = job->frame;
    const struct medium_block *block = &frame->medium;
    tyn_settings_params(job->settings, &tyn_pass_raymarch, params);
    params->grey = frame->grey && block->mode == TYN_MEDIUM_DENSITY;
    params->tabled = job->refs.phases.resource != 0;
    params->mode = block->mode;
    params->num_suns = in->sources->num_suns;
    params->num_lamps = in->num_marched_lamps;
    params->num_near_lamps = in->inscatter.resource ? in->num_near_lamps : 0;
    params->reach = TYN_LAMP_REACH * in->field->cell;
    params->spots = params->num_lamps + params->num_near_lamps > 0 && has_lobes(frame);
    params->kernels = in->lut.resource != 0;
    params->mean = in->mean_in_field;
    params->field = in->field->inscatter_is;
    params->one_channel = in->field->one_channel;
    memcpy(params->tint, in->field->tint, sizeof params->tint);
    params->emissive = frame->emissive;
    params->width = job->view->width;
    params->height = job->view->height;
    memcpy(params->extent, block->extent, sizeof params->extent);
    params->majorant = frame->majorant;
    params->longest_step = tyn_longest_step(frame, in->field->cell);
    params->num_shapes = block->num_shapes;
    params->kind = kind_of_shapes(frame, block->num_shapes);
    params->closed = !sunlight_enters_through_medium(frame, in->sources->num_suns) ||
                     block->size[0] * block->size[1] * block->size[2] == 1;
    params->repeat = tyn_is_periodic(frame);
    if (!frame->open_faces || params->repeat) {
        params->antialias = 0; // the box that the rays may miss has nothing at its faces
    }
    const bool other_camera = job->refs.shown_camera.resource != 0; // than `frame` has
    if (!other_camera) {
        memcpy(params->whole, job->view->whole, sizeof params->whole);
    }
    if (!params->repeat && !other_camera) { // else it is to be seen everywhere
        tyn_raymarch_window(params, &frame->camera);
        if (frame->empty) { // nothing to march through: a pixel, as no window would mean all
            params->first[0] = params->first[1] = 0;
            params->end[0] = params->end[1] = 1;
        }
    }

    params->background = !other_camera && is_background_seen(job);
    params->surfaces = !job->view->no_background && !(job->outputs & TYN_OUTPUT_COMPOSITE);
    const uint32_t read = job->outputs | tyn_job_hooks_read(job);
    if (read & (TYN_OUTPUT_TRANSMITTANCE | TYN_OUTPUT_COMPOSITE)) {
        params->layers |= RAYMARCH_LAYER_TRANSMITTANCE;
    }
    params->layers |= read & TYN_OUTPUT_DEPTH ? RAYMARCH_LAYER_DEPTH : 0;
    params->layers |= job->outputs & TYN_OUTPUT_SINGLE ? RAYMARCH_LAYER_SINGLE : 0;
    params->layers |= job->outputs & TYN_OUTPUT_MULTIPLE ? RAYMARCH_LAYER_MULTIPLE : 0;
    params->sparse_layers = job->sparse_layers;
    params->parted = job->capacity.software;
    if (job->refs.depth.resource) {
        memcpy(params->depth, job->host_depth, sizeof params->depth);
    }
}

void tyn_add_display(tyn_graph *g, const tyn_job *job, tyn_ref radiance)
{
    tyn_tonemap_params params;
    tyn_settings_params(job->settings, &tyn_pass_tonemap, &params);
    params.exposure_ev = job->view->exposure_ev;
    params.opaque = !job->view->no_background;
    tyn_ref refs[TYN_MAX_PORTS] = {[TONEMAP_PORT_RADIANCE] = radiance};
    tyn_graph_add(g, &tyn_pass_tonemap, &params, refs);
    tyn_job_output(g, job, TYN_OUTPUT_DISPLAY, refs[TONEMAP_PORT_DISPLAY]);
}

static void add_composite(tyn_graph *g, const tyn_job *job, tyn_ref radiance, tyn_ref transmittance)
{
    tyn_composite_params params = {
        .joint = job->half_view,
        .half_color = tyn_graph_format(g, job->refs.color) == VK_FORMAT_R16G16B16A16_SFLOAT,
    };
    tyn_ref refs[TYN_MAX_PORTS] = {
        [COMPOSITE_PORT_RADIANCE] = radiance,
        [COMPOSITE_PORT_TRANSMITTANCE] = transmittance,
        [COMPOSITE_PORT_COLOR] = job->refs.color,
    };
    if (job->refs.full_depth.resource) {
        refs[COMPOSITE_PORT_HALF_DEPTH] = job->refs.depth;
        refs[COMPOSITE_PORT_FULL_DEPTH] = job->refs.full_depth;
        memcpy(params.depth, job->host_depth, sizeof params.depth);
    }
    tyn_graph_add(g, &tyn_pass_composite, &params, refs);
    tyn_job_output(g, job, TYN_OUTPUT_COMPOSITE, refs[COMPOSITE_PORT_COLOR]);
}

void tyn_add_results(tyn_graph *g, const tyn_job *job, tyn_picture picture)
{
    for (uint32_t i = 0; i < job->num_hooks; i++) {
        if (job->hooks[i]->reads && job->hooks[i]->reads(job)) {
            job->hooks[i]->declare(g, job, &picture);
        }
    }
    tyn_add_guides(g, job);
    tyn_job_output(g, job, TYN_OUTPUT_RADIANCE, picture.radiance);
    tyn_job_output(g, job, TYN_OUTPUT_TRANSMITTANCE, picture.transmittance);
    tyn_job_output(g, job, TYN_OUTPUT_DEPTH, picture.depth);
    if (job->outputs & TYN_OUTPUT_DISPLAY) {
        tyn_add_display(g, job, picture.radiance);
    }
    if (job->outputs & TYN_OUTPUT_COMPOSITE) {
        add_composite(g, job, picture.radiance, picture.transmittance);
    }
}

tyn_picture tyn_add_march(tyn_graph *g, const tyn_job *job, const tyn_view_inputs *in)
{
    tyn_raymarch_params params;
    set_march_params(&params, job, in);
    tyn_ref refs[TYN_MAX_PORTS] = {
        [RAYMARCH_PORT_DISTANCE] = in->sources->distance,
        [RAYMARCH_PORT_SHAPES] = job->refs.shapes,
        [RAYMARCH_PORT_LIGHTS] = job->refs.suns,
        [RAYMARCH_PORT_PHASES] = job->refs.phases,
        [RAYMARCH_PORT_LUT] = in->lut,
        [RAYMARCH_PORT_LUT_BLOCK] = in->lut_block,
        [RAYMARCH_PORT_INSCATTER] = in->inscatter,
        [RAYMARCH_PORT_ROOMS] = in->sources->surface_light.rooms,
        [RAYMARCH_PORT_CAMERA] = job->refs.camera,
        [RAYMARCH_PORT_ENVIRONMENT] = job->refs.environment,
        [RAYMARCH_PORT_ENV_MAP] = job->refs.env_map,
        [RAYMARCH_PORT_GLOW] = in->glow,
        [RAYMARCH_PORT_HOST_DEPTH] = job->refs.depth,
        [RAYMARCH_PORT_SURFACE] = in->surface,
        [RAYMARCH_PORT_SEEN] = in->seen,
    };
    tyn_connect(refs, RAYMARCH_PORT_MEDIUM, in->sources->medium);
    refs[RAYMARCH_PORT_MEDIUM] = job->refs.medium; // also without media
    tyn_connect(refs, RAYMARCH_PORT_BEAMS, in->sources->beams);
    tyn_connect(refs, RAYMARCH_PORT_RADIALS, in->sources->lamps.radials);
    tyn_connect(refs, RAYMARCH_PORT_WALL_LINKS, in->sources->walls.cut);
    if (in->sources->num_suns || in->num_marched_lamps) { // light that surfaces may stop
        tyn_connect(refs, RAYMARCH_PORT_SHADOW_ATLAS, in->sources->shadows);
    }
    tyn_graph_add(g, &tyn_pass_raymarch, &params, refs);
    tyn_job_output(g, job, TYN_OUTPUT_SINGLE, refs[RAYMARCH_PORT_SINGLE]);
    tyn_job_output(g, job, TYN_OUTPUT_MULTIPLE, refs[RAYMARCH_PORT_MULTIPLE]);
    return (tyn_picture){refs[RAYMARCH_PORT_RADIANCE], refs[RAYMARCH_PORT_TRANSMITTANCE],
                         refs[RAYMARCH_PORT_DEPTH]};
}

void tyn_add_picture(tyn_graph *g, const tyn_job *job, const tyn_view_inputs *in)
{
    tyn_add_results(g, job, tyn_add_march(g, job, in));
}

void tyn_add_views(tyn_graph *g, const tyn_job *job, tyn_view_inputs *in)
{
    const bool picture = job->outputs & TYN_PICTURE_OUTPUTS;
    if (picture) {
        tyn_gather(g, job, in);
    }
    if (job->outputs & TYN_OUTPUT_PROBE) {
        tyn_add_probe(g, job, in);
    }
    if (job->guide) {
        tyn_add_guide(g, job, in);
    }
    if (job->outputs & TYN_OUTPUT_LIGHT) {
        tyn_add_light_field(g, job, in);
    }
    if (job->outputs & TYN_OUTPUT_BALANCE) {
        tyn_add_balance(g, job, in);
    }
    if (picture) {
        tyn_add_surfaces(g, job, in);
        tyn_add_picture(g, job, in);
    }
}
