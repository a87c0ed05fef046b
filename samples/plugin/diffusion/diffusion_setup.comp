// diffusion_setup.comp -- the equation of a cell: its coefficients and what is put into it; the first time also a guess.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/common/scene_args.h"
#include "shaders/common/counters.h"
#include "shaders/lattice/lattice_sweep.glsl"
#include "diffusion_system.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
layout(binding = 0) uniform sampler3D cells_tex;
layout(binding = 1) uniform sampler3D source_tex; // one texel of zeros where no light comes unscattered
TYN_UNIFORM(2, environment, env_block environment);
TYN_WRITE(3, system, vec4 equation[]);
TYN_WRITE(4, forward, vec4 forward[]);
TYN_UPDATE(5, fluence, float fluence[]);
TYN_UPDATE(6, counters, counters_block counters);

float transport_of(vec4 cell)
{
    return max(cell.y + (1.0 - cell.z) * cell.x, args.least);
}

// 1 / (3 sigma_tr) where light is even; where it is not, less, so that no more flows than there is: Levermore and Pomraning's
// limiter, as a quotient.
float diffusion_of(ivec3 c, uint channel, float transport)
{
    if (args.first == 1u) {
        return 1.0 / (3.0 * transport);
    }
    vec3 change = vec3(0.0);
    [[unroll]] for (int axis = 0; axis < 3; axis++) {
        ivec3 up = min(c + FACES[2 * axis + 1], ivec3(args.dims) - 1), down = max(c + FACES[2 * axis], ivec3(0));
        change[axis] = (fluence[system_index(up, channel)] - fluence[system_index(down, channel)]) /
                       (args.dx * max(float(up[axis] - down[axis]), 1.0));
    }
    float ratio = min(length(change) / max(transport * fluence[system_index(c, channel)], 1e-30), 1e6);
    return (2.0 + ratio) / (6.0 + 3.0 * ratio + ratio * ratio) / transport;
}

vec3 forward_of(vec4 cell, vec4 light)
{
    return cell.x * cell.z / transport_of(cell) * light.yzw;
}

void main()
{
    ivec3 texel = ivec3(gl_GlobalInvocationID), dims = ivec3(args.dims);
    if (any(greaterThanEqual(texel, dims * ivec3(1, 1, args.channels)))) {
        return;
    }
    uint channel = uint(texel.z / dims.z);
    ivec3 stack = ivec3(0, 0, int(channel) * dims.z), c = texel - stack;
    vec4 cell = texelFetch(cells_tex, texel, 0), light = lattice_fetch_source(source_tex, cells_tex, texel);
    float d = diffusion_of(c, channel, transport_of(cell));
    vec3 own = forward_of(cell, light);
    float outside = args.lit == 1u ? lattice_channel(environment.sky, args.channels, channel, args.tint) : 0.0;
    float put = (cell.x * light.x + LATTICE_4PI * cell.w) * args.dx, through = cell.y * args.dx;
    [[unroll]] for (int f = 0; f < 6; f++) {
        ivec3 q = c + FACES[f];
        if (system_within(q)) {
            vec4 other = texelFetch(cells_tex, q + stack, 0);
            vec4 there = lattice_fetch_source(source_tex, cells_tex, q + stack);
            put -= 0.5 * dot(own + forward_of(other, there), vec3(FACES[f]));
        } else {
            put -= system_boundary_share(d) * dot(own, vec3(FACES[f]));
            put += system_boundary(d) * LATTICE_4PI * outside;
        }
    }
    if (isnan(put) || isinf(put)) {
        put = 0.0;
        atomicAdd(counters.non_finite, 1u);
    }
    uint i = system_index(c, channel);
    equation[i] = vec4(d, through, put, 0.0);
    forward[i] = vec4(own, 0.0);
    if (args.first == 1u) {
        fluence[i] = LATTICE_4PI * outside; // what a medium that only scatters has inside a uniform environment
    }
}
