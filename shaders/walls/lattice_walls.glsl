// lattice_walls.glsl -- light of the lattice at a point, not blended through walls.
//
// Include after lattice.glsl and define:
//   WALLS_AT      first binding of the bundle TYN_WALLS (bundles.h)
//   WALLS_STORAGE if its buffers are storage buffers; else they are read as texels
//   LATTICE_ROOMS if it is known which cells are joined (lattice_rooms.glsl)
// Call nothing of this where the scene has no surfaces: then the buffers hold nothing.
//
// A point in a cell through which no wall passes sees all 26 neighbours, and is served by trilinear
// interpolation. Else it takes, of the eight cells around it, those on its own side: if it is on the
// side of its cell's centre (of up to three planes), those to which the links are open; if not, those whose
// centres are on the same sides of these planes as the point, and which have no wall towards it.
#ifndef TYN_LATTICE_WALLS_GLSL
#define TYN_LATTICE_WALLS_GLSL
#include "walls_args.h"
#include "walls_links.glsl"
#include "rooms.h"
#ifdef LATTICE_ROOMS
#include "lattice_rooms.glsl"
#endif

// Of the walls in a cell (struct wall_cell): 0 where none is about.
struct walls_planes {
    vec4 plane[TYN_WALLS_PLANES];
};

// Bit k: p, in M, is behind plane k as seen from the cell's centre.
uint walls_behind(const walls_planes walls, vec3 p)
{
    uint behind = 0u;
    for (uint k = 0u; k < TYN_WALLS_PLANES; k++) {
        behind |= dot(walls.plane[k].xyz, p) + walls.plane[k].w < 0.0 ? 1u << k : 0u;
    }
    return behind;
}

#ifdef WALLS_STORAGE
TYN_READ(WALLS_AT, wall_links, uint wall_links[]);
TYN_READ(WALLS_AT + 1, wall_cells, wall_cell wall_cells[]);

uint walls_links_of(uint cell)
{
    return wall_links[cell];
}

walls_planes walls_planes_of(uint cell)
{
    return walls_planes(wall_cells[cell].planes);
}
#else
layout(set = 0, binding = WALLS_AT) uniform usamplerBuffer wall_links_words;
layout(set = 0, binding = WALLS_AT + 1) uniform samplerBuffer wall_cells_texels; // four to a struct wall_cell

uint walls_links_of(uint cell)
{
    return texelFetch(wall_links_words, int(cell)).x;
}

walls_planes walls_planes_of(uint cell)
{
    walls_planes walls;
    for (int k = 0; k < TYN_WALLS_PLANES; k++) {
        walls.plane[k] = texelFetch(wall_cells_texels, 4 * int(cell) + k);
    }
    return walls;
}
#endif

struct walls_place {
    ivec3 cell;
    uint index; // of the cell
    uint links; // its wall_links
    vec3 x;     // the point in cell edges; centres are at whole numbers
};

// Of a point in M; outside the lattice that of its nearest cell.
walls_place walls_place_of(const lattice_box box, vec3 p)
{
    walls_place w;
    w.x = lattice_from_m(box, p) - 0.5;
    w.cell = clamp(ivec3(floor(w.x + 0.5)), ivec3(0), box.dims - 1);
    w.index = lattice_index(box, w.cell);
    w.links = walls_links_of(w.index);
    return w;
}

// Is there a wall about? If not, trilinear interpolation will do.
bool walls_near(const walls_place w)
{
    return (w.links & TYN_WALLS_NEAR) != 0u;
}

// The same, for what is not in the cell: a wall that cuts a link of the cell, but is not in it, has no plane there and may
// hide anything.
walls_planes walls_planes_hiding(uint cell)
{
    walls_planes walls = walls_planes_of(cell);
    bool unknown = (walls_links_of(cell) & TYN_WALLS_NEAR) != 0u && walls.plane[0] == vec4(0.0);
    walls.plane[0] = unknown ? vec4(0.0, 0.0, 0.0, -1.0) : walls.plane[0];
    return walls;
}

// Is p, a point of the cell, on the side of the cell's centre?
bool walls_same_side(const lattice_box box, ivec3 cell, vec3 p)
{
    return walls_behind(walls_planes_of(lattice_index(box, cell)), p) == 0u;
}

