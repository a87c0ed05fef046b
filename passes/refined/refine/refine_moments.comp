// refine_moments.comp -- products of layers and residuals in each cell, and their means on levels 1 to 3. A thread a cell.
#define REFINE_MOMENTS_ACCESS writeonly
#include "refine_pyramid.glsl"

layout(binding = 1) uniform sampler2D cells_tex;
TYN_READ(2, totals, refine_totals totals);

void main()
{
    const uvec2 cell = gl_GlobalInvocationID.xy;
    const bool inside = all(lessThan(cell, args.cells));
    vec3 moments[REFINE_MOMENTS];
    for (uint i = 0u; i < uint(REFINE_MOMENTS); i++) {
        moments[i] = vec3(0.0);
    }
    if (inside) {
        const vec4 pop = texelFetch(cells_tex, ivec2(refine_cell(REFINE_CELL_POP) + cell), 0);
        const vec3 single = texelFetch(cells_tex, ivec2(refine_cell(REFINE_CELL_SINGLE) + cell), 0).rgb;
        const vec3 mean = totals.mean, w = refine_weight(pop.rgb, mean);
        moments[0] = w * pop.rgb * pop.rgb;
        moments[1] = w * pop.rgb * single;
        moments[2] = w * pop.rgb * mean;
        moments[3] = w * single * single;
        moments[4] = w * single * mean;
        moments[5] = w * mean * mean;
        for (uint h = 0u; h < uint(REFINE_PARTS); h++) {
            const vec3 wr = w * texelFetch(cells_tex, ivec2(refine_cell(uint(REFINE_CELL_PARTS) + h) + cell), 0).rgb;
            moments[6u + 3u * h] = wr * pop.rgb;
            moments[7u + 3u * h] = wr * single;
            moments[8u + 3u * h] = wr * mean;
        }
    }
    for (uint i = 0u; i < uint(REFINE_MOMENTS); i++) {
        tile[i][gl_LocalInvocationIndex] = moments[i];
        if (inside) {
            imageStore(moments_image, ivec2(refine_moment(i) + cell), vec4(moments[i], 0.0));
        }
    }
    refine_store_coarser(0u);
}
