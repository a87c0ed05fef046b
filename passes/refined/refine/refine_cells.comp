// refine_cells.comp -- means of layers, and of samples less pop's picture, in cells. A thread a cell.
//
// What a part's samples say of pop is their mean less pop's where they are: detail within the cell is not taken for noise.
#include "refine.glsl"
#include "shaders/common/counters.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D base_tex;
layout(binding = 1) uniform sampler2D single_tex;
layout(binding = 2) uniform sampler2D samples_tex;
layout(binding = 3, rgba32f) writeonly uniform image2D cells_image;
TYN_UPDATE(4, counters, counters_block counters);

void main()
{
    const uvec2 cell = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(cell, args.cells))) {
        return;
    }
    vec3 pop = vec3(0.0), single = vec3(0.0), first = vec3(0.0);
    float pixels = 0.0;
    for (uint k = 0u; k < uint(REFINE_PARTS); k++) {
        const uvec2 s = 2u * cell + uvec2(k & 1u, k >> 1u);
        vec3 found = first; // beyond an edge of the picture
        if (all(lessThan(s, args.samples))) {
            vec3 own = vec3(0.0);
            float count = 0.0;
            for (uint i = 0u; i < args.grid * args.grid; i++) {
                const uvec2 pixel = args.grid * s + uvec2(i % args.grid, i / args.grid);
                if (all(lessThan(pixel, args.picture))) {
                    const vec3 base = texelFetch(base_tex, ivec2(pixel), 0).rgb, once = texelFetch(single_tex, ivec2(pixel), 0).rgb;
                    if (!refine_finite(base) || !refine_finite(once)) {
                        atomicAdd(counters.non_finite, 1u);
                        continue;
                    }
                    own += base;
                    single += once;
                    count += 1.0;
                }
            }
            pop += own;
            pixels += count;
            found = texelFetch(samples_tex, ivec2(s), 0).rgb - own / max(count, 1.0);
            if (!refine_finite(found)) {
                atomicAdd(counters.non_finite, 1u);
                found = vec3(0.0);
            }
            first = k == 0u ? found : first;
        }
        imageStore(cells_image, ivec2(refine_cell(uint(REFINE_CELL_PARTS) + k) + cell), vec4(found, 0.0));
    }
    imageStore(cells_image, ivec2(refine_cell(REFINE_CELL_POP) + cell), vec4(pop / max(pixels, 1.0), pixels));
    imageStore(cells_image, ivec2(refine_cell(REFINE_CELL_SINGLE) + cell), vec4(single / max(pixels, 1.0), 0.0));
}
