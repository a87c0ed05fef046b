// shade_sight.comp -- the distances of the first surfaces around patches of the box's faces: a ray a texel.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "surface_args.h"
#include "scene_args.h"
#include "lattice.glsl"
#include "shade_faces.h"
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
    uvec4 nodes[];
};
layout(binding = 4, scalar) uniform medium_uniform
{
    medium_block medium;
};
layout(binding = 5) uniform sampler2D faces_tex;
layout(binding = 6) uniform sampler3D moments_tex;
layout(binding = 7, r32f) uniform writeonly image2D sight_image;
layout(constant_id = 0) const uint channels = 1u;
#include "surface_trace.glsl"

void main()
{
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, imageSize(sight_image)))) {
        return;
    }
    ivec2 map = texel / SHADE_FACE_TEXELS, at = texel % SHADE_FACE_TEXELS;
    ivec3 dims = textureSize(moments_tex, 0);
    dims.z /= int(channels);
    lattice_box box = lattice_box_of(medium.extent, dims);
    int axis = map.y / 2;
    bool upper = (map.y & 1) != 0;
    vec3 lo = box.origin, hi = lattice_to_m(box, vec3(dims)), outwards = vec3(0.0);
    outwards[axis] = upper ? 1.0 : -1.0;
    vec4 rect = texelFetch(faces_tex, ivec2(map.x * SHADE_FACE_ENTRIES + SHADE_FACE_RECT, map.y), 0);
    vec2 middle = 0.5 * (rect.xy + rect.zw);
    float plane = upper ? hi[axis] : lo[axis];
    vec3 from = axis == 0 ? vec3(plane, middle) : axis == 1 ? vec3(middle.x, plane, middle.y) : vec3(middle, plane);
    vec3 d = vpl_frame(outwards) * normalize(vpl_map_direction(vec2(at) / float(SHADE_FACE_TEXELS - 1)));
    surface_hit hit = surface_hit(3e38, SURFACE_NONE, vec2(0.0));
    surface_ray ray = surface_ray_make(surface_transform(surfaces.to_world, from),
                                       surface_turn(surfaces.to_world, d), SURFACE_NONE);
    surface_trace_world(ray, false, hit);
    imageStore(sight_image, texel, vec4(hit.t));
}
