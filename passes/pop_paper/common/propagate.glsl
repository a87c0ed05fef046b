// propagate.glsl -- light in a grid aligned with its direction of travel: two numbers a cell.
//
// Elek, Ritschel, Dachsbacher, Seidel: Principal-Ordinates Propagation for Real-Time Rendering of
// Participating Media, 2014, section 4. A cell holds the power L of its light per face area and the
// mean cosine a of its directions about the grid's axis d: radiance L hg(omega . d, a). An iteration
// moves all light of a cell into its six neighbours; scattering lowers a, absorption lowers L.
// No bindings.
#ifndef TYN_PROPAGATE_GLSL
#define TYN_PROPAGATE_GLSL
#include "shaders/common/scene_args.h"
#include "propagate_args.h"
#include "propagate_hop.glsl"
#include "shaders/phase/hg.glsl"

// ---- the grid -----------------------------------------------------------------------------------

// The box around the medium's box with one axis along the light, in cubes of its longest side / cells. Where the number
// of cells along the light is given (not 0), they are as long as fills the box with them and as wide across, in squares, as
// the longer of the two sides there / cells. Across the light what the last cells reach beyond the medium is split evenly.
propagate_grid propagate_grid_of(vec3 extent, vec3 direction, uint cells, uint cells_along)
{
    propagate_grid grid;
    vec3 d = normalize(direction);
    vec3 steepness = abs(d); // start from the axis least along d: grids of axis-parallel light are aligned
    vec3 start = steepness.x <= steepness.y && steepness.x <= steepness.z ? vec3(1.0, 0.0, 0.0)
               : steepness.y <= steepness.z                               ? vec3(0.0, 1.0, 0.0)
                                                                          : vec3(0.0, 0.0, 1.0);
    vec3 u = normalize(start - dot(start, d) * d);
    vec3 v = cross(d, u);
    vec3 side = vec3(dot(abs(u), extent), dot(abs(v), extent), dot(abs(d), extent));
    vec3 low = vec3(dot(min(u, 0.0), extent), dot(min(v, 0.0), extent), dot(min(d, 0.0), extent));
    bool cubes = cells_along == 0u;
    float across = max(side.x, side.y);
    grid.cell = (cubes ? max(across, side.z) : across) / float(cells);
    grid.along = cubes ? grid.cell : side.z / float(cells_along);
    vec3 edges = vec3(grid.cell, grid.cell, grid.along);
    vec3 most = vec3(vec2(cells), cubes ? cells : cells_along);
    grid.size = uvec3(clamp(ceil(side / edges - 1e-3), vec3(1.0), most));
    vec2 surplus = vec2(grid.size.xy) * grid.cell - side.xy;
    low.xy -= 0.5 * surplus;
    grid.origin = u * low.x + v * low.y + d * low.z;
    grid.across_u = u;
    grid.across_v = v;
    grid.direction = d;
    grid.cone = PROPAGATE_CONE;
    return grid;
}

// Edge of a cell across the light over that along it; 1: a cube.
float propagate_stretch(const propagate_grid grid)
{
    return grid.cell / grid.along;
}

// Cell units <-> M. Cell i spans [i, i + 1].
vec3 propagate_to_m(const propagate_grid grid, vec3 cell)
{
    cell *= vec3(grid.cell, grid.cell, grid.along);
    return grid.origin + grid.across_u * cell.x + grid.across_v * cell.y + grid.direction * cell.z;
}

propagate_place propagate_place_of(const propagate_grid grid)
{
    propagate_place place;
    mat3 axes = mat3(grid.across_u, grid.across_v, grid.direction) / grid.cell;
    axes[2] *= propagate_stretch(grid);
    for (int i = 0; i < 3; i++) {
        place.rows[i] = vec4(axes[i], -dot(axes[i], grid.origin));
    }
    place.irradiance = grid.irradiance;
    place.size = grid.size.x | grid.size.y << 8 | grid.size.z << 16;
    return place;
}

// Position in cells of a grid, kept half a cell off its faces: where a linear fetch reads no cell
// beyond them.
vec3 propagate_at(const propagate_place place, vec3 p)
{
    vec3 at = vec3(dot(place.rows[0].xyz, p) + place.rows[0].w, dot(place.rows[1].xyz, p) + place.rows[1].w,
                   dot(place.rows[2].xyz, p) + place.rows[2].w);
    vec3 size = vec3(place.size & 255u, place.size >> 8 & 255u, place.size >> 16);
    return clamp(at, vec3(0.5), size - 0.5);
}

bool propagate_inside(const propagate_grid grid, ivec3 cell)
{
    return all(greaterThanEqual(cell, ivec3(0))) && all(lessThan(uvec3(cell), grid.size));
}

// Layers of workgroups of `depth` cells that a grid takes along z, so that no workgroup has two grids.
uint propagate_groups(uint cells, uint depth)
{
    return (cells + depth - 1u) / depth;
}

// Number of a cell in a buffer; `stack` = grid and channel, `cells` across the light and `along` it.
uint propagate_index(ivec3 cell, uint stack, uint cells, uint along)
{
    return ((stack * along + uint(cell.z)) * cells + uint(cell.y)) * cells + uint(cell.x);
}

