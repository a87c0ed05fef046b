// method.c -- method "refined": pop's picture corrected by a few paths, and with many of them the truth.
//
// The paths are those of method "path", whole light in an image whose pixels may be larger than the picture's; the pass refine fits
// what they say beyond pop on pop's layers (refined.md).
#include <tyndall/extend/limits.h>
#include <tyndall/extend/method.h>
#include <tyndall/extend/path_scene.h>
#include "refine/refine.h"
#include "refine_camera/refine_camera.h"
#include <math.h>
#include <string.h>

enum { FIELD_CELLS = 32 };             // along the longest side, of the field in which paths end
static const float FIELD_BIAS = 0.03f; // of such paths

static tyn_refine_params params_of(const tyn_job *job)
{
    tyn_refine_params params;
    tyn_settings_params(job->settings, &tyn_pass_refine, &params);
    params.picture[0] = job->view->width;
    params.picture[1] = job->view->height;
    params.unfinished = job->view->unfinished;
    params.begins = job->view->first_sample == 0;
    memcpy(params.lo, job->frame->near_lo, sizeof params.lo);
    memcpy(params.hi, job->frame->near_hi, sizeof params.hi);
    return params;
}

// Over a host's picture both pop and path show no surfaces nor what is behind.
static bool shows_medium_alone(const tyn_job *job)
{
    return job->view->no_background || job->outputs & TYN_OUTPUT_COMPOSITE;
}

// The job of the image of samples.
static void samples_job(const tyn_job *job, int32_t grid, tyn_view *view, tyn_job *samples)
{
    *view = *job->view;
    view->width = (view->width + (uint32_t)grid - 1) / (uint32_t)grid;
    view->height = (view->height + (uint32_t)grid - 1) / (uint32_t)grid;
    memset(view->whole, 0, sizeof view->whole);
    memset(view->corner, 0, sizeof view->corner);
    view->resume = NULL;
    view->no_background = shows_medium_alone(job);
    *samples = *job;
    samples->view = view;
    samples->outputs = TYN_OUTPUT_RADIANCE | TYN_OUTPUT_ERROR;
}

// Relative error of pop's picture where it is known without samples; 0: it is not. Of a medium that scatters nothing pop
// sees all light along straight ways, of a thin one all but what has scattered twice, about half the scattering depth.
// Nothing scattered comes from surfaces, and not all of an environment's light along exact ways.
static float known_error(const tyn_job *job, const tyn_refine_params *params)
{
    static const float march = 0.005f, thin = 0.005f;
    const tyn_frame_scene *frame = job->frame;
    const struct env_block *env = &frame->environment;
    const bool straight = !frame->num_triangles && !tyn_is_periodic(frame) && !job->view->max_depth;
    const bool beams = frame->medium.mode == TYN_MEDIUM_DENSITY && !env->has_map &&
                       !tyn_is_lit(env->radiance) && frame->lights.num_suns <= TYN_BEAM_MAX_SUNS;
    const float depth = frame->empty ? 0 : tyn_limit_scatterings(job);
    const float error = march + 0.5f * depth;
    return straight && depth <= (beams ? thin : 0) && error <= params->bias ? error : 0;
}

static uint32_t batch(const tyn_job *job)
{
    const tyn_refine_params params = params_of(job);
    tyn_view view;
    tyn_job samples;
    samples_job(job, params.grid, &view, &samples);
    return known_error(job, &params) > 0 ? UINT32_MAX : tyn_job_batch(&samples, "path");
}

// Delta-scaled mean free paths of the densest place in a cell of the field.
static float depth_of_cell(const tyn_frame_scene *frame)
{
    const struct medium_block *m = &frame->medium;
    const float *e = m->extent;
    float most = 0;
    for (uint32_t i = 0; i < m->num_shapes; i++) {
        for (int c = 0; c < 3; c++) {
            most = fmaxf(most, 1 - (float)tyn_phase_delta_fraction(frame->shapes[i].phase[c]));
        }
    }
    return most * frame->majorant * fmaxf(e[0], fmaxf(e[1], e[2])) / FIELD_CELLS;
}

// Scatterings after which paths end in pop's field, when they have forgotten where they went; 0: they do not. In media that few
// paths cross in so many the noise is made before, and it is not worth the bias. Where cells are thick the field is none to end in.
// Surfaces send light that the field has not.
static uint32_t depth_of(const tyn_job *job, const tyn_refine_params *params)
{
    enum { LEAST = 8, MOST = 64, DEEP = 6, THICK = 2 };
    const tyn_frame_scene *frame = job->frame;
    const bool asked = job->view->max_depth > 0; // paths end where --max-depth says
    const bool can = !frame->empty && !frame->num_triangles && !tyn_is_periodic(frame);
    if (params->bias < FIELD_BIAS || asked || !can) {
        return 0;
    }
    if (params->depth) {
        return (uint32_t)params->depth;
    }
    float least, most;
    tyn_range_of_g(job->scene, &least, &most);
    const float depth = fmaxf(ceilf(1.4f / fmaxf(1 - most, 0.001f)), LEAST);
    const float *e = frame->medium.extent;
    const float shortest = fminf(e[0], fminf(e[1], e[2]));
    const bool worth = frame->majorant * shortest >= DEEP * depth && depth <= MOST;
    return worth && depth_of_cell(frame) < THICK ? (uint32_t)depth : 0;
}

