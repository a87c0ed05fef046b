// solve.c -- see solve.h.
#include "solve.h"
#include <tyndall/extend/hash.h>
#include <tyndall/extend/path_scene.h>
#include <tyndall/extend/map_light.h>
#include "common/photon_args.h"
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
    float power = pi * (largest(frame->environment.mean) * area_across(p, all) +
                        2 * frame->emitters); // of both sides
    for (uint32_t i = 0; i < p->num_lights; i++) {
        const struct light_block *l = &frame->lights.scene[i];
        power += largest(l->color) * (l->kind == TYN_LIGHT_KIND_DIRECTIONAL
                                          ? area_across(p, l->direction)
                                          : 2 * pi * (1 - l->cos_outer));
    }
    return power > 0 ? exp2f(ceilf(log2f(power))) : 0;
}

// Of extinction, what delta scaling leaves at most, and what similarity leaves then.
static float scaled_extinction(const tyn_frame_scene *frame)
{
    float most = 0;
    for (uint32_t i = 0; i < frame->medium.num_shapes; i++) {
        const struct shape_block *s = &frame->shapes[i];
        for (int c = 0; c < 3; c++) {
            const float f = (float)tyn_phase_delta_fraction(s->phase[c]);
            const float all = s->sigma_a[c] + s->sigma_s[c];
            // Channels share one bound, that of the largest.
            most = fmaxf(most, all > 0 ? (s->sigma_a[c] + (1 - f) * s->sigma_s[c]) / all : 0);
        }
    }
    return fminf(most, 1);
}

static float reduced_extinction(const tyn_frame_scene *frame, int32_t similarity, bool scaled)
{
    float most = 0;
    for (uint32_t i = 0; i < frame->medium.num_shapes; i++) {
        const struct shape_block *s = &frame->shapes[i];
        for (int c = 0; c < 3; c++) {
            const float g = fmaxf((float)tyn_phase_mean_cosine(s->phase[c]), 0);
            float share = 1 - (scaled ? g / (1 + g) : g);
            share = similarity == TYN_PHOTON_SIMILARITY_PRINTED ? sqrtf(share) : share;
            share *= scaled ? 1 - (float)tyn_phase_delta_fraction(s->phase[c]) : 1;
            const float all = s->sigma_a[c] + s->sigma_s[c];
            most = fmaxf(most, all > 0 ? (s->sigma_a[c] + share * s->sigma_s[c]) / all : 0);
        }
    }
    return fminf(most, 1);
}

// Photons of a dispatch, by powers of two: as many as the time limit allows.
static uint32_t batch_of(const tyn_job *job, const tyn_photon_trace_params *p)
{
    const uint32_t most = tyn_dispatch_size_of(&job->capacity, TYN_SIZE_PHOTONS_MOST);
    const double cost = 4 * tyn_path_cost_ns(job, false);
    const double all = (double)p->photons * p->generations;
    uint32_t batch = tyn_dispatch_size_of(&job->capacity, TYN_SIZE_PHOTONS_LEAST);
    while ((batch < most && 2 * batch * cost < tyn_path_dispatch_ns(job)) ||
           batch * (double)TYN_PHOTON_DISPATCHES < all) {
        batch *= 2;
    }
    return batch;
}

