// env_importance_base.comp -- the finest level: box averages of the map without its suns.
//
// Every texel of the map counts with the solid angle that it shares with the texel of the level, so the
// level's integral is the map's, whatever the map's size.
#include "env_importance_args.h"
#include "shaders/light/sky.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
TYN_ARGS(env_importance_args args);
layout(binding = 0) uniform sampler2D env_map_tex;
layout(binding = 1, rgba32f) uniform writeonly image2D sky;

vec3 direction(float azimuth, float polar)
{
    return vec3(sin(polar) * sin(azimuth), cos(polar), -sin(polar) * cos(azimuth));
}

// Suns whose discs may reach a texel of the map that this texel overlaps: one bit each.
uint suns_nearby(uvec2 at, uvec2 map_size)
{
    vec2 uv = (vec2(at) + 0.5) / vec2(SKY_WIDTH, SKY_HEIGHT);
    vec3 d = direction((uv.x - 0.5) * 2.0 * SKY_PI, uv.y * SKY_PI);
    vec2 texel = vec2(2.0, 1.0) * SKY_PI / vec2(map_size);
    float margin = 0.02 + texel.x + texel.y;
    uint found = 0u;
    for (uint i = 0u; i < args.num_suns; i++) {
        float apart = acos(clamp(dot(d, args.suns[i].direction), -1.0, 1.0));
        float radius = acos(clamp(args.suns[i].cos_radius, -1.0, 1.0));
        found |= apart <= radius + margin ? 1u << i : 0u;
    }
    return found;
}

// A texel of the map without its suns. Of the others only `nearby` ones are asked.
vec3 residual(uvec2 at, uvec2 map_size, uint nearby)
{
    vec3 rgb = texelFetch(env_map_tex, ivec2(at), 0).rgb;
    // Negative and non-finite texels count as 0.
    rgb = mix(vec3(0.0), rgb, lessThanEqual(abs(rgb), vec3(3.4e38)));
    rgb = max(rgb, vec3(0.0));
    for (uint left = nearby; left != 0u; left &= left - 1u) {
        uint i = uint(findLSB(left));
        vec2 uv = (vec2(at) + 0.5) / vec2(map_size);
        vec3 d = direction((uv.x - 0.5) * 2.0 * SKY_PI, uv.y * SKY_PI);
        bool inside = dot(d, args.suns[i].direction) >= args.suns[i].cos_radius;
        rgb = inside ? min(rgb, args.suns[i].around) : rgb;
    }
    return rgb;
}

void main()
{
    const uvec2 at = gl_GlobalInvocationID.xy, size = uvec2(SKY_WIDTH, SKY_HEIGHT);
    const uvec2 map_size = uvec2(textureSize(env_map_tex, 0));
    // In units of a texel of the map / size.
    const uvec2 from = at * map_size, to = from + map_size;
    const uint nearby = suns_nearby(at, map_size);
    const float unit = SKY_PI / (float(map_size.y) * float(size.y));
    vec4 sum = vec4(0.0);
    for (uint y = from.y / size.y; y * size.y < to.y; y++) {
        uint top = max(from.y, y * size.y), bottom = min(to.y, (y + 1u) * size.y);
        // From the nearer pole: there sin is exact.
        uint middle = min(top + bottom, 2u * map_size.y * size.y - top - bottom);
        float band = sky_band(0.5 * float(middle) * unit, float(bottom - top) * unit);
        vec4 row = vec4(0.0);
        for (uint x = from.x / size.x; x * size.x < to.x; x++) {
            float share = float(min(to.x, (x + 1u) * size.x) - max(from.x, x * size.x));
            row += share * vec4(residual(uvec2(x, y), map_size, nearby), 1.0);
        }
        sum += band * row;
    }
    vec3 mean = sum.rgb / sum.a;
    float power = sky_luminance(mean) * sky_texel_solid_angle(int(at.y), ivec2(size));
    imageStore(sky, ivec2(at), vec4(mean, power));
}
