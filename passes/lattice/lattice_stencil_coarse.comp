// lattice_stencil_coarse.comp -- stencil of a level from that of the next finer one.
//
// Coarse conductances are those of cells twice as large whose D is the mean over the four fine
// faces: half the sum. Absorption adds up.
#include "shaders/lattice/lattice_args.h"
#include "shaders/common/quotient.glsl"
#include "lattice_levels.glsl"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
TYN_ARGS(lattice_level_args args); // level: the coarse one
TYN_WRITE(0, stencil_lo, vec4 stencil_lo[]);
TYN_WRITE(1, stencil_hi, vec4 stencil_hi[]);

#define LATTICE_STENCIL_LO 2
#define LATTICE_STENCIL_HI 3
#include "lattice_stencil_texels.glsl" // the buffers above, of finer cells

// 0: there are no walls; else two dispatches: 1 finds the orphans among the fine cells, 2 does the rest.
layout(constant_id = 0) const uint walls = 0;
layout(constant_id = 1) const uint lattice_repeat = 0; // a bit for each axis along which the grid goes on

// Children of coarse cell c that are connected with each other, most of them: bit = child.
uint largest_part(const lattice_level fine, ivec3 c, uint channel)
{
    uint part[8];
    vec3 hi[8];
    for (int child = 0; child < 8; child++) {
        ivec3 f = 2 * c + ivec3(child & 1, child >> 1 & 1, child >> 2);
        bool inside = all(lessThan(f, fine.size));
        part[child] = inside ? 1u << child : 0u;
        hi[child] = inside ? lattice_stencil_hi_at(channel + lattice_index(fine, f)).xyz : vec3(0.0);
    }
    for (int times = 0; times < 7; times++) {
        for (int child = 0; child < 8; child++) {
            for (int axis = 0; axis < 3; axis++) {
                int other = child | 1 << axis;
                if (other != child && part[other] != 0u && hi[child][axis] > 0.0) {
                    part[child] |= part[other];
                    part[other] |= part[child];
                }
            }
        }
    }
    uint largest = 0u;
    for (int child = 0; child < 8; child++) {
        largest = bitCount(part[child]) > bitCount(largest) ? part[child] : largest;
    }
    return largest;
}

void mark_orphans(const lattice_level fine, ivec3 c, uint channel)
{
    uint part = largest_part(fine, c, channel);
    for (int child = 0; child < 8; child++) {
        ivec3 f = 2 * c + ivec3(child & 1, child >> 1 & 1, child >> 2);
        if ((part >> child & 1u) == 0u && all(lessThan(f, fine.size))) {
            uint i = channel + lattice_index(fine, f);
            stencil_hi[i].w = -abs(lattice_stencil_hi_at(i).w);
        }
    }
}

// Is there a wall between a cell, or what stands for it on the next level, and its neighbour?
bool parted(const lattice_level fine, ivec3 f, int axis, int way, uint channel)
{
    if (walls == 0) {
        return false;
    }
    f[axis] = (f[axis] + way + fine.size[axis]) % fine.size[axis];
    return lattice_orphan(lattice_stencil_hi_at(channel + lattice_index(fine, f)));
}

// In series with the half cell that is to become twice as long; no way out at all through a wall.
float longer(float area, float conductance)
{
    return conductance > 0.0 ? area / (2.0 * (area / conductance) - 2.0) : 0.0;
}

void main()
{
    lattice_level coarse = lattice_level_of(ivec3(args.dims), args.level);
    lattice_level fine = lattice_level_of(ivec3(args.dims), args.level - 1);
    ivec3 c = ivec3(gl_GlobalInvocationID);
    int ch = quotient(c.z, coarse.size.z);
    c.z -= ch * coarse.size.z;
    if (any(greaterThanEqual(c.xy, coarse.size.xy)) || ch >= int(args.channels)) {
        return;
    }
    uint channel = uint(ch) * args.stride;
    if (walls == 1) {
        mark_orphans(fine, c, channel);
        return;
    }
    float edge = args.dx * float(1u << (args.level - 1)), area = edge * edge; // of fine cells
    lattice_stencil k = lattice_stencil(vec3(0.0), vec3(0.0), 0.0, 0.0);
    for (int child = 0; child < 8; child++) {
        ivec3 f = 2 * c + ivec3(child & 1, child >> 1 & 1, child >> 2);
        if (any(greaterThanEqual(f, fine.size))) {
            continue;
        }
        uint i = channel + lattice_index(fine, f);
        vec4 lo = lattice_stencil_lo_at(i), hi = lattice_stencil_hi_at(i);
        if (lattice_orphan(hi)) {
            continue;
        }
        k.absorption += lo.w;
        for (int axis = 0; axis < 3; axis++) {
            // At the box the half cell becomes twice as long. A coarse cell that reaches beyond the
            // box has its centre on it, so that only the Robin condition is left.
            const bool goes_on = (lattice_repeat >> axis & 1u) != 0u, alone = goes_on && coarse.size[axis] == 1;
            if (f[axis] == 0 && !goes_on) {
                k.lo[axis] += longer(area, lo[axis]);
            } else if (f[axis] % 2 == 0 && !alone && !parted(fine, f, axis, -1, channel)) {
                k.lo[axis] += 0.5 * lo[axis];
            }
            const bool last = f[axis] == fine.size[axis] - 1;
            if (last && !goes_on) {
                bool beyond = f[axis] % 2 == 0;
                float out_of_box = beyond && hi[axis] > 0.0 ? area / 2.0 : longer(area, hi[axis]);
                k.hi[axis] += out_of_box;
            } else if ((f[axis] % 2 == 1 || last) && !alone && !parted(fine, f, axis, 1, channel)) {
                k.hi[axis] += 0.5 * hi[axis];
            }
        }
    }
    uint i = channel + lattice_index(coarse, c);
    stencil_lo[i] = lattice_stencil_lo(k);
    stencil_hi[i] = lattice_stencil_hi(k);
}
