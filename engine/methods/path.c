// path.c -- method "path": unbiased path tracing, the reference that the other methods are judged by.
#include <tyndall/extend/limits.h>
#include <tyndall/extend/method.h>
#include "passes/path/path.h"
#include "passes/path_probe/path_probe.h"
#include "passes/path_balance/path_balance.h"
#include "passes/path_fluxes/path_fluxes.h"
#include "passes/path_distance/path_distance.h"
#include "shaders/path/path_args.h"
#include "view/view.h"
#include <tyndall/registry.h>
#include <math.h>
#include <string.h>

// ---- what a path costs ------------------------------------------------------------------------

// Threads of a dispatch: most, and of one whose paths are long.
enum { THREADS = 16384, THREADS_LONG = 1024 };

static const double DISPATCH_NS = 20e6; // aimed at; 50 ms is the limit on a software device
static const double RECORD_NS = 1e9;    // of all dispatches of a record

// Reflections of a path between surfaces: until roulette begins, and what is then left. In the open there are
// fewer.
static double count_reflections(const tyn_surfaces *surfaces)
{
    double albedo = 0;
    for (uint32_t i = 0; i < surfaces->num_materials; i++) {
        for (int c = 0; c < 3; c++) {
            albedo = fmax(albedo, (double)surfaces->materials[i].albedo[c]);
        }
    }
    return albedo > 0 ? fmin(log(0.1) / log(fmin(albedo, 0.999)) + 1 / (1.001 - albedo), 50) : 0;
}

// Nanoseconds of a ray through the triangles and of what happens at its end, measured likewise.
static double ray_cost_ns(const tyn_frame_scene *frame)
{
    double triangles = frame->num_triangles;
    bool tree = frame->surfaces.num_nodes > 1 && triangles > TYN_SURFACE_FEW;
    return tree ? 90 + 25 * log2(1 + triangles)
                : 20 + (triangles > TYN_SURFACE_FEW ? 8 : 2) * triangles;
}

// Nanoseconds of a path on two cores of a software device: measured 90 for the unit cube at sigma_s 4, 700 for a
// thin 64^3 grid; the estimate is up to twice that. In a medium that
// absorbs nothing the mean way of light between entering and leaving is 4 V / S whatever the scattering, so the
// number of collisions follows from the densest extinction.
static double path_cost_ns(const tyn_job *job, bool homogeneous)
{
    const struct medium_block *m = &job->frame->medium;
    double e[3] = {m->extent[0], m->extent[1], m->extent[2]};
    double surface = 2 * (e[0] * e[1] + e[1] * e[2] + e[2] * e[0]), chord = 0;
    if (m->repeat[0] || m->repeat[1] || m->repeat[2]) {
        for (int a = 0; a < 3; a++) {
            chord = fmax(chord, m->repeat[a] ? 0 : 2 * e[a]);
        }
    } else if (surface > 0) {
        chord = 4 * e[0] * e[1] * e[2] / surface;
    }
    double bound = 0;
    if (m->mode == TYN_MEDIUM_DENSITY) {
        bound = (double)m->sigma_t_max * m->max_density;
    } else {
        for (uint32_t i = 0; i < m->num_shapes; i++) {
            const struct shape_block *s = &job->frame->shapes[i];
            bound += s->sigma_s[1] + s->sigma_a[1];
        }
    }
    double collisions = 2 + bound * chord;
    double bricks = m->bricks[0] + m->bricks[1] + m->bricks[2];
    double cost = homogeneous ? 25 * collisions : 60 * m->num_shapes * collisions + 10 * bricks;
    if (job->frame->num_triangles) {
        // A ray to find the end of a flight and one for shadow, at every vertex.
        cost += 2 * collisions * ray_cost_ns(job->frame);
        cost *= 1 + count_reflections(&job->scene->surfaces);
    }
    // Paths that start inside have to find their way out of the thick of it.
    cost *= job->outputs & (TYN_OUTPUT_PROBE | TYN_OUTPUT_BALANCE) ? 2 + 0.5 * bound * chord : 1;
    return job->frame->grey ? cost : 2 * cost;
}

// ---- parameters -------------------------------------------------------------------------------

static bool has_grids(const tyn_job *job)
{
    const tyn_scene *scene = job->scene;
    for (uint32_t i = 0; i < scene->num_shapes; i++) {
        if (scene->media[scene->shapes[i].medium].volume >= 0) {
            return true;
        }
    }
    return false;
}

