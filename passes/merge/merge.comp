// merge.comp -- radiance that a cell scatters towards the eye, per sigma_s'.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "scene_args.h"
#include "merge_args.h"
#include "lattice.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
layout(push_constant, scalar) uniform push
{
    merge_args args;
};
layout(binding = 0, scalar) uniform medium_uniform
{
    medium_block medium;
};
layout(binding = 1, scalar) uniform camera_uniform
{
    camera_block camera;
};
layout(binding = 2) uniform sampler3D cells;
layout(binding = 3) uniform sampler3D moments;
layout(binding = 4, rgba32f) uniform writeonly image3D inscatter;

// The field is linear in direction: (phi + 3 g' v.F) / 4 pi, v towards the eye.
vec3 towards_eye(lattice_box box, ivec3 c)
{
    vec3 p = lattice_to_m(box, vec3(c) + 0.5), v = camera.origin - p;
    v = camera.orthographic != 0 ? -camera.forward : v / max(length(v), 1e-20);
    vec3 j;
    for (int ch = 0; ch < 3; ch++) {
        ivec3 texel = c + ivec3(0, 0, (args.channels == 1 ? 0 : ch) * box.dims.z);
        vec4 m = texelFetch(moments, texel, 0);
        j[ch] = max(m.x + 3.0 * texelFetch(cells, texel, 0).z * dot(v, m.yzw), 0.0) / 12.56637061;
    }
    return j * args.tint;
}

void main()
{
    ivec3 texel = ivec3(gl_GlobalInvocationID), dims = imageSize(inscatter) - 2;
    if (any(greaterThanEqual(texel, dims + 2))) {
        return;
    }
    lattice_box box = lattice_box_of(medium.extent, dims);
    // A ghost cell continues the two cells before it: 2 J_0 - J_1, along each axis where it is outside.
    ivec3 c = texel - 1, near = clamp(c, ivec3(0), dims - 1);
    ivec3 far = clamp(2 * near - c, ivec3(0), dims - 1);
    ivec3 outside = ivec3(notEqual(c, near));
    vec3 j = vec3(0.0);
    for (int k = 0; k <= outside.z; k++) {
        for (int l = 0; l <= outside.y; l++) {
            for (int i = 0; i <= outside.x; i++) {
                ivec3 q = ivec3(i == 0 ? near.x : far.x, l == 0 ? near.y : far.y, k == 0 ? near.z : far.z);
                float w = (i == 0 ? 1.0 + outside.x : -1.0) * (l == 0 ? 1.0 + outside.y : -1.0) *
                          (k == 0 ? 1.0 + outside.z : -1.0);
                j += w * towards_eye(box, q);
            }
        }
    }
    imageStore(inscatter, texel, vec4(max(j, vec3(0.0)), 1.0));
}
