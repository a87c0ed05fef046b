// path.c -- method "path": unbiased path tracing, the reference that the other methods are judged by.
#include <tyndall/extend/limits.h>
#include <tyndall/extend/method.h>
#include <tyndall/extend/path_scene.h>
#include "shaders/path/path_args.h"
#include "base/fault.h"
#include "passes/methods/view/view.h"
#include <tyndall/registry.h>
#include <math.h>
#include <string.h>

// ---- parameters -------------------------------------------------------------------------------

static uint32_t size_of(const tyn_job *job, tyn_dispatch_size which)
{
    return tyn_dispatch_size_of(&job->capacity, which);
}

// Pixels or points.
static double count_elements(const tyn_job *job, const tyn_pass_desc *pass)
{
    const tyn_view *view = job->view;
    return pass == &tyn_pass_path_probe ? view->num_points : (double)view->width * view->height;
}

// Threads of a dispatch, by halves: they are part of the frame's structure.
static uint32_t count_threads(const tyn_job *job, const tyn_pass_desc *pass, bool homogeneous)
{
    const uint32_t least = size_of(job, TYN_SIZE_PATH_LONG);
    const double cost = tyn_path_cost_ns(job, homogeneous),
                 most = count_elements(job, pass) * size_of(job, TYN_SIZE_PATH_SLOTS);
    uint32_t threads = size_of(job, TYN_SIZE_PATH_THREADS);
    while (threads > least && threads * cost > tyn_path_dispatch_ns(job)) {
        threads /= 2;
    }
    return threads < most ? threads : (uint32_t)most;
}

// Of a tracing pass; `threads` are those of images and probes.
static void set_params(tyn_path_params *p, const tyn_job *job, const tyn_pass_desc *pass)
{
    tyn_settings_params(job->settings, pass, p);
    tyn_path_scene(job, p);
    p->threads = p->threads ? p->threads : count_threads(job, pass, p->homogeneous);
}

// Balance: paths of a sample in each of its dispatches, within these as many as there is time for.
enum { BALANCE_CHUNKS = 1, SOLID_CHUNKS = 4, CHUNK_MIN = 4096, CHUNK_MAX = 16384 };

static void set_balance_params(tyn_path_params *p, const tyn_job *job)
{
    set_params(p, job, &tyn_pass_path_balance);
    const double paths = tyn_path_dispatch_ns(job) / tyn_path_cost_ns(job, p->homogeneous);
    p->chunks = p->triangles ? SOLID_CHUNKS : BALANCE_CHUNKS; // walls make more noise
    p->threads = size_of(job, TYN_SIZE_BALANCE_THREADS);
    p->paths = paths < CHUNK_MIN ? CHUNK_MIN : paths > CHUNK_MAX ? CHUNK_MAX : (uint32_t)paths;
}

// Fluxes: of a sample. On a processor few threads have many each: those that have their last path wait for the longest.
enum { FLUX_PATHS = 4096 };

// ---- what a record may be asked for -----------------------------------------------------------

typedef struct sample_work {
    double paths;    // of a sample
    double together; // of these in a dispatch
    double most;     // samples
} sample_work;

static sample_work work_of(const tyn_job *job, tyn_path_params *p)
{
    if (job->outputs & TYN_OUTPUT_BALANCE) {
        set_balance_params(p, job);
        return (sample_work){(double)p->paths * p->chunks, p->paths,
                             size_of(job, TYN_SIZE_BALANCE_SAMPLES)};
    }
    if (job->outputs & TYN_OUTPUT_FLUXES) {
        set_params(p, job, &tyn_pass_path_fluxes);
        return (sample_work){FLUX_PATHS, FLUX_PATHS, 1024};
    }
    const tyn_pass_desc *pass =
        job->outputs & TYN_OUTPUT_PROBE ? &tyn_pass_path_probe : &tyn_pass_path;
    set_params(p, job, pass);
    const double elements = count_elements(job, pass);
    return (sample_work){elements, fmin(elements, p->threads), 1e6};
}

