// refine_judge.comp -- how far each candidate by three parts is from the fourth's samples, in tiles of 8 x 8 cells. A thread a cell.
#include "refine_fits.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
TYN_WRITE(3, tiles, float tiles[]);
shared float errors[REFINE_CANDIDATES][64];

// One cell's share is bounded: rare bright paths decide nothing.
const float MOST = 100.0;

// Of the changes that each part says, the mean of three against the fourth.
float refine_error(vec3 change[REFINE_PARTS], const refine_cell_values v)
{
    vec3 sum = vec3(0.0), e = vec3(0.0);
    for (uint k = 0u; k < uint(REFINE_PARTS); k++) {
        sum += change[k];
    }
    for (uint k = 0u; k < uint(REFINE_PARTS); k++) {
        const vec3 off = (sum - change[k]) / float(REFINE_PARTS - 1) - v.residual[k];
        e += off * off;
    }
    return dot(min(e * v.weight / (totals.mean + 1e-20), MOST), vec3(1.0));
}

void main()
{
    const uvec2 cell = gl_GlobalInvocationID.xy, near = min(cell, args.cells - 1u);
    const uint thread = gl_LocalInvocationIndex;
    const bool inside = all(lessThan(cell, args.cells));
    const refine_cell_values v = refine_values(near);
    vec3 by_alone[REFINE_PARTS], by_all[REFINE_PARTS];
    for (uint k = 0u; k < uint(REFINE_PARTS); k++) {
        by_alone[k] = vec3(0.0);
    }
    errors[0][thread] = inside ? refine_error(by_alone, v) : 0.0;
    for (uint w = 0u; w < uint(REFINE_WINDOWS); w++) {
        for (uint k = 0u; k < uint(REFINE_PARTS); k++) {
            refine_fit alone, layers;
            refine_fits_of(w, k, near, alone, layers);
            by_alone[k] = refine_change(alone, v);
            by_all[k] = refine_change(layers, v);
        }
        errors[1u + 2u * w][thread] = inside ? refine_error(by_alone, v) : 0.0;
        errors[2u + 2u * w][thread] = inside ? refine_error(by_all, v) : 0.0;
    }
    barrier();
    if (thread < uint(REFINE_CANDIDATES)) {
        float sum = 0.0;
        for (uint i = 0u; i < 64u; i++) {
            sum += errors[thread][i];
        }
        tiles[(gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * uint(REFINE_CANDIDATES) + thread] = sum;
    }
}
