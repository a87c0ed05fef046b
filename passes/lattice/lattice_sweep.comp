// lattice_sweep.comp -- one sweep: a thread follows one lattice line of one direction and channel.
//
// psi stays in a register. Lines of a diagonal have different lengths; a thread that leaves the box
// at a side goes on at the opposite side with the line that enters there, so every thread makes as
// many steps as the box has slices, and every cell is met once per direction. At a link that a wall cuts
// the light has arrived at the wall, and the line goes on with what the wall sends out on its other side.
#include "shaders/lattice/lattice_args.h"
#define LATTICE_ENVIRONMENT 0
#include "shaders/lattice/lattice_unhindered.glsl"

layout(local_size_x = LATTICE_SWEEP_GROUP) in;
TYN_ARGS(lattice_args args);
layout(binding = 1) uniform sampler3D cells;
layout(binding = 2) uniform samplerBuffer emitted_texels; // vec4 per cell
TYN_WRITE(3, mean_psi, float mean_psi[]); // mean radiance in a cell: [direction][channel][cell]
TYN_WRITE(4, leaks, float leaks[]); // per thread: what leaves the box less what enters, W

layout(binding = 5) uniform samplerBuffer state_words; // floats
TYN_WRITE(6, arrived, float arrived[]); // radiance at the end of a cut link: [direction][channel][cell]
#define LATTICE_WALL_LINKS 7
#include "lattice_wall_state.glsl"
#include "shaders/walls/walls_links.glsl"
layout(constant_id = 0) const uint walls = 0;
layout(constant_id = 1) const uint periodic = 0; // some axes are

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
    // March along z, or along the axis of the direction; lines start at the cells of the plane
    // across.
    int axis = diagonal ? int(args.march) : int(direction / 2);
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
        ivec3 strides = ivec3(1, dims.x, dims.x * dims.y);
        ivec3 step_back = -o * (dims - 1) * strides; // from the last cell of an axis to its first
        int per_channel = dims.z * strides.z;
        int to_mean = int(direction * args.channels) * per_channel;
        int at = int(ch) * per_channel + c.z * strides.z + c.y * strides.y + c.x;

        float length_l = args.dx * (diagonal ? sqrt(3.0) : 1.0);
        vec3 omega = vec3(o) * (diagonal ? inversesqrt(3.0) : 1.0);
        float cross_section = args.dx * args.dx * args.dx / length_l; // of the tube around a line
        float boundary = lattice_boundary(args.channels, ch, args.tint);

        uint ahead = 1u << direction, back = 1u << walls_reverse(direction);

        float psi = boundary, before = 0.0;
        vec4 e = texelFetch(emitted_texels, at);
        float s = e.x + dot(omega, e.yzw);
        bvec3 open = bvec3(true);
        bool closed = false; // the line comes back to where it began
        float through = 1.0; // what of the light is left there
        int steps = dims[axis];
        if (periodic == 1) {
            open = equal(args.repeat, uvec3(0));
            closed = !diagonal && !open[axis];
            if (closed) { // the first time round finds out what comes back
                psi = 0.0;
                steps *= 2;
                vec4 end = texelFetch(emitted_texels, at + (dims[axis] - 1) * o[axis] * strides[axis]);
                before = end.x + dot(omega, end.yzw);
            }
        }
        for (int i = 0; i < steps; i++) {
            bvec3 at_first = both(equal(c, first), moves), at_last = both(equal(c, last), moves);
            bool enters = any(at_first), leaves = any(at_last);
            if (periodic == 1) {
                enters = any(both(at_first, open));
                leaves = any(both(at_last, open));
                if (closed && i == dims[axis]) {
                    psi /= max(1.0 - through, 1e-6);
                }
            }
            bool counted = leaves, ends = false;
            if (enters) {
                psi = boundary;
            }
            leak -= enters ? psi : 0.0;
            if (walls == 1) {
                uint id = uint(at - int(ch) * per_channel), cut = lattice_wall_links(id);
                if ((cut & back) != 0u) {
                    leak += enters ? psi : 0.0;
                    psi = texelFetch(state_words, int(4u * lattice_wall_vector(ch, id) + id % 4u)).x;
                    enters = true;
                    through = 0.0;
                }
                ends = (cut & ahead) != 0u;
                counted = leaves && !ends;
                leaves = leaves || ends;
            }
            vec4 cell = texelFetch(cells, c + ivec3(0, 0, int(ch) * dims.z), 0);
            // On, or around to the line that enters at the opposite side.
            int next = at + (at_last.x ? step_back.x : o.x * strides.x) +
                       (at_last.y ? step_back.y : o.y * strides.y) +
                       (at_last.z ? step_back.z : o.z * strides.z);
            c = mix(c + o, first, at_last);
            e = texelFetch(emitted_texels, next);
            float behind = e.x + dot(omega, e.yzw);
            // Central difference, one-sided at the box; limited so that the source keeps its sign.
            float slope = enters ? (leaves ? 0.0 : behind - s)
                                 : (leaves ? s - before : 0.5 * (behind - before));
            slope = clamp(slope, -2.0 * abs(s), 2.0 * abs(s));

            lattice_weights w = lattice_weights_of((cell.x + cell.y) * length_l);
            float q = length_l * cell.x, emission = length_l * cell.w;
            mean_psi[at + to_mean] = psi * w.a0 + q * (s * w.a1 + slope * w.b1) + emission * w.a1;
            through *= w.e;
            psi = psi * w.e + q * (s * w.a0 + slope * w.w1) + emission * w.a0;
            leak += counted ? psi : 0.0;
            if (ends) {
                arrived[at + to_mean] = psi;
            }
            before = s;
            s = behind;
            at = next;
        }
        leak *= cross_section * LATTICE_4PI * lattice_weight(direction);
    }
    leaks[(ch * LATTICE_DIRECTIONS + direction) * args.lines + line] = leak;
}
