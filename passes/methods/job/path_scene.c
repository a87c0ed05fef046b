// path_scene.c -- see tyndall/extend/path_scene.h.
#include <tyndall/extend/path_scene.h>
#include "scene/matrix.h"
#include "scene/phase.h"
#include "shaders/common/bundles.h"
#include <math.h>

// ---- what a path costs ------------------------------------------------------------------------

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

// Directions that the phase function draws alone are as good at equal time where it is not so forward.
static bool is_forward(const tyn_job *job)
{
    float least, most;
    tyn_range_of_g(job->scene, &least, &most);
    return most > 0.65f;
}

// Threads of a card that equal two cores: 490 in `room`, 10 to 200 in seven other scenes (NVIDIA H200). With twice the most a
// picture's first record is rather too short.
static const double THREADS_OF_TWO_CORES = 1000;

// Nanoseconds of a path on two cores of a software device: measured 90 for the unit cube at sigma_s 4, 700 for a
// thin 64^3 grid; the estimate is up to twice that. In a medium that
// absorbs nothing the mean way of light between entering and leaving is 4 V / S whatever the scattering, so the
// number of collisions follows from the densest extinction.
static double software_cost_ns(const tyn_job *job, bool homogeneous)
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
    cost += is_forward(job) ? 100 * collisions : 0; // for the guide
    if (job->frame->num_triangles) {
        // A ray to find the end of a flight and one for shadow, at every vertex.
        cost += 2 * collisions * ray_cost_ns(job->frame);
        cost *= 1 + count_reflections(&job->scene->surfaces);
    }
    // Paths that start inside have to find their way out of the thick of it.
    cost *= job->outputs & (TYN_OUTPUT_PROBE | TYN_OUTPUT_BALANCE) ? 2 + 0.5 * bound * chord : 1;
    return job->frame->grey ? cost : 2 * cost;
}

double tyn_path_cost_ns(const tyn_job *job, bool homogeneous)
{
    enum { LEAST_NS = 20 }; // of a path that meets nothing
    const double cost = software_cost_ns(job, homogeneous);
    return job->capacity.software
               ? cost
               : fmax(cost, LEAST_NS) * THREADS_OF_TWO_CORES / job->capacity.threads;
}

double tyn_path_dispatch_ns(const tyn_job *job)
{
    return 1e6 * tyn_dispatch_size_of(&job->capacity, TYN_SIZE_DISPATCH_MS);
}

// ---- parameters -------------------------------------------------------------------------------

static bool has_grids(const tyn_job *job)
{
    const tyn_scene *scene = job->scene;
    for (uint32_t i = 0; i < scene->num_shapes; i++) {
        const tyn_medium *m = &scene->media[scene->shapes[i].medium];
        if (m->volume >= 0 || m->emission_grid || m->radiance_grid || m->albedo_grid) {
            return true;
        }
    }
    return false;
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

void tyn_path_scene(const tyn_job *job, tyn_path_params *p)
{
    const tyn_frame_scene *frame = job->frame;
    const struct medium_block *m = &frame->medium;
    const struct env_block *env = &frame->environment;
    const tyn_view *view = job->view;
    p->seed = view->seed;
    p->first_sample = view->first_sample;
    p->num_samples = view->num_samples ? view->num_samples : 1;
    p->max_depth = view->max_depth;
    p->rr_depth = view->rr_depth;
    p->homogeneous = frame->empty || (m->num_shapes == 1 && !has_grids(job));
    bool sphere = frame->shapes[0].kind == TYN_SHAPE_KIND_SPHERE;
    p->num_shapes = frame->empty ? 1 : m->num_shapes;
    p->sphere = sphere && p->num_shapes == 1;
    p->grey = p->one_phase = 1;
    p->glow = p->albedo = 0;
    float sigma_t = 0;
    for (uint32_t i = 0; i < m->num_shapes; i++) {
        const struct shape_block *s = &frame->shapes[i];
        p->one_phase = p->one_phase && tyn_phase_is_grey(s->phase);
        p->grey = p->grey && p->one_phase && vec_grey(s->sigma_s) && vec_grey(s->sigma_a);
        sigma_t = fmaxf(sigma_t, s->sigma_s[1] + s->sigma_a[1]);
        p->glow |= s->colors[TYN_COLORS_EMISSION].size[0] || s->colors[TYN_COLORS_RADIANCE].size[0];
        p->albedo |= s->colors[TYN_COLORS_ALBEDO].size[0] > 0;
    }
    p->grey = p->grey && !p->albedo;
    p->tabled = job->refs.phases.resource != 0;
    p->guide = is_forward(job) ? p->guide : TYN_PATH_GUIDE_NONE;
    p->repeat = tyn_is_periodic(frame);
    p->triangles = frame->num_triangles;
    p->textures = frame->num_textures;
    p->keep_few = job->capacity.software;
    p->short_loops = job->capacity.short_loops;
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

// ---- refs -------------------------------------------------------------------------------------

enum { TYN_PATH_SCENE(TYN_PORT_ENUM, SCENE) };

void tyn_connect_path_scene(tyn_ref *refs, const tyn_job *job, tyn_ref bricks)
{
    refs[SCENE_PORT_ATLAS] = job->refs.atlas;
    refs[SCENE_PORT_MEDIUM] = job->refs.medium;
    refs[SCENE_PORT_SHAPES] = job->refs.shapes;
    refs[SCENE_PORT_BRICKS] = bricks;
    refs[SCENE_PORT_LIGHTS] = job->refs.lights;
    refs[SCENE_PORT_ENVIRONMENT] = job->refs.environment;
    refs[SCENE_PORT_ENV_MAP] = job->refs.env_map;
    refs[SCENE_PORT_ENV_TABLE] = job->refs.env_cdf;
    tyn_connect(refs, SCENE_PORT_SURFACES, job->refs.geometry);
    tyn_connect(refs, SCENE_PORT_MATERIALS, job->refs.materials);
    refs[SCENE_PORT_EMITTERS] = job->refs.emitters;
    refs[SCENE_PORT_COLORS] = job->refs.colors;
    refs[SCENE_PORT_PHASES] = job->refs.phases;
}
