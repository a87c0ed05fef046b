// refine_mean.comp -- the mean of pop's picture. One group, in a fixed order.
#include "refine.glsl"

layout(local_size_x = 256) in;
layout(binding = 0) uniform sampler2D cells_tex;
TYN_WRITE(1, totals, refine_totals totals);
shared vec4 part[256];

void main()
{
    const uint thread = gl_LocalInvocationIndex, count = args.cells.x * args.cells.y;
    vec4 sum = vec4(0.0);
    for (uint i = thread; i < count; i += 256u) {
        const vec4 cell = texelFetch(cells_tex, ivec2(refine_cell(REFINE_CELL_POP) + uvec2(i % args.cells.x, i / args.cells.x)), 0);
        sum += vec4(max(cell.rgb, 0.0) * cell.a, cell.a);
    }
    part[thread] = sum;
    barrier();
    if (thread == 0u) {
        sum = vec4(0.0);
        for (uint i = 0u; i < 256u; i++) {
            sum += part[i];
        }
        totals.mean = sum.rgb / max(sum.a, 1.0);
    }
}
