// shade_rooms.glsl -- the room of the lattice (rooms.h) that a place on a surface is in.
//
// A VPL's map shows what is in its way up to a few degrees: where a wall that is seen at a slant hides a surface behind
// it, it may miss it. Rooms miss nothing that is closed.
#include "shade.glsl"

const int SHADE_ROOM_STEPS = 8;

// Place k on the way from p to the camera, which is the last one: away from the surface's own wall, and less than a cell apart.
vec3 shade_room_place(vec3 p, vec3 way, float far, float dx, int k, out bool last)
{
    float s = (0.5 + 0.75 * float(k)) * dx;
    last = s >= far;
    return p + min(s, far) * way;
}

// What the camera sees of a surface is in the room of every place on the way to it: of the nearest one in a cell without
// walls, else of the nearest one that is on the side of its cell's centre. TYN_ROOMS_ANY: unknown.
uint shade_room_of(vec3 p)
{
    lattice_box box = shade_lattice();
    float far = dot(p - camera.origin, camera.forward);
    vec3 way = camera_select(camera, -far * camera.forward, camera.origin - p);
    far = length(way);
    way /= max(far, 1e-20);
    uint room = TYN_ROOMS_ANY;
    bool last = false;
    for (int k = 0; k < SHADE_ROOM_STEPS && room == TYN_ROOMS_ANY && !last; k++) {
        room = walls_room_told(box, shade_room_place(p, way, far, box.dx, k, last), false);
    }
    last = false;
    for (int k = 0; k < SHADE_ROOM_STEPS && room == TYN_ROOMS_ANY && !last; k++) {
        room = walls_room_told(box, shade_room_place(p, way, far, box.dx, k, last), true);
    }
    return room;
}
