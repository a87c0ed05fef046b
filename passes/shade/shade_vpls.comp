// shade_vpls.comp -- every pixel takes a part of the VPLs.
//
// Neighbours in a pattern of 5 x 5 pixels take different ones (Wald et al. 2002, interleaved sampling), and
// shade_gather.comp sums over the pattern. A workgroup has pixels of one place in the pattern:
// where no light of theirs shines on any of them they are done with it.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shade.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 21, rgba32f) uniform writeonly image2D place_image; // position; x of the folded normal
layout(binding = 22, rgba32f) uniform writeonly image2D part_image;  // irradiance; y of the normal

void main()
{
    uint part_of = gl_WorkGroupID.z;
    ivec2 cell = ivec2(part_of % shade_side, part_of / shade_side);
    ivec2 pixel = shade_side * ivec2(gl_GlobalInvocationID.xy) + cell;
    if (any(greaterThanEqual(pixel, ivec2(camera.size)))) {
        return;
    }
    // The pixel's first sample that meets a surface, from its middle on.
    const int count = shade_samples * shade_samples;
    ivec2 corner = pixel * shade_samples, texel = corner + shade_samples / 2;
    gbuffer_point found = shade_sample(corner);
    if (gbuffer_whole(texelFetch(emission_tex, corner, 0))) {
        found.distance = texelFetch(surface_tex, texel, 0).w;
    } else {
        found.distance = 0.0;
        int start = (shade_samples / 2) * (shade_samples + 1);
        for (int k = start; k < start + count && found.distance <= 0.0; k++) {
            texel = shade_texel(corner, k < count ? k : k - count);
            found = shade_sample(texel);
        }
    }
    if (found.distance <= 0.0) {
        imageStore(place_image, pixel, vec4(vec3(0.0), SHADE_NONE));
        imageStore(part_image, pixel, vec4(0.0));
        return;
    }
    shade_point p = shade_point(shade_position(texel, found.distance), found.normal, found.facet);
    // Of many each place takes a 25th, of fewer a fifth: any five in a row take all, and any five below each other.
    // Else differences between parts would be larger than what a gather evens out.
    uint places = uint(shade_side * shade_side), parts = places;
    if (shade_side == SHADE_SIDE && vpl_count <= SHADE_MOST * SHADE_SIDE) {
        parts = vpl_count <= SHADE_MOST ? 1u : SHADE_SIDE;
        part_of = uint(cell.x + 2 * cell.y) % parts;
    }
    vec3 part = shade_vpls(p, part_of, parts) * (float(parts) / float(places));
    vec2 normal = gbuffer_fold(p.normal);
    imageStore(place_image, pixel, vec4(p.position, normal.x));
    imageStore(part_image, pixel, vec4(part, normal.y));
}
