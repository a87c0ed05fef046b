// shade_surface.comp -- radiance of the surfaces towards the camera. One thread a pixel; those that show several pieces
// of surface are left to shade_edges.comp.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shade_piece.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(camera.size)))) {
        return;
    }
    ivec2 corner = pixel * shade_samples;
    vec4 emission = texelFetch(emission_tex, corner, 0);
    for (bool none = gbuffer_none(emission); none; none = false) {
        for (int k = 0; k < shade_samples * shade_samples; k++) {
            imageStore(radiance_image, shade_texel(corner, k), vec4(vec3(0.0), NOWHERE));
        }
    }
    for (bool whole = gbuffer_whole(emission); whole; whole = false) {
        vec4 surface = texelFetch(surface_tex, corner, 0);
        gbuffer_point seen = gbuffer_unpack(surface, texelFetch(albedo_tex, corner, 0), emission);
        // In the middle of the samples, but on the plane of the one whose facet is to be in a shadow or not.
        vec3 at = shade_position(corner, surface.w), off = vec3(0.0);
        for (int k = 1; k < shade_samples * shade_samples; k++) {
            ivec2 texel = shade_texel(corner, k);
            off += shade_position(texel, texelFetch(surface_tex, texel, 0).w) - at;
        }
        off = (off - dot(off, seen.facet) * seen.facet) / float(shade_samples * shade_samples);
        shade_point p = shade_point(at + off, seen.normal, seen.facet);
        vec3 irradiance = irradiance_at(p, vec4(pixel, pixel + 1));
        if (shade_has(SHADE_VPLS)) {
            irradiance += shade_unpack(imageLoad(indirect_image, pixel)).irradiance;
        }
        vec3 radiance = seen.emission + seen.albedo * irradiance / PI;
        for (int k = 0; k < shade_samples * shade_samples; k++) {
            ivec2 texel = shade_texel(corner, k);
            imageStore(radiance_image, texel, vec4(radiance, texelFetch(surface_tex, texel, 0).w));
        }
    }
}
