// refine_solve.comp -- regressions of residuals on layers, by window, part and channel. A thread a texel of a window's level.
//
// A window is a Gaussian of one texel of its level (binomial 1 4 6 4 1), the smallest one of .7 cells (1 2 1).
#include "refine.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D moments_tex;
layout(binding = 1, rgba32f) writeonly uniform image2D coefficients_image;

// Part of each layer's own square that is added to it: coefficients that the samples do not decide are 0.
const float RIDGE = 1e-4;

vec3 moment(uint plane, uint level, vec2 at, bool small)
{
    const vec2 corner = vec2(refine_moment(plane) + refine_corner(level));
    const vec2 last = vec2(refine_size(level)) - 0.5, of_image = 1.0 / vec2(textureSize(moments_tex, 0));
    vec3 sum = vec3(0.0);
    if (small) {
        for (int i = 0; i < 4; i++) {
            const vec2 tap = clamp(at + vec2(i & 1, i >> 1) - 0.5, vec2(0.5), last);
            sum += 0.25 * textureLod(moments_tex, (corner + tap) * of_image, 0.0).rgb;
        }
        return sum;
    }
    for (int i = 0; i < 9; i++) {
        const ivec2 k = ivec2(i % 3, i / 3) - 1;
        const vec2 tap = clamp(at + 1.2 * vec2(k), vec2(0.5), last);
        const float w = (k.x == 0 ? 6.0 : 5.0) * (k.y == 0 ? 6.0 : 5.0) / 256.0;
        sum += w * textureLod(moments_tex, (corner + tap) * of_image, 0.0).rgb;
    }
    return sum;
}

// Cholesky of the symmetric 3 x 3 matrix (xx xy xz yy yz zz) for one channel.
vec3 solve(float xx, float xy, float xz, float yy, float yz, float zz, vec3 b)
{
    const float tiny = 1e-30;
    xx = xx * (1.0 + RIDGE) + tiny;
    yy = yy * (1.0 + RIDGE) + tiny;
    zz = zz * (1.0 + RIDGE) + tiny;
    const float lxy = xy / xx, lxz = xz / xx;
    const float dy = max(yy - lxy * xy, RIDGE * yy), uyz = yz - lxy * xz, lyz = uyz / dy;
    const float dz = max(zz - lxz * xz - lyz * uyz, RIDGE * zz);
    const float y1 = b.y - lxy * b.x, z1 = b.z - lxz * b.x - lyz * y1;
    const float z = z1 / dz, y = y1 / dy - lyz * z;
    return vec3(b.x / xx - lxy * y - lxz * z, y, z);
}

void main()
{
    const uvec2 place = gl_GlobalInvocationID.xy;
    uint window = 0u;
    uvec2 texel = place;
    bool found = all(lessThan(place, args.cells));
    for (uint w = 1u; w < uint(REFINE_WINDOWS); w++) {
        const uvec2 corner = refine_window(w);
        if (all(greaterThanEqual(place, corner)) && all(lessThan(place - corner, refine_size(w - 1u)))) {
            window = w;
            texel = place - corner;
            found = true;
        }
    }
    if (!found) { // what lies beside a level is read with a weight of 0
        const bool in_plane = all(lessThan(place, refine_coefficient(uint(REFINE_COEFFICIENTS_ROW) + 1u)));
        for (uint i = 0u; in_plane && i < uint(REFINE_COEFFICIENTS); i++) {
            imageStore(coefficients_image, ivec2(place + refine_coefficient(i)), vec4(0.0));
        }
        return;
    }
    const uint level = refine_level_of(window);
    vec3 m[REFINE_MOMENTS];
    for (uint i = 0u; i < uint(REFINE_MOMENTS); i++) {
        m[i] = moment(i, level, vec2(texel) + 0.5, window == 0u);
    }
    for (uint h = 0u; h < uint(REFINE_PARTS); h++) {
        const vec3 bx = m[6u + 3u * h], by = m[7u + 3u * h], bz = m[8u + 3u * h];
        const vec3 alone = bx / (m[0] * (1.0 + RIDGE) + 1e-30);
        vec3 c[3];
        for (int k = 0; k < 3; k++) {
            c[k] = solve(m[0][k], m[1][k], m[2][k], m[3][k], m[4][k], m[5][k], vec3(bx[k], by[k], bz[k]));
        }
        const ivec2 to = ivec2(place);
        imageStore(coefficients_image, to + ivec2(refine_coefficient(3u * h)), vec4(alone, c[0].x));
        imageStore(coefficients_image, to + ivec2(refine_coefficient(3u * h + 1u)), vec4(c[1].x, c[2].x, c[0].y, c[1].y));
        imageStore(coefficients_image, to + ivec2(refine_coefficient(3u * h + 2u)), vec4(c[2].y, c[0].z, c[1].z, c[2].z));
    }
}
