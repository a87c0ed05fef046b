// lattice_ordinates_lines.comp -- the sky's mean along the lattice's lines, as if there were no surfaces: its mean radiance in
// every cell. A thread follows one line of one direction and channel; lines are those of lattice_sweep.comp.
#include "shaders/lattice/lattice_args.h"
#define LATTICE_ENVIRONMENT 0
#include "shaders/lattice/lattice_unhindered.glsl"

layout(local_size_x = 64) in;
TYN_ARGS(lattice_mean_args args);
layout(binding = 1) uniform sampler3D cells;
TYN_WRITE(2, mean_psi, float mean_psi[]); // [direction][channel][cell]

bvec3 lattice_both(bvec3 a, bvec3 b)
{
    return bvec3(a.x && b.x, a.y && b.y, a.z && b.z);
}

void main()
{
    uint line = gl_GlobalInvocationID.x, direction = gl_GlobalInvocationID.y, ch = gl_GlobalInvocationID.z;
    ivec3 dims = ivec3(args.dims), o = lattice_step(direction);
    bool diagonal = direction >= 6u;
    int axis = diagonal ? int(args.march) : int(direction / 2u);
    int u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
    if (line >= uint(dims[u] * dims[v])) {
        return;
    }
    ivec3 first = mix(dims - 1, ivec3(0), greaterThan(o, ivec3(0))), last = dims - 1 - first, c;
    c[u] = int(line) % dims[u];
    c[v] = int(line) / dims[u];
    c[axis] = first[axis];
    bvec3 moves = notEqual(o, ivec3(0));
    float length_l = args.dx * (diagonal ? sqrt(3.0) : 1.0);
    float boundary = lattice_boundary(args.channels, ch, args.tint), psi = boundary;
    for (int i = 0; i < dims[axis]; i++) {
        bvec3 at_first = equal(c, first), at_last = equal(c, last);
        psi = any(lattice_both(at_first, moves)) ? boundary : psi;
        vec4 cell = texelFetch(cells, c + ivec3(0, 0, int(ch) * dims.z), 0);
        lattice_weights w = lattice_weights_of((cell.x + cell.y) * length_l);
        mean_psi[((int(direction * args.channels + ch) * dims.z + c.z) * dims.y + c.y) * dims.x + c.x] = psi * w.a0;
        psi *= w.e;
        // On, or around to the line that enters at the opposite side.
        c = mix(c + o, first, lattice_both(at_last, moves));
    }
}
