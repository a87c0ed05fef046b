// environment.glsl -- radiance of the surroundings: a constant or a latitude-longitude map.
#ifndef TYN_ENVIRONMENT_GLSL
#define TYN_ENVIRONMENT_GLSL
#include "shaders/common/scene_args.h"

const float TYN_INV_PI = 0.31830988618;

// Texture coordinates of the map for a direction of the map's own frame, outwards: row 0 is up (+Y),
// the image centre looks along -Z, +X is at u = 0.75.
vec2 environment_uv(vec3 d)
{
    // atan(0, 0) is undefined; towards a pole every u is right.
    float azimuth = d.x == 0.0 && d.z == 0.0 ? 0.0 : atan(d.x, -d.z);
    return vec2(0.5 + azimuth * 0.5 * TYN_INV_PI, acos(clamp(d.y, -1.0, 1.0)) * TYN_INV_PI);
}

vec3 environment_map_direction(const env_block env, vec3 d_M)
{
    return vec3(dot(env.rows[0].xyz, d_M), dot(env.rows[1].xyz, d_M), dot(env.rows[2].xyz, d_M));
}

// Radiance, W/(m^2 sr), that arrives from direction `d_M` (unit, outwards). `map` wraps in x and is
// clamped in y.
vec3 environment_radiance(const env_block env, sampler2D map, vec3 d_M)
{
    if (env.has_map == 0u) {
        return env.radiance;
    }
    vec2 uv = environment_uv(environment_map_direction(env, d_M));
    return env.radiance * textureLod(map, uv, 0.0).rgb;
}

#endif
