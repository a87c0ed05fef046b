// photon.c -- see photon.h.
#include "solve/photon.h"
#include "base/hash.h"
#include "job/path_scene.h"
#include <tyndall/registry.h>
#include <math.h>
#include <string.h>

// Area of the box across light along `way`, m^2.
static float area_across(const tyn_path_params *p, const float way[3])
{
    float size[3], sum = 0;
    for (int a = 0; a < 3; a++) {
        size[a] = p->box[1][a] - p->box[0][a];
    }
    for (int a = 0; a < 3; a++) {
        sum += fabsf(way[a]) * size[(a + 1) % 3] * size[(a + 2) % 3];
    }
    return sum;
}

static float largest(const float v[3])
{
    return fmaxf(v[0], fmaxf(v[1], v[2]));
}

// What photons are drawn by, W (photon_trace_start.glsl), rounded up to a power of two: the cache's unit hangs on it.
static float power_of_lights(const tyn_frame_scene *frame, const tyn_path_params *p)
{
    const float pi = 3.14159265f, all[3] = {1, 1, 1};
    float power = pi * largest(frame->environment.mean) * area_across(p, all);
    for (uint32_t i = 0; i < p->num_lights; i++) {
        const struct light_block *l = &frame->lights.scene[i];
        power += largest(l->color) * (l->kind == TYN_LIGHT_KIND_DIRECTIONAL
                                          ? area_across(p, l->direction)
                                          : 2 * pi * (1 - l->cos_outer));
    }
    return power > 0 ? exp2f(ceilf(log2f(power))) : 0;
}

// Of extinction, what similarity leaves at most.
static float reduced_extinction(const tyn_frame_scene *frame, int32_t similarity)
{
    float most = 0;
    for (uint32_t i = 0; i < frame->medium.num_shapes; i++) {
        const struct shape_block *s = &frame->shapes[i];
        for (int c = 0; c < 3; c++) {
            float share = 1 - fmaxf((float)tyn_phase_mean_cosine(s->phase[c]), 0);
            share = similarity == TYN_PHOTON_SIMILARITY_PRINTED ? sqrtf(share) : share;
            const float all = s->sigma_a[c] + s->sigma_s[c];
            // Channels share one bound, that of the largest.
            most = fmaxf(most, all > 0 ? (s->sigma_a[c] + share * s->sigma_s[c]) / all : 0);
        }
    }
    return fminf(most, 1);
}

// Photons of a dispatch, by powers of two: as many as the time limit allows.
static uint32_t batch_of(const tyn_job *job, const tyn_photon_trace_params *p)
{
    enum { LEAST = 1024, MOST = 65536 };
    const double cost = 4 * tyn_path_cost_ns(job, false);
    const double all = (double)p->photons * p->generations;
    uint32_t batch = LEAST;
    while ((batch < MOST && 2 * batch * cost < TYN_PATH_DISPATCH_NS) ||
           batch * (double)TYN_PHOTON_DISPATCHES < all) {
        batch *= 2;
    }
    return batch;
}

static void set_sun(const tyn_frame_scene *frame, tyn_photon_trace_params *p)
{
    const tyn_lights *lights = &frame->lights;
    p->sun_cosine = 2; // nothing is within it
    if (lights->num_suns) {
        memcpy(p->sun, lights->suns[0].direction, sizeof p->sun);
        // Of a disc with this mean cosine the rim's.
        p->sun_cosine = 2 * fminf(lights->suns[0].mean_cosine, 1) - 1 - 1e-5f;
    }
}

static void set_params(const tyn_job *job, const tyn_sources *s, tyn_photon_trace_params *p)
{
    const tyn_frame_scene *frame = job->frame;
    tyn_settings_params(job->settings, &tyn_pass_photon_trace, p);
    p->shape = s->lattice.shape;
    tyn_path_scene(job, &p->path);
    p->path.max_steps = 1;    // counted in turns of a thread instead
    p->path.first_sample = 0; // nothing of these is read
    p->path.num_samples = 0;
    p->path.layers = p->path.opaque = p->path.scattered = 0;
    memcpy(p->path.box[1], frame->medium.extent, sizeof p->path.box[1]);
    if (frame->num_triangles) {
        tyn_scene_box(frame, p->path.box[0], p->path.box[1]);
    }
    set_sun(frame, p);
    p->power = power_of_lights(frame, &p->path);
    p->reduced = reduced_extinction(frame, p->similarity);
    p->batch = batch_of(job, p);
    const int32_t each = p->renewed < p->generations ? p->renewed : p->generations;
    p->settles = (uint32_t)((p->generations + each - 1) / each - 1);
}

// What may not change without all generations being made anew. What moves and glows may.
static uint64_t key_of(const tyn_job *job, const tyn_photon_trace_params *p)
{
    uint64_t key = tyn_hash_u64(TYN_HASH_SEED, job->view->cut);
    key = tyn_hash_bytes(key, &p->shape, sizeof p->shape);
    key = tyn_hash_bytes(key, p->path.box, sizeof p->path.box);
    key = tyn_hash_bytes(key, &p->power, sizeof p->power);
    const int32_t settings[] = {p->photons, p->generations, p->renewed, p->similarity};
    key = tyn_hash_bytes(key, settings, sizeof settings);
    const uint32_t kinds[] = {p->path.num_shapes,  p->path.num_lights, p->path.num_lamps,
                              p->path.environment, p->path.seed,       p->path.triangles};
    return tyn_hash_bytes(key, kinds, sizeof kinds);
}

