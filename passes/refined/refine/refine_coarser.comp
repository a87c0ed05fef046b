// refine_coarser.comp -- means of moments on three levels above one that is there.
#define REFINE_MOMENTS_ACCESS
#include "refine_pyramid.glsl"

void main()
{
    const uvec2 texel = gl_GlobalInvocationID.xy;
    const bool inside = all(lessThan(texel, refine_size(args.level)));
    for (uint i = 0u; i < uint(REFINE_MOMENTS); i++) {
        tile[i][gl_LocalInvocationIndex] =
            inside ? imageLoad(moments_image, ivec2(refine_moment(i) + refine_corner(args.level) + texel)).rgb : vec3(0.0);
    }
    refine_store_coarser(args.level);
}
