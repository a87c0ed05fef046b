// walls_eval.comp -- lattice_walls.glsl at points, for the test of it.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lattice/lattice.glsl"
#define WALLS_AT 0
#define WALLS_STORAGE
#include "shaders/walls/lattice_walls.glsl"

layout(local_size_x = 64) in;
layout(binding = 2) uniform sampler3D field;
layout(binding = 3, scalar) readonly buffer setup_buffer
{
    vec3 extent;
    uvec3 dims;
};
layout(binding = 4, scalar) readonly buffer point_buffer
{
    vec3 points[];
};
layout(binding = 5, scalar) writeonly buffer result_buffer
{
    vec4 results[];
};

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i < uint(points.length())) {
        lattice_box box = lattice_box_of(extent, ivec3(dims));
        walls_place w = walls_place_of(box, points[i]);
        walls_blend b = walls_blend_of(box, w, points[i]);
        // Whether the point's cell sees that of the next.
        bool sees = walls_visible(box, w.cell, walls_place_of(box, points[(i + 1u) % uint(points.length())]).cell);
        results[i] = vec4(walls_fetch(field, box, b, ivec3(0)).x, float(walls_near(w)),
                          float(walls_same_side(box, w.cell, points[i])), sees ? 1.0 : -1.0);
    }
}
