// beam_density.comp -- mean density along each sun; x, y: column, z: sun.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define MEDIUM_BLOCK 0
#define MEDIUM_DENSITY 1
#include "medium.glsl"
#include "beam_args.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 2, scalar) buffer beam_buffer
{
    beam_block beams[];
};
layout(set = 0, binding = 3, r32f) writeonly uniform image3D column_image;

#define BEAM_VALUE float

float beam_value(vec3 p)
{
    return textureLod(medium_density_tex, medium_uvw(medium_wrap(p)), 0.0).r;
}

bool beam_any(float value)
{
    return value > 0.0;
}

void beam_store(ivec3 texel, float mean)
{
    imageStore(column_image, texel, vec4(isnan(mean) || isinf(mean) ? 0.0 : mean));
}
#include "beam_sweep.glsl"

void main()
{
    if (all(lessThan(gl_GlobalInvocationID.xy, imageSize(column_image).xy))) {
        if (beam_sweep(beams[gl_WorkGroupID.z], gl_GlobalInvocationID.xy)) {
            atomicOr(beams[gl_WorkGroupID.z].edges, 1u);
        }
    }
}
