// background.glsl -- the environment behind a pixel.
//
// Where a pixel covers texels of the map it shows their mean, as a path tracer's would. Where it is
// smaller than a texel, bilinear interpolation would show the map's grid, creases along the texels and
// diamonds around bright ones: there it is averaged over a box of half a texel, which rounds the creases
// off. That is smooth (its derivative is continuous), never negative, keeps the energy of bright texels, and
// is within 1 % of the bilinear map that `path` sees.
#ifndef TYN_BACKGROUND_GLSL
#define TYN_BACKGROUND_GLSL
#include "camera.glsl"
#include "environment.glsl"

const float BACKGROUND_MAX_TAPS = 8.0; // along each side of a pixel
const float BACKGROUND_SMOOTH = 0.5;   // texels over which magnified ones are blended

// Of the texels before and after the nearest one, `d` in [-1/2, 1/2] texels from it: the tent averaged over
// a box of the width `b` in (0, 1]. What is left is the nearest one's.
vec2 background_weight_before(vec2 d, vec2 b)
{
    vec2 hi = max(0.5 * b - d, 0.0), lo = max(-0.5 * b - d, 0.0);
    return (hi * hi - lo * lo) / (2.0 * b);
}

// The map at `uv`, averaged over a box of `width` texels, at most one.
vec3 background_lookup(sampler2D map, vec2 uv, vec2 width)
{
    vec2 size = vec2(textureSize(map, 0));
    vec2 nearest = floor(uv * size), d = uv * size - nearest - 0.5;
    vec2 before = background_weight_before(d, width), after = background_weight_before(-d, width);
    // Two bilinear fetches a side, of the texels (before, half the nearest) and (the other half, after).
    vec2 half_nearest = 0.5 * (1.0 - before - after);
    vec2 low = before + half_nearest, high = after + half_nearest;
    vec2 at_low = (nearest - 0.5 + half_nearest / low) / size;
    vec2 at_high = (nearest + 0.5 + after / high) / size;
    return low.y * (low.x * textureLod(map, at_low, 0.0).rgb +
                    high.x * textureLod(map, vec2(at_high.x, at_low.y), 0.0).rgb) +
           high.y * (low.x * textureLod(map, vec2(at_low.x, at_high.y), 0.0).rgb +
                     high.x * textureLod(map, at_high, 0.0).rgb);
}

// Radiance, W/(m^2 sr), that arrives at the part of the image within `side` / 2 pixels of `pixel` (column +
// u, row + v), as if nothing were in between.
vec3 background_radiance(env_block env, sampler2D map, camera_block camera, vec2 pixel, float side)
{
    if (env.has_map == 0u) {
        return env.radiance;
    }
    // What the position's sides are in texels. For the direction n (any length) in the map's frame, rho its
    // distance from the axis: d phi = (n.x dn.z - n.z dn.x) / rho^2, d theta = (n.y n.dn / n^2 - dn.y) / rho.
    // A box as wide as the root of the sum of squares has the footprint's variance.
    vec2 size = vec2(textureSize(map, 0)), footprint = vec2(0.0);
    if (camera.orthographic == 0u) {
        vec2 s = 2.0 * pixel / vec2(camera.size) - 1.0;
        vec3 n = environment_map_direction(
            env, camera.forward + (s.x + camera.shift.x) * camera.half_width * camera.right +
                     (camera.shift.y - s.y) * camera.half_height * camera.up);
        vec3 across = 2.0 * side / float(camera.size.x) * camera.half_width *
                      environment_map_direction(env, camera.right);
        vec3 down = 2.0 * side / float(camera.size.y) * camera.half_height *
                    environment_map_direction(env, camera.up);
        float n2 = dot(n, n), rho2 = max(n.x * n.x + n.z * n.z, 1e-12 * n2);
        vec2 phi = (n.x * vec2(across.z, down.z) - n.z * vec2(across.x, down.x)) / rho2;
        vec2 theta = (n.y / n2 * vec2(dot(n, across), dot(n, down)) - vec2(across.y, down.y)) /
                     sqrt(rho2);
        footprint = size * vec2(0.5 * TYN_INV_PI * length(phi), TYN_INV_PI * length(theta));
    }
    // The mean over the footprint's box where that has no more than a texel, else over a grid of such ones.
    float taps = clamp(ceil(max(footprint.x, footprint.y) - 0.01), 1.0, BACKGROUND_MAX_TAPS);
    vec2 width = mix(min(footprint / taps, vec2(1.0)), vec2(BACKGROUND_SMOOTH),
                     lessThan(footprint, vec2(BACKGROUND_SMOOTH)));
    vec3 sum = vec3(0.0);
    for (float y = 0.5; y < taps; y++) {
        for (float x = 0.5; x < taps; x++) {
            vec2 at = pixel + side * (vec2(x, y) / taps - 0.5);
            vec3 d = environment_map_direction(env, camera_ray_through(camera, at).direction);
            sum += background_lookup(map, environment_uv(d), width);
        }
    }
    return env.radiance * sum / (taps * taps);
}

#endif
