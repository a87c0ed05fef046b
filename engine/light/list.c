// list.c -- see list.h.
#include "light/list.h"
#include <string.h>

// The constellation of the environment, its suns among its lights; {0} if nothing shines from there.
static tyn_ref add_constellation(tyn_graph *g, const tyn_job *job, uint32_t lights)
{
    const struct env_block *env = &job->frame->environment;
    if (env->mean[0] + env->mean[1] + env->mean[2] <= 0) {
        return (tyn_ref){0};
    }
    const tyn_median_cut_params params = {.lights = lights, .map = env->has_map};
    tyn_ref refs[TYN_MAX_PORTS] = {{0}};
    if (env->has_map) {
        refs[MEDIAN_CUT_PORT_SUMS] = tyn_add_map_sums(g, job);
    }
    tyn_graph_add(g, &tyn_pass_median_cut, &params, refs);
    tyn_job_counters(g, job, &tyn_pass_median_cut, refs[MEDIAN_CUT_PORT_CONSTELLATION]);
    return refs[MEDIAN_CUT_PORT_CONSTELLATION];
}

static bool is_same(const struct light_block *a, const struct light_block *b)
{
    return memcmp(a->direction, b->direction, sizeof a->direction) == 0 &&
           memcmp(a->color, b->color, sizeof a->color) == 0;
}

// Suns and lamps of the scene; those of the map are in the constellation. The strongest suns of scene and map have
// shadow maps, in their order.
static struct light_list_args lights_of(const tyn_job *job, const tyn_sources *s)
{
    const tyn_lights *lights = &job->frame->lights;
    struct light_list_args args = {
        .num_suns = lights->num_directional,
        .num_lamps = lights->num_lamps,
        .shadows = s->shadows.shadows.resource != 0,
    };
    const uint32_t mapped = args.shadows ? tyn_num_beams(lights) : 0;
    for (uint32_t i = 0, sun = 0; i < mapped; i++) {
        if (sun < lights->num_directional && is_same(&lights->suns[i], &lights->scene[sun])) {
            args.sun_shadow[sun++] = i;
            args.suns_with_shadow = sun;
        }
    }
    return args;
}

tyn_ref tyn_add_light_list(tyn_graph *g, const tyn_job *job, const tyn_sources *s, uint32_t lights,
                           uint32_t *most)
{
    const tyn_ref constellation = add_constellation(g, job, lights);
    tyn_light_list_params params = {.listed = lights_of(job, s)};
    params.listed.constellation = constellation.resource != 0;
    *most = params.listed.num_suns + params.listed.num_lamps +
            (params.listed.constellation ? lights : 0);
    tyn_ref refs[TYN_MAX_PORTS] = {
        [LIGHT_LIST_PORT_CONSTELLATION] = constellation,
        [LIGHT_LIST_PORT_LIGHTS] = job->refs.lights,
        [LIGHT_LIST_PORT_ENVIRONMENT] = job->refs.environment,
    };
    tyn_graph_add(g, &tyn_pass_light_list, &params, refs);
    return refs[LIGHT_LIST_PORT_LIGHT_LIST];
}
