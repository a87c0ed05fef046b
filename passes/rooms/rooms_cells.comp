// rooms_cells.comp -- the room of each cell and VPL.
#include "rooms_args.h"
#include "shaders/walls/rooms.h"
#include "shaders/lattice/lattice.glsl"
#include "rooms_forest.glsl"

layout(local_size_x = ROOMS_GROUP) in;
TYN_ARGS(rooms_args args);
TYN_WRITE(1, rooms, uint rooms[]);
TYN_READ(2, vpls, uint vpl_count; uvec3 vpl_pad; light_block vpls[]);

// As the last entries of rooms.h tell it, of a VPL that shines in `room`.
uint cell_before(uint vpl, uint room)
{
    ivec3 dims = ivec3(args.dims);
    lattice_box box = lattice_box_of(args.extent, dims);
    vec3 x = lattice_from_m(box, vpls[vpl].position) + 0.75 * vpls[vpl].direction; // as walls_cell_before of lattice_walls.glsl
    ivec3 before = ivec3(floor(x));
    uint found = TYN_ROOMS_NONE;
    float nearest = 1e30;
    for (int k = 0; k < 27; k++) {
        ivec3 d = ivec3(k % 3, k / 3 % 3, k / 9) - 1, q = before + d;
        bool inside = all(equal(q, clamp(q, ivec3(0), dims - 1)));
        uint cell = inside ? uint((q.z * dims.y + q.y) * dims.x + q.x) : 0u;
        uint of_cell = rooms_first(inside ? TYN_ROOMS_OF_CELL(cell) : TYN_ROOMS_OUTSIDE);
        if (d == ivec3(0) && of_cell == room) {
            return TYN_ROOMS_ANY;
        }
        float away = distance(vec3(q) + 0.5, x);
        if (inside && of_cell == room && away < nearest) {
            nearest = away;
            found = cell;
        }
    }
    return found;
}

void main()
{
    uint i = gl_GlobalInvocationID.x, cells = args.dims.x * args.dims.y * args.dims.z;
    if (i >= TYN_ROOMS_ELEMENTS(cells)) {
        return;
    }
    uint room = rooms_first(i), vpl = i - TYN_ROOMS_OF_VPL(cells, 0u);
    rooms[i] = room > cells ? TYN_ROOMS_ANY : room;
    if (i > cells) {
        bool known = vpl < vpl_count && room <= cells;
        rooms[TYN_ROOMS_BEFORE_VPL(cells, vpl)] = known ? cell_before(vpl, room) : TYN_ROOMS_ANY;
    }
}
