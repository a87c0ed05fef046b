// walls_scatter.comp -- one workgroup per triangle, or a few if there are not many: the links it cuts and the
// cells it passes through.
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

// Of a link and its reverse one is looked at: that whose first component is > 0.
const uint HALF = 13u;
const uint FORWARD[HALF] = uint[](0u, 2u, 4u, 6u, 8u, 10u, 12u, 14u, 16u, 18u, 20u, 22u, 24u);

// Cells from which a link along d has a box that meets the triangle's.
void range_of(vec3 least, vec3 most, vec3 d, out ivec3 first, out ivec3 count)
{
    vec3 lo = ceil(least - max(d, vec3(0.0))), hi = floor(most - min(d, vec3(0.0)));
    first = ivec3(clamp(lo, vec3(-1.0), vec3(args.dims) + 1.0));
    ivec3 last = ivec3(clamp(hi, vec3(-2.0), vec3(args.dims)));
    count = max(last - first + 1, ivec3(0));
}

void main()
{
    uint triangle = gl_WorkGroupID.y * args.row + gl_WorkGroupID.x;
    if (triangle >= args.num_triangles) {
        return;
    }
    uvec3 v = uvec3(triangles[triangle].v0, triangles[triangle].v1, triangles[triangle].v2);
    walls_triangle t = walls_triangle_of(walls_lattice_place(vertices[v.x].position), walls_lattice_place(vertices[v.y].position),
                                         walls_lattice_place(vertices[v.z].position));
    vec3 least = min(t.a, min(t.b, t.c)), most = max(t.a, max(t.b, t.c));
    float size = length(t.normal);
    if (!(all(lessThan(abs(least), vec3(1e9))) && all(lessThan(abs(most), vec3(1e9)))) || size == 0.0) {
        return; // not finite, or without area
    }
    uint me = gl_WorkGroupID.z * WALLS_GROUP + gl_LocalInvocationIndex, stride = args.slices * WALLS_GROUP;
    // What rounding may move the triangle by.
    vec3 slack = 1e-4 + 4e-7 * max(abs(least), abs(most));
    least -= slack;
    most += slack;

    // All links whose boxes meet the triangle's, one direction after another.
    ivec3 first[HALF], count[HALF];
    uint total = 0u;
    for (uint k = 0u; k < HALF; k++) {
        range_of(least, most, vec3(walls_step(FORWARD[k])), first[k], count[k]);
        total += uint(count[k].x * count[k].y * count[k].z);
    }
    for (uint i = me; i < total; i += stride) {
        uint k = 0u, of = i;
        for (uint n = uint(count[k].x * count[k].y * count[k].z); of >= n && k < HALF - 1u;
             n = uint(count[k].x * count[k].y * count[k].z)) {
            of -= n;
            k++;
        }
        ivec3 c = first[k] + ivec3(int(of) % count[k].x, int(of) / count[k].x % count[k].y,
                                   int(of) / (count[k].x * count[k].y));
        uint link = FORWARD[k];
        ivec3 d = walls_step(link);
        bool here = in_lattice(c), there = in_lattice(c + d);
        float where;
        if ((here || there) && walls_cuts(t, vec3(c), vec3(d), where)) {
            cut(c, link, here && there, where, triangle);
            cut(c + d, walls_reverse(link), here && there, 1.0 - where, triangle);
        }
    }

    // The cubes of the cells are around their true centres; a wall in a face of one is not in it.
    vec3 shift = vec3(TYN_WALLS_SHIFT_X, TYN_WALLS_SHIFT_Y, TYN_WALLS_SHIFT_Z);
    ivec3 lo = ivec3(clamp(ceil(least + shift - 0.5), vec3(0.0), vec3(args.dims)));
    ivec3 hi = ivec3(clamp(floor(most + shift + 0.5), vec3(-1.0), vec3(args.dims) - 1.0));
    ivec3 box = max(hi - lo + 1, ivec3(0));
    uint cells = args.dims.x * args.dims.y * args.dims.z;
    for (uint i = me; i < uint(box.x * box.y * box.z); i += stride) {
        ivec3 c = lo + ivec3(int(i) % box.x, int(i) / box.x % box.y, int(i) / (box.x * box.y));
        if (walls_in_cube(t, vec3(c) - shift, 0.499)) {
            float height = walls_height(t, vec3(c)).x;
            vec3 outward = height < 0.0 ? -t.normal : t.normal, main = abs(outward);
            int axis = main.x >= main.y && main.x >= main.z ? 0 : main.y >= main.z ? 1 : 2;
            uint slot = uint(2 * axis + int(outward[axis] < 0.0)), at = walls_cell_index(c);
            atomicOr(links[at], TYN_WALLS_NEAR);
            atomicMin(nearest[slot * cells + at], key_of(abs(height) / size, triangle));
        }
    }
}
