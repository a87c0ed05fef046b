// lattice_mix.comp -- the next state, from the results of the last sweeps, and what it emits.
#include "shaders/lattice/lattice_args.h"
#include "shaders/common/quotient.glsl"
#include "shaders/lattice/lattice_sweep.glsl"
#include "shaders/common/counters.h"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
TYN_ARGS(lattice_args args);
layout(binding = 0) uniform sampler3D cells;
layout(binding = 1) uniform sampler3D source;
layout(binding = 2) uniform samplerBuffer result_0_texels;
layout(binding = 3) uniform samplerBuffer result_1_texels;
layout(binding = 4) uniform samplerBuffer result_2_texels;
TYN_READ(5, weights, vec2 weights[]);
TYN_WRITE(6, state, vec4 state[]);
TYN_WRITE(7, emitted, vec4 emitted[]);
TYN_UPDATE(8, counters, counters_block counters);
layout(binding = 9, rgba32f) uniform writeonly image3D moments;
layout(binding = 10) uniform samplerBuffer swept_texels;
TYN_UPDATE(12, wall_power, vec2 wall_power[]); // absorbed, sent out of wall_light; W

layout(constant_id = 0) const uint last = 0; // 1: of the last sweep
layout(constant_id = 1) const uint walls = 0;
#define LATTICE_WALL_CELLS 11
#include "lattice_wall_state.glsl"

// What the walls absorb of the light that is left in the end: the sweep's is that of the state before it.
void absorb_change(uint ch, uint cell, int v, float radiance)
{
    vec4 surface = lattice_wall_surface(cell);
    if (surface.a > 0.0 && surface[ch] > 0.0) {
        float change = (radiance - texelFetch(swept_texels, v)[cell % 4u]) / surface[ch]; // of what arrives
        uint i = ch * lattice_all_cells() + cell;
        float more = LATTICE_4PI * args.dx * args.dx * surface.a * (1.0 - surface[ch]) * change;
        wall_power[i].x = max(wall_power[i].x + more, 0.0);
    }
}

// Counts what the clamp of the walls' radiance at 0 hides of what they send out.
void count_walls(uint cell, float radiance)
{
    float area = lattice_wall_surface(cell).a;
    float below = area * max(-radiance, 0.0), above = area * max(radiance, 0.0);
    TYN_LIGHT_CLAMP_ADD(counters.clamp_0, below, above)
    if (below > 0.0) {
        atomicAdd(counters.clamped, 1u);
    }
}

// The next radiance of the walls of a cell.
void mix_walls(uint ch, uint cell)
{
    uint k = cell % 4u;
    int v = int(lattice_wall_vector(ch, cell));
    float newest = texelFetch(result_0_texels, v)[k], radiance = newest;
    if (args.history >= 1) {
        radiance += weights[ch].x * (texelFetch(result_1_texels, v)[k] - newest);
    }
    if (args.history >= 2) {
        radiance += weights[ch].y * (texelFetch(result_2_texels, v)[k] - newest);
    }
    if (isnan(radiance) || isinf(radiance)) {
        radiance = 0.0;
        atomicAdd(counters.non_finite, 1u);
    }
    if (last == 1) {
        count_walls(cell, radiance);
    }
    radiance = max(radiance, 0.0);
    state[v][k] = radiance;
    if (last == 1) {
        absorb_change(ch, cell, v, radiance);
    }
}

void main()
{
    uvec3 texel = gl_GlobalInvocationID;
    uint ch = uint(quotient(int(texel.z), int(args.dims.z)));
    if (any(greaterThanEqual(texel.xy, args.dims.xy)) || ch >= args.channels) {
        return;
    }
    uint i = (texel.z * args.dims.y + texel.y) * args.dims.x + texel.x;
    vec4 newest = texelFetch(result_0_texels, int(i)), m = newest;
    if (args.history >= 1) {
        m += weights[ch].x * (texelFetch(result_1_texels, int(i)) - newest);
    }
    if (args.history >= 2) {
        m += weights[ch].y * (texelFetch(result_2_texels, int(i)) - newest);
    }
    if (any(isnan(m)) || any(isinf(m))) {
        m = vec4(0.0);
        atomicAdd(counters.non_finite, 1);
    }
    if (walls == 1) {
        mix_walls(ch, i - ch * lattice_all_cells());
    }
    if (last == 1) {
        imageStore(moments, ivec3(texel), m);
    } else {
        state[i] = m;
        vec4 beam = lattice_fetch_source(source, cells, ivec3(texel));
        emitted[i] = lattice_emitted(m + beam, texelFetch(cells, ivec3(texel), 0).z);
    }
}
