// host_depth.glsl -- where the host's surfaces are, from its hardware depth.
#ifndef TYN_HOST_DEPTH_GLSL
#define TYN_HOST_DEPTH_GLSL
#include "shaders/common/scene_args.h"

#define TYN_INFINITY uintBitsToFloat(0x7f800000u)

// Distance along a ray of the camera to the host's surface, m. `clip`: tyn_job.host_depth.
float host_distance(sampler2D depths, const camera_block camera, vec4 clip, ivec2 pixel, vec3 direction)
{
    ivec2 size = textureSize(depths, 0);
    ivec2 texel = ivec2((vec2(pixel) + 0.5) / vec2(camera.size) * vec2(size));
    float depth = texelFetch(depths, min(texel, size - 1), 0).r;
    // Clip z and w are linear in view z: depth (p11 z + p15) = p10 z + p14. An infinite far plane
    // divides by zero.
    float below = depth * clip.z - clip.x;
    float z = (clip.y - depth * clip.w) / below;
    return abs(below) > 1e-12 ? abs(z) / dot(direction, camera.forward) : TYN_INFINITY;
}

#endif
