// refine_choose.comp -- the candidate of each tile: the least error, smoothed over tiles nearby. A thread a tile.
#include "refine.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
TYN_READ(0, tiles, float tiles[]);
TYN_WRITE(1, choices, uint choices[]);

const float SMOOTH = 10.0 / float(REFINE_TILE); // tiles

void main()
{
    const ivec2 size = ivec2((args.cells + uint(REFINE_TILE) - 1u) / uint(REFINE_TILE));
    const ivec2 tile = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(tile, size))) {
        return;
    }
    float errors[REFINE_CANDIDATES];
    for (uint i = 0u; i < uint(REFINE_CANDIDATES); i++) {
        errors[i] = 0.0;
    }
    for (int k = 0; k < 49; k++) {
        const ivec2 away = ivec2(k % 7, k / 7) - 3, at = tile + away;
        if (all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, size))) {
            const float w = exp(-0.5 * float(away.x * away.x + away.y * away.y) / (SMOOTH * SMOOTH));
            for (uint i = 0u; i < uint(REFINE_CANDIDATES); i++) {
                errors[i] += w * tiles[uint(at.y * size.x + at.x) * uint(REFINE_CANDIDATES) + i];
            }
        }
    }
    uint best = 0u;
    float least = errors[0];
    for (uint i = 1u; i < uint(REFINE_CANDIDATES); i++) {
        if (errors[i] < least) {
            least = errors[i];
            best = i;
        }
    }
    choices[uint(tile.y * size.x + tile.x)] = best;
}
