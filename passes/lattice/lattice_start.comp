// lattice_start.comp -- the first guess: the environment everywhere as if unhindered, no sunlight; or
// what lattice_ordinates found.
//
// In a medium that only scatters, inside a uniform environment, the former is already the solution. Among
// walls it is dark: what no light reaches stays so.
#include "shaders/lattice/lattice_args.h"
#include "shaders/common/quotient.glsl"
#define LATTICE_ENVIRONMENT 0
#include "shaders/lattice/lattice_unhindered.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
TYN_ARGS(lattice_args args);
layout(binding = 1) uniform sampler3D cells;
layout(binding = 2) uniform sampler3D source;
TYN_WRITE(3, state, vec4 state[]);
TYN_WRITE(4, emitted, vec4 emitted[]);
TYN_READ(5, guess, vec4 guess[]);
TYN_READ(6, wall_light, vec3 wall_light[]);
layout(constant_id = 0) const uint walls = 0;
layout(constant_id = 1) const uint lit_walls = 0; // there is wall_light
#include "lattice_wall_state.glsl"

void main()
{
    uvec3 texel = gl_GlobalInvocationID; // channels stacked along z
    uint ch = uint(quotient(int(texel.z), int(args.dims.z)));
    if (any(greaterThanEqual(texel.xy, args.dims.xy)) || ch >= args.channels) {
        return;
    }
    uint i = (texel.z * args.dims.y + texel.y) * args.dims.x + texel.x;
    vec4 m = args.guess == 1 ? guess[i] : lattice_unhindered(args.channels, ch, args.tint);
    if (walls == 1) {
        m = args.guess == 1 ? m : vec4(0.0);
        uint cell = i - ch * lattice_all_cells();
        uint vector = lattice_wall_vector(ch, cell);
        float sent = lit_walls == 1 ? lattice_channel(wall_light[cell], args.channels, ch, args.tint) : 0.0;
        state[vector][cell % 4u] = sent;
        for (uint k = cell % 4u + 1u; cell + 1u == lattice_all_cells() && k < 4u; k++) {
            state[vector][k] = 0.0;
        }
    }
    state[i] = m;
    vec4 beam = lattice_fetch_source(source, cells, ivec3(texel));
    emitted[i] = lattice_emitted(m + beam, texelFetch(cells, ivec3(texel), 0).z);
}
