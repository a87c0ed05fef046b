// refine_carry.comp -- the last picture's residuals, reprojected to this camera. A thread a cell.
#include "refine.glsl"
#include "shaders/common/camera.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D kept_tex;
layout(binding = 1, rgba32f) writeonly uniform image2D carried_image;
TYN_UNIFORM(2, camera, camera_block camera);
TYN_READ(3, seen, camera_block seen);

// Image position that shows `place`, as camera_ray_through has it; `away`: how far before the camera it is, m.
vec2 position_in(const camera_block by, vec3 place, out float away)
{
    const vec3 to = place - by.origin;
    away = camera_select(by, 1.0, dot(to, by.forward));
    const vec2 beside = vec2(dot(to, by.right), -dot(to, by.up)) / (away * vec2(by.half_width, by.half_height));
    const vec2 s = beside + vec2(-by.shift.x, by.shift.y);
    return 0.5 * (s + 1.0) * camera_whole(by) - vec2(by.corner);
}

// Where the ray meets the middle of what is before the camera: residuals are so smooth that its depth matters little.
vec3 place_of(uvec2 cell)
{
    const camera_ray ray = camera_ray_through(camera, (vec2(cell) + 0.5) * float(2u * args.grid));
    const vec2 span = ray_box(ray.origin, ray_inverse(ray.direction), args.lo, args.hi);
    const float beside = dot(0.5 * (args.lo + args.hi) - ray.origin, ray.direction);
    const float away = span.x < span.y ? 0.5 * (max(span.x, 0.0) + span.y) : beside;
    return ray.origin + max(away, 1e-6) * ray.direction;
}

void main()
{
    const uvec2 cell = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(cell, args.cells)) || args.carried == 0u) {
        return;
    }
    float away;
    const vec2 at = position_in(seen, place_of(cell), away) / float(2u * args.grid);
    const bool is = away > 0.0 && all(greaterThan(at, vec2(0.0))) && all(lessThan(at, vec2(args.cells)));
    const vec2 near = clamp(at, vec2(0.5), vec2(args.cells) - 0.5), texels = vec2(textureSize(kept_tex, 0));
    for (uint k = 0u; k < uint(REFINE_PARTS); k++) {
        const vec2 corner = vec2(refine_kept(k));
        imageStore(carried_image, ivec2(refine_kept(k) + cell),
                   is ? textureLod(kept_tex, (corner + near) / texels, 0.0) : vec4(0.0));
    }
}
