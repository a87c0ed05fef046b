// propagate_radial.glsl -- the six-neighbour propagation around a local light.
//
// Elek et al. 2014, section 6. The principal direction of a cell is that away from the light. A cell holds the
// power P of its light, in units of the light's intensity (sr), and its spread 1 - a about that direction.
// Power needs no factor on its way to cells of another size: P / (Omega r^2) is the radiance's share that falls
// as the area grows. No bindings.
#ifndef TYN_PROPAGATE_RADIAL_GLSL
#define TYN_PROPAGATE_RADIAL_GLSL
#include "propagate.glsl"
#include "propagate_radial_grid.h"
#include "octahedral.glsl"
#include "radial_lobe.glsl"

// ---- where the cells are ------------------------------------------------------------------------

// M direction of a point of the map, not normalised: the inverse of orthogonal rows.
vec3 propagate_radial_heading(propagate_radial_grid grid, vec2 e)
{
    vec3 m = octahedral_point(e), r0 = grid.to_map[0], r1 = grid.to_map[1], r2 = grid.to_map[2];
    return r0 * (m.x / dot(r0, r0)) + r1 * (m.y / dot(r1, r1)) + r2 * (m.z / dot(r2, r2));
}

// Solid angle of an area du dv of the map: dOmega = det / |x|^3 du dv, x = the heading; a face of the
// octahedron is a plane whose cone has the volume du dv / 3, and a linear map multiplies that by det.
float propagate_radial_solid_angle(propagate_radial_grid grid, vec3 heading)
{
    float det = inversesqrt(dot(grid.to_map[0], grid.to_map[0]) * dot(grid.to_map[1], grid.to_map[1]) *
                            dot(grid.to_map[2], grid.to_map[2]));
    float x = length(heading);
    return det / (x * x * x);
}

// The texel across the light: -p. An exchange of whole texels if their number along a side is even.
ivec2 propagate_radial_across(ivec2 t, int cells)
{
    vec2 e = octahedral_of(-octahedral_point(octahedral_texel(t, cells)));
    return clamp(ivec2(floor((0.5 * e + 0.5) * float(cells))), ivec2(0), ivec2(cells - 1));
}

// Inner and outer radius of a layer.
vec2 propagate_radial_span(propagate_radial_grid grid, int layer)
{
    return layer == 0 ? vec2(0.0, grid.inner)
                      : grid.inner * pow(vec2(grid.growth), vec2(layer - 1, layer));
}

uint propagate_radial_index(ivec3 cell, uint stack, uint cells, uint layers)
{
    return ((stack * layers + uint(cell.z)) * cells + uint(cell.y)) * cells + uint(cell.x);
}

// ---- one hop --------------------------------------------------------------------------------------

// A cell as buffer "cells" has it. The ball has its whole radius instead of half a cell.
struct propagate_radial_cell {
    float decay; // ln of what half a cell along the radius takes of a
    float loss;  // ... of the power: optical depth of absorption
    float g;
    float mu;    // cosine between the principal direction and that to the eye; below -1: not in the grid
};

propagate_radial_cell propagate_radial_cell_of(vec4 stored)
{
    return propagate_radial_cell(stored.x, stored.y, stored.z, stored.w);
}

// What leaves a cell outwards, to each side and inwards; its spread, which the next cell changes on the
// way. `wide`: sideways extent of the cell over that along the radius. All of the ball's light goes outwards.
vec4 propagate_radial_outgoing(propagate_radial_cell cell, bool ball, float wide, float light, float spread)
{
    if (ball) {
        return vec4(light * exp(-cell.loss), 0.0, 0.0, spread);
    }
    vec4 state = propagate_state(light, spread);
    float along = exp(-cell.loss), beside = exp(-cell.loss * wide);
    return vec4(propagate_part(state, 1) * along, propagate_part(state, 0) * beside,
                propagate_part(state, -1) * along, spread);
}

// Spread after a way that takes e^-decay of a.
float propagate_radial_spread(float spread, float decay)
{
    return spread + (1.0 - spread) * propagate_loss(decay);
}

#endif
