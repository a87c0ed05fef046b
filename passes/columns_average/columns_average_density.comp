// columns_average_density.comp -- density averaged over the texels of a coarser grid of the same box.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/beams/columns_args.h"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
layout(push_constant, scalar) uniform push
{
    columns_average_args args;
};
layout(binding = 0) uniform sampler3D density;
layout(binding = 1, r32f) writeonly uniform image3D mean_density;
#include "columns_average.glsl"

void main()
{
    uvec3 texel = gl_GlobalInvocationID;
    if (any(greaterThanEqual(texel, args.size))) {
        return;
    }
    float sum = 0.0;
    for (uint i = 0; i < columns_average_count(); i++) {
        sum += textureLod(density, columns_average_uvw(texel, i), 0.0).r;
    }
    imageStore(mean_density, ivec3(texel), vec4(sum / float(columns_average_count())));
}
