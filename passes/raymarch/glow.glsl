// glow.glsl -- light of the environment that has been scattered forward only, any number of times.
//
// Such light has hardly left its direction, so it is seen along the view ray itself: behind the
// transmittances e^-tau (true) and e^-tau' (forward scattering counts as not scattered) it is
//   e^-tau' (1 - e^-t) B(t, v),   t = tau - tau' the forward depth,
// and B is the environment smeared by the lobes of all orders from the first on (Goudsmit and Saunderson
// 1940), with the Legendre moments (e^(t phi_l) - 1) / (e^t - 1), phi_l those of one forward scattering.
// Pass env_glow makes the texture, in the map's frame and units.
#include "shaders/light/environment.glsl"
#include "shaders/light/glow_args.h"

// Texture coordinate of a forward depth.
float glow_w(float t, int levels)
{
    float level = log(1.0 + max(t, 0.0) / TYN_GLOW_DEPTH) / TYN_GLOW_STEP;
    return (0.5 + min(level, float(levels - 1))) / float(levels);
}

// B / env.radiance per channel for a unit direction of M, outwards. `glow` wraps in x.
vec3 glow_radiance(sampler3D glow, const env_block env, vec3 d_M, float t)
{
    vec2 uv = environment_uv(environment_map_direction(env, d_M));
    return textureLod(glow, vec3(uv, glow_w(t, textureSize(glow, 0).z)), 0.0).rgb;
}

vec3 glow_radiance(sampler3D glow, const env_block env, vec3 d_M, vec3 t)
{
    vec2 uv = environment_uv(environment_map_direction(env, d_M));
    int levels = textureSize(glow, 0).z;
    return vec3(textureLod(glow, vec3(uv, glow_w(t.r, levels)), 0.0).r,
                textureLod(glow, vec3(uv, glow_w(t.g, levels)), 0.0).g,
                textureLod(glow, vec3(uv, glow_w(t.b, levels)), 0.0).b);
}
