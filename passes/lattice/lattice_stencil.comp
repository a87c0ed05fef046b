// lattice_stencil.comp -- stencil of the diffusion correction on the lattice itself.
#include "shaders/lattice/lattice_args.h"
#include "shaders/common/quotient.glsl"
#include "lattice_stencil.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
TYN_ARGS(lattice_level_args args);
layout(binding = 0) uniform sampler3D cells;
TYN_WRITE(1, stencil_lo, vec4 stencil_lo[]);
TYN_WRITE(2, stencil_hi, vec4 stencil_hi[]);

layout(constant_id = 0) const uint walls = 0;
layout(constant_id = 1) const uint lattice_repeat = 0; // a bit for each axis along which the grid goes on
#define LATTICE_WALL_LINKS 3
#define LATTICE_WALL_CELLS 4
#include "lattice_wall_state.glsl"

// 1 / (3 sigma_tr), and a second term without which a correction with this coefficient makes the
// iteration diverge where cells are optically thick (tau' > 3): a sweep itself spreads light by
// about that much. In vacuum the coefficient is bounded by the size of the box.
float diffusion_coefficient(vec4 cell)
{
    float total = cell.x + cell.y, tau = total * args.dx;
    float transport = total - cell.z * cell.x;
    return 1.0 / (3.0 * max(transport, args.least_transport)) + 0.2 * args.dx * min(1.0, tau * tau);
}

void main()
{
    ivec3 texel = ivec3(gl_GlobalInvocationID);
    ivec3 dims = ivec3(args.dims);
    if (any(greaterThanEqual(texel.xy, dims.xy)) || texel.z >= dims.z * int(args.channels)) {
        return;
    }
    int ch = quotient(texel.z, dims.z);
    ivec3 c = ivec3(texel.xy, texel.z - ch * dims.z);
    vec4 cell = texelFetch(cells, texel, 0);
    float d = diffusion_coefficient(cell);
    vec3 k[2];
    for (int side = 0; side < 2; side++) {
        for (int axis = 0; axis < 3; axis++) {
            bool border = c[axis] == (side == 0 ? 0 : dims[axis] - 1);
            bool goes_on = (lattice_repeat >> axis & 1u) != 0u;
            if (border && args.repeat[axis] == 0u) {
                k[side][axis] = args.dx * args.dx / (2.0 + args.dx / (2.0 * d));
            } else if (border && !goes_on) {
                k[side][axis] = 0.0; // as if mirrored there
            } else {
                ivec3 q = texel;
                q[axis] += (border ? 1 - dims[axis] : 1) * (2 * side - 1);
                float behind = diffusion_coefficient(texelFetch(cells, q, 0));
                k[side][axis] = args.dx * 2.0 * d * behind / (d + behind);
            }
        }
    }
    float absorption = cell.y * args.dx * args.dx * args.dx;
    if (walls == 1) {
        // No flow through cut faces. What the walls absorb: D de/dn = -(e / 2) (1 - albedo) / (1 + albedo),
        // in series with the half cell.
        uint id = uint((c.z * dims.y + c.y) * dims.x + c.x), cut = lattice_wall_links(id);
        for (int axis = 0; axis < 3; axis++) {
            k[0][axis] = (cut >> (2 * axis + 1) & 1u) != 0u ? 0.0 : k[0][axis];
            k[1][axis] = (cut >> (2 * axis) & 1u) != 0u ? 0.0 : k[1][axis];
        }
        vec4 surface = lattice_wall_surface(id);
        float area = 4.0 * surface.a * args.dx * args.dx, albedo = surface[ch];
        absorption += area * (1.0 - albedo) / (2.0 * (1.0 + albedo) + (1.0 - albedo) * args.dx / (2.0 * d));
        absorption += 1e-5 * args.dx * args.dx; // there is a solution also where nothing absorbs
    }
    lattice_stencil s = lattice_stencil(k[0], k[1], absorption, 0.0);
    uint i = uint(ch) * args.stride + uint((c.z * dims.y + c.y) * dims.x + c.x);
    stencil_lo[i] = lattice_stencil_lo(s);
    stencil_hi[i] = lattice_stencil_hi(s);
}
