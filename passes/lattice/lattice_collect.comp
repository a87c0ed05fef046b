// lattice_collect.comp -- moments of the radiance of a sweep, and the source of its diffusion
// correction.
#include "shaders/lattice/lattice_args.h"
#include "shaders/common/quotient.glsl"
#include "shaders/lattice/lattice_sweep.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
TYN_ARGS(lattice_args args);
layout(binding = 0) uniform sampler3D cells;
layout(binding = 1) uniform samplerBuffer mean_psi_words; // [direction][channel][cell]
layout(binding = 2) uniform samplerBuffer state_words;    // floats
TYN_WRITE(3, swept, vec4 swept[]);
// The correction solves for what the sweep's change of phi would still set off: its scattering, W.
TYN_WRITE(4, rhs, float rhs[]);
TYN_WRITE(5, correction, float correction[]);

layout(binding = 6) uniform samplerBuffer arrived_words; // as mean_psi, at the ends of cut links
TYN_READ(7, wall_light, vec3 wall_light[]);
TYN_WRITE(8, wall_power, vec2 wall_power[]); // absorbed, sent out of wall_light; W
layout(binding = 11) uniform samplerBuffer stencil_hi_words; // four floats to a cell
#define LATTICE_WALL_LINKS 9
#define LATTICE_WALL_CELLS 10
#include "lattice_wall_state.glsl"
layout(constant_id = 0) const uint walls = 0;
layout(constant_id = 1) const uint lit_walls = 0; // there is wall_light

// Light that arrives at a cell's walls comes back with their mean albedo as one radiance on all lines that
// start there: what arrives is the sum of 4 pi w psi over the tubes' cross-sections, dx^3 / L. Returns
// the part of the correction's right hand side: what the change of that radiance would still set off.
float reflect_light(uint i, uint ch, uint per_direction)
{
    uint cell = i - ch * lattice_all_cells(), vector = lattice_wall_vector(ch, cell);
    uint cut = lattice_wall_links(cell);
    float albedo = 0.0, area = 0.0, per_radiance = LATTICE_4PI * args.dx * args.dx, sent = 0.0, sum = 0.0;
    if ((cut & (1u << LATTICE_DIRECTIONS) - 1u) != 0u) {
        for (uint d = 0; d < LATTICE_DIRECTIONS; d++) {
            if ((cut >> d & 1u) != 0u) {
                float share = lattice_share(d);
                sum += share * texelFetch(arrived_words, int(d * per_direction + i)).x;
            }
        }
        vec4 surface = lattice_wall_surface(cell);
        albedo = surface[ch];
        area = surface.a;
        if (lit_walls == 1) {
            sent = lattice_channel(wall_light[cell], args.channels, ch, args.tint);
        }
    }
    float radiance = area > 0.0 ? albedo * sum / area + sent : 0.0;
    swept[vector][cell % 4u] = radiance;
    for (uint k = cell % 4u + 1u; cell + 1u == lattice_all_cells() && k < 4u; k++) {
        swept[vector][k] = 0.0;
    }
    wall_power[i] = per_radiance * vec2((1.0 - albedo) * sum, sent * area);
    // Marshak's condition for a wall that reflects and shines.
    float change = radiance - texelFetch(state_words, int(4u * vector + cell % 4u)).x;
    return per_radiance * area * change * 2.0 / (1.0 + albedo);
}

void main()
{
    uvec3 texel = gl_GlobalInvocationID;
    uint ch = uint(quotient(int(texel.z), int(args.dims.z))), plane = args.dims.x * args.dims.y;
    if (any(greaterThanEqual(texel.xy, args.dims.xy)) || ch >= args.channels) {
        return;
    }
    uint i = texel.z * plane + texel.y * args.dims.x + texel.x;
    uint per_direction = plane * args.dims.z * args.channels;
    float axes = 0.0, diagonals = 0.0;
    vec3 axis_flux = vec3(0.0), diagonal_flux = vec3(0.0);
    for (uint d = 0; d < LATTICE_DIRECTIONS; d++) {
        float psi = texelFetch(mean_psi_words, int(d * per_direction + i)).x;
        vec3 o = vec3(lattice_step(d));
        if (d < 6) {
            axes += psi;
            axis_flux += psi * o;
        } else {
            diagonals += psi;
            diagonal_flux += psi * o;
        }
    }
    vec4 m = LATTICE_4PI * vec4(LATTICE_WEIGHT_AXIS * axes + LATTICE_WEIGHT_DIAGONAL * diagonals,
                                LATTICE_WEIGHT_AXIS * axis_flux +
                                    LATTICE_WEIGHT_DIAGONAL * inversesqrt(3.0) * diagonal_flux);
    swept[i] = m;
    float sigma_s = texelFetch(cells, ivec3(texel), 0).x;
    uint l = ch * args.stride + i - ch * plane * args.dims.z; // on level 0
    float change = args.dx * args.dx * args.dx * sigma_s * (m.x - texelFetch(state_words, int(4u * i)).x);
    if (walls == 1) {
        change += reflect_light(i, ch, per_direction);
    }
    rhs[l] = change;
    // The first half of the first relaxation, from corrections of 0.
    float corrected = 0.0;
    if (args.corrected == 1 && ((texel.x + texel.y + texel.z - ch * args.dims.z) & 1) == 0) {
        corrected = change / abs(texelFetch(stencil_hi_words, int(4u * l + 3u)).x);
    }
    correction[l] = corrected;
}