vec3 walls_centre(const lattice_box box, ivec3 cell)
{
    vec3 shift = vec3(TYN_WALLS_SHIFT_X, TYN_WALLS_SHIFT_Y, TYN_WALLS_SHIFT_Z);
    return lattice_to_m(box, vec3(cell) + 0.5 + shift);
}

// Shares of the cells around a point: corner i is `cell`, and `step` away from it along x, y, z as bits 0, 1, 2 of i
// are set. They sum to 1, or are all 0 where no cell near has light for the point.
struct walls_blend {
    ivec3 cell, step; // 0 where that would be beyond the lattice: the same cell counts twice then
    float share[8];
    ivec3 instead; // where all shares are 0: the cell to take alone; x < 0: none
};

ivec3 walls_corner(const walls_blend b, uint i)
{
    return b.cell + b.step * ivec3(i & 1u, i >> 1 & 1u, i >> 2);
}

// Does a point that is behind walls of its cell see cell q? `behind` = walls_behind of the point.
bool walls_sees_behind(const lattice_box box, const walls_place w, vec3 p, uint behind, ivec3 q)
{
    // Walls between p and q that do not touch the point's cell are in that of q.
    uint side = walls_behind(walls_planes_of(w.index), walls_centre(box, q));
    return q != w.cell && side == behind && walls_same_side(box, q, p);
}

bool walls_sees(const lattice_box box, const walls_place w, vec3 p, uint behind, ivec3 q)
{
    if (behind != 0u) {
        return walls_sees_behind(box, w, p, behind, q);
    }
    return q == w.cell || (w.links >> walls_link(q - w.cell) & 1u) == 0u;
}

// Bit i: corner i may be reached, the steps being down where negative[axis] is 1.
uint walls_open_corners(uint links, uvec3 negative)
{
    uvec3 axis = uvec3(links) >> (uvec3(0u, 2u, 4u) + negative);
    uvec3 face = uvec3(links) >> (uvec3(14u, 18u, 22u) + negative.yxx + 2u * negative.zzy); // across x, y, z
    uint diagonal = links >> (6u + negative.x + 2u * negative.y + 4u * negative.z);
    return 1u | (~axis.x & 1u) << 1 | (~axis.y & 1u) << 2 | (~face.z & 1u) << 3 | (~axis.z & 1u) << 4 |
           (~face.y & 1u) << 5 | (~face.x & 1u) << 6 | (~diagonal & 1u) << 7;
}

// Is q a cell of `room`?
bool walls_in_room(const lattice_box box, ivec3 q, uint room)
{
#ifdef LATTICE_ROOMS
    return room == TYN_ROOMS_ANY || rooms_of_cell(box.dims, q) == room;
#else
    return true;
#endif
}

#ifdef LATTICE_ROOMS
// As rooms_told; `beside`: also of a place near a wall, if it is on the side of its cell's centre of all planes there.
uint walls_room_told(const lattice_box box, vec3 p, bool beside)
{
    ivec3 c = ivec3(floor(lattice_from_m(box, p))), at = clamp(c, ivec3(0), box.dims - 1);
    uint index = lattice_index(box, at), links = walls_links_of(index);
    return rooms_told(box.dims, c, at, links, beside && walls_behind(walls_planes_of(index), p) == 0u);
}
#endif

