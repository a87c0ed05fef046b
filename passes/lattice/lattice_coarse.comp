// lattice_coarse.comp -- the V-cycle on all levels small enough for one workgroup's shared memory.
//
// One workgroup per channel. The first level's right hand side comes from a buffer, as do all
// stencils; the corrections of all levels and the other right hand sides are in shared memory.
#extension GL_EXT_control_flow_attributes : require
#include "shaders/lattice/lattice_args.h"
#include "shaders/common/quotient.glsl"
#include "lattice_levels.glsl"
#define LATTICE_STENCIL_LO 0
#define LATTICE_STENCIL_HI 1
#include "lattice_stencil_texels.glsl"

layout(local_size_x = LATTICE_COARSE_GROUP) in;
#define WORKGROUP_SIZE LATTICE_COARSE_GROUP
#define WORKGROUP_SUM vec2
#include "shaders/common/workgroup.glsl"
TYN_ARGS(lattice_level_args args); // level: the first that is solved here
layout(binding = 2) uniform samplerBuffer rhs_words;
TYN_UPDATE(3, correction, float correction_out[]);

layout(constant_id = 0) const uint walls = 0;
layout(constant_id = 2) const uint little_shared = 0;

// Each level has 1/8 of the cells of the one before; 1/4 in a box one cell thin; and 1/2 in one
// that is thin along two axes, which has at most 64 cells to begin with. So 3/8 more hold all
// levels.
const uint coarse_cells = little_shared == 1u ? LATTICE_COARSE_FEW : LATTICE_COARSE_CELLS; // at most
const uint COARSER = (coarse_cells >> 2) + (coarse_cells >> 3);
shared float correction[coarse_cells + COARSER];
shared float rhs[COARSER];


// On the coarsest level, at most 4^3 cells, over-relaxed.
const uint COARSEST_RELAXATIONS = 8;
const float COARSEST_OMEGA = 1.5;

lattice_level at;    // the level at work
lattice_level first; // the finest one here
uint channel;        // first cell of the channel in the buffers

// Index in `correction` and, less the cells of the finest level, in `rhs`.
uint index_of(ivec3 c)
{
    return lattice_index(at, c) - first.first;
}

lattice_stencil stencil_at(ivec3 c)
{
    return lattice_stencil_at(channel + lattice_index(at, c));
}

float correction_at(uint i)
{
    return correction[i];
}

#define LATTICE_REPEAT 1
#include "lattice_inflow.glsl"

// Right hand side plus what flows in from the neighbours.
float inflow(ivec3 c, const lattice_stencil k)
{
    uint i = index_of(c);
    float sum = at.first == first.first ? texelFetch(rhs_words, int(channel + lattice_index(at, c))).x
                                        : rhs[i - lattice_num_cells(first.size)];
    return lattice_inflow(sum, at, c, i, k);
}

// Half relaxations from `begin` on, of even and odd cells in turn.
void relax(uint begin, uint end, float omega)
{
    ivec3 half_size = ivec3((at.size.x + 1) / 2, at.size.yz);
    uint n = lattice_num_cells(half_size);
    // Where an odd number of cells repeats the first and last one are neighbours of one colour: the last take a turn of their own.
    uint odd = 0u;
    for (int axis = 0; axis < 3; axis++) {
        odd |= lattice_repeats(axis) && at.size[axis] % 2 == 1 && at.size[axis] > 1 ? 1u << axis : 0u;
    }
    for (uint t = begin << 3; t < end << 3; t++) {
        if ((t & 7u & ~odd) != 0u) {
            continue;
        }
        for (uint i = gl_LocalInvocationIndex; i < n; i += LATTICE_COARSE_GROUP) {
            ivec3 c = quotient_place(i, half_size);
            c.x = 2 * c.x + (c.y + c.z + int(t >> 3) & 1);
            uvec3 last = uvec3(equal(c, at.size - 1));
            uint turn = (last.x | last.y << 1 | last.z << 2) & odd;
            if (c.x < at.size.x && turn == (t & 7u)) {
                lattice_stencil k = stencil_at(c);
                float old = correction[index_of(c)];
                correction[index_of(c)] = mix(old, inflow(c, k) / k.diagonal, omega);
            }
        }
        barrier();
    }
}

// Residual of the level at work, summed into the right hand side of the next; half of that one's first relaxation.
void restrict_to_next(float omega)
{
    lattice_level next = lattice_next_level(at);
    uint to = next.first - first.first;
    uint n = lattice_num_cells(next.size);
    for (uint i = gl_LocalInvocationIndex; i < n; i += LATTICE_COARSE_GROUP) {
        ivec3 c = quotient_place(i, next.size);
        float sum = 0.0;
        const int even[4] = int[](0, 3, 5, 6); // the others were relaxed last: no residual
        [[unroll]] for (int k = 0; k < 4; k++) {
            int child = even[k];
            ivec3 f = 2 * c + ivec3(child & 1, child >> 1 & 1, child >> 2);
            vec4 hi = lattice_stencil_hi_at(channel + lattice_index(at, min(f, at.size - 1)));
            if (all(lessThan(f, at.size)) && !lattice_orphan(hi)) {
                lattice_stencil k = lattice_stencil_of(lattice_stencil_lo_at(channel + lattice_index(at, f)), hi);
                sum += inflow(f, k) - k.diagonal * correction[index_of(f)];
            }
        }
        rhs[to + i - lattice_num_cells(first.size)] = sum;
        float diagonal = abs(lattice_stencil_hi_at(channel + lattice_index(next, c)).w);
        correction[to + i] = (c.x + c.y + c.z & 1) == 0 ? omega * sum / diagonal : 0.0;
    }
    barrier();
}

