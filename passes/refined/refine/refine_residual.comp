// refine_residual.comp -- how far samples are from the fit, and how far their noise alone would put them, in tiles of 8 x 8 pixels.
#include "refine.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D fitted_tex;
layout(binding = 1) uniform sampler2D samples_tex;
layout(binding = 2) uniform sampler2D noise_tex;
TYN_READ(3, totals, refine_totals totals);
TYN_WRITE(4, residuals, refine_residuals residuals[]);
shared refine_residuals part[64];

void main()
{
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    refine_residuals found = REFINE_NO_RESIDUALS;
    if (all(lessThan(pixel, args.picture))) {
        const vec3 fit = texelFetch(fitted_tex, ivec2(pixel), 0).rgb;
        const vec3 less = texelFetch(samples_tex, ivec2(pixel), 0).rgb - fit, noise = texelFetch(noise_tex, ivec2(pixel), 0).rgb;
        const vec3 w = refine_weight(fit, totals.mean);
        const vec2 squares = vec2(dot(w, less * less), dot(w, noise * noise));
        if (!any(isnan(squares)) && !any(isinf(squares))) {
            const vec3 unit = totals.mean + 1e-20; // squares of sums stay in range
            found = refine_residuals(squares.x, squares.y, fit / unit, less / unit, (noise / unit) * (noise / unit));
        }
    }
    part[gl_LocalInvocationIndex] = found;
    barrier();
    if (gl_LocalInvocationIndex == 0u) {
        refine_residuals sum = REFINE_NO_RESIDUALS;
        for (uint i = 0u; i < 64u; i++) {
            sum = refine_add(sum, part[i], 1.0);
        }
        residuals[gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x] = sum;
    }
}
