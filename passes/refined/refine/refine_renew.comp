// refine_renew.comp -- new and reprojected residuals, averaged by their variances. A thread a cell.
//
// Parts are averaged each with its own, so they stay independent. A difference beyond both variances is a change of the light; it is
// added to the reprojected residuals' variance.
#include "refine.glsl"
#include "shaders/common/scene_args.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, rgba32f) uniform image2D cells_image;
layout(binding = 1) uniform sampler2D carried_tex;
layout(binding = 2, rgba32f) writeonly uniform image2D kept_image;
TYN_READ(3, totals, refine_totals totals);
TYN_READ(4, changes, refine_changes changes[]);
TYN_UNIFORM(5, camera, camera_block camera);
TYN_WRITE(6, seen, camera_block seen);

const float SMOOTH = 1.25; // tiles, as windows are chosen
// Part of the variances by which a difference must exceed them, and the largest share that is taken over.
const float DOUBT = 0.5, MOST = 0.97;

// Share that is taken over.
float taken_over(uvec2 cell)
{
    const ivec2 size = ivec2((args.cells + uint(REFINE_TILE) - 1u) / uint(REFINE_TILE)), tile = ivec2(cell / uint(REFINE_TILE));
    refine_changes sum = refine_changes(0.0, 0.0, 0.0);
    for (int k = 0; k < 49; k++) {
        const ivec2 away = ivec2(k % 7, k / 7) - 3, at = tile + away;
        if (all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, size))) {
            const float w = exp(-0.5 * float(away.x * away.x + away.y * away.y) / (SMOOTH * SMOOTH));
            sum = refine_add_changes(sum, changes[uint(at.y * size.x + at.x)], w);
        }
    }
    const float change = max(sum.difference - (1.0 + DOUBT) * (sum.now + sum.before), 0.0);
    return min(sum.now / max(sum.now + sum.before + change, 1e-30), MOST);
}

void main()
{
    const uvec2 cell = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(cell, args.cells)) || args.unfinished != 0u) {
        return; // what is kept is of pictures that were made
    }
    if (all(equal(cell, uvec2(0u)))) {
        seen = camera;
    }
    const vec3 unit = refine_unit(imageLoad(cells_image, ivec2(refine_cell(REFINE_CELL_POP) + cell)).rgb, totals.mean);
    const float share = taken_over(cell);
    for (uint k = 0u; k < uint(REFINE_PARTS); k++) {
        const ivec2 at = ivec2(refine_cell(uint(REFINE_CELL_PARTS) + k) + cell), to = ivec2(refine_kept(k) + cell);
        const vec4 before = texelFetch(carried_tex, to, 0);
        vec3 residual = imageLoad(cells_image, at).rgb / unit;
        if (before.a > REFINE_KNOWN && refine_finite(before.rgb) && share >= 0.0) {
            residual = mix(residual, before.rgb, share);
        }
        const bool good = refine_finite(residual);
        imageStore(cells_image, at, vec4(good ? residual * unit : vec3(0.0), 0.0));
        imageStore(kept_image, to, good ? vec4(residual, 1.0) : vec4(0.0));
    }
}
