// shade_alone.comp -- smooth light of pieces of surface that no place for it tells of, as bars thinner than a pixel: they
// take all VPLs themselves.
#define SHADE_COLOURS
#include "shaders/surfaces/piece_light.glsl"
#include "shade_piece.glsl"
#define SHADE_ALONE_COUNT (SHADE_PIECE_AT + 1)
#define SHADE_ALONE (SHADE_PIECE_AT + 2)
#define SHADE_ALONE_TAKEN
#include "shade_alone.glsl"
#define SHADE_SKY_AT (SHADE_PIECE_AT + 3)
#include "shade_sky.glsl"

layout(local_size_x = GBUFFER_EDGES) in;

layout(binding = SHADE_PIECE_AT, rgba32ui) uniform uimage2D surface_radiance_image; // piece_light.glsl

void main()
{
    uint n = gbuffer_edge();
    if (n >= alone_count.count) {
        return;
    }
    uvec2 entry = alone_pixels[n];
    ivec2 pixel = ivec2(entry.x & 0xffffu, entry.x >> 16);
    gbuffer_pixel seen = shade_pixel(pixel);
    gbuffer_groups groups = gbuffer_groups_of(seen);
    bool two = groups.second != 0u;
    uvec4 texel = imageLoad(surface_radiance_image, pixel);
    piece_light all[2] = piece_light[2](piece_light_unpack(texel, two, 0), piece_light_unpack(texel, two, 1));
    for (uint left = entry.y, members; left != 0u; left &= ~members) {
        gbuffer_point found = gbuffer_piece(seen, gbuffer_of_group(groups, left), members);
        shade_point p = shade_point_of(found);
        vec3 light = shade_step > 1 ? smooth_light_at(p) : vec3(0.0);
        shade_point same[SHADE_MANY] = shade_point[](p, p, p, p); // the compiler sees that they are
        if (shade_has(SHADE_VPLS)) {
            uint room = shade_has(SHADE_ROOMS) ? shade_room_of(p.position) : TYN_ROOMS_ANY;
            float nearest[SHADE_MANY];
            light += shade_vpls(same, uint[SHADE_MANY](room, room, room, room), 0u, 1u, nearest)[0];
        }
        if (shade_has(SHADE_SKY_MAPS)) {
            vec4 part = vec4(pixel, pixel + 1);
            light += shade_sky(same, vec4[](part, part, part, part), 0u, 1u)[0];
        }
        gbuffer_colours colours = gbuffer_colours_of(seen, members, found);
        colours.emission = vec3(0.0); // what it sends already
        vec3 more = shade_radiance(colours, light);
        vec2 share = vec2(bitCount(members & groups.first), bitCount(members & groups.second)) /
                     max(vec2(bitCount(groups.first), bitCount(groups.second)), 1.0);
        all[0].radiance += share.x * more;
        all[1].radiance += share.y * more;
    }
    imageStore(surface_radiance_image, pixel, piece_light_pack(all[0], all[1], two));
}