// How many lobes there is light for: of suns, of the map's regions, of all other.
static uint32_t fit_lobes(const tyn_job *job, tyn_photon_trace_params *p)
{
    const tyn_lights *lights = &job->frame->lights;
    const bool sky = tyn_is_lit(job->frame->environment.mean);
    const bool map = sky && job->frame->environment.has_map;
    const uint32_t suns =
        lights->num_directional > 0 ? lights->num_directional : lights->num_suns > 0;
    const uint32_t useful =
        map ? PHOTON_MOST_LOBES : suns + (lights->num_lamps || sky || job->frame->emitters > 0);
    const uint32_t room = tyn_photon_most_lobes(p), asked = (uint32_t)p->lobes;
    uint32_t lobes = asked < useful ? asked : useful;
    if (lobes > room && room > 0) {
        tyn_job_warn(job, "photon_trace.lobes: %u of %u fit into %d MiB", room, lobes,
                     PHOTON_MOST_BYTES >> 20);
        lobes = room;
    }
    p->lobes = lobes > 1 ? (int32_t)lobes : 1;
    const uint32_t before = (uint32_t)p->lobes - 1;
    return suns < before ? suns : before;
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

static bool is_light(const struct light_block *a, const struct light_block *b)
{
    return memcmp(a->direction, b->direction, sizeof a->direction) == 0 &&
           memcmp(a->color, b->color, sizeof a->color) == 0;
}

// What light photons leave to the march until it has scattered: the suns that have beams and the lamps that have grids.
static void set_marched(const tyn_frame_scene *frame, const tyn_sources *marched,
                        tyn_photon_trace_params *p)
{
    const tyn_lights *lights = &frame->lights;
    const struct env_block *env = &frame->environment;
    memset(p->marched, 0, sizeof p->marched);
    p->num_map_suns = 0;
    if (p->first == TYN_PHOTON_FIRST_CACHE) {
        return;
    }
    for (uint32_t n = 0; n < marched->num_suns; n++) {
        bool found = false;
        for (uint32_t i = 0; i < lights->num_directional && !found; i++) {
            found = is_light(&lights->suns[n], &lights->scene[i]) &&
                    !(p->marched[i / 32] >> i % 32 & 1);
            p->marched[i / 32] |= (uint32_t)found << i % 32;
        }
        for (uint32_t i = 0; env->has_map && i < frame->map->num_suns && !found; i++) {
            const tyn_map_sun *sun = &frame->map->suns[i];
            struct photon_map_sun *to = &p->map_suns[p->num_map_suns];
            float cosine = 0;
            for (int a = 0; a < 3; a++) {
                to->direction[a] = lights->suns[n].direction[a];
                for (int r = 0; r < 3; r++) {
                    cosine -= to->direction[a] * env->rows[r][a] * sun->direction[r];
                }
                to->around[a] = env->radiance[a] * sun->around[a];
            }
            to->cos_radius = sun->cos_radius;
            found = cosine > 1 - 1e-6f;
            p->num_map_suns += found;
        }
    }
    for (uint32_t i = 0; i < marched->lamps.num_lamps; i++) {
        const uint32_t light = lights->num_directional + i;
        p->marched[light / 32] |= 1u << light % 32;
    }
}

static void set_params(const tyn_job *job, const tyn_sources *s, const tyn_sources *marched,
                       tyn_photon_trace_params *p)
{
    const tyn_frame_scene *frame = job->frame;
    tyn_settings_params(job->settings, &tyn_pass_photon_trace, p);
    p->shape = s->lattice.shape;
    tyn_path_scene(job, &p->path);
    p->sky_first = fit_lobes(job, p);
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
    const bool scaled = p->first == TYN_PHOTON_FIRST_BEAMS;
    p->reduced = reduced_extinction(frame, p->similarity, scaled);
    p->scaled = scaled ? scaled_extinction(frame) : 1;
    p->majorant = frame->majorant * p->scaled;
    if (job->outputs & (TYN_OUTPUT_PROBE | TYN_OUTPUT_LIGHT) || !(p->majorant > 0)) {
        p->mean = TYN_PHOTON_MEAN_VOLUME; // points may be anywhere
    }
    set_marched(frame, marched, p);
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
    const int32_t settings[] = {p->photons, p->generations, p->renewed, p->similarity,
                                p->first,   p->mean,        p->lobes,   (int32_t)p->sky_first};
    key = tyn_hash_bytes(key, settings, sizeof settings);
    const uint32_t kinds[] = {p->path.num_shapes,  p->path.num_lights, p->path.num_lamps,
                              p->path.environment, p->path.seed,       p->path.triangles};
    return tyn_hash_bytes(key, kinds, sizeof kinds);
}

static void add_view(tyn_graph *g, const tyn_job *job, const tyn_sources *s,
                     const tyn_photon_trace_params *trace, tyn_ref light, tyn_field *field)
{
    const bool scaled = trace->first == TYN_PHOTON_FIRST_BEAMS;
    const struct medium_block *m = &job->frame->medium;
    tyn_photon_upsample_params up;
    tyn_settings_params(job->settings, &tyn_pass_photon_upsample, &up);
    up.shape = s->lattice.shape;
    up.mode = m->mode;
    up.majorant = trace->majorant;
    up.lobes = (uint32_t)trace->lobes;
    up.weighted = trace->mean == TYN_PHOTON_MEAN_MEDIUM;
    up.scaled = scaled;
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
    view.scaled = scaled;
    view.lobes = up.lobes;
    view.has_sun = trace->sky_first > 0 || (view.lobes == 1 && job->frame->lights.num_suns == 1);
    memcpy(view.axis, trace->sun, sizeof view.axis);
    tyn_ref eye[TYN_MAX_PORTS] = {
        [PHOTON_VIEW_PORT_CAMERA] = job->refs.camera,
        [PHOTON_VIEW_PORT_FLUENCE] = refs[PHOTON_UPSAMPLE_PORT_FLUENCE],
        [PHOTON_VIEW_PORT_WAY] = refs[PHOTON_UPSAMPLE_PORT_WAY],
    };
    tyn_connect(eye, PHOTON_VIEW_PORT_MEDIUM, s->medium);
    tyn_graph_add(g, &tyn_pass_photon_view, &view, eye);
    field->inscatter = eye[PHOTON_VIEW_PORT_INSCATTER];
    field->inscatter_is = scaled ? TYN_INSCATTER_SCALED : TYN_INSCATTER_PLAIN;
    field->cell = s->lattice.side * (float)s->lattice.shape.cells / (float)up.cells;
}

void tyn_solve_photon(tyn_graph *g, const tyn_job *job, const tyn_sources *s,
                      const tyn_sources *marched, tyn_field *field)
{
    tyn_photon_trace_params trace;
    set_params(job, s, marched, &trace);
    const uint64_t key = key_of(job, &trace);
    tyn_ref refs[TYN_MAX_PORTS] = {
        [PHOTON_TRACE_PORT_ORDINATES] =
            (uint32_t)trace.lobes > trace.sky_first + 1 ? marched->sky.ordinates : (tyn_ref){0},
        [PHOTON_TRACE_PORT_RING] =
            tyn_graph_history_buffer(g, "photon_ring", tyn_photon_ring_size(&trace), key),
        [PHOTON_TRACE_PORT_FLUX] =
            tyn_graph_history_buffer(g, "photon_flux", tyn_photon_flux_size(&trace), key),
    };
    tyn_connect_path_scene(refs, job, s->bricks);
    tyn_graph_add(g, &tyn_pass_photon_trace, &trace, refs);

    tyn_photon_cache_params cache;
    tyn_settings_params(job->settings, &tyn_pass_photon_cache, &cache);
    cache.shape = s->lattice.shape;
    cache.generations = (uint32_t)trace.generations;
    cache.slots = cache.generations +
                  (uint32_t)(trace.renewed < trace.generations ? trace.renewed : trace.generations);
    cache.lobes = (uint32_t)trace.lobes;
    cache.unit = 1 / tyn_photon_units(&trace);
    cache.majorant = trace.mean == TYN_PHOTON_MEAN_MEDIUM ? trace.majorant : 0;
    cache.scaled = trace.first == TYN_PHOTON_FIRST_BEAMS;
    tyn_ref sums[TYN_MAX_PORTS] = {
        [PHOTON_CACHE_PORT_MEDIUM] = job->refs.medium,
        [PHOTON_CACHE_PORT_CELLS] = s->lattice.cells,
        [PHOTON_CACHE_PORT_RING] = refs[PHOTON_TRACE_PORT_RING],
        [PHOTON_CACHE_PORT_FLUX] = refs[PHOTON_TRACE_PORT_FLUX],
        [PHOTON_CACHE_PORT_SUM] =
            tyn_graph_history_buffer(g, "photon_sum", tyn_photon_sum_size(&trace), key),
    };
    tyn_graph_add(g, &tyn_pass_photon_cache, &cache, sums);
    field->moments = sums[PHOTON_CACHE_PORT_MOMENTS];
    field->cell = s->lattice.side;
    field->one_channel = false;
    field->tint[0] = field->tint[1] = field->tint[2] = 1;
    if (job->outputs & TYN_PICTURE_OUTPUTS) {
        add_view(g, job, s, &trace, sums[PHOTON_CACHE_PORT_LIGHT], field);
    }
}