static bool equal3(const float v[3])
{
    return v[0] == v[1] && v[1] == v[2];
}

static uint32_t count_near_lamps(const tyn_frame_scene *frame)
{
    const float *e = frame->medium.extent;
    float reach = 0.5f * sqrtf(e[0] * e[0] + e[1] * e[1] + e[2] * e[2]);
    uint32_t count = 0;
    for (uint32_t i = 0; i < frame->lights.num_lamps; i++) {
        const float *p = tyn_first_lamp(&frame->lights)[i].position;
        bool near = true;
        for (int a = 0; a < 3; a++) {
            near = near && p[a] > -reach && p[a] < e[a] + reach;
        }
        count += near;
    }
    return count;
}

// In a medium that is thin even along its longest diagonal, how much denser first flights should think it is.
static float stretch_of(const tyn_frame_scene *frame)
{
    const float thin = 0.1f;
    const struct medium_block *m = &frame->medium;
    const float *e = m->extent;
    float depth = m->sigma_t_max * m->max_density * sqrtf(e[0] * e[0] + e[1] * e[1] + e[2] * e[2]);
    bool one = m->mode == TYN_MEDIUM_DENSITY && !m->repeat[0] && !m->repeat[1] && !m->repeat[2];
    return one && !frame->num_triangles && depth > 0 && depth < thin ? fminf(1 / depth, 1e12f) : 1;
}

static void set_params(tyn_path_params *p, const tyn_job *job, const tyn_pass_desc *pass)
{
    const tyn_frame_scene *frame = job->frame;
    const struct medium_block *m = &frame->medium;
    const struct env_block *env = &frame->environment;
    const tyn_view *view = job->view;
    tyn_settings_params(job->settings, pass, p);
    p->seed = view->seed;
    p->first_sample = view->first_sample;
    p->num_samples = view->num_samples ? view->num_samples : 1;
    p->max_depth = view->max_depth;
    p->rr_depth = view->rr_depth;
    p->homogeneous = frame->empty || (m->num_shapes == 1 && !has_grids(job));
    bool sphere = frame->shapes[0].kind == TYN_SHAPE_KIND_SPHERE;
    p->num_shapes = frame->empty ? 1 : m->num_shapes;
    p->sphere = sphere && p->num_shapes == 1;
    p->threads = THREADS; // by halves: they are part of the frame's structure
    while (p->threads > THREADS_LONG &&
           p->threads * path_cost_ns(job, p->homogeneous) > DISPATCH_NS) {
        p->threads /= 2;
    }
    p->grey = 1;
    float sigma_t = 0;
    for (uint32_t i = 0; i < m->num_shapes; i++) {
        const struct shape_block *s = &frame->shapes[i];
        p->grey =
            p->grey && equal3(s->sigma_s) && equal3(s->sigma_a) && tyn_phase_is_grey(s->phase);
        sigma_t = fmaxf(sigma_t, s->sigma_s[1] + s->sigma_a[1]);
    }
    p->repeat = m->repeat[0] || m->repeat[1] || m->repeat[2];
    p->triangles = frame->num_triangles;
    p->textures = frame->num_textures;
    p->keep_few = job->cpu_device;
    p->emitters = job->refs.emitters.resource != 0 && !p->repeat; // else there is no end of them
    p->emissive = frame->emissive;
    p->num_lights = frame->lights.num_directional + frame->lights.num_lamps;
    p->num_lamps = frame->lights.num_lamps;
    p->near_lamps = count_near_lamps(frame);
    bool sky = env->radiance[0] + env->radiance[1] + env->radiance[2] > 0;
    p->environment = !sky           ? TYN_PATH_ENV_NONE
                     : env->has_map ? TYN_PATH_ENV_MAP
                                    : TYN_PATH_ENV_CONSTANT;
    p->sigma_guess = p->homogeneous ? sigma_t : 0.3f * sigma_t * m->max_density;
    p->stretch = stretch_of(frame);
    p->layers =
        (job->outputs & (TYN_OUTPUT_SINGLE | TYN_OUTPUT_MULTIPLE | TYN_OUTPUT_TRANSMITTANCE)) != 0;
    p->opaque = sky && !view->no_background;
    p->scattered = view->scattered_only;
    for (int w = 0; w < 3; w++) {
        for (int a = 0; a < 3; a++) {
            p->world[w][a] = frame->m_from_world[w * 4 + a];
        }
    }
}

// A sample of fluxes. Few threads with many paths each: those that have their last path wait for the longest.
enum { FLUX_THREADS = 512, FLUX_SAMPLE_PATHS = 8 };

