// lpv_reflect_sum.comp -- power of a block of texels, of the channel that has most: what bounds the sums.
#include "lpv_reflect_args.h"
#include "shaders/lattice/lattice_sweep.glsl"

layout(local_size_x = LPV_REFLECT_SIDE, local_size_y = LPV_REFLECT_SIDE) in;
TYN_ARGS(lpv_reflect_args args);
layout(binding = 0) uniform sampler2D rsm_flux_tex;
TYN_WRITE(1, partials, float partials[]);

#define WORKGROUP_SIZE LPV_REFLECT_LANES
#define WORKGROUP_SUM float
#include "shaders/common/workgroup.glsl"

void main()
{
    uint lane = gl_LocalInvocationIndex;
    ivec2 size = textureSize(rsm_flux_tex, 0), corner = LPV_REFLECT_BLOCK * ivec2(gl_WorkGroupID.xy);
    float sum = 0.0;
    for (int y = int(gl_LocalInvocationID.y); y < LPV_REFLECT_BLOCK; y += LPV_REFLECT_SIDE) {
        for (int x = int(gl_LocalInvocationID.x); x < LPV_REFLECT_BLOCK; x += LPV_REFLECT_SIDE) {
            ivec2 texel = corner + ivec2(x, y);
            if (all(lessThan(texel, size))) {
                vec3 flux = texelFetch(rsm_flux_tex, texel, 0).rgb;
                float most = 0.0;
                for (uint ch = 0u; ch < args.channels; ch++) {
                    most = max(most, lattice_channel(flux, args.channels, ch, args.tint));
                }
                sum += most < 3.0e38 ? most : 0.0; // neither infinite nor NaN
            }
        }
    }
    sum = workgroup_total(sum);
    if (lane == 0u) {
        partials[gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x] = sum;
    }
}
