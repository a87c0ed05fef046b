// shade_gather.comp -- all VPLs' light at a pixel, from the parts that it and its neighbours took.
//
// The 5 x 5 pixels around one, the outermost by half, hold every place of the pattern once, symmetrically.
// Only neighbours on the same piece of surface count; few of them stand for all, as every place of the
// pattern takes VPLs from everywhere. Where next to none are left the pixel takes all VPLs itself.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shade.glsl"

const int GROUP = 8, APRON = GROUP + 2 * SHADE_REACH;
layout(local_size_x = GROUP, local_size_y = GROUP) in;

layout(binding = 20) uniform sampler2D place_tex;
layout(binding = 21) uniform sampler2D part_tex;
layout(binding = 22, rgba32f) uniform writeonly image2D indirect_image; // irradiance; not 0: a surface

shared vec4 places[APRON * APRON];
shared vec4 parts[APRON * APRON];

void main()
{
    ivec2 origin = ivec2(gl_WorkGroupID.xy) * GROUP - SHADE_REACH;
    for (int i = int(gl_LocalInvocationIndex); i < APRON * APRON; i += GROUP * GROUP) {
        ivec2 at = origin + ivec2(i % APRON, i / APRON);
        bool inside = all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, ivec2(camera.size)));
        places[i] = inside ? texelFetch(place_tex, at, 0) : vec4(vec3(0.0), SHADE_NONE);
        parts[i] = inside ? texelFetch(part_tex, at, 0) : vec4(0.0);
    }
    barrier();
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), local = ivec2(gl_LocalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(camera.size)))) {
        return;
    }
    int centre = (local.y + SHADE_REACH) * APRON + local.x + SHADE_REACH;
    vec4 place = places[centre];
    if (place.w == SHADE_NONE) {
        imageStore(indirect_image, pixel, vec4(0.0));
        return;
    }
    vec3 normal = gbuffer_unfold(vec2(place.w, parts[centre].w));
    // Neighbours may be as far off the pixel's plane as the pixel is wide.
    float across = camera.orthographic != 0u ? 1.0 : distance(place.xyz, camera.origin);
    float width = 2.0 * camera.half_height / float(camera.size.y) * across;
    float tolerance = 1.0 / (width * width);
    vec4 sum = vec4(0.0);
    for (int y = -SHADE_REACH; y <= SHADE_REACH; y++) {
        for (int x = -SHADE_REACH; x <= SHADE_REACH; x++) {
            int i = centre + y * APRON + x;
            float share = (abs(x) == SHADE_REACH ? 0.5 : 1.0) * (abs(y) == SHADE_REACH ? 0.5 : 1.0);
            float off = dot(normal, places[i].xyz - place.xyz);
            float turned = dot(normal, gbuffer_unfold(vec2(places[i].w, parts[i].w)));
            bool surface = places[i].w != SHADE_NONE;
            share *= surface ? smoothstep(0.7, 0.9, turned) / (1.0 + tolerance * off * off) : 0.0;
            sum += share * vec4(parts[i].rgb, 1.0);
        }
    }
    vec3 all = sum.rgb * (float(SHADE_SIDE * SHADE_SIDE) / max(sum.w, 1e-6));
    if (sum.w < 4.0) {
        shade_point p = shade_point(place.xyz, normal, normal);
        all = shade_vpls(p, 0u, 1u);
        for (uint i = 0u; shade_has(SHADE_SPREAD) && i < SHADE_PATHS; i++) {
            all += shade_spread_suns(p, i);
        }
    }
    imageStore(indirect_image, pixel, vec4(all, 1.0));
}
