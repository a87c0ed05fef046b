// beam_density.comp -- density integrated along each sun; x, y: column, z: sun.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define MEDIUM_AT 0
#include "shaders/medium/medium.glsl"
#include "shaders/beams/beam_args.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 5, scalar) buffer beam_buffer
{
    beam_block beams[];
};
layout(set = 0, binding = 6, r32f) writeonly uniform image3D column_image;

#define BEAM_VALUE float

float beam_value(vec3 uvw)
{
    return textureLod(medium_density_tex, uvw, 0.0).r;
}

bool beam_any(float value)
{
    return value > 0.0;
}

void beam_store(ivec3 texel, float value)
{
    imageStore(column_image, texel, vec4(isnan(value) || isinf(value) ? 0.0 : value));
}
#include "beam_sweep.glsl"

void main()
{
    uvec2 column = gl_GlobalInvocationID.xy;
    uint sun = gl_WorkGroupID.z;
    if (all(lessThan(column, beams[sun].nodes.xy)) && beam_sweep(beams[sun], column)) {
        atomicOr(beams[sun].edges, 1u);
    }
}
