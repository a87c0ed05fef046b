// lattice_stencil_walls.comp -- marks the cells to which corrections of the next coarser level come unblended, as there
// are walls about.
#include "shaders/lattice/lattice_args.h"
#include "shaders/common/quotient.glsl"
#include "lattice_levels.glsl"
#include "lattice_stencil.glsl"

layout(local_size_x = LATTICE_GROUP) in; // along all levels of a channel
TYN_ARGS(lattice_level_args args);
TYN_UPDATE(0, stencil_lo, vec4 stencil_lo[]);
TYN_READ(1, stencil_hi, vec4 stencil_hi[]);

layout(constant_id = 1) const uint lattice_repeat = 0; // a bit for each axis along which the grid goes on

bool near_walls(uint in_level, const lattice_level fine, const lattice_level coarse, uint channel)
{
    ivec3 c = quotient_place(in_level, fine.size);
    lattice_interpolation from = lattice_interpolation_of(c, coarse.size, lattice_repeat);
    bool open = true;
    for (uint corner = 0; corner < 8; corner++) {
        uint k = channel + lattice_index(coarse, lattice_corner(from, corner));
        open = open && lattice_open(stencil_lo[k].xyz, stencil_hi[k].xyz);
    }
    return !open;
}

void main()
{
    uint i = gl_GlobalInvocationID.x, channel = gl_GlobalInvocationID.y * args.stride;
    if (i >= args.stride) {
        return;
    }
    bool near = false;
    lattice_level level = lattice_level_of(ivec3(args.dims), 0);
    for (uint l = 0; l + 1 < args.levels; l++) {
        lattice_level next = lattice_next_level(level);
        if (i >= level.first && i < next.first) {
            near = near_walls(i - level.first, level, next, channel);
        }
        level = next;
    }
    for (; near; near = false) {
        stencil_lo[channel + i].w = -stencil_lo[channel + i].w;
    }
}
