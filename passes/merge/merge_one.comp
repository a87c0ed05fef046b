// merge_one.comp -- radiance that a cell scatters towards the eye, per sigma_s', of one channel.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/common/scene_args.h"
#include "shaders/common/counters.h"
#include "merge_args.h"
#include "shaders/lattice/lattice.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
layout(push_constant, scalar) uniform push
{
    merge_args args;
};
layout(binding = 0, scalar) readonly buffer field_buffer
{
    float field[];
};
layout(binding = 1, scalar) buffer counters_buffer
{
    counters_block counters;
};
layout(binding = 2, r32f) uniform writeonly image3D inscatter;

#define MERGE_CHANNELS 1u
#include "merge.glsl"
#include "merge_ghosts.glsl"

void main()
{
    ivec3 texel = ivec3(gl_GlobalInvocationID);
    if (all(lessThan(texel, ivec3(args.dims) + 2))) {
        imageStore(inscatter, texel, merge_texel(texel));
    }
}
