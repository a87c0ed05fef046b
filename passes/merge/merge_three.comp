// merge_three.comp -- radiance that a cell scatters towards the eye, per sigma_s', of three
// channels.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "scene_args.h"
#include "lattice.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
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

#define MERGE_CHANNELS 3
#include "merge.glsl"

void main()
{
    merge_texel(ivec3(gl_GlobalInvocationID));
}
