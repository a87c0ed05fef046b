// gradient_split.comp -- samples whose error is too large are replaced by those points of the next grid that are near them (Ren et
// al. 2008, Sec 5). A thread a sample.
//
// Near: within the valid radius, as published; and all whose cells touch the sample's, so that grids which do not halve each
// other leave no gap. Lists are in any order; what is done with a point does not depend on it.
#include "gradient_args.h"
#include "shaders/common/counters.h"
TYN_ARGS(gradient_args args);
#define MEDIUM_BLOCK 0
#include "shaders/medium/medium.glsl"
#include "gradient_grid.glsl"

layout(constant_id = 1) const uint gradient_threads = 16u; // of a sample of the next level

layout(local_size_x = 64) in;
TYN_READ(1, samples, gradient_sample samples[]);
TYN_UPDATE(2, heads, gradient_head heads);
TYN_UPDATE(3, entries, uint entries[]);
TYN_UPDATE(4, states, uint states[]);
TYN_UPDATE(5, counters, counters_block counters);

void list(const gradient_grid next, uint point)
{
    const uint level = args.level + 1u;
    if (atomicOr(states[next.first + point], GRADIENT_IS_LISTED) == 0u) {
        const uint number = atomicAdd(heads.levels[level].count, 1u);
        entries[next.first + number] = point;
        const uint sampling = number / (GRADIENT_GROUP / gradient_threads), splitting = number / GRADIENT_GROUP;
        atomicMax(heads.levels[level].groups.x, min(sampling + 1u, GRADIENT_ROW));
        atomicMax(heads.levels[level].groups.y, sampling / GRADIENT_ROW + 1u);
        atomicMax(heads.levels[level].groups.z, 1u);
        atomicMax(heads.levels[level].split.x, min(splitting + 1u, GRADIENT_ROW));
        atomicMax(heads.levels[level].split.y, splitting / GRADIENT_ROW + 1u);
        atomicMax(heads.levels[level].split.z, 1u);
    }
}

void main()
{
    const gradient_grid grid = gradient_grid_of(args.level);
    const uint number = (gl_WorkGroupID.y * GRADIENT_ROW + gl_WorkGroupID.x) * GRADIENT_GROUP + gl_LocalInvocationIndex;
    const uint count = args.level == 0u ? gradient_points(grid) : heads.levels[args.level].count;
    if (number >= count) {
        return;
    }
    uint point = number;
    if (args.level > 0u) {
        point = entries[grid.first + number];
    }
    if (!(samples[grid.first + point].error > args.epsilon * heads.reference)) {
        return;
    }
    states[grid.first + point] = GRADIENT_IS_LISTED;
    atomicAdd(counters.pixels, ~0u); // one less
    const gradient_grid next = gradient_grid_of(args.level + 1u);
    const vec3 x = gradient_place(grid, gradient_at(grid, point));
    const vec3 touching = (0.5 - 1e-3) * (grid.spacing + next.spacing);
    const ivec3 from = max(ivec3(ceil((x - grid.radius) / next.spacing - 0.5)), ivec3(0));
    const ivec3 to = min(ivec3(floor((x + grid.radius) / next.spacing - 0.5)), next.size - 1);
    for (int k = from.z; k <= to.z; k++) {
        for (int j = from.y; j <= to.y; j++) {
            for (int i = from.x; i <= to.x; i++) {
                const vec3 away = gradient_place(next, ivec3(i, j, k)) - x;
                if (dot(away, away) < grid.radius * grid.radius || all(lessThan(abs(away), touching))) {
                    list(next, gradient_index(next, ivec3(i, j, k)));
                }
            }
        }
    }
}
