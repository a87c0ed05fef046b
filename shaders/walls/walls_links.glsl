// walls_links.glsl -- the 26 links of a cell. No bindings.
#ifndef TYN_WALLS_LINKS_GLSL
#define TYN_WALLS_LINKS_GLSL
#include "walls_args.h"
#include "shaders/lattice/lattice_sweep.glsl"

// Steps of link 0..25; 0..13 are those of the lattice lines.
ivec3 walls_step(uint link)
{
    if (link < 14u) {
        return lattice_step(link);
    }
    uint k = link - 14u;
    ivec2 s = ivec2((k & 1u) == 0u ? 1 : -1, (k & 2u) == 0u ? 1 : -1);
    return k < 4u ? ivec3(0, s) : k < 8u ? ivec3(s.x, 0, s.y) : ivec3(s, 0);
}

// Of a step of at most 1 along each axis, not 0.
uint walls_link(ivec3 s)
{
    uvec3 negative = uvec3(lessThan(s, ivec3(0)));
    if (s.x != 0 && s.y != 0 && s.z != 0) {
        return 6u + negative.x + 2u * negative.y + 4u * negative.z;
    }
    if (s.x == 0) {
        return s.y == 0 ? 4u + negative.z : s.z == 0 ? 2u + negative.y : 14u + negative.y + 2u * negative.z;
    }
    if (s.y == 0) {
        return s.z == 0 ? negative.x : 18u + negative.x + 2u * negative.z;
    }
    return 22u + negative.x + 2u * negative.y;
}

// The same link seen from its other end.
uint walls_reverse(uint link)
{
    return link < 6u ? link ^ 1u : link < 14u ? 6u + (link - 6u ^ 7u) : 14u + (link - 14u ^ 3u);
}

// Is there a wall on the way from a place in c to the cell `at` of the lattice that is next to it and has these links? The
// place is in that cell or outside; where it is right beside the lattice, the wall may be farther away than the place.
bool walls_cut_off(ivec3 c, ivec3 at, uint links)
{
    ivec3 out_of = c - at;
    bool beside = out_of != ivec3(0) && all(lessThanEqual(abs(out_of), ivec3(1)));
    return beside && (links >> walls_link(beside ? out_of : ivec3(1, 0, 0)) & 1u) != 0u;
}

#endif
