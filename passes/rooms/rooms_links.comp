// rooms_links.comp -- joins the cells that open links join, one thread a cell.
#include "rooms_args.h"
#include "shaders/walls/walls_links.glsl"
#include "shaders/walls/rooms.h"
#include "shaders/common/quotient.glsl"
#include "rooms_forest.glsl"

layout(local_size_x = ROOMS_GROUP) in;
TYN_ARGS(rooms_args args);
TYN_READ(1, wall_links, uint links[]);

bool in_lattice(ivec3 c)
{
    return all(greaterThanEqual(c, ivec3(0))) && all(lessThan(c, ivec3(args.dims)));
}

bool is_free(int cell)
{
    return (links[cell] & TYN_WALLS_NEAR) == 0u;
}

void main()
{
    ivec3 dims = ivec3(args.dims), row = ivec3(1, dims.x, dims.x * dims.y);
    uint i = gl_GlobalInvocationID.x;
    if (i >= uint(row.z * dims.z)) {
        return;
    }
    ivec3 c = quotient_place(i, dims);
    uint open = ~links[i], wanted = 0u;
    // Far from walls the cell before it along x has the same neighbours but those of links that these have between
    // themselves.
    bool deep = is_free(int(i)) && all(greaterThan(c, ivec3(0)));
    deep = deep && is_free(int(i) - row.x) && is_free(int(i) - row.y) && is_free(int(i) - row.z);
    bool outer = any(equal(c, ivec3(0))) || any(equal(c, dims - 1)), leaves = false;
    for (uint link = 0u; link < uint(TYN_WALLS_LINKS) && (outer || !deep); link++) {
        ivec3 d = walls_step(link);
        bool is_open = (open >> link & 1u) != 0u, inside = in_lattice(c + d);
        leaves = leaves || is_open && !inside;
        // Of the two ends the later joins.
        wanted |= is_open && inside && d.x + row.y * d.y + row.z * d.z < 0 ? 1u << link : 0u;
    }
    wanted = deep ? 1u << walls_link(ivec3(-1, 0, 0)) : wanted;
    if (leaves) {
        rooms_join(TYN_ROOMS_OF_CELL(i), TYN_ROOMS_OUTSIDE);
    }
    for (; wanted != 0u; wanted &= wanted - 1u) {
        ivec3 d = walls_step(uint(findLSB(wanted)));
        rooms_join(TYN_ROOMS_OF_CELL(i), uint(int(TYN_ROOMS_OF_CELL(i)) + d.x + row.y * d.y + row.z * d.z));
    }
}
