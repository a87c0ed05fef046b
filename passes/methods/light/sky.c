// sky.c -- the light of an environment map as principal ordinates.
#include "passes/methods/light/sources.h"
#include "scene/env_suns.h"
#include <tyndall/registry.h>
#include <string.h>

// `suns`: they stay in the map.
static void add_env_importance(tyn_graph *g, const tyn_job *job, bool suns, tyn_ref *sky,
                               tyn_ref *sums)
{
    const tyn_map_light *map = job->frame->map;
    tyn_env_importance_params params;
    tyn_settings_params(job->settings, &tyn_pass_env_importance, &params);
    params.suns.num_suns = suns ? 0 : map->num_suns;
    for (uint32_t i = 0; i < params.suns.num_suns; i++) {
        struct sky_sun *sun = &params.suns.suns[i];
        memcpy(sun->direction, map->suns[i].direction, sizeof sun->direction);
        memcpy(sun->around, map->suns[i].around, sizeof sun->around);
        sun->cos_radius = map->suns[i].cos_radius;
    }
    tyn_ref refs[TYN_MAX_PORTS] = {[ENV_IMPORTANCE_PORT_ENV_MAP] = job->refs.env_map};
    tyn_graph_add(g, &tyn_pass_env_importance, &params, refs);
    *sky = refs[ENV_IMPORTANCE_PORT_SKY];
    *sums = refs[ENV_IMPORTANCE_PORT_SUMS];
}

tyn_ref tyn_add_map_sums(tyn_graph *g, const tyn_job *job, bool suns)
{
    tyn_ref sky, sums;
    add_env_importance(g, job, suns, &sky, &sums);
    return sums;
}

// A sun as an ordinate: a cone with its mean cosine.
static struct ordinate ordinate_of_sun(const struct light_block *sun)
{
    struct ordinate o = {.mean_cosine = sun->mean_cosine,
                         .solid_angle = 4.0f * 3.14159265f * (1.0f - sun->mean_cosine)};
    memcpy(o.irradiance, sun->color, sizeof o.irradiance);
    memcpy(o.direction, sun->direction, sizeof o.direction);
    return o;
}

// Ordinates, `unlit`, and with the light of the environment and of the suns among `params`.
static tyn_ref add_ordinates(tyn_graph *g, const tyn_job *job, const tyn_ordinates_params *params,
                             tyn_ref refs[TYN_MAX_PORTS], tyn_ref *unlit)
{
    tyn_ordinates_params dark = *params;
    memcpy(dark.rows, job->frame->environment.rows, sizeof dark.rows);
    tyn_sky_light_params light;
    tyn_settings_params(job->settings, &tyn_pass_sky_light, &light);
    light.split = params->split;
    light.num_fixed = params->num_fixed;
    memcpy(light.fixed, params->fixed, sizeof light.fixed);
    for (uint32_t i = 0; i < dark.num_fixed; i++) {
        memset(dark.fixed[i].irradiance, 0, sizeof dark.fixed[i].irradiance);
    }
    tyn_graph_add(g, &tyn_pass_ordinates, &dark, refs);
    *unlit = refs[ORDINATES_PORT_ORDINATES];
    tyn_ref lit[TYN_MAX_PORTS] = {
        [SKY_LIGHT_PORT_ENVIRONMENT] = job->refs.environment, [SKY_LIGHT_PORT_ORDINATES] = *unlit};
    tyn_graph_add(g, &tyn_pass_sky_light, &light, lit);
    return lit[SKY_LIGHT_PORT_LIT];
}

// What surfaces hide of `count` directions.
static void add_maps(tyn_graph *g, const tyn_job *job, uint32_t count, tyn_sky *sky)
{
    tyn_sky_shadows_params params;
    tyn_settings_params(job->settings, &tyn_pass_sky_shadows, &params);
    params.count = count;
    params.wide = params.reach > 0.0f && tyn_reach_beyond(job->frame, params.reach);
    params.num_triangles = job->frame->num_triangles;
    params.num_vertices = job->frame->num_vertices;
    memcpy(params.near_lo, job->frame->near_lo, sizeof params.near_lo);
    memcpy(params.near_hi, job->frame->near_hi, sizeof params.near_hi);
    tyn_ref refs[TYN_MAX_PORTS] = {
        [SKY_SHADOWS_PORT_SURFACES] = job->refs.geometry.surfaces,
        [SKY_SHADOWS_PORT_TRIANGLES] = job->refs.geometry.triangles,
        [SKY_SHADOWS_PORT_VERTICES] = job->refs.geometry.vertices,
        [SKY_SHADOWS_PORT_ORDINATES] = sky->unlit_directions,
    };
    tyn_graph_add(g, &tyn_pass_sky_shadows, &params, refs);
    tyn_take(refs, SKY_SHADOWS_PORT_SKY_ATLAS, sky->maps);
}

