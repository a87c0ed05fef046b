// lattice_sweep.comp -- one sweep: a thread follows one lattice line of one direction and channel.
//
// psi stays in a register. Lines of a diagonal have different lengths; a thread that leaves the box at a
// side goes on at the opposite side with the line that enters there, so every thread makes as many steps
// as the box has slices, and every cell is met once per direction.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "scene_args.h"
#include "lattice_args.h"
#include "lattice_sweep.glsl"

layout(local_size_x = LATTICE_SWEEP_GROUP) in;
layout(push_constant, scalar) uniform push
{
    lattice_args args;
};
layout(binding = 0, scalar) uniform environment_uniform
{
    env_block environment;
};
layout(binding = 1) uniform sampler3D cells;
layout(binding = 2) uniform sampler3D emitted;
// Mean radiance in the cell, directions stacked along x.
layout(binding = 3, r32f) uniform writeonly image3D mean_psi;
layout(binding = 4, scalar) writeonly buffer leak_buffer
{
    float leaks[]; // per thread: what leaves the box less what enters, W
};

bvec3 both(bvec3 a, bvec3 b)
{
    return bvec3(a.x && b.x, a.y && b.y, a.z && b.z);
}

void main()
{
    uint line = gl_GlobalInvocationID.x, direction = gl_GlobalInvocationID.y;
    uint ch = gl_GlobalInvocationID.z;
    ivec3 dims = ivec3(args.dims);
    ivec3 o = lattice_step(direction);
    bool diagonal = direction >= 6;
    // March along z, or along the axis of the direction; lines start at the cells of the plane across.
    int axis = diagonal ? 2 : int(direction / 2);
    int u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
    if (line >= args.lines) {
        return;
    }
    float leak = 0.0;
    if (line < uint(dims[u] * dims[v])) {
        ivec3 c;
        c[u] = int(line) % dims[u];
        c[v] = int(line) / dims[u];
        c[axis] = o[axis] > 0 ? 0 : dims[axis] - 1;
        ivec3 first = mix(dims - 1, ivec3(0), greaterThan(o, ivec3(0)));
        ivec3 last = dims - 1 - first;
        bvec3 moves = notEqual(o, ivec3(0));
        ivec3 stack = ivec3(0, 0, int(ch) * dims.z);
        ivec3 to_mean = stack + ivec3(int(direction) * dims.x, 0, 0);

        float length_l = args.dx * (diagonal ? sqrt(3.0) : 1.0);
        vec3 omega = vec3(o) * (diagonal ? inversesqrt(3.0) : 1.0);
        float weight = diagonal ? LATTICE_WEIGHT_DIAGONAL : LATTICE_WEIGHT_AXIS;
        float tube = args.dx * args.dx * args.dx / length_l * LATTICE_4PI * weight; // m^2 sr
        float boundary = lattice_channel(environment.mean, args.channels, ch, args.tint);

        float psi = boundary, before = 0.0;
        vec4 e = texelFetch(emitted, c + stack, 0);
        float s = e.x + dot(omega, e.yzw);
        for (int i = 0; i < dims[axis]; i++) {
            bool enters = any(both(equal(c, first), moves)), leaves = any(both(equal(c, last), moves));
            if (enters) {
                psi = boundary;
                leak -= psi;
            }
            ivec3 next = mix(c + o, first, both(equal(c, last), moves));
            e = texelFetch(emitted, next + stack, 0);
            float behind = e.x + dot(omega, e.yzw);
            // Central difference, one-sided at the box; limited so that the source keeps its sign.
            float slope = enters ? (leaves ? 0.0 : behind - s)
                                 : (leaves ? s - before : 0.5 * (behind - before));
            slope = clamp(slope, -2.0 * abs(s), 2.0 * abs(s));

            vec4 cell = texelFetch(cells, c + stack, 0);
            lattice_weights w = lattice_weights_of((cell.x + cell.y) * length_l);
            float q = length_l * cell.x, emission = length_l * cell.w;
            float mean = psi * w.a0 + q * (s * w.a1 + slope * w.b1) + emission * w.a1;
            psi = psi * w.e + q * (s * w.a0 + slope * w.w1) + emission * w.a0;
            imageStore(mean_psi, c + to_mean, vec4(mean));
            if (leaves) {
                leak += psi;
            }
            before = s;
            s = behind;
            c = next;
        }
        leak *= tube;
    }
    leaks[(ch * LATTICE_DIRECTIONS + direction) * args.lines + line] = leak;
}
