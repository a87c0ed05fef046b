// wall_light_sum.comp -- the light of virtual point lights (VPLs) that the walls of a part of the lattice get, by room. One
// workgroup per part; sums have a fixed order.
#include "wall_light_args.h"

layout(local_size_x = WALL_LIGHT_SUM_GROUP) in;
#define WORKGROUP_SIZE WALL_LIGHT_SUM_GROUP
#define WORKGROUP_SUM vec3
#include "shaders/common/workgroup.glsl"
TYN_ARGS(wall_light_args args);
TYN_READ(0, arrived, vec3 arrived[]); // W/m^2, times the area over dx^2
TYN_WRITE(1, parts, vec3 parts[]); // [room, by its first VPL][part]: 0, but for what is written here
layout(constant_id = 0) const uint rooms = 0;
#define LATTICE_ROOMS 2
#define WALL_LIGHT_FIRST 3
#include "wall_light_rooms.glsl"

shared uint next;

void main()
{
    uint me = gl_LocalInvocationIndex, part = gl_WorkGroupID.x, cells = args.dims.x * args.dims.y * args.dims.z;
    uint size = (cells + args.num_parts - 1u) / args.num_parts;
    uint begin = part * size + me, end = min((part + 1u) * size, cells);
    // Room after room, in the order of their first VPLs; most parts have walls of one or two.
    for (uint from = 0u; from < WALL_LIGHT_VPLS; from++) {
        barrier();
        if (me == 0u) {
            next = WALL_LIGHT_DARK;
        }
        uint mine = WALL_LIGHT_DARK;
        for (uint i = begin; i < end; i += WALL_LIGHT_SUM_GROUP) {
            if (arrived[i] != vec3(0.0)) {
                uint vpl = first_vpl(i);
                mine = vpl >= from ? min(mine, vpl) : mine;
            }
        }
        barrier();
        if (mine != WALL_LIGHT_DARK) {
            atomicMin(next, mine);
        }
        barrier();
        from = next;
        if (from == WALL_LIGHT_DARK) {
            break;
        }
        vec3 sum = vec3(0.0);
        for (uint i = begin; i < end; i += WALL_LIGHT_SUM_GROUP) {
            vec3 light = arrived[i];
            sum += light != vec3(0.0) && first_vpl(i) == from ? light : vec3(0.0);
        }
        sum = workgroup_total(sum);
        if (me == 0u) {
            parts[from * WALL_LIGHT_PARTS + part] = sum;
        }
    }
}
