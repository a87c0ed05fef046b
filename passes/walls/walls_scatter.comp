// walls_scatter.comp -- one workgroup per triangle, or a few if there are not many: the links it cuts and the
// cells it passes through.
//
// What several triangles do to a cell is put together by atomic or and minimum, which do not depend on
// their order. A link is judged once, from one of its ends.
#extension GL_EXT_control_flow_attributes : require
#include "walls_pass_args.h"
#include "shaders/surfaces/surface_args.h"
#include "shaders/lattice/lattice.glsl"
#include "shaders/walls/walls_links.glsl"
#include "shaders/walls/walls_triangle.glsl"

layout(local_size_x = WALLS_GROUP) in;
TYN_ARGS(walls_pass_args args);
#define GEOMETRY_AT 0
#include "shaders/surfaces/surfaces.glsl"
TYN_UPDATE(4, wall_links, uint links[]);
// [link 0..13][cell]: of the nearest hit, its share of the way (8 bits), its triangle (24 bits).
TYN_UPDATE(5, hits, uint hits[]);
// [slot][cell]: of the nearest plane that passes through the cell, the same.
TYN_UPDATE(6, nearest, uint nearest[]);
#include "shaders/walls/walls_place.glsl"

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

// Of a link and its reverse one is looked at: that whose first component but zeros is > 0.
const int HALF = 13;

ivec3 half_step(int k)
{
    return ivec3((k + 14) / 9, (k + 14) / 3 % 3, (k + 14) % 3) - 1;
}

// Where along each axis links may start whose boxes meet the triangle's, by their step -1, 0, 1 along the axis.
struct starts {
    ivec3 first, first_up; // of steps <= 0, of 1
    ivec3 count_down, count, count_up;
};

starts starts_of(vec3 least, vec3 most)
{
    vec3 dims = vec3(args.dims);
    starts s;
    s.first = ivec3(clamp(ceil(least), vec3(-1.0), dims + 1.0));
    s.first_up = ivec3(clamp(ceil(least - 1.0), vec3(-1.0), dims + 1.0));
    ivec3 last = ivec3(clamp(floor(most), vec3(-2.0), dims)), last_down = ivec3(clamp(floor(most + 1.0), vec3(-2.0), dims));
    s.count_down = max(last_down - s.first + 1, ivec3(0));
    s.count = max(last - s.first + 1, ivec3(0));
    s.count_up = max(last - s.first_up + 1, ivec3(0));
    return s;
}

ivec3 count_of(const starts s, ivec3 d)
{
    return mix(mix(s.count, s.count_down, lessThan(d, ivec3(0))), s.count_up, greaterThan(d, ivec3(0)));
}

// Element i of a box of n cells, x fastest. Whole numbers below 2^22: a CPU device divides them one after another.
ivec3 cell_of(int i, ivec3 n)
{
    int row = int((float(i) + 0.5) / float(n.x)), slice = int((float(row) + 0.5) / float(n.y));
    return ivec3(i - row * n.x, row - slice * n.y, slice);
}

void main()
{
    uint triangle = gl_WorkGroupID.y * args.row + gl_WorkGroupID.x;
    if (triangle >= args.num_triangles) {
        return;
    }
    walls_triangle t = walls_triangle_at(triangle);
    vec3 least = min(t.a, min(t.b, t.c)), most = max(t.a, max(t.b, t.c));
    float size = length(t.normal);
    if (!(all(lessThan(abs(least), vec3(1e9))) && all(lessThan(abs(most), vec3(1e9)))) || size == 0.0) {
        return; // not finite, or without area
    }
    int me = int(gl_WorkGroupID.z * WALLS_GROUP + gl_LocalInvocationIndex), stride = int(args.slices * WALLS_GROUP);
    // What rounding may move the triangle by.
    vec3 slack = 1e-4 + 4e-7 * max(abs(least), abs(most));
    least -= slack;
    most += slack;

    // All links whose boxes meet the triangle's, one direction after another.
    starts from = starts_of(least, most);
    int ends[HALF], total = 0;
    [[unroll]] for (int k = 0; k < HALF; k++) {
        ivec3 n = count_of(from, half_step(k));
        total += n.x * n.y * n.z;
        ends[k] = total;
    }
    for (int i = me; i < total; i += stride) {
        int k = 0, before = 0;
        [[unroll]] for (int j = 0; j < HALF - 1; j++) {
            k = i >= ends[j] ? j + 1 : k;
            before = i >= ends[j] ? ends[j] : before;
        }
        ivec3 d = half_step(k), c = mix(from.first, from.first_up, greaterThan(d, ivec3(0))) + cell_of(i - before, count_of(from, d));
        bool here = in_lattice(c), there = in_lattice(c + d);
        float where;
        if ((here || there) && walls_cuts(t, vec3(c), vec3(d), where)) {
            uint link = walls_link(d);
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
    for (int i = me; i < box.x * box.y * box.z; i += stride) {
        ivec3 c = lo + cell_of(i, box);
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
