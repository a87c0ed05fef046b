// shade_surface.comp -- radiance of the surfaces towards the camera. One thread a pixel; those that show several pieces
// of surface are left to shade_edges.comp.
#include "shade_piece.glsl"
#include "shade_whole.glsl"
#define SHADE_ALONE_COUNT (SHADE_PIECE_AT + 1)
#define SHADE_ALONE (SHADE_PIECE_AT + 2)
#include "shade_alone.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = SHADE_PIECE_AT, rg32ui) uniform writeonly uimage2D surface_radiance_image; // packed_colour.glsl

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(camera.size)))) {
        return;
    }
    ivec2 corner = pixel * shade_samples;
    gbuffer_facing seen = shade_facing(pixel);
    if (seen.shown == GBUFFER_NONE) {
        for (int k = 0; k < shade_samples * shade_samples; k++) {
            imageStore(surface_radiance_image, shade_texel(corner, k), uvec4(0u));
        }
    }
    if (seen.shown == GBUFFER_WHOLE) {
        shade_point p = shade_whole(pixel, seen);
        bool alone = false;
        vec3 irradiance;
        if (shade_step > 1) {
            vec3 smoothed = smooth_light_around(p, vec2(pixel) + 0.5, alone);
            irradiance = sharp_light_at(p, vec4(pixel, pixel + 1)) + (alone ? vec3(0.0) : smoothed);
        } else {
            irradiance = irradiance_at(p, vec4(pixel, pixel + 1));
            irradiance += shade_has(SHADE_SHARED) ? shade_unpack(imageLoad(part_image, pixel)).irradiance : vec3(0.0);
        }
        uvec2 radiance = colour_pack(shade_radiance(gbuffer_unpack(shade_colours(pixel, 0)), irradiance));
        for (int k = 0; k < shade_samples * shade_samples; k++) {
            imageStore(surface_radiance_image, shade_texel(corner, k), uvec4(radiance, 0u, 0u));
        }
        if (alone) {
            shade_list_alone(pixel, SHADE_ALONE_WHOLE, 1u);
        }
    }
}
