// shade_edges.comp -- pixels that show several pieces of surface, or one beside nothing: one after another.
#include "shaders/surfaces/gbuffer_edges.glsl"
#include "shade_piece.glsl"
#include "shade_several.glsl"
#define SHADE_ALONE_COUNT (SHADE_PIECE_AT + 1)
#define SHADE_ALONE (SHADE_PIECE_AT + 2)
#include "shade_alone.glsl"

layout(local_size_x = GBUFFER_EDGES) in;

layout(binding = SHADE_PIECE_AT, rg32ui) uniform writeonly uimage2D surface_radiance_image; // packed_colour.glsl, and the piece's number

void main()
{
    uint n = gbuffer_edge();
    if (n >= edge_count.count) {
        return;
    }
    int count = shade_samples * shade_samples;
    ivec2 pixel = ivec2(edges[n] & 0xffffu, edges[n] >> 16), corner = pixel * shade_samples;
    uint left = 0u; // bit k: sample k shows a surface and is not shaded yet
    for (int k = 0; k < count; k++) {
        ivec2 texel = shade_texel(corner, k);
        bool shown = shade_distance(texel) > 0.0;
        left |= shown ? 1u << k : 0u;
        if (!shown) {
            imageStore(surface_radiance_image, texel, uvec4(0u));
        }
    }
    uint alone = 0u; // bit k: sample k shows a piece that no place tells of
    for (uint piece = 0u; left != 0u; piece++) {
        gbuffer_colours colours;
        uint members;
        shade_point p = piece_of(pixel, left, colours, members);
        vec4 part = part_of(corner, members);
        vec2 middle = 0.5 * (part.xy + part.zw);
        bool lone = false;
        vec3 smoothed = vec3(0.0);
        if (shade_step > 1) {
            smoothed = smooth_light_around(p, middle, lone);
        } else if (shade_has(SHADE_SHARED)) {
            smoothed = smooth_light_beside(p, middle, lone);
        }
        vec3 irradiance = shade_step > 1 ? sharp_light_at(p, part) : irradiance_at(p, part);
        irradiance += lone ? vec3(0.0) : smoothed;
        alone |= lone ? members : 0u;
        uvec2 radiance = colour_pack(shade_radiance(colours, irradiance)) | uvec2(0u, min(piece, 3u) << 30);
        for (uint some = members; some != 0u; some &= some - 1u) {
            imageStore(surface_radiance_image, shade_texel(corner, findLSB(some)), uvec4(radiance, 0u, 0u));
        }
        left &= ~members;
    }
    if (alone != 0u) {
        shade_list_alone(pixel, alone, 1u);
    }
}