// Of a thread in one dispatch.
static double flux_paths(const tyn_job *job, bool homogeneous)
{
    return DISPATCH_NS / (path_cost_ns(job, homogeneous) * FLUX_THREADS);
}

static uint32_t batch(const tyn_job *job)
{
    if (job->outputs & TYN_OUTPUT_BALANCE) {
        return 1;
    }
    tyn_path_params p;
    if (job->outputs & TYN_OUTPUT_FLUXES) {
        set_params(&p, job, &tyn_pass_path_fluxes);
        double samples = flux_paths(job, p.homogeneous) / FLUX_SAMPLE_PATHS;
        return samples < 1 ? 1 : (uint32_t)fmin(samples, 1024);
    }
    bool probes = job->outputs & TYN_OUTPUT_PROBE;
    set_params(&p, job, probes ? &tyn_pass_path_probe : &tyn_pass_path);
    double elements = probes ? job->view->num_points : (double)job->view->width * job->view->height;
    double cost = path_cost_ns(job, p.homogeneous);
    double samples =
        fmin(DISPATCH_NS / (cost * fmin(elements, p.threads)), RECORD_NS / (cost * elements));
    return samples < 1 ? 1 : samples > 1e6 ? 1000000 : (uint32_t)samples;
}

// ---- nodes ------------------------------------------------------------------------------------

static void connect_scene(tyn_ref *refs, const tyn_job *job, tyn_ref bricks)
{
    refs[PATH_PORT_ATLAS] = job->refs.atlas;
    refs[PATH_PORT_MEDIUM] = job->refs.medium;
    refs[PATH_PORT_SHAPES] = job->refs.shapes;
    refs[PATH_PORT_BRICKS] = bricks;
    refs[PATH_PORT_LIGHTS] = job->refs.lights;
    refs[PATH_PORT_ENVIRONMENT] = job->refs.environment;
    refs[PATH_PORT_ENV_MAP] = job->refs.env_map;
    refs[PATH_PORT_ENV_TABLE] = job->refs.env_cdf;
    tyn_connect(refs, PATH_PORT_SURFACES, job->refs.geometry);
    tyn_connect(refs, PATH_PORT_MATERIALS, job->refs.materials);
    refs[PATH_PORT_EMITTERS] = job->refs.emitters;
}

static tyn_ref history(tyn_graph *g, const char *name, uint32_t width, uint32_t height)
{
    return tyn_graph_history_image(g, name, TYN_IMAGE_2D, VK_FORMAT_R32G32B32A32_SFLOAT,
                                   (tyn_extent){width, height, 1}, 1);
}

static void add_image(tyn_graph *g, const tyn_job *job, tyn_ref bricks)
{
    tyn_path_params params;
    set_params(&params, job, &tyn_pass_path);
    uint32_t w = job->view->width, h = job->view->height;
    uint32_t lw = params.layers ? w : 1, lh = params.layers ? h : 1;
    tyn_ref refs[PATH_NUM_PORTS] = {
        [PATH_PORT_CAMERA] = job->refs.camera,
        [PATH_PORT_MEAN] = history(g, "path_mean", w, h),
        [PATH_PORT_LOW] = history(g, "path_low", w, h),
        [PATH_PORT_DEVIATION] = history(g, "path_deviation", w, h),
        [PATH_PORT_MEAN_SINGLE] = history(g, "path_single", lw, lh),
        [PATH_PORT_MEAN_MULTIPLE] = history(g, "path_multiple", lw, lh),
        [PATH_PORT_MEAN_TRANSMITTANCE] = history(g, "path_transmittance", lw, lh),
    };
    connect_scene(refs, job, bricks);
    tyn_graph_add(g, &tyn_pass_path, &params, refs);
    tyn_job_output(g, job, TYN_OUTPUT_RADIANCE, refs[PATH_PORT_RADIANCE]);
    tyn_job_output(g, job, TYN_OUTPUT_ERROR, refs[PATH_PORT_ERROR]);
    tyn_job_output(g, job, TYN_OUTPUT_SINGLE, refs[PATH_PORT_SINGLE]);
    tyn_job_output(g, job, TYN_OUTPUT_MULTIPLE, refs[PATH_PORT_MULTIPLE]);
    tyn_job_output(g, job, TYN_OUTPUT_TRANSMITTANCE, refs[PATH_PORT_TRANSMITTANCE]);
    tyn_job_counters(g, job, &tyn_pass_path, refs[PATH_PORT_COUNTERS]);
    if (job->outputs & TYN_OUTPUT_DISPLAY) {
        tyn_add_display(g, job, refs[PATH_PORT_RADIANCE]);
    }
}

