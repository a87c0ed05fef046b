// wall_light_reflect.comp -- what the walls of a cell send out of the light that arrives there from virtual point lights.
#include "wall_light_args.h"
#include "shaders/walls/walls_args.h"
#include "shaders/lattice/lattice_sweep.glsl"

layout(local_size_x = WALL_LIGHT_GROUP) in; // through the list
TYN_ARGS(wall_light_args args);
TYN_READ(0, wall_cells, wall_cell wall_cells[]);
TYN_READ(1, list, wall_light_list list; uint list_entries[]);
TYN_READ(2, arrived, vec3 arrived[]);
TYN_UPDATE(3, wall_light, vec3 wall_light[]);
TYN_READ(4, power, wall_light_power power);
layout(constant_id = 0) const uint added = 0; // 1: to the suns' light
layout(constant_id = 1) const uint scaled = 0;
layout(constant_id = 2) const uint rooms = 0;
#define LATTICE_ROOMS 5
#define WALL_LIGHT_FIRST 6
#include "wall_light_rooms.glsl"

void main()
{
    if (gl_GlobalInvocationID.x >= list.count) {
        return;
    }
    uint i = list_entries[args.dims.x * args.dims.y * args.dims.z + gl_GlobalInvocationID.x];
    vec3 radiance = wall_cells[i].albedo * arrived[i] / (LATTICE_4PI * wall_cells[i].area);
    if (scaled == 1u) {
        radiance *= power.scale[first_vpl(i)];
    }
    wall_light[i] = added == 1u ? wall_light[i] + radiance : radiance;
}