static void add_view(tyn_graph *g, const tyn_job *job, const tyn_sources *s,
                     const tyn_photon_trace_params *trace, tyn_ref light, tyn_field *field)
{
    const struct medium_block *m = &job->frame->medium;
    tyn_photon_upsample_params up;
    tyn_settings_params(job->settings, &tyn_pass_photon_upsample, &up);
    up.shape = s->lattice.shape;
    up.mode = m->mode;
    up.majorant = job->frame->majorant;
    const uint32_t most = m->size[0] > m->size[1] ? m->size[0] : m->size[1];
    const uint32_t voxels = most > m->size[2] ? most : m->size[2];
    const int32_t least = 2 * s->lattice.shape.cells;
    const int32_t wanted = (int32_t)voxels > least ? (int32_t)voxels : least;
    up.cells = up.cells < wanted ? up.cells : wanted;
    up.cells = tyn_lattice_fit(s->lattice.shape.extent, s->lattice.shape.repeat, up.cells);
    tyn_ref refs[TYN_MAX_PORTS] = {
        [PHOTON_UPSAMPLE_PORT_CELLS] = s->lattice.cells, [PHOTON_UPSAMPLE_PORT_LIGHT] = light};
    tyn_connect(refs, PHOTON_UPSAMPLE_PORT_MEDIUM, s->medium);
    tyn_graph_add(g, &tyn_pass_photon_upsample, &up, refs);
    tyn_photon_view_params view;
    tyn_settings_params(job->settings, &tyn_pass_photon_view, &view);
    view.mode = m->mode;
    memcpy(view.sun, trace->sun, sizeof view.sun);
    tyn_ref eye[TYN_MAX_PORTS] = {
        [PHOTON_VIEW_PORT_CAMERA] = job->refs.camera,
        [PHOTON_VIEW_PORT_SUN_LIGHT] = refs[PHOTON_UPSAMPLE_PORT_SUN_LIGHT],
        [PHOTON_VIEW_PORT_SKY_LIGHT] = refs[PHOTON_UPSAMPLE_PORT_SKY_LIGHT],
        [PHOTON_VIEW_PORT_SKY_WAY] = refs[PHOTON_UPSAMPLE_PORT_SKY_WAY],
    };
    tyn_connect(eye, PHOTON_VIEW_PORT_MEDIUM, s->medium);
    tyn_graph_add(g, &tyn_pass_photon_view, &view, eye);
    tyn_job_counters(g, job, &tyn_pass_photon_view, eye[PHOTON_VIEW_PORT_COUNTERS]);
    field->inscatter = eye[PHOTON_VIEW_PORT_INSCATTER];
    field->inscatter_is = TYN_INSCATTER_PLAIN;
    field->cell = s->lattice.side * (float)s->lattice.shape.cells / (float)up.cells;
}

void tyn_solve_photon(tyn_graph *g, const tyn_job *job, const tyn_sources *s, tyn_field *field)
{
    tyn_photon_trace_params trace;
    set_params(job, s, &trace);
    const uint64_t key = key_of(job, &trace);
    tyn_ref refs[TYN_MAX_PORTS] = {[PHOTON_TRACE_PORT_RING] = tyn_graph_history_buffer(
                                       g, "photon_ring", tyn_photon_ring_size(&trace), key)};
    tyn_connect_path_scene(refs, job, s->bricks);
    tyn_graph_add(g, &tyn_pass_photon_trace, &trace, refs);
    tyn_job_counters(g, job, &tyn_pass_photon_trace, refs[PHOTON_TRACE_PORT_COUNTERS]);

    tyn_photon_cache_params cache;
    tyn_settings_params(job->settings, &tyn_pass_photon_cache, &cache);
    cache.shape = s->lattice.shape;
    cache.generations = (uint32_t)trace.generations;
    cache.slots = cache.generations +
                  (uint32_t)(trace.renewed < trace.generations ? trace.renewed : trace.generations);
    memcpy(cache.sun, trace.sun, sizeof cache.sun);
    cache.unit = 1 / tyn_photon_units(&trace);
    tyn_ref sums[TYN_MAX_PORTS] = {
        [PHOTON_CACHE_PORT_MEDIUM] = job->refs.medium,
        [PHOTON_CACHE_PORT_RING] = refs[PHOTON_TRACE_PORT_RING],
        [PHOTON_CACHE_PORT_SUM] =
            tyn_graph_history_buffer(g, "photon_sum", tyn_photon_sum_size(&trace), key),
    };
    tyn_graph_add(g, &tyn_pass_photon_cache, &cache, sums);
    tyn_job_counters(g, job, &tyn_pass_photon_cache, sums[PHOTON_CACHE_PORT_COUNTERS]);
    field->moments = sums[PHOTON_CACHE_PORT_MOMENTS];
    field->cell = s->lattice.side;
    field->one_channel = false;
    field->tint[0] = field->tint[1] = field->tint[2] = 1;
    if (job->outputs & TYN_PICTURE_OUTPUTS) {
        add_view(g, job, s, &trace, sums[PHOTON_CACHE_PORT_LIGHT], field);
    }
}