static void add_probes(tyn_graph *g, const tyn_job *job, tyn_ref bricks)
{
    tyn_path_params params;
    set_params(&params, job, &tyn_pass_path_probe);
    tyn_ref refs[PATH_PROBE_NUM_PORTS] = {
        [PATH_PROBE_PORT_POINTS] = job->refs.points,
        [PATH_PROBE_PORT_STATE] = tyn_graph_history_buffer(
            g, "path_probes", tyn_path_probe_state_size(job->view->num_points), 1),
    };
    connect_scene(refs, job, bricks);
    tyn_graph_add(g, &tyn_pass_path_probe, &params, refs);
    tyn_job_output(g, job, TYN_OUTPUT_PROBE, refs[PATH_PROBE_PORT_RESULTS]);
    tyn_job_counters(g, job, &tyn_pass_path_probe, refs[PATH_PROBE_PORT_COUNTERS]);
}

// The box that is balanced.
static void set_box(tyn_path_params *p, const tyn_frame_scene *frame)
{
    memset(p->box[0], 0, sizeof p->box[0]);
    memcpy(p->box[1], frame->medium.extent, sizeof p->box[1]);
    if (frame->num_triangles) {
        tyn_scene_box(frame, p->box[0], p->box[1]);
    }
}

// Power of the lamps inside the box, which count as emitted.
static void set_lamp_power(tyn_path_params *p, const tyn_frame_scene *frame)
{
    for (uint32_t i = 0; i < frame->lights.num_lamps; i++) {
        const struct light_block *l = &tyn_first_lamp(&frame->lights)[i];
        bool inside = true;
        for (int a = 0; a < 3; a++) {
            inside = inside && l->position[a] >= p->box[0][a] && l->position[a] <= p->box[1][a];
        }
        for (int c = 0; inside && c < 3; c++) {
            p->lamp_power[c] += l->color[c] * light_lobe_integral(*l);
        }
    }
}

// One `sample` of a balance is a dispatch of some thousand paths: as many as the time limit allows.
static void add_balance(tyn_graph *g, const tyn_job *job, tyn_ref bricks)
{
    enum { BALANCE_CHUNKS = 1, SOLID_CHUNKS = 4, CHUNK_MIN = 4096, CHUNK_MAX = 16384 };
    tyn_path_params params;
    set_params(&params, job, &tyn_pass_path_balance);
    set_box(&params, job->frame);
    set_lamp_power(&params, job->frame);
    double paths = DISPATCH_NS / path_cost_ns(job, params.homogeneous);
    params.chunks = params.triangles ? SOLID_CHUNKS : BALANCE_CHUNKS; // walls make more noise
    params.threads = 4096;
    params.num_samples = paths < CHUNK_MIN   ? CHUNK_MIN
                         : paths > CHUNK_MAX ? CHUNK_MAX
                                             : (uint32_t)paths;
    params.first_sample *= params.chunks * params.num_samples;
    tyn_ref refs[PATH_BALANCE_NUM_PORTS] = {
        [PATH_BALANCE_PORT_STATE] =
            tyn_graph_history_buffer(g, "path_balance", tyn_path_balance_state_size(), 1),
        [PATH_BALANCE_PORT_AREAS] = job->refs.areas,
    };
    connect_scene(refs, job, bricks);
    tyn_graph_add(g, &tyn_pass_path_balance, &params, refs);
    tyn_job_output(g, job, TYN_OUTPUT_BALANCE, refs[PATH_BALANCE_PORT_BALANCE]);
    tyn_job_counters(g, job, &tyn_pass_path_balance, refs[PATH_BALANCE_PORT_COUNTERS]);
}

