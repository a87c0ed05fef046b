// composite.comp -- the medium over a host image; built for each of its formats, COLOUR_FORMAT, and with JOINT for images
// twice as large as the medium's picture.
layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform sampler2D radiance;
layout(binding = 1) uniform sampler2D transmittance;
layout(binding = 2, COLOUR_FORMAT) uniform image2D color;

#ifdef JOINT
#include "shaders/common/scene_args.h"
#include "composite_args.h"
layout(binding = 3) uniform sampler2D half_depth;
layout(binding = 4) uniform sampler2D full_depth;
TYN_ARGS(composite_args args);

const float SAME = 0.02; // relative difference of distances at which a neighbour counts half

// 1 / distance of what the host has drawn; 0: nothing. Clip z and w are linear in view z (host_depth.glsl).
float nearness(float depth)
{
    float above = args.depth.y - depth * args.depth.w;
    return abs(depth * args.depth.z - args.depth.x) / max(abs(above), 1e-20);
}

// Joint bilateral upsampling (Kopf et al. 2007): of the four pixels around, by their place and by how their ray ended.
void medium_at(ivec2 p, out vec3 light, out vec3 passed)
{
    vec2 at = 0.5 * (vec2(p) + 0.5) - 0.5;
    ivec2 low = ivec2(floor(at)), last = textureSize(radiance, 0) - 1;
    vec2 t = at - vec2(low);
    bool deep = args.depth != vec4(0.0);
    float here = deep ? nearness(texelFetch(full_depth, p, 0).r) : 0.0, sum = 0.0;
    light = passed = vec3(0.0);
    for (int i = 0; i < 4; i++) {
        ivec2 step = ivec2(i & 1, i >> 1), q = clamp(low + step, ivec2(0), last);
        vec2 share = mix(1.0 - t, t, vec2(step));
        float weight = share.x * share.y;
        if (deep) {
            float there = nearness(texelFetch(half_depth, q, 0).r);
            float off = abs(there - here) / max(max(there, here), 1e-20) / SAME;
            weight /= 1.0 + off * off;
        }
        light += weight * texelFetch(radiance, q, 0).rgb;
        passed += weight * texelFetch(transmittance, q, 0).rgb;
        sum += weight;
    }
    light /= sum;
    passed /= sum;
}
#else
void medium_at(ivec2 p, out vec3 light, out vec3 passed)
{
    light = texelFetch(radiance, p, 0).rgb;
    passed = texelFetch(transmittance, p, 0).rgb;
}
#endif

void main()
{
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, imageSize(color)))) {
        return;
    }
    vec3 light, passed;
    medium_at(p, light, passed);
    vec4 c = imageLoad(color, p);
    c.rgb = c.rgb * passed + light;
    imageStore(color, p, c);
}
