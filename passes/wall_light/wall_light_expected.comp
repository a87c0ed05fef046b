// wall_light_expected.comp -- the power that a virtual point light (VPL) sends to walls, as the rays of its map say, and the
// room that it shines in. One workgroup per VPL.
//
// The map's texels are directions on a grid with its edges: halves there. A ray that ends beyond the lattice's last links
// meets no wall of a cell.
#include "wall_light_args.h"
#define MEDIUM_BLOCK 0
#define RADIALS_AT 1
#include "shaders/medium/medium.glsl"
#include "shaders/beams/radial.glsl"
#include "shaders/lattice/lattice.glsl"
#include "shaders/light/vpl_visibility.glsl"

layout(local_size_x = WALL_LIGHT_GROUP) in;
#define WORKGROUP_SIZE WALL_LIGHT_GROUP
#define WORKGROUP_SUM vec4
#include "shaders/common/workgroup.glsl"
TYN_ARGS(wall_light_args args);
layout(binding = 5) uniform sampler2D vpl_distances_tex;
TYN_WRITE(6, power, wall_light_power power);
layout(constant_id = 1) const uint rooms = 0;
#define LATTICE_ROOMS 7
#include "shaders/walls/lattice_rooms.glsl"
TYN_UPDATE(8, first, uint first[]); // by room: the first VPL that shines there

const float PI = 3.14159265;

// Of the cell that light goes out from, as wall_light_vpls.comp has it: only cells that open links join with it see the VPL.
uint room_of(uint vpl, light_block light, lattice_box box)
{
    ivec3 from = ivec3(floor(lattice_from_m(box, light.position) + 0.75 * light.direction)); // walls_cell_before
    bool shines = rooms == 0 || rooms_cell_before(box.dims, vpl, from);
    bool inside = all(greaterThanEqual(from, ivec3(0))) && all(lessThan(from, box.dims));
    return rooms == 0 || !inside ? TYN_ROOMS_OUTSIDE : shines ? rooms_of_cell(box.dims, from) : rooms_of_vpl(box.dims, vpl);
}

void main()
{
    uint me = gl_LocalInvocationIndex, vpl = gl_WorkGroupID.x, n = radial_num_lamps + vpl;
    bool shines = n < radial_count;
    int side = textureSize(vpl_distances_tex, 0).x / VPL_MAPS_IN_A_ROW;
    uint rays = shines ? uint(side * side) : 0u;
    radial_grid grid = radials[min(n, TYN_RADIAL_LAMPS_MAX + TYN_RADIAL_VPLS_MAX - 1u)];
    light_block light = grid.light;
    vec3 from = vpl_map_origin(light.position, light.direction, light.radius);
    mat3 frame = vpl_frame(light.direction);
    lattice_box box = lattice_box_of(args.extent, ivec3(args.dims));
    ivec2 corner = vpl_map_corner(vpl, side);
    vec4 sum = vec4(0.0); // arrives, per W/sr; of all directions
    for (uint k = me; k < rays; k += WALL_LIGHT_GROUP) {
        ivec2 at = ivec2(k % uint(side), k / uint(side));
        vec3 on_map = vpl_map_direction(vec2(at) / float(side - 1));
        float size = length(on_map), end = texelFetch(vpl_distances_tex, corner + at, 0).r;
        vec2 whole = mix(vec2(1.0), vec2(0.5), lessThan(min(at, side - 1 - at), ivec2(1)));
        float share = whole.x * whole.y * on_map.z / (size * size * size * size);
        vec3 away = min(end, 1e6 * box.dx) * (frame * (on_map / size));
        vec3 off = abs(from + away - 0.5 * args.extent) - 0.5 * box.dx * vec3(args.dims);
        bool meets = max(off.x, max(off.y, off.z)) < 0.5 * box.dx;
        beam_tau tau = radial_tau(radial_place_in(grid, away, length(away)));
        sum += share * vec4(meets ? exp(-(tau.a + tau.p)) : vec3(0.0), 1.0);
    }
    sum = workgroup_total(sum);
    if (me == 0u) {
        uint room = shines ? room_of(vpl, light, box) : TYN_ROOMS_NONE;
        power.room[vpl] = room;
        power.expected[vpl] = shines ? light.color * (PI * sum.rgb / max(sum.a, 1e-20)) : vec3(0.0);
        if (room <= args.dims.x * args.dims.y * args.dims.z) {
            atomicMin(first[room], vpl);
        }
    }
}