// What paths from suns and surroundings do not carry.
static tyn_result check_fluxes(const tyn_job *job)
{
    const tyn_frame_scene *frame = job->frame;
    const struct medium_block *m = &frame->medium;
    const struct env_block *env = &frame->environment;
    const char *wrong = NULL;
    bool sky = env->radiance[0] + env->radiance[1] + env->radiance[2] > 0;
    if (frame->empty && !frame->num_triangles) {
        wrong = "there is no medium and no surface";
    } else if (frame->lights.num_lamps) {
        wrong =
            "there are lamps, whose light starts inside; only suns and the environment may shine "
            "(balance knows lamps)";
    } else if (frame->emissive || job->refs.emitters.resource) {
        wrong = "media or surfaces emit; only suns and the environment may shine (balance knows "
                "emission)";
    } else if (!frame->lights.num_directional && !sky) {
        wrong = "there is neither a sun nor an environment";
    } else if (m->repeat[0] && m->repeat[1] && m->repeat[2]) {
        wrong = "the medium repeats along all axes: no light enters it";
    }
    if (wrong) {
        tyn_log_print(job->log, TYN_LOG_ERROR, "output 'fluxes': %s", wrong);
    }
    return wrong ? TYN_ERR_UNSUPPORTED : TYN_OK;
}

static void add_fluxes(tyn_graph *g, const tyn_job *job, tyn_ref bricks)
{
    tyn_path_params params;
    set_params(&params, job, &tyn_pass_path_fluxes);
    set_box(&params, job->frame);
    params.threads = FLUX_THREADS;
    // A record's structure may not depend on the number of its samples.
    double paths = flux_paths(job, params.homogeneous);
    params.chunks = 1;
    while (params.chunks < FLUX_SAMPLE_PATHS && params.chunks * paths < FLUX_SAMPLE_PATHS) {
        params.chunks *= 2;
    }
    params.first_sample *= FLUX_SAMPLE_PATHS;
    params.num_samples *= FLUX_SAMPLE_PATHS / params.chunks;
    tyn_ref refs[PATH_FLUXES_NUM_PORTS] = {
        [PATH_FLUXES_PORT_STATE] =
            tyn_graph_history_buffer(g, "path_fluxes", tyn_path_fluxes_state_size(), 1),
    };
    connect_scene(refs, job, bricks);
    tyn_graph_refuse(g, check_fluxes(job));
    tyn_graph_add(g, &tyn_pass_path_fluxes, &params, refs);
    tyn_job_output(g, job, TYN_OUTPUT_FLUXES, refs[PATH_FLUXES_PORT_FLUXES]);
    tyn_job_counters(g, job, &tyn_pass_path_fluxes, refs[PATH_FLUXES_PORT_COUNTERS]);
}

// A periodic medium's own axes must be those of M; surfaces repeat with it, each copy in a period of its own.
static tyn_result check_repeat(const tyn_job *job)
{
    const struct medium_block *m = &job->frame->medium;
    const struct shape_block *s = &job->frame->shapes[0];
    bool repeat = m->repeat[0] || m->repeat[1] || m->repeat[2];
    for (int i = 0; repeat && i < 9; i++) {
        if (i / 3 != i % 3 && fabsf(s->rows[i / 3][i % 3]) * m->extent[i % 3] > 1e-4f) {
            tyn_log_print(job->log, TYN_LOG_ERROR,
                          "shape 0 repeats and is sheared; the axes of a periodic box must be at "
                          "right angles");
            return TYN_ERR_UNSUPPORTED;
        }
    }
    float lo[3], hi[3];
    tyn_surfaces_box(job->frame, lo, hi);
    for (int a = 0; repeat && a < 3; a++) {
        if (m->repeat[a] && hi[a] - lo[a] > 1.0001f * m->extent[a]) {
            tyn_log_print(job->log, TYN_LOG_ERROR,
                          "surfaces reach over %g m along the medium's axis %d, on which it "
                          "repeats every %g m; they repeat with it and must fit into one period",
                          (double)(hi[a] - lo[a]), a, (double)m->extent[a]);
            return TYN_ERR_PARAMS;
        }
    }
    return TYN_OK;
}

static void add_distances(tyn_graph *g, const tyn_job *job, tyn_view_inputs *in)
{
    const tyn_path_distance_params params = {job->view->width, job->view->height};
    tyn_ref refs[PATH_DISTANCE_NUM_PORTS] = {
        [PATH_DISTANCE_PORT_CAMERA] = job->refs.camera,
    };
    tyn_connect(refs, PATH_DISTANCE_PORT_SURFACES, job->refs.geometry);
    tyn_graph_add(g, &tyn_pass_path_distance, &params, refs);
    in->surface = refs[PATH_DISTANCE_PORT_RADIANCE];
    in->distances = refs[PATH_DISTANCE_PORT_DISTANCES];
}

