// wall_light_scale.comp -- the factors that make the walls of each room get what virtual point lights (VPLs) send to walls
// there. One workgroup, a thread per VPL; sums have a fixed order.
//
// The walls of the lattice are stairs: those of a box of seven cells are some percent more or less than its
// own, and farther or nearer.
#include "wall_light_args.h"
#include "shaders/lattice/lattice.glsl"

layout(local_size_x = WALL_LIGHT_VPLS) in;
TYN_ARGS(wall_light_args args);
TYN_UPDATE(0, power, wall_light_power power);
TYN_READ(1, parts, vec3 parts[]); // [room, by its first VPL][part]
TYN_READ(2, first, uint first[]); // by room

// Of rooms: W that are sent, W of these that no wall of the lattice gets; least and most factor, 0: of no light.
shared vec4 found[WALL_LIGHT_VPLS];

float sum_of(vec3 v)
{
    return v.x + v.y + v.z;
}

void main()
{
    uint me = gl_LocalInvocationIndex, room = power.room[me];
    found[me] = vec4(0.0);
    if (room <= args.dims.x * args.dims.y * args.dims.z && first[room] == me) {
        float dx = lattice_box_of(args.extent, ivec3(args.dims)).dx;
        vec3 sent = vec3(0.0), got = vec3(0.0);
        for (uint vpl = me; vpl < WALL_LIGHT_VPLS; vpl++) {
            sent += power.room[vpl] == room ? power.expected[vpl] : vec3(0.0);
        }
        for (uint part = 0u; part < args.num_parts; part++) {
            got += parts[me * WALL_LIGHT_PARTS + part];
        }
        got *= dx * dx;
        bvec3 lit = greaterThan(got, vec3(0.0));
        vec3 scale = mix(vec3(1.0), min(sent / max(got, vec3(1e-30)), vec3(1e6)), lit); // finite, as those of beams
        power.scale[me] = scale;
        found[me].xy = vec2(sum_of(sent), sum_of(abs(sent - scale * got)));
        if (any(lit)) {
            vec3 low = mix(vec3(1e30), scale, lit), high = mix(vec3(0.0), scale, lit);
            found[me].zw = vec2(min(low.x, min(low.y, low.z)), max(high.x, max(high.y, high.z)));
        }
    }
    barrier();
    if (me == 0u) {
        vec4 all = vec4(0.0, 0.0, 1e30, 0.0);
        uint rooms = 0u;
        for (uint vpl = 0u; vpl < WALL_LIGHT_VPLS; vpl++) {
            vec4 one = found[vpl];
            all.xy += one.xy;
            if (one.w > 0.0) {
                all.zw = vec2(min(all.z, one.z), max(all.w, one.w));
                rooms++;
            }
        }
        power.rooms = rooms;
        power.least = rooms > 0u ? all.z : 1.0;
        power.most = rooms > 0u ? all.w : 1.0;
        power.astray = all.y / max(all.x, 1e-30);
    }
}
