// rooms_vpls.comp -- joins each virtual point light (VPL) with the rooms that it sees: one thread a texel of their maps.
//
// A ray of the map goes to the first surface, so every place on it is in the VPL's room. One in a cell without a wall
// tells which that is, wherever the lattice's links are cut; a ray counts if the one beside it tells the same.
#include "rooms_args.h"
#define LATTICE_ROOMS 4 // as links join them
#include "shaders/walls/lattice_rooms.glsl"
#include "shaders/lattice/lattice.glsl"
#include "shaders/light/vpl_visibility.glsl"
#include "rooms_forest.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
TYN_ARGS(rooms_args args);
layout(binding = 1) uniform usamplerBuffer wall_links_words;
TYN_READ(2, vpls, uint vpl_count; uvec3 vpl_pad; light_block vpls[]);
layout(binding = 3) uniform sampler2D vpl_distances_tex;

// As close as half a cell in boxes of a few cells, where few have no walls; down to a seventh of the way.
const int TRIES = 12;
const float NEXT = 0.84; // as far as the place before

// The room that the ray of texel `at` of a VPL's map tells of; TYN_ROOMS_ANY: none.
uint told_by(const lattice_box box, vec3 from, mat3 frame, ivec2 corner, ivec2 at, int side)
{
    vec3 d = frame * normalize(vpl_map_direction(vec2(at) / float(side - 1)));
    float end = min(texelFetch(vpl_distances_tex, corner + at, 0).r, 1e4 * box.dx);
    uint told = TYN_ROOMS_ANY;
    float place = end - 1.8 * box.dx;
    for (int k = 0; k < TRIES && told == TYN_ROOMS_ANY && place > 0.0; k++) {
        ivec3 c = ivec3(floor(lattice_from_m(box, from + place * d)));
        ivec3 at = clamp(c, ivec3(0), box.dims - 1);
        told = rooms_told(box.dims, c, at, texelFetch(wall_links_words, int(lattice_index(box, at))).x, false);
        place *= NEXT;
    }
    return told;
}

void main()
{
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy), size = textureSize(vpl_distances_tex, 0);
    int side = size.x / VPL_MAPS_IN_A_ROW;
    uint vpl = uint(texel.y / side * VPL_MAPS_IN_A_ROW + texel.x / side);
    if (any(greaterThanEqual(texel, size)) || vpl >= min(vpl_count, uint(TYN_RADIAL_VPLS_MAX))) {
        return;
    }
    ivec2 corner = vpl_map_corner(vpl, side), at = texel - corner;
    if ((at.x & 1) != 0 || at.x + 1 >= side) {
        return;
    }
    light_block light = vpls[vpl];
    lattice_box box = lattice_box_of(args.extent, ivec3(args.dims));
    vec3 from = vpl_map_origin(light.position, light.direction, light.radius);
    mat3 frame = vpl_frame(light.direction);
    uint a = told_by(box, from, frame, corner, at, side), b = told_by(box, from, frame, corner, at + ivec2(1, 0), side);
    if (a == b && a != TYN_ROOMS_ANY) {
        rooms_join(TYN_ROOMS_OF_VPL(args.dims.x * args.dims.y * args.dims.z, vpl), a);
    }
}
