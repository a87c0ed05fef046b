// shade_gather.comp -- all VPLs' light at a pixel, from the parts that it and its neighbours took.
//
// The 5 x 5 pixels around one hold every place of the pattern once (in small pictures, where it is 4 x 4, if the
// outermost count by half).
// Only neighbours on the same piece of surface count; few of them stand for all, as every place of the
// pattern takes VPLs from everywhere. Where next to none are left the pixel takes all VPLs itself.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shade.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 21) uniform sampler2D place_tex;
layout(binding = 22) uniform sampler2D part_tex;
layout(binding = 23, rgba32f) uniform writeonly image2D indirect_image; // irradiance; not 0: a surface

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), last = ivec2(camera.size) - 1;
    if (any(greaterThan(pixel, last))) {
        return;
    }
    vec4 place = texelFetch(place_tex, pixel, 0);
    if (place.w == SHADE_NONE) {
        imageStore(indirect_image, pixel, vec4(0.0));
        return;
    }
    vec3 normal = gbuffer_unfold(vec2(place.w, texelFetch(part_tex, pixel, 0).w));
    // Neighbours may be as far off the pixel's plane as the pixel is wide.
    float across = camera.orthographic != 0u ? 1.0 : distance(place.xyz, camera.origin);
    float width = 2.0 * camera.half_height / float(camera.size.y) * across;
    float tolerance = 1.0 / (width * width);
    vec4 sum = vec4(0.0);
    // All of them within the picture: every place of the pattern counts at its borders, too.
    bool odd = shade_side == SHADE_SIDE;
    ivec2 first = pixel - SHADE_REACH;
    first = odd ? clamp(first, ivec2(0), last - 2 * SHADE_REACH) : first;
    for (int y = 0; y <= 2 * SHADE_REACH; y++) {
        for (int x = 0; x <= 2 * SHADE_REACH; x++) {
            ivec2 at = first + ivec2(x, y), held = clamp(at, ivec2(0), last);
            vec4 there = texelFetch(place_tex, held, 0);
            vec4 part = texelFetch(part_tex, held, 0);
            float share = odd ? 1.0 : (x % 4 == 0 ? 0.5 : 1.0) * (y % 4 == 0 ? 0.5 : 1.0);
            float off = dot(normal, there.xyz - place.xyz);
            float turned = dot(normal, gbuffer_unfold(vec2(there.w, part.w)));
            bool surface = at == held && there.w != SHADE_NONE;
            share *= surface ? smoothstep(0.7, 0.9, turned) / (1.0 + tolerance * off * off) : 0.0;
            sum += share * vec4(part.rgb, 1.0);
        }
    }
    vec3 all = sum.rgb * (float(shade_side * shade_side) / max(sum.w, 1e-6));
    for (bool alone = sum.w < float(shade_side); alone; alone = false) { // a loop, as most need not go in
        shade_point p = shade_point(place.xyz, normal, normal);
        shade_point same[SHADE_MANY] = shade_point[](p, p, p, p); // the compiler sees that they are
        all = shade_vpls(same, 0u, 1u)[0];
    }
    imageStore(indirect_image, pixel, vec4(all, 1.0));
}