static tyn_extent size_of_field(const tyn_job *job)
{
    return tyn_lattice_dims(job->frame->medium.extent, FIELD_CELLS);
}

// Pop's job with probes at the places of the field.
static void ask_field(tyn_graph *g, tyn_job *base, tyn_view *view)
{
    const tyn_extent size = size_of_field(base);
    view->points = NULL;
    view->num_points = size.x * size.y * size.z;
    view->scattered_only = true;
    base->refs.points = tyn_add_field_points(g, base, size);
    base->outputs |= TYN_OUTPUT_PROBE;
}

// Means of samples and their standard errors into the ports of the fit.
static void add_samples(tyn_graph *g, const tyn_job *job, int32_t grid, uint32_t depth,
                        tyn_ref probes, const tyn_ref guide[2], tyn_ref *fit)
{
    tyn_ref path[TYN_NUM_OUTPUTS] = {{0}};
    tyn_job samples;
    tyn_view view;
    samples_job(job, grid, &view, &samples);
    memcpy(samples.refs.guide, guide, sizeof samples.refs.guide);
    if (depth) {
        tyn_add_field_images(g, job, size_of_field(job), probes, samples.refs.field);
        view.max_depth = depth;
    }
    if (grid > 1 || job->outputs & TYN_OUTPUT_COMPOSITE) {
        tyn_refine_camera_params camera;
        memset(&camera, 0, sizeof camera);
        tyn_refine_camera(&job->frame->camera, (uint32_t)grid, &camera.camera);
        camera.camera.background = !view.no_background;
        tyn_ref refs[TYN_MAX_PORTS] = {{0}};
        tyn_graph_add(g, &tyn_pass_refine_camera, &camera, refs);
        samples.refs.camera = refs[REFINE_CAMERA_PORT_CAMERA];
    }
    tyn_job_declare(g, &samples, "path", path);
    fit[REFINE_PORT_SAMPLES] = path[TYN_INDEX_RADIANCE];
    fit[REFINE_PORT_NOISE] = path[TYN_INDEX_ERROR];
}

// Pop's job: its picture, what is read of it beside, and single scattering if it is refined.
static void base_job(const tyn_job *job, bool sampled, tyn_view *view, tyn_job *base)
{
    const uint32_t read = job->outputs | tyn_job_hooks_read(job);
    *view = *job->view;
    view->no_background = shows_medium_alone(job);
    *base = *job;
    base->view = view;
    base->outputs = TYN_OUTPUT_RADIANCE |
                    (read & (TYN_OUTPUT_TRANSMITTANCE | TYN_OUTPUT_DEPTH | TYN_OUTPUT_SINGLE));
    base->outputs |= sampled ? TYN_OUTPUT_SINGLE : 0;
    base->outputs |= job->outputs & TYN_OUTPUT_COMPOSITE ? TYN_OUTPUT_TRANSMITTANCE : 0;
    base->sparse_layers = !(read & TYN_OUTPUT_SINGLE); // for the fit that is enough
}

// What is kept from picture to picture.
static void add_kept(tyn_graph *g, const tyn_job *job, const tyn_refine_params *params,
                     tyn_ref *refs)
{
    static const char *const names[] = {"refine_kept", "refine_carried"};
    const uint64_t cut = job->view->cut; // another one forgets
    for (int i = 0; i < 2; i++) {
        refs[REFINE_PORT_KEPT + i] = tyn_graph_history_image(
            g, names[i], TYN_IMAGE_2D, VK_FORMAT_R32G32B32A32_SFLOAT, tyn_refine_kept(params), cut);
    }
    refs[REFINE_PORT_SEEN] =
        tyn_graph_history_buffer(g, "refine_seen", sizeof(struct camera_block), cut);
    refs[REFINE_PORT_CAMERA] = job->refs.camera;
}

// TYN_OK, or what is wrong, said.
static tyn_result check(const tyn_graph *g, const tyn_job *job, const tyn_refine_params *params)
{
    const uint32_t side = tyn_refine_side(params), most = tyn_graph_drawn_side(g);
    if (side > most) {
        return TYN_FAULT(job->log, TYN_ERR_UNSUPPORTED,
                         "refine.grid=%d at %u x %u pixels needs images of %u texels along a side, "
                         "and this device has %u: a larger grid, --refine 1 or less, needs fewer",
                         params->grid, job->view->width, job->view->height, side, most);
    }
    if (job->refs.depth.resource) {
        return TYN_FAULT(job->log, TYN_ERR_UNSUPPORTED,
                         "tyn_frame.depth: paths of 'refined' do not end at a host's surfaces; "
                         "'pop' takes depth, and 'refined' is composited without");
    }
    return TYN_OK;
}

