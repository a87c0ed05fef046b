// refine_combine.comp -- coefficients of a cell from the candidates chosen by the four tiles about it, and sums that tell
// how much of the change the parts confirm of each other, and how far pop is off. A thread a cell.
#include "refine_fits.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
TYN_READ(3, choices, uint choices[]);
layout(binding = 4, rgba32f) writeonly uniform image2D final_image;
TYN_WRITE(5, sums, refine_sums sums[]);
shared refine_sums part[64];

refine_fit refine_plus(const refine_fit a, const refine_fit b, float w)
{
    return refine_fit(a.pop + w * b.pop, a.single + w * b.single, a.one + w * b.one);
}

void main()
{
    const uvec2 cell = gl_GlobalInvocationID.xy;
    const bool inside = all(lessThan(cell, args.cells));
    const uvec2 near = min(cell, args.cells - 1u);
    const ivec2 tiles = ivec2((args.cells + uint(REFINE_TILE) - 1u) / uint(REFINE_TILE));
    const vec2 place = (vec2(near) + 0.5) / float(REFINE_TILE) - 0.5;
    const ivec2 first = ivec2(floor(place));
    const vec2 t = place - vec2(first);
    const refine_fit none = refine_fit(vec3(0.0), vec3(0.0), vec3(0.0));
    refine_fit fits[REFINE_PARTS];
    for (uint h = 0u; h < uint(REFINE_PARTS); h++) {
        fits[h] = none;
    }
    for (int k = 0; k < 4; k++) {
        const ivec2 corner = ivec2(k & 1, k >> 1), tile = clamp(first + corner, ivec2(0), tiles - 1);
        const vec2 share = mix(1.0 - t, t, equal(corner, ivec2(1)));
        const uint choice = choices[uint(tile.y * tiles.x + tile.x)];
        if (choice == 0u) {
            continue;
        }
        for (uint h = 0u; h < uint(REFINE_PARTS); h++) {
            refine_fit alone, layers;
            refine_fits_of((choice - 1u) / 2u, h, near, alone, layers);
            if ((choice & 1u) == 1u) {
                layers = alone;
            }
            fits[h] = refine_plus(fits[h], layers, share.x * share.y);
        }
    }
    const refine_cell_values v = refine_values(near);
    const vec3 w = v.weight / (totals.mean + 1e-20);
    vec3 change[REFINE_PARTS], all_change = vec3(0.0), all_residual = vec3(0.0);
    refine_fit fit = none;
    for (uint k = 0u; k < uint(REFINE_PARTS); k++) {
        change[k] = refine_change(fits[k], v);
        all_change += change[k] / float(REFINE_PARTS);
        all_residual += v.residual[k] / float(REFINE_PARTS);
        fit = refine_plus(fit, fits[k], 1.0 / float(REFINE_PARTS));
    }
    refine_sums found = REFINE_NO_SUMS;
    found.cells = 1.0;
    found.light = dot(v.pop / (totals.mean + 1e-20), vec3(1.0));
    vec3 variance = vec3(0.0); // of a part's samples
    for (uint k = 0u; k < uint(REFINE_PARTS); k++) {
        const float n = float(REFINE_PARTS);
        const vec3 three = (n * all_change - change[k]) / (n - 1.0), own = v.residual[k] - all_residual;
        found.confirmed += dot(w, three * v.residual[k]) / n;
        found.change += dot(w, three * three) / n;
        found.residual += dot(w, v.residual[k] * v.residual[k]) / n;
        variance += own * own / (n - 1.0);
        found.spread += dot(w, (three - all_change) * (three - all_change)) * (n - 1.0) / n;
    }
    found.noise = dot(w, variance);
    // As if there were one part: those that fits have in common make them noisier together than apart.
    found.doubt = dot(w * w * variance, all_change * all_change);
    found.excess = refine_squares(found, 1.0) * refine_squares(found, 1.0);
    part[gl_LocalInvocationIndex] = inside ? found : REFINE_NO_SUMS;
    if (inside) {
        const ivec2 to = ivec2(cell);
        imageStore(final_image, to, vec4(fit.pop, 0.0));
        imageStore(final_image, to + ivec2(args.cells.x, 0), vec4(fit.single, 0.0));
        imageStore(final_image, to + ivec2(2u * args.cells.x, 0), vec4(fit.one * totals.mean, 0.0));
    }
    barrier();
    if (gl_LocalInvocationIndex == 0u) {
        refine_sums sum = part[0];
        for (uint i = 1u; i < 64u; i++) {
            sum = refine_add(sum, part[i], 1.0);
        }
        sums[gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x] = sum;
    }
}
