// radial_beam_density.comp -- mean density around local lights; a thread per direction.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define MEDIUM_AT 0
#include "shaders/medium/medium.glsl"
#include "shaders/beams/radial_args.h"
#include "radial_beam_args.h"

layout(local_size_x = RADIAL_GROUP * RADIAL_GROUP) in;
layout(push_constant, scalar) uniform push
{
    radial_beam_args args;
};
layout(set = 0, binding = 5, scalar) readonly buffer radial_buffer
{
    uint radial_count, radial_num_lamps;
    uvec2 radial_pad;
    radial_grid radials[];
};
layout(set = 0, binding = 6, r32f) writeonly uniform image3D column_image;

#define RADIAL_VALUE float

float radial_value(vec3 uvw)
{
    return textureLod(medium_density_tex, uvw, 0.0).r;
}

void radial_store(ivec3 texel, float value)
{
    imageStore(column_image, texel, vec4(isnan(value) || isinf(value) ? 0.0 : value));
}
#include "radial_sweep.glsl"

void main()
{
    uint n;
    ivec2 texel;
    if (radial_thread(n, texel)) {
        radial_sweep(n, texel);
    }
}