// `room` of the point, with LATTICE_ROOMS; or TYN_ROOMS_ANY. It tells what planes of two cells do not: walls in a third one
// between them.
walls_blend walls_blend_in(const lattice_box box, const walls_place w, vec3 p, uint room)
{
    walls_planes planes = walls_planes_of(w.index);
    uint behind = walls_behind(planes, p);
    vec3 away = w.x - vec3(w.cell);
    bvec3 down = lessThan(away, vec3(0.0));
    ivec3 step = mix(ivec3(1), ivec3(-1), down);
    bvec3 beyond = notEqual(clamp(w.cell + step, ivec3(0), box.dims - 1), w.cell + step);
    step = mix(step, ivec3(0), beyond);
    walls_blend b;
    b.cell = w.cell;
    b.step = step;
    b.instead = ivec3(-1);

    uint seen = walls_open_corners(w.links, uvec3(down));
    seen = beyond.x ? (seen & 0x55u) * 3u : seen;
    seen = beyond.y ? (seen & 0x33u) * 5u : seen;
    seen = beyond.z ? (seen & 0x0fu) * 17u : seen;
    // Behind walls, those that these do not part from the point and which have no wall of their own towards it: that
    // is asked for in a loop, as some devices run both sides of a branch.
    uint same = 0u;
    vec3 centre = walls_centre(box, w.cell), dx = box.dx * vec3(step);
    for (uint i = 1u; i < 8u; i++) {
        vec3 q = centre + dx * vec3(i & 1u, i >> 1 & 1u, i >> 2);
        same |= walls_behind(planes, q) == behind && q != centre ? 1u << i : 0u;
    }
    seen = behind == 0u ? seen : same;
    for (uint left = behind == 0u ? 0u : same; left != 0u; left &= left - 1u) {
        uint i = uint(findLSB(left));
        bool sees = walls_same_side(box, walls_corner(b, i), p) && walls_in_room(box, walls_corner(b, i), room);
        seen = sees ? seen : seen & ~(1u << i);
    }
    vec3 f = min(abs(away), vec3(0.5));
    float sum = 0.0;
    for (uint i = 0u; i < 8u; i++) {
        vec3 t = mix(1.0 - f, f, vec3(i & 1u, i >> 1 & 1u, i >> 2));
        b.share[i] = (seen >> i & 1u) != 0u ? t.x * t.y * t.z : 0.0;
        sum += b.share[i];
    }
    bool any_seen = sum > 1e-6;
    for (uint i = 0u; i < 8u; i++) {
        b.share[i] = any_seen ? b.share[i] / sum : 0.0;
    }
    float nearest = 1e30;
    for (int i = any_seen ? 27 : 0; i < 27; i++) {
        ivec3 q = w.cell + ivec3(i % 3, i / 3 % 3, i / 9) - 1;
        if (any(lessThan(q, ivec3(0))) || any(greaterThanEqual(q, box.dims)) || !walls_sees(box, w, p, behind, q) ||
            !walls_in_room(box, q, room)) {
            continue;
        }
        float far = distance(vec3(q), w.x);
        b.instead = far < nearest ? q : b.instead;
        nearest = min(far, nearest);
    }
    return b;
}

walls_blend walls_blend_of(const lattice_box box, const walls_place w, vec3 p)
{
    return walls_blend_in(box, w, p, TYN_ROOMS_ANY);
}

// Do the centres of two cells see each other? Along the links next to the line between them: never through a
// closed mesh; past edges and along oblique walls right to about a cell. `b` may be outside the lattice, where
// there are no walls.
bool walls_visible(const lattice_box box, ivec3 a, ivec3 b)
{
    ivec3 way = abs(b - a), at = a;
    int n = max(way.x, max(way.y, way.z));
    for (int i = 1; i <= n; i++) {
        ivec3 next = a + ivec3(floor(vec3(b - a) * (float(i) / float(n)) + 0.5));
        uint links = walls_links_of(lattice_index(box, at));
        if ((links >> walls_link(next - at) & 1u) != 0u) {
            return false;
        }
        if (any(lessThan(next, ivec3(0))) || any(greaterThanEqual(next, box.dims))) {
            return true;
        }
        at = next;
    }
    return true;
}

// The cell that a light on a surface shines from, `n` being the side it is on.
ivec3 walls_cell_before(const lattice_box box, vec3 p, vec3 n)
{
    return ivec3(floor(lattice_from_m(box, p) + 0.75 * n));
}

// A field with one texel per cell, `skip` texels of the texture before cell 0. Channel ch of a stacked one:
// skip.z = ch dims.z.
vec4 walls_fetch(sampler3D field, const lattice_box box, const walls_blend b, ivec3 skip)
{
    vec4 sum = vec4(0.0);
    if (b.instead.x >= 0) {
        return texelFetch(field, b.instead + skip, 0);
    }
    for (uint i = 0u; i < 8u; i++) {
        if (b.share[i] > 0.0) {
            sum += b.share[i] * texelFetch(field, walls_corner(b, i) + skip, 0);
        }
    }
    return sum;
}

#endif
