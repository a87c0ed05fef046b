// propagate_rect_shrink_density.comp -- the density at a resolution that suits the cells of many grids.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define MEDIUM_AT 0
#include "shaders/medium/medium.glsl"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
layout(set = 0, binding = 5, r32f) uniform writeonly image3D out_density;
#include "propagate_shrink.glsl"

void main()
{
    ivec3 texel = ivec3(gl_GlobalInvocationID), size = imageSize(out_density);
    if (any(greaterThanEqual(texel, size))) {
        return;
    }
    ivec3 along = shrink_samples(size);
    float density = 0.0;
    for (int n = 0; n < along.x * along.y * along.z; n++) {
        density += medium_density(shrink_sample(texel, size, along, n));
    }
    imageStore(out_density, texel, vec4(density / float(along.x * along.y * along.z)));
}
