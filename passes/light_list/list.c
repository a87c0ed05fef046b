// list.c -- all lights of a scene in one list.
#include "list.h"
#include "light_list/light_list.h"
#include "median_cut/median_cut.h"
#include <string.h>

// The constellation of the environment, its suns among its lights or `suns_apart`; {0} if nothing shines from there.
static tyn_ref add_constellation(tyn_graph *g, const tyn_job *job, uint32_t lights, bool suns_apart)
{
    const struct env_block *env = &job->frame->environment;
    if (!tyn_is_lit(suns_apart ? env->sky : env->mean)) {
        return (tyn_ref){0};
    }
    const tyn_median_cut_params params = {.lights = lights, .map = env->has_map};
    tyn_ref refs[TYN_MAX_PORTS] = {{0}};
    if (env->has_map) {
        refs[MEDIAN_CUT_PORT_SUMS] = tyn_add_map_sums(g, job, !suns_apart);
    }
    tyn_graph_add(g, &tyn_pass_median_cut, &params, refs);
    return refs[MEDIAN_CUT_PORT_CONSTELLATION];
}

static bool is_same(const struct light_block *a, const struct light_block *b)
{
    return memcmp(a->direction, b->direction, sizeof a->direction) == 0 &&
           memcmp(a->color, b->color, sizeof a->color) == 0;
}

// The strongest suns of scene and map have shadow maps, in their order; those of the map may be in the constellation.
static struct light_list_args lights_of(const tyn_job *job, const tyn_sources *s, bool suns_apart)
{
    const tyn_lights *lights = &job->frame->lights;
    struct light_list_args args = {
        .num_suns = suns_apart ? lights->num_suns : lights->num_directional,
        .num_lamps = lights->num_lamps,
        .first_lamp = lights->num_directional,
        .wide = suns_apart,
        .shadows = s->shadows.shadows.resource != 0,
    };
    const struct light_block *suns = suns_apart ? lights->suns : lights->scene;
    const uint32_t mapped = args.shadows ? tyn_num_beams(lights) : 0;
    for (uint32_t i = 0, sun = 0; i < mapped; i++) {
        if (sun < args.num_suns && is_same(&lights->suns[i], &suns[sun])) {
            args.sun_shadow[sun++] = i;
            args.suns_with_shadow = sun;
        }
    }
    return args;
}

tyn_light_list tyn_add_light_list(tyn_graph *g, const tyn_job *job, const tyn_sources *s,
                                  uint32_t lights, bool suns_apart)
{
    const tyn_ref constellation = add_constellation(g, job, lights, suns_apart);
    tyn_light_list_params params = {.listed = lights_of(job, s, suns_apart)};
    params.listed.constellation = constellation.resource != 0;
    tyn_ref refs[TYN_MAX_PORTS] = {
        [LIGHT_LIST_PORT_CONSTELLATION] = constellation,
        [LIGHT_LIST_PORT_SUNS] = suns_apart ? job->refs.suns : job->refs.lights,
        [LIGHT_LIST_PORT_LIGHTS] = job->refs.lights,
        [LIGHT_LIST_PORT_ENVIRONMENT] = job->refs.environment,
        [LIGHT_LIST_PORT_DIRECTIONS] = suns_apart ? s->sky.directions : (tyn_ref){0},
    };
    tyn_graph_add(g, &tyn_pass_light_list, &params, refs);
    const bool shaded = refs[LIGHT_LIST_PORT_DIRECTIONS].resource != 0;
    return (tyn_light_list){
        .lights = refs[LIGHT_LIST_PORT_LIGHT_LIST],
        .shades = shaded ? refs[LIGHT_LIST_PORT_LIGHT_SHADES] : (tyn_ref){0},
        .most = params.listed.num_suns + params.listed.num_lamps +
                (params.listed.constellation ? lights : 0),
    };
}
