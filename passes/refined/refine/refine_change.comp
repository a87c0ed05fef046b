// refine_change.comp -- squared difference of new and reprojected residuals, and both variances, in tiles of 8 x 8 cells. A thread a cell.
#include "refine.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D cells_tex;
layout(binding = 1) uniform sampler2D carried_tex;
TYN_READ(2, totals, refine_totals totals);
TYN_WRITE(3, changes, refine_changes changes[]);
shared refine_changes part[64];

// Variance of the mean of parts, by how far they are apart.
vec3 variance_of(vec3 parts[REFINE_PARTS], vec3 mean)
{
    vec3 sum = vec3(0.0);
    for (uint k = 0u; k < uint(REFINE_PARTS); k++) {
        sum += (parts[k] - mean) * (parts[k] - mean);
    }
    return sum / float(REFINE_PARTS * (REFINE_PARTS - 1));
}

void main()
{
    const uvec2 cell = gl_GlobalInvocationID.xy, near = min(cell, args.cells - 1u);
    const vec3 unit = refine_unit(texelFetch(cells_tex, ivec2(refine_cell(REFINE_CELL_POP) + near), 0).rgb, totals.mean);
    vec3 now[REFINE_PARTS], before[REFINE_PARTS], now_mean = vec3(0.0), before_mean = vec3(0.0);
    bool known = all(lessThan(cell, args.cells));
    for (uint k = 0u; k < uint(REFINE_PARTS); k++) {
        const vec4 old = texelFetch(carried_tex, ivec2(refine_kept(k) + near), 0);
        now[k] = texelFetch(cells_tex, ivec2(refine_cell(uint(REFINE_CELL_PARTS) + k) + near), 0).rgb / unit;
        before[k] = old.rgb;
        known = known && old.a > REFINE_KNOWN;
        now_mean += now[k] / float(REFINE_PARTS);
        before_mean += before[k] / float(REFINE_PARTS);
    }
    const vec3 off = now_mean - before_mean;
    const refine_changes none = refine_changes(0.0, 0.0, 0.0);
    part[gl_LocalInvocationIndex] = !known ? none : refine_changes(dot(unit, off * off), dot(unit, variance_of(now, now_mean)),
                                                                   dot(unit, variance_of(before, before_mean)));
    barrier();
    if (gl_LocalInvocationIndex == 0u) {
        refine_changes sum = none;
        for (uint i = 0u; i < 64u; i++) {
            sum = refine_add_changes(sum, part[i], 1.0);
        }
        changes[gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x] = sum;
    }
}
