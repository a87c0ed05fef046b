// background.glsl -- the environment behind a pixel.
//
// Where a pixel covers texels of the map it shows their mean, as a path tracer's would. Where it is
// smaller than a texel, bilinear interpolation would show the map's grid, creases along the texels and
// diamonds around bright ones: there it is averaged over a box of half a texel, which rounds the creases
// off. That is smooth (its derivative is continuous), never negative and keeps the energy of bright texels. Of
// the bilinear map that `path` sees it takes 1/8 off the contrast of a single texel; in photographs and
// skies it is within 1 % of that.
#ifndef TYN_BACKGROUND_GLSL
#define TYN_BACKGROUND_GLSL
#include "shaders/common/camera.glsl"
#include "shaders/light/environment.glsl"

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
// u, row + v), as if nothing were in between. `direction`: of the ray through `pixel`.
vec3 background_radiance(const env_block env, sampler2D map, const camera_block camera, vec3 direction, vec2 pixel,
                         float side)
{
    if (env.has_map == 0u) {
        return env.radiance;
    }
    vec3 d = environment_map_direction(env, direction);
    vec2 uv = environment_uv(d), size = vec2(textureSize(map, 0));
    // What a step across and one down in the image are in texels; of parallel rays nothing. With rho the distance of
    // d from the axis: d phi = (d.x dd.z - d.z dd.x) / rho^2, d theta = (d.y d.dd - dd.y) / rho. A box as wide as
    // the root of the sum of squares has the footprint's variance.
    float scale = camera_select(camera, 0.0, 2.0 * side * dot(direction, camera.forward));
    vec3 across = scale * camera.half_width / camera_whole(camera).x * environment_map_direction(env, camera.right);
    vec3 down = scale * camera.half_height / camera_whole(camera).y * environment_map_direction(env, camera.up);
    float rho2 = max(d.x * d.x + d.z * d.z, 1e-12);
    vec2 phi = (d.x * vec2(across.z, down.z) - d.z * vec2(across.x, down.x)) / rho2;
    vec2 theta = (d.y * vec2(dot(d, across), dot(d, down)) - vec2(across.y, down.y)) * inversesqrt(rho2);
    vec2 footprint = size * vec2(0.5 * TYN_INV_PI * length(phi), TYN_INV_PI * length(theta));
    // The mean over the footprint's box where that has no more than a texel, else over a grid of such ones.
    float taps = clamp(ceil(max(footprint.x, footprint.y) - 0.01), 1.0, BACKGROUND_MAX_TAPS);
    vec2 width = mix(min(footprint / taps, vec2(1.0)), vec2(BACKGROUND_SMOOTH),
                     lessThan(footprint, vec2(BACKGROUND_SMOOTH)));
    vec3 mean = taps > 1.0 ? vec3(0.0) : background_lookup(map, uv, width);
    float count = taps > 1.0 ? taps : 0.0, share = 1.0 / (taps * taps);
    for (float y = 0.5; y < count; y++) {
        for (float x = 0.5; x < count; x++) {
            vec2 at = pixel + side * (vec2(x, y) / taps - 0.5);
            vec3 tap = environment_map_direction(env, camera_ray_through(camera, at).direction);
            mean += share * background_lookup(map, environment_uv(tap), width);
        }
    }
    return env.radiance * mean;
}

#endif
