// propagate_radial.glsl -- the six-neighbour propagation around a local light.
//
// Elek et al. 2014, section 6. The principal direction of a cell is that away from the light. A cell holds the
// power P of its light, in units of the light's intensity (sr), and its spread 1 - a about that direction.
// Power needs no factor on its way to cells of another size: P / (Omega r^2) is the radiance's share that falls
// as the area grows. No bindings.
#include "propagate.glsl"
#include "propagate_radial_grid.h"
#include "shaders/common/octahedral.glsl"

// ---- where the cells are ------------------------------------------------------------------------

// M direction of a point of the map, not normalised: the inverse of orthogonal rows.
vec3 propagate_radial_heading(const propagate_radial_grid grid, vec2 e)
{
    vec3 m = octahedral_point(e), r0 = grid.to_map[0], r1 = grid.to_map[1], r2 = grid.to_map[2];
    return r0 * (m.x / dot(r0, r0)) + r1 * (m.y / dot(r1, r1)) + r2 * (m.z / dot(r2, r2));
}

// Solid angle of an area du dv of the map: dOmega = det / |x|^3 du dv, x = the heading; a face of the
// octahedron is a plane whose cone has the volume du dv / 3, and a linear map multiplies that by det.
float propagate_radial_solid_angle(const propagate_radial_grid grid, vec3 heading)
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
vec2 propagate_radial_span(const propagate_radial_grid grid, int layer)
{
    return layer == 0 ? vec2(0.0, grid.inner)
                      : grid.inner * pow(vec2(grid.growth), vec2(layer - 1, layer));
}

uint propagate_radial_index(ivec3 cell, uint stack, uint cells, uint layers)
{
    return ((stack * layers + uint(cell.z)) * cells + uint(cell.y)) * cells + uint(cell.x);
}

// ---- one hop --------------------------------------------------------------------------------------
//
// As in grids that are aligned with parallel light: cells count as cubes of their depth along the radius, which
// they are in the mean, so that light that is equal on a shell stays so. The ball has its radius as half a cell.

// What leaves a cell outwards, to each side and inwards; its spread. All of the ball's light goes outwards.
vec4 propagate_radial_outgoing(const propagate_cell cell, bool ball, float light, float spread, uint rate)
{
    return ball ? vec4(light * propagate_kept(cell), 0.0, 0.0, propagate_more_spread(cell, spread, rate))
                : propagate_outgoing(cell, light, spread, rate);
}