// Samples of a record that keep its dispatches and itself short.
static uint32_t batch(const tyn_job *job)
{
    tyn_path_params p;
    const sample_work work = work_of(job, &p);
    const double cost = job->sample_ms > 0 ? 1e6 * job->sample_ms / work.paths
                                           : tyn_path_cost_ns(job, p.homogeneous);
    // A card of another kind may be far slower than foretold.
    const double part = job->sample_ms > 0 || job->capacity.software ? 1 : 0.125;
    const double samples =
        part * fmin(tyn_path_dispatch_ns(job) / (cost * work.together),
                    1e6 * size_of(job, TYN_SIZE_RECORD_MS) / (cost * work.paths));
    return samples < 1 ? 1 : (uint32_t)fmin(samples, work.most);
}

// ---- nodes ------------------------------------------------------------------------------------

static tyn_ref history(tyn_graph *g, const char *name, uint32_t width, uint32_t height)
{
    return tyn_graph_history_image(g, name, TYN_IMAGE_2D, VK_FORMAT_R32G32B32A32_SFLOAT,
                                   (tyn_extent){width, height, 1}, 1);
}

// Surfaces make noise of their own, and in thin media a path scatters about once.
static bool wants_guide(const tyn_job *job, const tyn_path_params *params)
{
    return params->guide == TYN_PATH_GUIDE_FIELD && !job->frame->empty && !params->triangles &&
           !params->repeat && !params->tabled && params->stretch <= 1;
}

bool tyn_path_wants_guide(const tyn_job *job)
{
    tyn_path_params params;
    set_params(&params, job, &tyn_pass_path);
    return wants_guide(job, &params);
}

// What the paths of an image are guided by: the job's, or pop's, whose warnings do not concern this picture.
static bool add_guide(tyn_graph *g, const tyn_job *job, tyn_ref guide[2])
{
    memcpy(guide, job->refs.guide, sizeof job->refs.guide);
    if (!guide[0].resource) {
        tyn_job pop = *job;
        tyn_ref made[TYN_NUM_OUTPUTS];
        pop.outputs = 0;
        pop.guide = guide;
        pop.warn = NULL;
        tyn_graph_aid(g, true);
        tyn_job_declare(g, &pop, "pop", made);
        tyn_graph_aid(g, false);
    }
    return guide[0].resource != 0;
}

