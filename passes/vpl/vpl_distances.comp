// vpl_distances.comp -- what each VPL sees: the distance of the first surface in every direction of its map.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "surface_args.h"
#include "radial_args.h"
#include "vpl_visibility.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0, scalar) uniform surfaces_uniform
{
    surface_block surfaces;
};
layout(binding = 1, scalar) readonly buffer vertices_buffer
{
    surface_vertex vertices[];
};
layout(binding = 2, scalar) readonly buffer triangles_buffer
{
    surface_triangle triangles[];
};
layout(binding = 3, scalar) readonly buffer nodes_buffer
{
    surface_node nodes[];
};
layout(binding = 4, scalar) readonly buffer vpl_buffer
{
    uint vpl_count;
    uvec3 vpl_pad;
    radial_light vpls[];
};
layout(binding = 5, r32f) uniform writeonly image2D distance_image;
#include "surface_trace.glsl"

void main()
{
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(distance_image);
    int side = size.x / VPL_MAPS_IN_A_ROW;
    uint vpl = uint(texel.y / side * VPL_MAPS_IN_A_ROW + texel.x / side);
    if (any(greaterThanEqual(texel, size)) || vpl >= vpl_count) {
        return;
    }
    radial_light light = vpls[vpl];
    vec3 d = vpl_frame(light.axis) *
             normalize(vpl_map_direction(vec2(texel % side) / float(side - 1)));
    // From a little above the surface: the middle of what the VPL stands for may be below a curved one.
    vec3 reach = max(abs(light.position), vec3(light.radius));
    float lift = 0.02 * light.radius + 1e-5 * max(max(reach.x, reach.y), reach.z);
    vec3 from = surface_transform(surfaces.to_world, light.position + lift * light.axis);
    surface_hit hit = surface_hit(3e38, SURFACE_NONE, vec2(0.0));
    surface_ray ray = surface_ray_make(from, surface_turn(surfaces.to_world, d), SURFACE_NONE);
    surface_trace_world(ray, false, hit);
    imageStore(distance_image, texel, vec4(hit.t));
}
