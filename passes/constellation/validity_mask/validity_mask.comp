// validity_mask.comp -- from the farthest slice to the nearest until one is not empty; a thread a pixel. Built for both
// modes of the medium.
#include "shaders/common/camera.glsl"
#include "../common/slices.glsl"
#include "validity_mask_args.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const uint with_distance = 0u;
layout(constant_id = 1) const uint emissive = 0u;
TYN_ARGS(validity_mask_args args);
TYN_UNIFORM(0, medium, medium_block medium);
layout(binding = 1) uniform sampler3D voxels_tex;
TYN_UNIFORM(2, camera, camera_block camera);
layout(binding = 3, rgba16f) uniform writeonly image2D mask_image;
#ifdef TYN_DENSITY
#define AWAY(v) (v).g
#define MATTER(v) (v).r
#else
layout(binding = 4) uniform sampler3D emission_tex;
#define AWAY(v) (v).a
#define MATTER(v) max(max((v).r, (v).g), (v).b)
#endif

bool is_empty(vec4 v, vec3 uvw)
{
    float matter = MATTER(v);
#ifndef TYN_DENSITY
    if (emissive != 0u) {
        const vec3 e = textureLod(emission_tex, uvw, 0.0).rgb;
        matter = max(matter, max(max(e.r, e.g), e.b));
    }
#endif
    return !(matter > 0.0);
}

// Half floats hold whole numbers up to 2048, then every second, fourth, ...: the next larger one, as slices beyond the
// farthest one that is not empty do no harm.
float rounded_up(int slice)
{
    const int step = 1 << max(findMSB(slice) - 10, 0);
    return float((slice + step - 1) / step * step);
}

void main()
{
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, camera.size))) {
        return;
    }
    const camera_ray ray = camera_ray_through(camera, vec2(pixel) + 0.5);
    vec2 span = ray_box(ray.origin, ray_inverse(ray.direction), vec3(0.0), medium.extent);
    span.x = max(span.x, 0.0);
    const slices s = slices_of(args.slices, span);
    const vec3 uvw = (ray.origin + s.start * ray.direction) / medium.extent, along = ray.direction / medium.extent;
    int i = s.count - 1;
    bool found = false;
    while (i >= 0 && !found) {
        const vec3 at = uvw + slice_at(args.slices, s, i) * along;
        const vec4 v = textureLod(voxels_tex, at, 0.0);
        found = !is_empty(v, at);
        const int skipped = with_distance != 0u ? slices_skipped(args.slices, AWAY(v)) : 0;
        i -= found ? 0 : 1 + skipped;
    }
    imageStore(mask_image, ivec2(pixel), vec4(ray.direction, found ? rounded_up(i) : -1.0));
}