// How much of the correction e of the level at work the next finer one is to get.
//
// Cycles give more than they should, a little on every level: seven tenths too much in a slab of depth 29 of 32 cells, twice as much
// in one of 48. And beside walls corrections are carried over unblended, as steps between coarse cells, which hold
// twice the energy e.A e that they have on the coarse level, whose conductances are right for blended
// ones; then cycles would diverge. So corrections are scaled to the least energy, r.e / e.A e (Braess, "Towards algebraic
// multigrid for elliptic problems of second order", Computing 55, 1995).
float step_length()
{
    vec2 sum = vec2(0.0);
    uint n = lattice_num_cells(at.size), me = gl_LocalInvocationIndex;
    for (uint i = me; i < n; i += LATTICE_COARSE_GROUP) {
        ivec3 c = quotient_place(i, at.size);
        uint id = channel + lattice_index(at, c);
        vec4 k_lo = lattice_stencil_lo_at(id), k_hi = lattice_stencil_hi_at(id);
        lattice_stencil k = lattice_stencil_of(k_lo, k_hi);
        float e = correction[index_of(c)];
        float r = at.first == first.first ? texelFetch(rhs_words, int(id)).x : rhs[index_of(c) - lattice_num_cells(first.size)];
        // Each cell has half of the energy of its faces.
        float steps = walls == 0 || lattice_open(k.lo, k.hi) ? 0.5 : 1.0;
        vec3 lo = vec3(0.0), hi = vec3(0.0);
        for (int axis = 0; axis < 3; axis++) {
            const int step = axis == 0 ? 1 : axis == 1 ? at.size.x : at.size.x * at.size.y;
            bool first_one = c[axis] == 0 && !lattice_repeats(axis);
            bool last_one = c[axis] == at.size[axis] - 1 && !lattice_repeats(axis);
            uint i = index_of(c);
            lo[axis] = first_one ? sqrt(2.0) * e : lattice_beside(i, c[axis], at.size[axis], step, -1, axis) - e;
            hi[axis] = last_one ? sqrt(2.0) * e : lattice_beside(i, c[axis], at.size[axis], step, 1, axis) - e;
        }
        sum += vec2(r * e, k.absorption * e * e + steps * (dot(k.lo, lo * lo) + dot(k.hi, hi * hi)));
    }
    sum = workgroup_total(sum);
    return sum.y > 0.0 ? clamp(sum.x / sum.y, 0.0, 4.0) : 1.0;
}

void interpolate_from_next(float scale)
{
    lattice_level next = lattice_next_level(at);
    uint to = at.first - first.first;
    uint n = lattice_num_cells(at.size);
    for (uint i = gl_LocalInvocationIndex; i < n; i += LATTICE_COARSE_GROUP) {
        lattice_interpolation from = lattice_interpolation_of(quotient_place(i, at.size), next.size, lattice_repeat);
        bool blended = true;
        if (walls == 1) {
            uint k = channel + at.first + i;
            if (lattice_orphan(lattice_stencil_hi_at(k))) {
                continue;
            }
            blended = !lattice_alone(lattice_stencil_lo_at(k));
        }
        float sum = 0.0;
        for (uint corner = 0; corner < 8; corner++) {
            ivec3 c = blended ? lattice_corner(from, corner) : from.near;
            uint q = lattice_index(next, c) - first.first;
            sum += lattice_corner_weight(corner) * correction[q];
        }
        correction[to + i] += scale * sum;
    }
    barrier();
}

void main()
{
    channel = gl_WorkGroupID.x * args.stride;
    first = lattice_level_of(ivec3(args.dims), args.level);
    uint n = lattice_num_cells(first.size), in_buffer = channel + first.first;
    for (uint i = gl_LocalInvocationIndex; i < n; i += LATTICE_COARSE_GROUP) {
        correction[i] = correction_out[in_buffer + i];
    }
    barrier();
    at = first;
    for (uint level = args.level; level + 1 < args.levels; level++) {
        relax(level == args.level ? args.colour : 1, 2, 1.0);
        restrict_to_next(level + 2 < args.levels ? 1.0 : COARSEST_OMEGA);
        at = lattice_next_level(at);
    }
    relax(args.level + 1 < args.levels ? 1 : 0, 2 * COARSEST_RELAXATIONS, COARSEST_OMEGA);
    for (uint level = args.levels - 1; level > args.level; level--) {
        float scale = step_length();
        at = lattice_level_of(ivec3(args.dims), level - 1);
        interpolate_from_next(scale);
        relax(0, 2, 1.0);
    }
    float scale = args.level > 0u ? step_length() : 1.0;
    for (uint i = gl_LocalInvocationIndex; i < n; i += LATTICE_COARSE_GROUP) {
        correction_out[in_buffer + i] = scale * correction[i];
    }
}
