// refine_fits.glsl -- cells, and what fits of windows say there.
#include "refine.glsl"
layout(binding = 0) uniform sampler2D cells_tex;
layout(binding = 1) uniform sampler2D coefficients_tex;
TYN_UPDATE(2, totals, refine_totals totals);

struct refine_cell_values {
    vec3 pop, single, residual[REFINE_PARTS], weight;
};

refine_cell_values refine_values(uvec2 cell)
{
    refine_cell_values v;
    v.pop = texelFetch(cells_tex, ivec2(refine_cell(REFINE_CELL_POP) + cell), 0).rgb;
    v.single = texelFetch(cells_tex, ivec2(refine_cell(REFINE_CELL_SINGLE) + cell), 0).rgb;
    for (uint k = 0u; k < uint(REFINE_PARTS); k++) {
        v.residual[k] = texelFetch(cells_tex, ivec2(refine_cell(uint(REFINE_CELL_PARTS) + k) + cell), 0).rgb;
    }
    v.weight = refine_weight(v.pop, totals.mean);
    return v;
}

// Coefficients of pop, single and 1.
struct refine_fit {
    vec3 pop, single, one;
};

vec4 refine_tap(uint plane, uint window, uvec2 cell)
{
    const uint level = refine_level_of(window);
    const vec2 at = clamp((vec2(cell) + 0.5) / float(1u << level), vec2(0.5), vec2(refine_size(level)) - 0.5);
    return textureLod(coefficients_tex,
                      (vec2(refine_coefficient(plane) + refine_window(window)) + at) / vec2(textureSize(coefficients_tex, 0)), 0.0);
}

// Of one part.
void refine_fits_of(uint window, uint h, uvec2 cell, out refine_fit alone, out refine_fit all_layers)
{
    const vec4 a = refine_tap(3u * h, window, cell), b = refine_tap(3u * h + 1u, window, cell),
               c = refine_tap(3u * h + 2u, window, cell);
    alone = refine_fit(a.rgb, vec3(0.0), vec3(0.0));
    all_layers = refine_fit(vec3(a.a, b.rg), vec3(b.ba, c.r), c.gba);
}

// What a fit adds to pop's picture in a cell.
vec3 refine_change(const refine_fit fit, const refine_cell_values v)
{
    return fit.pop * v.pop + fit.single * v.single + fit.one * totals.mean;
}
