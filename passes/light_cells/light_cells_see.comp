// light_cells_see.comp -- what the lights see of each cube.
#extension GL_EXT_control_flow_attributes : require
#include "shaders/light/light_cells_args.h"

#define SHADOW_BLOCKS 0
#define SHADOW_LIGHTS 1
#include "shadow_region.glsl"

layout(constant_id = 0) const uint num_suns = 1u;
layout(constant_id = 1) const uint num_lamps = 0u;
layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
layout(binding = 2, r32f) uniform writeonly image3D light_cells_image;

TYN_ARGS(light_cells_args args);

void main()
{
    uvec3 cell = gl_GlobalInvocationID;
    if (any(greaterThanEqual(cell, args.dims))) {
        return;
    }
    vec3 middle = (vec3(cell) + 0.5) * args.edge;
    float reach = (0.5 + TYN_LIGHT_CELLS_REACH) * args.edge;
    uint bits = 0u;
    // Not unrolled: uniform_branch.glsl.
    [[dont_unroll]] for (uint n = 0u; n < num_suns; n++) {
        shadow_light l = shadows[n];
        bits |= shadow_region_seen(l, shadow_region_sun(l, middle, reach)) << (2u * n);
    }
    [[dont_unroll]] for (uint n = TYN_SHADOW_SUNS; n < TYN_SHADOW_SUNS + num_lamps; n++) {
        shadow_light l = shadows[n];
        bits |= shadow_region_seen(l, shadow_region_lamp(l, middle, reach)) << (2u * n);
    }
    imageStore(light_cells_image, ivec3(cell), vec4(float(bits)));
}
