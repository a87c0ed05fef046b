// shade_vpls.comp -- every pixel takes a sixteenth of the VPLs.
//
// Neighbours in a pattern of 4 x 4 pixels take different ones (Wald et al. 2002, interleaved sampling), and
// shade_gather.comp sums over the pattern. A workgroup has pixels of one place in the pattern, four apart:
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
    ivec2 cell = ivec2(part_of % SHADE_SIDE, part_of / SHADE_SIDE);
    ivec2 pixel = SHADE_SIDE * ivec2(gl_GlobalInvocationID.xy) + cell;
    if (any(greaterThanEqual(pixel, ivec2(camera.size)))) {
        return;
    }
    // The pixel's first sample that meets a surface, from its middle on.
    int side = int(args.samples), count = side * side;
    int start = (side / 2) * side + side / 2;
    gbuffer_point found;
    ivec2 texel;
    for (int i = 0; i < count; i++) {
        int k = start + i;
        texel = shade_texel(pixel * side, k < count ? k : k - count);
        found = shade_sample(texel);
        if (found.distance > 0.0) {
            break;
        }
    }
    if (found.distance <= 0.0) {
        imageStore(place_image, pixel, vec4(vec3(0.0), SHADE_NONE));
        imageStore(part_image, pixel, vec4(0.0));
        return;
    }
    shade_point p = shade_point(shade_position(texel, found.distance), found.normal, found.facet);
    vec3 part = shade_vpls(p, part_of, SHADE_SIDE * SHADE_SIDE);
    vec2 normal = gbuffer_fold(p.normal);
    imageStore(place_image, pixel, vec4(p.position, normal.x));
    imageStore(part_image, pixel, vec4(part, normal.y));
}
