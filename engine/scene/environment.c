// environment.c -- what an environment map's suns are to a scene.
#include <assert.h>
#include <math.h>
#include "scene/env_suns.h"

static_assert(TYN_MAX_MAP_SUNS == (int)TYN_MAP_SUNS_MAX, "all suns that are found can be told");

// Turns v by the rotation of a quaternion x, y, z, w of any length; {0,0,0,0} = identity.
static void rotate(const float q[4], const float v[3], double out[3])
{
    const double n =
        (double)q[0] * q[0] + (double)q[1] * q[1] + (double)q[2] * q[2] + (double)q[3] * q[3];
    const double s = n > 0 ? 2 / n : 0, w = q[3];
    const double t[3] = {(double)q[1] * v[2] - (double)q[2] * v[1],
                         (double)q[2] * v[0] - (double)q[0] * v[2],
                         (double)q[0] * v[1] - (double)q[1] * v[0]};
    out[0] = v[0] + s * (w * t[0] + q[1] * t[2] - q[2] * t[1]);
    out[1] = v[1] + s * (w * t[1] + q[2] * t[0] - q[0] * t[2]);
    out[2] = v[2] + s * (w * t[2] + q[0] * t[1] - q[1] * t[0]);
}

uint32_t tyn_environment_suns(const tyn_environment *env,
                              tyn_environment_sun suns[TYN_MAX_MAP_SUNS])
{
    tyn_map_light map;
    if (!env || !suns || !tyn_map_light_find(env, &map)) {
        return 0;
    }
    for (uint32_t i = 0; i < map.num_suns; i++) {
        const tyn_map_sun *from = &map.suns[i];
        double towards[3];
        rotate(env->rotation, from->direction, towards);
        for (int a = 0; a < 3; a++) {
            suns[i].irradiance[a] = (float)(from->irradiance[a] * (double)env->radiance[a] *
                                            (double)tyn_environment_strength(env));
            suns[i].direction[a] = (float)-towards[a];
        }
        // The mean cosine of an even disc is that of half its height.
        suns[i].radius = (float)acos(fmax(2 * (double)from->mean_cosine - 1, 0));
    }
    return map.num_suns;
}
