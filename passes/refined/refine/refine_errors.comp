// refine_errors.comp -- how far pop and the refined picture are off, in tiles: mean squares as in refine_sums. A thread a tile.
//
// What a part's samples differ by from a fit of the others, less their own variance, estimates the fit's mean square error, with few
// samples a noisy one: it is weighed, by its standard error, with the whole picture's.
#include "refine.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
TYN_READ(0, sums, refine_sums sums[]);
TYN_READ(1, totals, refine_totals totals);
layout(binding = 2, rgba32f) writeonly uniform image2D errors_image;

const float SMOOTH = 10.0 / float(REFINE_TILE); // tiles

void main()
{
    const ivec2 size = ivec2((args.cells + uint(REFINE_TILE) - 1u) / uint(REFINE_TILE));
    const ivec2 tile = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(tile, size))) {
        return;
    }
    refine_sums sum = REFINE_NO_SUMS;
    vec2 excess = vec2(0.0);
    for (int k = 0; k < 49; k++) {
        const ivec2 away = ivec2(k % 7, k / 7) - 3, at = tile + away;
        if (all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, size))) {
            const float w = exp(-0.5 * float(away.x * away.x + away.y * away.y) / (SMOOTH * SMOOTH));
            sum = refine_add(sum, sums[uint(at.y * size.x + at.x)], w);
            excess += w * w * sums[uint(at.y * size.x + at.x)].excess;
        }
    }
    const float n = 3.0 * sum.cells, share = totals.share; // three channels
    const vec2 before = totals.expected * max(sum.light / n, 1e-6);
    const vec2 sure = before * before, unsure = REFINE_TAIL * refine_doubt(excess, share) / (n * n);
    vec2 errors = mix(before, refine_squares(sum, share) / n, sure / max(sure + unsure, 1e-30));
    errors = max(errors, 0.04 * before);
    errors.y = max(errors.y, share * share * sum.spread / n);
    imageStore(errors_image, tile, vec4(errors, 0.0, 0.0));
}
