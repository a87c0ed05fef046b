// shade_rooms.glsl -- the room of the lattice (rooms.h) that a place on a surface is in.
//
// A VPL's map shows what is in its way up to a few degrees: where a wall that is seen at a slant hides a surface behind
// it, it may miss it. Rooms miss nothing that is closed.
#ifndef SHADE_ROOMS_GLSL
#define SHADE_ROOMS_GLSL
#include "shaders/lattice/lattice.glsl"
#include "walls_table.glsl"
#include "shaders/walls/walls_links.glsl"

const int SHADE_ROOM_STEPS = 8;

// Place k on the way from p to the camera, which is the last one: away from the surface's own wall, and less than a cell apart.
vec3 shade_room_place(vec3 p, vec3 way, float far, float dx, int k, out bool last)
{
    float s = (0.5 + 0.75 * float(k)) * dx;
    last = s >= far;
    return p + min(s, far) * way;
}

// What a place tells of its room: -1 nothing. `own`: also if a wall is near, and the place is on the side of its cell's
// centre of all planes there, so that none is between.
float shade_room_told(lattice_box box, vec3 p, bool own)
{
    ivec3 c = ivec3(floor(lattice_from_m(box, p))), at = clamp(c, ivec3(0), box.dims - 1);
    vec4 entry = texelFetch(walls_table_tex, at + ivec3(0, 0, TYN_WALLS_PLANES * box.dims.z), 0);
    uint links = walls_table_links(entry);
    bool near = (links & TYN_WALLS_NEAR) != 0u;
    bool behind = !own;
    for (int k = 0; own && k < TYN_WALLS_PLANES; k++) {
        vec4 plane = texelFetch(walls_table_tex, at + ivec3(0, 0, k * box.dims.z), 0);
        behind = behind || dot(plane.xyz, p) + plane.w < 0.0;
    }
    return walls_cut_off(c, at, links) ? -1.0 : at != c ? 0.0 : near && behind ? -1.0 : entry.z;
}

// What the camera sees of a surface is in the room of every place on the way to it: of the nearest one in a cell without
// walls, else of the nearest one that is on the side of its cell's centre. -1: unknown.
float shade_room_of(vec3 p)
{
    ivec3 dims = textureSize(walls_table_tex, 0);
    dims.z /= TYN_WALLS_PLANES + 1;
    lattice_box box = lattice_box_of(medium.extent, dims);
    float far = dot(p - camera.origin, camera.forward);
    vec3 way = camera_select(camera, -far * camera.forward, camera.origin - p);
    far = length(way);
    way /= max(far, 1e-20);
    float room = -1.0;
    bool last = false;
    for (int k = 0; k < SHADE_ROOM_STEPS && room < 0.0 && !last; k++) {
        room = shade_room_told(box, shade_room_place(p, way, far, box.dx, k, last), false);
    }
    last = false;
    for (int k = 0; k < SHADE_ROOM_STEPS && room < 0.0 && !last; k++) {
        room = shade_room_told(box, shade_room_place(p, way, far, box.dx, k, last), true);
    }
    return room;
}

#endif