static void add_image(tyn_graph *g, const tyn_job *job, tyn_ref bricks)
{
    tyn_path_params params;
    set_params(&params, job, &tyn_pass_path);
    params.sample_offset = job->view->sample_offset;
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
    if (job->refs.field[0].resource) {
        params.ended = 1;
        memcpy(&refs[PATH_PORT_FIELD_RED], job->refs.field, sizeof job->refs.field);
    }
    params.field = wants_guide(job, &params) && add_guide(g, job, &refs[PATH_PORT_GUIDE_SCATTERED]);
    const tyn_resume *resume = job->view->resume;
    if (resume) {
        params.resumed = job->view->first_sample == resume->num_samples;
        memcpy(&refs[PATH_PORT_RESUMED], job->refs.resumed, sizeof job->refs.resumed);
        for (int port = PATH_PORT_RESUMED_SINGLE; port <= PATH_PORT_RESUMED_TRANSMITTANCE; port++) {
            if (params.layers && !refs[port].resource) { // nobody asks for this layer
                refs[port] = refs[PATH_PORT_RESUMED];
            }
        }
    }
    tyn_connect_path_scene(refs, job, bricks);
    tyn_graph_add(g, &tyn_pass_path, &params, refs);
    tyn_job_output(g, job, TYN_OUTPUT_RADIANCE, refs[PATH_PORT_RADIANCE]);
    tyn_job_output(g, job, TYN_OUTPUT_ERROR, refs[PATH_PORT_ERROR]);
    tyn_job_output(g, job, TYN_OUTPUT_LOW, refs[PATH_PORT_LOW]);
    tyn_job_output(g, job, TYN_OUTPUT_DEVIATION, refs[PATH_PORT_DEVIATION]);
    tyn_job_output(g, job, TYN_OUTPUT_SINGLE, refs[PATH_PORT_SINGLE]);
    tyn_job_output(g, job, TYN_OUTPUT_MULTIPLE, refs[PATH_PORT_MULTIPLE]);
    tyn_job_output(g, job, TYN_OUTPUT_TRANSMITTANCE, refs[PATH_PORT_TRANSMITTANCE]);
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
    tyn_connect_path_scene(refs, job, bricks);
    tyn_graph_add(g, &tyn_pass_path_probe, &params, refs);
    tyn_job_output(g, job, TYN_OUTPUT_PROBE, refs[PATH_PROBE_PORT_RESULTS]);
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

static void add_balance(tyn_graph *g, const tyn_job *job, tyn_ref bricks)
{
    tyn_path_params params;
    set_balance_params(&params, job);
    set_box(&params, job->frame);
    set_lamp_power(&params, job->frame);
    tyn_ref refs[PATH_BALANCE_NUM_PORTS] = {
        [PATH_BALANCE_PORT_STATE] =
            tyn_graph_history_buffer(g, "path_balance", sizeof(struct path_balance_state), 1),
        [PATH_BALANCE_PORT_AREAS] = job->refs.areas,
    };
    tyn_connect_path_scene(refs, job, bricks);
    tyn_graph_add(g, &tyn_pass_path_balance, &params, refs);
    tyn_job_output(g, job, TYN_OUTPUT_BALANCE, refs[PATH_BALANCE_PORT_BALANCE]);
}

// What paths from suns and surroundings do not carry.
static tyn_result check_fluxes(const tyn_job *job)
{
    const tyn_frame_scene *frame = job->frame;
    const struct medium_block *m = &frame->medium;
    const struct env_block *env = &frame->environment;
    const char *wrong = NULL;
    if (frame->empty && !frame->num_triangles) {
        wrong = "there is no medium and no surface";
    } else if (frame->lights.num_lamps) {
        wrong =
            "there are lamps, whose light starts inside; only suns and the environment may shine "
            "(balance knows lamps)";
    } else if (frame->emissive || job->refs.emitters.resource) {
        wrong = "media or surfaces emit; only suns and the environment may shine (balance knows "
                "emission)";
    } else if (!frame->lights.num_directional && !tyn_is_lit(env->radiance)) {
        wrong = "there is neither a sun nor an environment";
    } else if (m->repeat[0] && m->repeat[1] && m->repeat[2]) {
        wrong = "the medium repeats along all axes: no light enters it";
    }
    return wrong ? TYN_FAULT(job->log, TYN_ERR_UNSUPPORTED, "output 'fluxes': %s", wrong) : TYN_OK;
}

static void add_fluxes(tyn_graph *g, const tyn_job *job, tyn_ref bricks)
{
    tyn_path_params params;
    set_params(&params, job, &tyn_pass_path_fluxes);
    set_box(&params, job->frame);
    params.threads = size_of(job, TYN_SIZE_FLUX_THREADS);
    // A record's structure may not depend on the number of its samples.
    const uint32_t each = FLUX_PATHS / params.threads;
    const double paths =
        tyn_path_dispatch_ns(job) / (tyn_path_cost_ns(job, params.homogeneous) * params.threads);
    params.chunks = 1;
    while (params.chunks < each && params.chunks * paths < each) {
        params.chunks *= 2;
    }
    params.first_sample *= each;
    params.num_samples *= each / params.chunks;
    tyn_ref refs[PATH_FLUXES_NUM_PORTS] = {
        [PATH_FLUXES_PORT_STATE] =
            tyn_graph_history_buffer(g, "path_fluxes", sizeof(struct path_fluxes_state), 1),
    };
    tyn_connect_path_scene(refs, job, bricks);
    tyn_graph_refuse(g, check_fluxes(job));
    tyn_graph_add(g, &tyn_pass_path_fluxes, &params, refs);
    tyn_job_output(g, job, TYN_OUTPUT_FLUXES, refs[PATH_FLUXES_PORT_FLUXES]);
}

// A periodic medium's own axes must be those of M; surfaces repeat with it, each copy in a period of its own.
static tyn_result check_repeat(const tyn_job *job)
{
    const struct medium_block *m = &job->frame->medium;
    if (tyn_is_periodic(job->frame) && tyn_is_sheared(job->frame)) {
        return TYN_FAULT(job->log, TYN_ERR_UNSUPPORTED,
                         "shape 0 repeats and is sheared; the axes of a periodic box must be at "
                         "right angles");
    }
    float lo[3], hi[3];
    tyn_surfaces_box(job->frame, lo, hi);
    for (int a = 0; a < 3; a++) {
        if (m->repeat[a] && hi[a] - lo[a] > 1.0001f * m->extent[a]) {
            return TYN_FAULT(job->log, TYN_ERR_PARAMS,
                             "surfaces reach over %g m along the medium's axis %d, on which it "
                             "repeats every %g m; they repeat with it and must fit into one period",
                             (double)(hi[a] - lo[a]), a, (double)m->extent[a]);
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
    in->seen = refs[PATH_DISTANCE_PORT_SEEN];
}

// Depths have no noise to take away: the ray march finds them, and does nothing else here.
static void add_depth(tyn_graph *g, const tyn_job *job, const tyn_sources *s)
{
    if (tyn_is_periodic(job->frame)) {
        tyn_graph_refuse(
            g,
            TYN_FAULT(job->log, TYN_ERR_PARAMS,
                      "the layer 'depth' does not know periodic media (\"repeat\"); leave it out"));
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
    const uint32_t not_images = TYN_OUTPUT_PROBE | TYN_OUTPUT_BALANCE | TYN_OUTPUT_DEPTH |
                                TYN_OUTPUT_FLUXES | TYN_GUIDE_OUTPUTS;
    tyn_sources s = {0};
    TYN_TRY(check_repeat(job));
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
    tyn_add_guides(g, job);
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

static const char *const passes[] = {
    TYN_MEDIUM_PASSES(TYN_PASS_NAME),
    TYN_SUN_PASSES(TYN_PASS_NAME),
    TYN_VIRTUAL_LIGHT_PASSES(TYN_PASS_NAME),
    TYN_SKY_PASSES(TYN_PASS_NAME),
    TYN_LAMP_PASSES(TYN_PASS_NAME),
    TYN_CELL_PASSES(TYN_PASS_NAME),
    TYN_LATTICE_PASSES(TYN_PASS_NAME),
    TYN_FIELD_PASSES(TYN_PASS_NAME),
    "path",
    "path_probe",
    "path_balance",
    "path_fluxes",
    "path_distance",
    "gbuffer",
    "guides",
    "raymarch",
    "tonemap",
    "export",
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

static const tyn_promise promise = {.furnace = 1e-4,
                                    .cube_forward = 0.001,
                                    .slabs = 2e-4,
                                    .half_space = 7e-4,
                                    .airlight = 1e-3,
                                    .point_source = 0.002,
                                    .energy = 0.01};

const tyn_method tyn_method_path = {
    .info = {.name = "path",
             .summary = "unbiased path tracing: the reference",
             .outputs = TYN_OUTPUT_RADIANCE | TYN_OUTPUT_TRANSMITTANCE | TYN_OUTPUT_DEPTH |
                        TYN_OUTPUT_SINGLE | TYN_OUTPUT_MULTIPLE | TYN_OUTPUT_ERROR |
                        TYN_OUTPUT_DISPLAY | TYN_OUTPUT_PROBE | TYN_OUTPUT_BALANCE |
                        TYN_OUTPUT_FLUXES | TYN_OUTPUT_LOW | TYN_OUTPUT_DEVIATION |
                        TYN_OUTPUT_ALBEDO | TYN_OUTPUT_NORMAL,
             .progressive = true,
             .traces_rays = true,
             .reference = true,
             .phases = TYN_PHASES_ALL,
             .limits = limits,
             .promise = &promise},
    .reads_env_cdf = true,
    .batch = batch,
    .passes = passes,
    .declare = declare,
};