static tyn_result declare(tyn_graph *g, const tyn_job *job)
{
    tyn_refine_params params = params_of(job);
    params.known = known_error(job, &params);
    const tyn_result result = check(g, job, &params);
    if (result != TYN_OK) {
        return result;
    }
    const bool sampled = params.known == 0;
    const uint32_t depth = sampled ? depth_of(job, &params) : 0;
    tyn_ref pop[TYN_NUM_OUTPUTS] = {{0}}, guide[2] = {{0}};
    tyn_job base;
    tyn_view view;
    base_job(job, sampled, &view, &base);
    if (depth) {
        ask_field(g, &base, &view);
    }
    base.guide = sampled && tyn_path_wants_guide(job) ? guide : NULL;
    tyn_job_declare(g, &base, "pop", pop);
    tyn_ref refs[TYN_MAX_PORTS] = {
        [REFINE_PORT_BASE] = pop[TYN_INDEX_RADIANCE],
        [REFINE_PORT_SINGLE] = pop[TYN_INDEX_SINGLE],
    };
    if (sampled) {
        add_samples(g, job, params.grid, depth, pop[TYN_INDEX_PROBE], guide, refs);
    }
    add_kept(g, job, &params, refs);
    tyn_graph_add(g, &tyn_pass_refine, &params, refs);
    tyn_add_results(g, job,
                    (tyn_picture){refs[REFINE_PORT_RADIANCE], pop[TYN_INDEX_TRANSMITTANCE],
                                  pop[TYN_INDEX_DEPTH]});
    tyn_job_output(g, job, TYN_OUTPUT_ERROR, refs[REFINE_PORT_ERROR]);
    tyn_job_output(g, job, TYN_OUTPUT_BIAS, refs[REFINE_PORT_BIAS]);
    tyn_job_output(g, job, TYN_OUTPUT_SINGLE, pop[TYN_INDEX_SINGLE]);
    return tyn_graph_status(g);
}

static const char *const passes[] = {
    TYN_MEDIUM_PASSES(TYN_PASS_NAME),
    TYN_SUN_PASSES(TYN_PASS_NAME),
    TYN_VIRTUAL_LIGHT_PASSES(TYN_PASS_NAME),
    TYN_SKY_PASSES(TYN_PASS_NAME),
    TYN_LAMP_PASSES(TYN_PASS_NAME),
    TYN_CELL_PASSES(TYN_PASS_NAME),
    TYN_LATTICE_PASSES(TYN_PASS_NAME),
    TYN_GATHER_PASSES(TYN_PASS_NAME),
    TYN_SURFACE_PASSES(TYN_PASS_NAME),
    TYN_FIELD_PASSES(TYN_PASS_NAME),
    "refine_camera",
    "path",
    "refine",
    TYN_PICTURE_PASSES(TYN_PASS_NAME),
    NULL,
};

static double ended(const tyn_regime *r)
{
    (void)r;
    return 0.1;
}

static const tyn_limit limits[] = {
    {.key = "samples",
     .advice = {"starts as 'pop'; each sample takes some of its error away (--refine N)"},
     .source = "passes/refined/refined.md, \"Measured\""},
    {.key = "paths that are ended",
     .where = {TYN_ABOVE(depth, 1e5), TYN_ABOVE(albedo, 0.9999)},
     .error = ended,
     .warning = {"accuracy: the medium is %.2g mean free paths deep and absorbs next to nothing; "
                 "paths end after so many steps (-D path.max_steps), and the picture is refined "
                 "towards what is left of them: take 'pop'",
                 {TYN_FIGURE(depth)}},
     .source = "docs/stress.md, \"What is found\""},
    TYN_LIMIT_FLOATS,
    {NULL},
};

static const tyn_promise promise = {.furnace = 0.02, .cube_isotropic = 0.03};

const tyn_method tyn_method_refined = {
    .info = {.name = "refined",
             .summary = "pop corrected by a few paths, fitted on its layers",
             .outputs = TYN_OUTPUT_RADIANCE | TYN_OUTPUT_TRANSMITTANCE | TYN_OUTPUT_DEPTH |
                        TYN_OUTPUT_SINGLE | TYN_OUTPUT_ERROR | TYN_OUTPUT_BIAS |
                        TYN_OUTPUT_DISPLAY | TYN_OUTPUT_ALBEDO | TYN_OUTPUT_NORMAL |
                        TYN_OUTPUT_COMPOSITE,
             .progressive = true,
             .traces_rays = true,
             .phases = TYN_PHASES_ONE,
             .limits = limits,
             .promise = &promise},
    .reads_env_cdf = true,
    .batch = batch,
    .passes = passes,
    .declare = declare,
};
