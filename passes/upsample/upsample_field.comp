// upsample_field.comp -- see upsample.h; one thread a texel.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define MEDIUM_BLOCK 0
#define MEDIUM_DENSITY 1
#include "medium.glsl"
#include "lattice.glsl"
#include "propagate.glsl"
#include "upsample_args.h"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
layout(set = 0, binding = 2, scalar) readonly buffer grids_buffer { propagate_grid grids[]; };
layout(set = 0, binding = 3) uniform sampler3D cells;
layout(set = 0, binding = 4) uniform sampler3D seen;
layout(set = 0, binding = 5, rgba32f) uniform writeonly image3D out_inscatter;
layout(push_constant, scalar) uniform push { upsample_args args; };

float guide(vec3 sigma_s)
{
    return (sigma_s.r + sigma_s.g + sigma_s.b) * (1.0 / 3.0);
}

// Likeness of two scattering coefficients, in (0, 1]. The floor keeps a point that is like none of its
// neighbours at their trilinear mean.
float likeness(float a, float b)
{
    if (args.range <= 0.0) {
        return 1.0;
    }
    float d = abs(a - b) / max(a + b, 1e-30) / args.range;
    return exp(-0.5 * d * d) + 1e-4;
}

// First component of the channels of a cell; `texel` is that of the first channel.
vec3 channels_of(sampler3D stack, ivec3 texel, propagate_grid grid)
{
    float first = texelFetch(stack, texel, 0).r;
    if (grid.channels == 1u) {
        return vec3(first);
    }
    ivec3 next = ivec3(0, 0, int(args.grid_cells));
    return vec3(first, texelFetch(stack, texel + next, 0).r, texelFetch(stack, texel + 2 * next, 0).r);
}

// Light of one grid at a point, clamped to the outer cells.
vec3 gather(propagate_grid grid, vec3 p, float here)
{
    vec3 at = propagate_from_m(grid, p) - 0.5;
    ivec3 base = ivec3(floor(at)), last = ivec3(grid.size) - 1;
    vec3 part = at - vec3(base);
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (int n = 0; n < 8; n++) {
        ivec3 corner = ivec3(n & 1, n >> 1 & 1, n >> 2);
        ivec3 texel = clamp(base + corner, ivec3(0), last) + ivec3(0, 0, int(grid.first_layer));
        vec3 tent = mix(1.0 - part, part, vec3(corner));
        float weight = tent.x * tent.y * tent.z * likeness(here, guide(channels_of(cells, texel, grid)));
        sum += weight * channels_of(seen, texel, grid);
        weights += weight;
    }
    return grid.irradiance * sum / weights;
}

void main()
{
    ivec3 texel = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(uvec3(texel), args.dims + 2u))) {
        return;
    }
    lattice_box box = lattice_box_of(medium.extent, ivec3(args.dims));
    ivec3 cell = clamp(texel - 1, ivec3(0), box.dims - 1);
    vec3 p = clamp(lattice_to_m(box, vec3(cell) + 0.5), vec3(0.0), medium.extent);
    float here = guide(medium_sample(p).sigma_s);
    vec3 light = vec3(0.0);
    for (uint n = 0u; n < args.num_suns; n++) {
        light += gather(grids[n], p, here);
    }
    imageStore(out_inscatter, texel, vec4(light, 0.0));
}
