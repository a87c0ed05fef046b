// gbuffer_resolve.comp -- what pixels show whose samples all see one triangle, or none. The others are listed for
// gbuffer_mixed.comp: on a device whose threads run together they would keep their neighbours waiting.
#include "gbuffer_sample.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(camera.size)))) {
        return;
    }
    ivec2 corner = pixel * samples;
    uint index = imageLoad(seen, corner).r;
    bool same = true;
    for (int k = 1; k < samples * samples; k++) {
        same = same && imageLoad(seen, texel_of(corner, k)).r == index;
    }
    if (same && index == 0u) {
        for (int k = 0; k < samples * samples; k++) {
            imageStore(distances_image, texel_of(corner, k), vec4(0.0));
        }
        imageStore(facing_image, pixel, uvec4(0u, 0u, GBUFFER_NONE, 0u));
    }
    if (same && index != 0u) {
        gbuffer_triangle triangle = gbuffer_triangle_of(index - 1u);
        vec2 middle = vec2(corner) + 0.5 * float(samples);
        gbuffer_point p = gbuffer_point_of(triangle, middle, gbuffer_ray(middle));
        vec3 albedo = vec3(0.0), direction;
        for (int k = 0; k < samples * samples; k++) {
            ivec2 texel = texel_of(corner, k);
            vec2 at = vec2(texel) + 0.5;
            vec4 w = gbuffer_meet(triangle, gbuffer_ray(at), direction);
            albedo += textured != 0u ? gbuffer_albedo_at(triangle, at, w.xyz) : vec3(0.0);
            imageStore(distances_image, texel, vec4(w.w));
        }
        p.colours.albedo = textured != 0u ? albedo / float(samples * samples) : p.colours.albedo;
        store_whole(pixel, p);
    }
    if (!same) {
        uint n = atomicAdd(mixed_count.count, 1u);
        mixed[n] = uint(pixel.y) << 16 | uint(pixel.x);
        if (n % GBUFFER_EDGES == 0u) {
            uvec2 groups = gbuffer_edge_groups(n, row);
            atomicMax(mixed_count.groups.x, groups.x);
            atomicMax(mixed_count.groups.y, groups.y);
        }
    }
    if (pixel == ivec2(0)) {
        mixed_count.groups.z = 1u;
    }
}
