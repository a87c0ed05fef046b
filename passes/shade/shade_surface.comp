// shade_surface.comp -- radiance of the surfaces towards the camera.
//
// A thread has a pixel of the picture, which it shades if that shows one piece of surface; or one of the list of pixels that show
// several, or one beside nothing, whose pieces it shades one after another (args.listed).
#include "shaders/surfaces/gbuffer_edges.glsl"
#include "shade_piece.glsl"
#include "shade_whole.glsl"
#include "shade_several.glsl"
#define SHADE_ALONE_COUNT (SHADE_PIECE_AT + 1)
#define SHADE_ALONE (SHADE_PIECE_AT + 2)
#include "shade_alone.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = SHADE_PIECE_AT, rg32ui) uniform writeonly uimage2D surface_radiance_image; // packed_colour.glsl, and the piece's number

bool is_listed()
{
    bool listed = shade_has(SHADE_EDGES);
    if (shade_has(SHADE_PIXELS)) {
        listed = listed && args.listed != 0u;
    }
    return listed;
}

// Samples of the pixel that are to be shaded: bits. Of those that show no surface the picture gets 0.
uint samples_shown(ivec2 pixel, const gbuffer_facing seen, bool listed)
{
    uint shown = 0u;
    for (int k = 0; k < shade_samples * shade_samples; k++) {
        ivec2 texel = shade_texel(pixel * shade_samples, k);
        bool is = listed ? shade_distance(texel) > 0.0 : seen.shown == GBUFFER_WHOLE;
        shown |= is ? 1u << k : 0u;
        if (listed ? !is : seen.shown == GBUFFER_NONE) {
            imageStore(surface_radiance_image, texel, uvec4(0u));
        }
    }
    return shown;
}

// Smooth light that is looked up. `lone`: no place tells of it.
vec3 smooth_light_found(const shade_point p, ivec2 pixel, vec2 middle, bool listed, out bool lone)
{
    lone = false;
    if (shade_step > 1) {
        return smooth_light_around(p, middle, lone);
    }
    vec3 light = vec3(0.0);
    if (shade_has(SHADE_SHARED)) {
        if (listed) {
            light = smooth_light_beside(p, middle, lone);
        } else {
            light = shade_unpack(imageLoad(part_image, pixel)).irradiance;
        }
    }
    return light;
}

void main()
{
    bool listed = is_listed();
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    bool is = all(lessThan(pixel, ivec2(camera.size)));
    if (listed) {
        uint n = gbuffer_edge();
        is = n < edge_count.count;
        uint entry = edges[is ? n : 0u];
        pixel = ivec2(entry & 0xffffu, entry >> 16);
    }
    if (!is) {
        return;
    }
    gbuffer_facing seen = shade_facing(pixel);
    uint left = samples_shown(pixel, seen, listed);
    uint alone = 0u; // bit k: sample k shows a piece that no place tells of
    for (uint piece = 0u; left != 0u; piece++) {
        gbuffer_colours colours;
        uint members = left;
        vec4 part = vec4(pixel, pixel + 1);
        shade_point p;
        if (listed) {
            p = piece_of(pixel, left, colours, members);
            part = part_of(pixel * shade_samples, members);
        } else {
            p = shade_whole(pixel, seen);
            colours = gbuffer_unpack(shade_colours(pixel, 0));
        }
        bool lone;
        vec3 smoothed = smooth_light_found(p, pixel, 0.5 * (part.xy + part.zw), listed, lone);
        vec3 irradiance = shade_step > 1 ? sharp_light_at(p, part) : irradiance_at(p, part);
        irradiance += lone ? vec3(0.0) : smoothed;
        alone |= lone ? (listed ? members : SHADE_ALONE_WHOLE) : 0u;
        uvec2 radiance = colour_pack(shade_radiance(colours, irradiance)) | uvec2(0u, min(piece, 3u) << 30);
        for (int k = 0; k < shade_samples * shade_samples; k++) {
            if ((members >> k & 1u) != 0u) {
                imageStore(surface_radiance_image, shade_texel(pixel * shade_samples, k), uvec4(radiance, 0u, 0u));
            }
        }
        left &= ~members;
        if (!shade_has(SHADE_EDGES)) {
            break; // known when the kernel is compiled
        }
    }
    if (alone != 0u) {
        shade_list_alone(pixel, alone, 1u);
    }
}