// ---- one hop (Eqs 1-4) ----------------------------------------------------------------------------

// -ln g for 0 < g < 1; the series where a rounded ln would lose digits: -ln g = 2 artanh((1-g)/(1+g)).
float propagate_minus_log(float g)
{
    float y = (1.0 - g) / (1.0 + g);
    return g > 0.8 ? y * (2.0 + y * y * (2.0 / 3.0 + y * y * (0.4 + y * y * 2.0 / 7.0))) : -log(g);
}

// Exponent of the fall of a over a scattering depth: a' = a e^-decay (Eq 4). The flight has a Poisson
// number of events, so the exact mean of g^n has the exponent (1 - g) depth; the paper takes g to the
// mean number instead, which has no meaning for g < 0: the exact rate is used there.
float propagate_decay(float depth, float g, uint rate)
{
    if (rate == TYN_PROPAGATE_RATE_EXACT || g < 0.0) {
        return (1.0 - g) * depth;
    }
    if (depth <= 0.0) {
        return 0.0;
    }
    return g > 0.0 ? propagate_minus_log(g) * depth : 1e30; // g = 0: isotropic after any event
}

// A cell as buffer "cells" has it.
struct propagate_cell {
    float sigma_s; // optical depths over the edge of a cell along the light
    float sigma_a;
    float g;
    float mu; // cosine between the grid's direction and that to the eye; below -1: not part of the grid
};

propagate_cell propagate_cell_of(vec4 stored)
{
    return propagate_cell(stored.x, stored.y, stored.z, stored.w);
}

const vec4 propagate_no_cell = vec4(0.0, 0.0, 0.0, -2.0);

// What the way through half a cell leaves of L, and takes of a.
float propagate_kept(const propagate_cell cell)
{
    return exp(-0.5 * cell.sigma_a);
}

float propagate_more_spread(const propagate_cell cell, float spread, uint rate)
{
    return spread + (1.0 - spread) * propagate_loss(0.5 * propagate_decay(cell.sigma_s, cell.g, rate));
}

// What leaves a cell that holds `light` in its middle: ahead, to each of the four sides, behind; and its
// spread. Half of a hop lies in either cell, and what happens on the way multiplies: so a cell can do
// its own half for all of its neighbours.
vec4 propagate_outgoing(const propagate_cell cell, float light, float spread, uint rate)
{
    vec4 state = propagate_state(light, spread, PROPAGATE_CONE);
    float kept = propagate_kept(cell);
    return vec4(vec3(propagate_part(state, 1), propagate_part(state, 0), propagate_part(state, -1)) * kept,
                propagate_more_spread(cell, spread, rate));
}

// ---- cells that are not cubes ---------------------------------------------------------------------
//
// A hop to the side is shorter or longer than one along the light, by `stretch`: that fraction of the scattering and of the
// absorption happens on it. What is handed on is power either way, whose fractions sum to 1.

// The cell as light crosses it sideways.
propagate_cell propagate_sideways(const propagate_cell cell, float stretch)
{
    return propagate_cell(cell.sigma_s * stretch, cell.sigma_a * stretch, cell.g, cell.mu);
}

// Mean length of the hops by which a cell hands on its light, in edges along the light.
float propagate_way(vec4 state, float stretch)
{
    return mix(1.0, stretch, 4.0 * state.z);
}

// Light that comes to the faces of a cell and its product with its spread: the same in the middle.
vec2 propagate_arrived(const propagate_cell cell, vec2 light, uint rate)
{
    float arrived = light.x * propagate_kept(cell);
    float spread = light.x > 0.0 ? light.y / light.x : 1.0;
    return vec2(arrived, arrived * propagate_more_spread(cell, spread, rate));
}

// As propagate_outgoing, of a cell in the state `state`; `beside` is the spread of what goes to the sides.
vec4 propagate_outgoing_stretched(const propagate_cell cell, float stretch, vec4 state, uint rate, out float beside)
{
    propagate_cell across = propagate_sideways(cell, stretch);
    vec2 kept = vec2(propagate_kept(cell), propagate_kept(across));
    beside = propagate_more_spread(across, state.y, rate);
    return vec4(vec3(propagate_part(state, 1), propagate_part(state, 0), propagate_part(state, -1)) * kept.xyx,
                propagate_more_spread(cell, state.y, rate));
}

// ---- what the eye gets (Eq 8) -----------------------------------------------------------------------

// The direction from a cell to the eye.
vec3 propagate_to_eye(const camera_block camera, vec3 p)
{
    vec3 v = camera.origin - p;
    float r = length(v);
    return camera.orthographic != 0u || r < 1e-9 ? -camera.forward : v / r;
}

// Light of a cell towards the eye per unit L, 1/sr. Radiance in flight has mean cosine a; with
// `last_event` it is scattered once more on its way to the eye, which by the self-convolution of the
// phase function makes it g a. A delta (a = 1) is not radiance: the lobe is never narrower than 0.995.
float propagate_towards_eye(float mu, float a, float g, bool last_event)
{
    return hg(clamp(last_event ? g * a : a, -HG_MAX, HG_MAX), mu);
}

#endif
