// shade_alone.comp -- smooth light of pieces of surface that no place for it tells of, as bars thinner than a pixel: they
// take all VPLs themselves.
#include "shade_piece.glsl"
#include "shade_several.glsl"
#define SHADE_SKY_AT (MATERIALS_AT + 3)
#include "shade_sky.glsl"
#include "shade_whole.glsl"
#define SHADE_ALONE_COUNT (SHADE_PIECE_AT + 1)
#define SHADE_ALONE (SHADE_PIECE_AT + 2)
#define SHADE_ALONE_TAKEN
#include "shade_alone.glsl"

layout(local_size_x = GBUFFER_EDGES) in;

layout(binding = SHADE_PIECE_AT, rg32ui) uniform uimage2D surface_radiance_image; // packed_colour.glsl

void main()
{
    uint n = gbuffer_edge();
    if (n >= alone_count.count) {
        return;
    }
    uvec2 entry = alone_pixels[n];
    ivec2 pixel = ivec2(entry.x & 0xffffu, entry.x >> 16), corner = pixel * shade_samples;
    bool whole = entry.y == SHADE_ALONE_WHOLE;
    uint left = whole ? (1u << shade_samples * shade_samples) - 1u : entry.y;
    while (left != 0u) {
        shade_point p;
        gbuffer_colours colours;
        uint members = left;
        if (whole) {
            p = shade_whole(pixel, shade_facing(pixel));
            colours = gbuffer_unpack(shade_colours(pixel, 0));
        } else {
            p = piece_of(pixel, left, colours, members);
        }
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
        uvec2 others = imageLoad(surface_radiance_image, shade_texel(corner, findLSB(members))).xy;
        colours.emission = colour_unpack(others); // what it sends already
        uvec2 radiance = colour_pack(shade_radiance(colours, light)) | uvec2(0u, others.y & 0xc0000000u);
        for (uint some = members; some != 0u; some &= some - 1u) {
            imageStore(surface_radiance_image, shade_texel(corner, findLSB(some)), uvec4(radiance, 0u, 0u));
        }
        left &= ~members;
    }
}