// Depths have no noise to take away: the ray march finds them, and does nothing else here.
static void add_depth(tyn_graph *g, const tyn_job *job, const tyn_sources *s)
{
    if (tyn_is_periodic(job->frame)) {
        tyn_log_print(job->log, TYN_LOG_ERROR,
                      "the layer 'depth' does not know periodic media (\"repeat\"); leave it out");
        tyn_graph_refuse(g, TYN_ERR_PARAMS);
        return;
    }
    tyn_job depth = *job;
    depth.outputs = TYN_OUTPUT_DEPTH;
    depth.num_hooks = 0;
    const tyn_field no_field = {0};
    tyn_view_inputs view = {.sources = s, .field = &no_field};
    if (job->frame->num_triangles) {
        add_distances(g, &depth, &view);
    }
    tyn_add_picture(g, &depth, &view);
}

static tyn_result declare(tyn_graph *g, const tyn_job *job)
{
    const uint32_t not_images =
        TYN_OUTPUT_PROBE | TYN_OUTPUT_BALANCE | TYN_OUTPUT_DEPTH | TYN_OUTPUT_FLUXES;
    tyn_sources s = {0};
    tyn_result result = check_repeat(job);
    if (result != TYN_OK) {
        return result;
    }
    if (tyn_job_hooks_read(job)) {
        tyn_job_warn(job, "what stands between march and composite is left out: 'path' does not "
                          "march");
    }
    if (!job->frame->empty) {
        tyn_add_medium(g, job, &s);
    }
    if (job->outputs & ~not_images) {
        add_image(g, job, s.bricks);
    }
    if (job->outputs & TYN_OUTPUT_PROBE) {
        add_probes(g, job, s.bricks);
    }
    if (job->outputs & TYN_OUTPUT_DEPTH) {
        add_depth(g, job, &s);
    }
    if (job->outputs & TYN_OUTPUT_BALANCE) {
        add_balance(g, job, s.bricks);
    }
    if (job->outputs & TYN_OUTPUT_FLUXES) {
        add_fluxes(g, job, s.bricks);
    }
    return tyn_graph_status(g);
}

static const tyn_pass_desc *const passes[] = {
    TYN_MEDIUM_PASSES(TYN_PASS_ADDRESS),
    &tyn_pass_path,
    &tyn_pass_path_probe,
    &tyn_pass_path_balance,
    &tyn_pass_path_fluxes,
    &tyn_pass_path_distance,
    &tyn_pass_raymarch,
    &tyn_pass_tonemap,
    &tyn_pass_export,
    NULL,
};

static double ended(const tyn_regime *r)
{
    (void)r;
    return 0.1;
}

static const tyn_limit limits[] = {
    {.key = "samples",
     .where = {TYN_ABOVE(albedo, 0.99), TYN_ABOVE(transport_depth, 9.999)},
     .level = TYN_LIMIT_STRAINED,
     .advice = {"unbiased, but light scatters hundreds of times (albedo %.4g, %.4g transport mean "
                "free paths deep): samples are dear, and rare long paths make bright pixels",
                {TYN_FIGURE(albedo), TYN_FIGURE(transport_depth)}},
     .source = "docs/choosing.md, \"Samples\""},
    {.key = "samples",
     .advice = {"unbiased: only the number of samples decides"},
     .source = "docs/choosing.md, \"Samples\""},
    {.key = "paths that are ended",
     .where = {TYN_ABOVE(depth, 1e5), TYN_ABOVE(scaled_albedo, 0.9999)},
     .error = ended,
     .warning = {"accuracy: the medium is %.2g mean free paths deep and absorbs next to nothing; "
                 "paths end after so many steps (-D path.max_steps), what is left of them is lost",
                 {TYN_FIGURE(depth)}},
     .source = "docs/stress.md, \"What is found\""},
    TYN_LIMIT_FLOATS,
    {NULL},
};

const tyn_method tyn_method_path = {
    .info = {.name = "path",
             .summary = "unbiased path tracing: the reference",
             .passes = passes,
             .outputs = TYN_OUTPUT_RADIANCE | TYN_OUTPUT_TRANSMITTANCE | TYN_OUTPUT_DEPTH |
                        TYN_OUTPUT_SINGLE | TYN_OUTPUT_MULTIPLE | TYN_OUTPUT_ERROR |
                        TYN_OUTPUT_DISPLAY | TYN_OUTPUT_PROBE | TYN_OUTPUT_BALANCE |
                        TYN_OUTPUT_FLUXES,
             .progressive = true,
             .traces_rays = true,
             .reference = true,
             .limits = limits},
    .reads_env_cdf = true,
    .batch = batch,
    .declare = declare,
};
