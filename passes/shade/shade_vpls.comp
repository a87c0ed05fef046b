// shade_vpls.comp -- every pixel takes a part of the VPLs.
//
// Neighbours in a pattern of 5 x 5 pixels take different ones (Wald et al. 2002, interleaved sampling), and
// shade_gather.comp sums over the pattern. A thread has several pixels of one place in
// the pattern.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shade.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 21, rgba32f) uniform writeonly image2D place_image; // position; x of the folded normal
layout(binding = 22, rgba32f) uniform writeonly image2D part_image;  // irradiance; y of the normal

// Where a pixel's first sample is that meets a surface, from its middle on. Without one: facing nothing.
shade_point point_of(ivec2 pixel, out bool none)
{
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
    none = found.distance <= 0.0;
    return shade_point(shade_position(texel, found.distance), found.normal, found.facet);
}

void main()
{
    uint part_of = gl_WorkGroupID.z;
    ivec2 cell = ivec2(part_of % shade_side, part_of / shade_side), size = ivec2(camera.size);
    ivec2 first = shade_side * ivec2(gl_GlobalInvocationID.xy * uvec2(1, SHADE_MANY)) + cell;
    shade_point p[SHADE_MANY];
    bool none[SHADE_MANY];
    [[unroll]] for (int i = 0; i < SHADE_MANY; i++) {
        p[i] = point_of(min(first + ivec2(0, i * shade_side), size - 1), none[i]);
    }
    // Of many each place takes a 25th, of fewer a fifth: any five in a row take all, and any five below each other.
    // Else differences between parts would be larger than what a gather evens out.
    uint places = uint(shade_side * shade_side), parts = places;
    if (shade_side == SHADE_SIDE && vpl_count <= SHADE_MOST * SHADE_SIDE) {
        parts = vpl_count <= SHADE_MOST ? 1u : SHADE_SIDE;
        part_of = uint(cell.x + 2 * cell.y) % parts;
    }
    vec3 part[SHADE_MANY] = shade_vpls(p, part_of, parts);
    float scale = float(parts) / float(places);
    [[unroll]] for (int i = 0; i < SHADE_MANY; i++) {
        ivec2 pixel = first + ivec2(0, i * shade_side);
        if (all(lessThan(pixel, size))) {
            vec2 normal = gbuffer_fold(p[i].normal);
            imageStore(place_image, pixel, none[i] ? vec4(vec3(0.0), SHADE_NONE) : vec4(p[i].position, normal.x));
            imageStore(part_image, pixel, none[i] ? vec4(0.0) : vec4(scale * part[i], normal.y));
        }
    }
}
