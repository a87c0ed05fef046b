// sky_seen.comp -- the share of every ordinate that the cells see; x: two cells.
//
// What of an ordinate is seen is that of its directions, by their light. Each is asked for at a place of its own in the cell, if that is on the side of the cell's centre, else at the
// centre. A place in the open is lit by half of the four texels around it, so that shadows are as large as they should be. Next to
// walls, or where a map's texels are wider than a cell, that would let light into closed rooms: there a cell is dark
// unless one of its places is lit for sure.
#include "shaders/common/scene_args.h"
#include "shaders/light/ordinate_args.h"
#include "shaders/light/shadow_frame.glsl"
#include "cell_places.glsl"
#include "shaders/lattice/lattice.glsl"
#include "sky_seen_args.h"
#define SKY_MAPS_AT 2
#include "shaders/light/sky_maps.glsl"
#define WALLS_AT 4
#include "shaders/walls/lattice_walls.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
layout(constant_id = 0) const uint walls = 0u;
TYN_ARGS(sky_seen_args args);
TYN_UNIFORM(0, ordinates, ordinates_block ordinates);
TYN_UNIFORM(1, directions, ordinates_block directions);
TYN_WRITE(6, sky_seen, uint sky_seen_words[]);

void main()
{
    uvec3 first = gl_GlobalInvocationID * uvec3(2, 1, 1);
    if (any(greaterThanEqual(first, args.dims))) {
        return;
    }
    lattice_box box = lattice_box_of(args.extent, ivec3(args.dims));
    vec3 shift = vec3(TYN_WALLS_SHIFT_X, TYN_WALLS_SHIFT_Y, TYN_WALLS_SHIFT_Z);
    vec3 places[2][4];
    bool beside[2];
    for (int i = 0; i < 2; i++) {
        ivec3 cell = min(ivec3(first) + ivec3(i, 0, 0), ivec3(args.dims) - 1);
        vec3 centre = lattice_to_m(box, vec3(cell) + 0.5 + shift);
        beside[i] = false;
        walls_planes planes;
        if (walls == 1u) {
            uint index = lattice_index(box, cell);
            beside[i] = (walls_links_of(index) & TYN_WALLS_NEAR) != 0u;
            planes = walls_planes_hiding(index);
        }
        for (uint k = 0u; k < 4u; k++) {
            vec3 p = centre + box.dx * place_in_cell(k);
            bool same = !beside[i] || walls_behind(planes, p) == 0u;
            places[i][k] = same ? p : centre;
        }
    }
    uint row = (args.dims.x + 1u) / 2u, plane = args.dims.z * args.dims.y * row;
    uint word = (first.z * args.dims.y + first.y) * row + first.x / 2u;
    uint count = min(ordinates.count, args.count);
    vec2 even = vec2(0.0);
    float all = 0.0;
    for (uint n = 0u; n < count; n++) {
        bool fixed_one = n < ordinates.num_fixed;
        uint first_of = fixed_one ? n : ordinates.num_fixed + (n - ordinates.num_fixed) * args.fan;
        vec2 lit = vec2(0.0), sure = vec2(0.0), even_lit = vec2(0.0);
        float power = 0.0, even_power = 0.0, texel = 0.0;
        for (uint k = 0u; k < (fixed_one ? 1u : args.fan); k++) {
            ordinate part = directions.list[first_of + k];
            shadow_light map = sky_map_of(first_of + k);
            float light = fixed_one ? 1.0 : dot(part.irradiance, args.tint);
            texel = max(texel, 2.0 / (map.texels * min(length(map.rows[0].xyz), length(map.rows[1].xyz))));
            for (int i = 0; i < 2; i++) {
                uint by = sky_map_lights(map, places[i][k]);
                float open = (by & SHADOW_LIT_BY_HALF) != 0u ? 1.0 : 0.0;
                lit[i] += light * open;
                even_lit[i] += part.even * open;
                sure[i] = (by & SHADOW_LIT_BY_ALL) != 0u ? 1.0 : sure[i];
            }
            power += light;
            even_power += part.even;
        }
        all += even_power;
        vec2 share = lit / max(power, 1e-30);
        if (power < 1e-30 && even_power > 0.0) {
            share = even_lit / even_power; // the map is black there
        }
        for (int i = 0; i < 2; i++) {
            bool dark = (beside[i] || texel > box.dx) && sure[i] == 0.0;
            share[i] = dark ? 0.0 : min(share[i], 1.0);
            even[i] += dark ? 0.0 : even_lit[i];
        }
        sky_seen_words[word + (n + 1u) * plane] = packUnorm2x16(share);
    }
    sky_seen_words[word] = packUnorm2x16(all > 0.0 ? even / all : vec2(1.0));
}
