// wall_light_cells.comp -- the cells that have walls in rooms that virtual point lights shine in: few, so that a list of them
// keeps all threads of wall_light_vpls.comp busy on devices that run them in groups.
#extension GL_EXT_control_flow_attributes : require
#include "wall_light_args.h"
#include "shaders/walls/walls_links.glsl"

layout(local_size_x = WALL_LIGHT_GROUP) in;
TYN_ARGS(wall_light_args args);
TYN_READ(0, wall_cells, wall_cell wall_cells[]);
TYN_UPDATE(1, list, wall_light_list list; uint list_entries[]);
TYN_WRITE(2, wall_light, vec3 wall_light[]);
TYN_READ(3, wall_links, uint links[]);
TYN_WRITE(4, arrived, vec3 arrived[]);
layout(constant_id = 0) const uint added = 0;  // 1: to the suns' light
layout(constant_id = 1) const uint scaled = 0; // 1: light that black walls get counts, too
layout(constant_id = 2) const uint rooms = 0;
#define LATTICE_ROOMS 5
#define WALL_LIGHT_FIRST 6
#include "wall_light_rooms.glsl"

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i == 0u) {
        list.groups.yz = uvec2(1u);
    }
    uint cells = args.dims.x * args.dims.y * args.dims.z;
    if (i >= cells) {
        return;
    }
    uint cut = 0u, found = links[i];
    [[unroll]] for (uint link = 0u; link < uint(TYN_WALLS_LINKS); link++) {
        ivec3 d = walls_step(link);
        cut |= (found >> link & 1u) << uint(13 + d.x + 3 * d.y + 9 * d.z);
    }
    list_entries[i] = cut;
    bool reflects = wall_cells[i].area > 0.0 && (scaled == 1 || wall_cells[i].albedo != vec3(0.0));
    if (reflects && first_vpl(i) != WALL_LIGHT_DARK) {
        uint n = atomicAdd(list.count, 1u);
        list_entries[cells + n] = i;
        atomicMax(list.groups.x, n / WALL_LIGHT_GROUP + 1u);
    } else {
        arrived[i] = vec3(0.0);
        if (added == 0) {
            wall_light[i] = vec3(0.0);
        }
    }
}