// Parts of the ordinates of `params`, with all light of theirs, and what surfaces hide of it, if there are any. `refs` are those of the
// ordinates.
static void add_directions(tyn_graph *g, const tyn_job *job, tyn_ordinates_params params,
                           tyn_ref refs[TYN_MAX_PORTS], tyn_sky *sky)
{
    const uint32_t count = (uint32_t)params.count, fixed = params.num_fixed;
    params.fan = TYN_SKY_FAN;
    while (params.fan > 1 && fixed + count * params.fan > TYN_ORDINATES_MAX) {
        params.fan /= 2;
    }
    // Regions are placed as those of the ordinates are.
    params.spread *= params.split ? 1.0f / ORDINATES_SPREAD_OF_ALL : 1.0f;
    params.split = 0;
    refs[ORDINATES_PORT_ORDINATES] = (tyn_ref){0};
    sky->fan = params.fan;
    sky->directions = add_ordinates(g, job, &params, refs, &sky->unlit_directions);
    const uint32_t all = fixed + count * params.fan;
    if (job->frame->num_triangles) {
        add_maps(g, job, all < TYN_ORDINATES_MAX ? all : TYN_ORDINATES_MAX, sky);
    }
}

// `directions`: of each ordinate, as surfaces hide some of it, or for finer phases.
static void add_sky(tyn_graph *g, const tyn_job *job, uint32_t first_sun, bool can_split,
                    bool directions, tyn_sources *s)
{
    const tyn_frame_scene *frame = job->frame;
    const struct env_block *env = &frame->environment;
    tyn_ordinates_params params;
    tyn_settings_params(job->settings, &tyn_pass_ordinates, &params);
    params.split = can_split && params.split;
    for (uint32_t i = first_sun; i < frame->lights.num_suns; i++) {
        params.fixed[params.num_fixed++] = ordinate_of_sun(&frame->lights.suns[i]);
    }
    tyn_sky *sky = &s->sky;
    sky->split = params.split;
    bool regions = tyn_is_lit(env->sky) && (env->has_map || !params.split || directions);
    if (!regions && !params.num_fixed) {
        return;
    }
    params.count = regions ? params.count : 0;
    uint32_t count = (uint32_t)params.count + params.num_fixed;
    sky->count = count < TYN_ORDINATES_MAX ? count : TYN_ORDINATES_MAX;

    tyn_ref refs[TYN_MAX_PORTS] = {{0}};
    if (regions && env->has_map) {
        add_env_importance(g, job, false, &sky->map, &refs[ORDINATES_PORT_SUMS]);
        refs[ORDINATES_PORT_SKY] = sky->map;
    }
    if (regions) {
        refs[ORDINATES_PORT_IMPORTANCE] = sky->importance;
    }
    sky->ordinates = add_ordinates(g, job, &params, refs, &sky->unlit_ordinates);
    if (directions) {
        add_directions(g, job, params, refs, sky);
    }
}

void tyn_add_sky(tyn_graph *g, const tyn_job *job, uint32_t first_sun, bool can_split,
                 tyn_sources *s)
{
    add_sky(g, job, first_sun, can_split, false, s);
}

void tyn_add_whole_sky(tyn_graph *g, const tyn_job *job, tyn_sources *s)
{
    add_sky(g, job, tyn_num_beams(&job->frame->lights), false, true, s);
}

void tyn_add_surroundings(tyn_graph *g, const tyn_job *job, bool can_split, tyn_sources *s)
{
    const tyn_frame_scene *frame = job->frame;
    const uint32_t first_sun = frame->empty ? tyn_num_beams(&frame->lights) : s->num_suns;
    const bool maps = can_split && !tyn_is_periodic(frame);
    if (maps || !tyn_has_walls(frame)) {
        add_sky(g, job, first_sun, can_split, maps && frame->num_triangles, s);
    } else if (frame->environment.has_map) {
        // Ordinates know of no walls; the mean of the sky comes in along the lattice's lines, which do.
        tyn_job_warn(
            job,
            "among surfaces the medium is lit by the mean of the environment map and by its suns");
    }
    // Of a sky that surfaces may hide the mean comes with the ordinates.
    const bool hidden = s->sky.maps.sky_maps.resource != 0;
    s->mean_from_all_sides = tyn_is_lit(frame->environment.sky) && !hidden &&
                             (s->sky.split || !s->sky.ordinates.resource);
}
