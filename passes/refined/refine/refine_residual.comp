// refine_residual.comp -- how far samples are from the fit, and how far their noise alone would put them, in tiles of 8 x 8 pixels.
#include "refine.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D fitted_tex;
layout(binding = 1) uniform sampler2D samples_tex;
layout(binding = 2) uniform sampler2D noise_tex;
TYN_READ(3, totals, refine_totals totals);
TYN_WRITE(4, residuals, vec2 residuals[]);
shared vec2 part[64];

void main()
{
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    vec2 found = vec2(0.0);
    if (all(lessThan(pixel, args.picture))) {
        const vec3 fit = texelFetch(fitted_tex, ivec2(pixel), 0).rgb;
        const vec3 off = texelFetch(samples_tex, ivec2(pixel), 0).rgb - fit, noise = texelFetch(noise_tex, ivec2(pixel), 0).rgb;
        const vec3 w = refine_weight(fit, totals.mean);
        found = vec2(dot(w, off * off), dot(w, noise * noise));
        if (any(isnan(found)) || any(isinf(found))) {
            found = vec2(0.0);
        }
    }
    part[gl_LocalInvocationIndex] = found;
    barrier();
    if (gl_LocalInvocationIndex == 0u) {
        vec2 sum = vec2(0.0);
        for (uint i = 0u; i < 64u; i++) {
            sum += part[i];
        }
        residuals[gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x] = sum;
    }
}
