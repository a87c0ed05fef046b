// shade_rooms.glsl -- the room of the lattice (rooms.h) that a place on a surface is in.
//
// A VPL's map shows what is in its way up to a few degrees: where a wall that is seen at a slant hides a surface behind
// it, it may miss it. Rooms miss nothing that is closed.
#ifndef SHADE_ROOMS_GLSL
#define SHADE_ROOMS_GLSL
#include "lattice.glsl"
#include "walls_table.glsl"
#include "walls_links.glsl"

const int SHADE_ROOM_STEPS = 8;

// What the camera sees of a surface is in the room of every place on the way to it: of the nearest one in a cell without
// walls. -1: unknown.
float shade_room_of(vec3 p)
{
    ivec3 dims = textureSize(walls_table_tex, 0);
    dims.z /= TYN_WALLS_PLANES + 1;
    lattice_box box = lattice_box_of(medium.extent, dims);
    float far = dot(p - camera.origin, camera.forward);
    vec3 way = camera.orthographic != 0u ? -far * camera.forward : camera.origin - p;
    far = length(way);
    way /= max(far, 1e-20);
    float room = -1.0;
    for (int k = 0; k < SHADE_ROOM_STEPS && room < 0.0; k++) {
        float s = (0.5 + 0.75 * float(k)) * box.dx;
        if (s >= far) {
            break;
        }
        ivec3 c = ivec3(floor(lattice_from_m(box, p + s * way))), at = clamp(c, ivec3(0), dims - 1);
        vec4 entry = texelFetch(walls_table_tex, at + ivec3(0, 0, TYN_WALLS_PLANES * dims.z), 0);
        bool near = (walls_table_links(entry) & TYN_WALLS_NEAR) != 0u;
        // Right beside the lattice, with a wall on the way there: that may be farther away.
        ivec3 out_of = c - at;
        bool beside = out_of != ivec3(0) && all(lessThanEqual(abs(out_of), ivec3(1)));
        uint link = walls_link(beside ? out_of : ivec3(1, 0, 0));
        bool walled = beside && (walls_table_links(entry) >> link & 1u) != 0u;
        room = walled ? -1.0 : at != c ? 0.0 : near ? -1.0 : entry.z;
    }
    return room;
}

#endif
