// walls_scatter.comp -- one workgroup per triangle: the links it cuts and the cells it passes through.
//
// What several triangles do to a cell is put together by atomic or and minimum, which do not depend on
// their order. A link is judged once, from one of its ends.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "walls_pass_args.h"
#include "surface_args.h"
#include "lattice.glsl"
#include "walls_links.glsl"
#include "walls_triangle.glsl"

layout(local_size_x = WALLS_GROUP) in;
layout(push_constant, scalar) uniform push
{
    walls_pass_args args;
};
layout(binding = 0, scalar) uniform surface_uniform
{
    surface_block surfaces;
};
layout(binding = 1, scalar) readonly buffer vertex_buffer
{
    surface_vertex vertices[];
};
layout(binding = 2, scalar) readonly buffer triangle_buffer
{
    surface_triangle triangles[];
};
layout(binding = 3, scalar) buffer link_buffer
{
    uint links[];
};
// [link 0..13][cell]: of the nearest hit, its share of the way (8 bits), its triangle (24 bits).
layout(binding = 4, scalar) buffer hit_buffer
{
    uint hits[];
};
// [slot][cell]: of the nearest plane that passes through the cell, the same.
layout(binding = 5, scalar) buffer nearest_buffer
{
    uint nearest[];
};
#include "walls_place.glsl"

uint key_of(float share, uint triangle)
{
    return uint(clamp(share, 0.0, 1.0) * 255.0 + 0.5) << 24 | triangle;
}

bool in_lattice(ivec3 c)
{
    return all(greaterThanEqual(c, ivec3(0))) && all(lessThan(c, ivec3(args.dims)));
}

void cut(ivec3 c, uint link, bool inner, float where, uint triangle)
{
    if (!in_lattice(c)) {
        return;
    }
    uint i = walls_cell_index(c), n = args.dims.x * args.dims.y * args.dims.z;
    atomicOr(links[i], 1u << link | (inner ? TYN_WALLS_NEAR : 0u));
    if (link < 14u) {
        atomicMin(hits[link * n + i], key_of(where, triangle));
    }
}

void main()
{
    uint triangle = gl_WorkGroupID.y * args.row + gl_WorkGroupID.x;
    if (triangle >= args.num_triangles) {
        return;
    }
    uvec3 v = uvec3(triangles[triangle].v0, triangles[triangle].v1, triangles[triangle].v2);
    walls_triangle t = walls_triangle_of(walls_place(vertices[v.x].position), walls_place(vertices[v.y].position),
                                         walls_place(vertices[v.z].position));
    vec3 least = min(t.a, min(t.b, t.c)), most = max(t.a, max(t.b, t.c));
    float size = length(t.normal);
    if (!(all(lessThan(abs(least), vec3(1e9))) && all(lessThan(abs(most), vec3(1e9)))) || size == 0.0) {
        return; // not finite, or without area
    }
    vec3 dims = vec3(args.dims);
    ivec3 lo = ivec3(clamp(floor(least) - 1.0, vec3(-1.0), dims + 1.0));
    ivec3 hi = ivec3(clamp(ceil(most) + 1.0, vec3(-2.0), dims));
    ivec3 count = max(hi - lo + 1, ivec3(0));
    uint n = uint(count.x * count.y * count.z), cells = args.dims.x * args.dims.y * args.dims.z;
    vec3 shift = vec3(TYN_WALLS_SHIFT_X, TYN_WALLS_SHIFT_Y, TYN_WALLS_SHIFT_Z);
    for (uint i = gl_LocalInvocationIndex; i < n; i += WALLS_GROUP) {
        ivec3 c = lo + ivec3(int(i) % count.x, int(i) / count.x % count.y, int(i) / (count.x * count.y));
        vec3 p = vec3(c);
        vec2 height = walls_height(t, p);
        if (abs(height.x) > 1.75 * size + height.y) {
            continue;
        }
        bool inside = in_lattice(c);
        for (uint link = 0u; link < TYN_WALLS_LINKS; link++) {
            ivec3 d = walls_step(link);
            // Of a link and its reverse one has its first component > 0.
            int ahead = d.x != 0 ? d.x : d.y != 0 ? d.y : d.z;
            float where;
            if (ahead < 0 || !(inside || in_lattice(c + d)) || !walls_cuts(t, p, vec3(d), where)) {
                continue;
            }
            bool inner = inside && in_lattice(c + d);
            cut(c, link, inner, where, triangle);
            cut(c + d, walls_reverse(link), inner, 1.0 - where, triangle);
        }
        // The cube of the cell is around its true centre; a wall in one of its faces is not in it.
        if (inside && walls_in_cube(t, p - shift, 0.499)) {
            vec3 outward = height.x < 0.0 ? -t.normal : t.normal, main = abs(outward);
            int axis = main.x >= main.y && main.x >= main.z ? 0 : main.y >= main.z ? 1 : 2;
            uint slot = uint(2 * axis + int(outward[axis] < 0.0)), at = walls_cell_index(c);
            atomicOr(links[at], TYN_WALLS_NEAR);
            atomicMin(nearest[slot * cells + at], key_of(abs(height.x) / size, triangle));
        }
    }
}
