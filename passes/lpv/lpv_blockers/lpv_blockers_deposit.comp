// lpv_blockers_deposit.comp -- a thread a texel of the maps along the axes: the surface in it blocks.
//
// A surface is in up to three maps. It counts in that of the main direction of its normal, which sees all of its area best.
#include "lpv_blockers_args.h"
#include "shaders/lattice/lattice.glsl"
#include "../common/deposit.glsl"
#include "shaders/random/rng.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
TYN_ARGS(lpv_blockers_args args);
layout(binding = 0) uniform sampler2D rsm_position_tex;
layout(binding = 1) uniform sampler2D rsm_normal_tex;
TYN_UPDATE(2, potential, int potential[]);

void main()
{
    ivec2 texel = ivec2(gl_GlobalInvocationID);
    if (any(greaterThanEqual(texel, textureSize(rsm_position_tex, 0)))) {
        return;
    }
    vec4 p = texelFetch(rsm_position_tex, texel, 0);
    vec3 n = texelFetch(rsm_normal_tex, texel, 0).xyz, a = abs(n);
    if (a == vec3(0.0) || any(isnan(n))) {
        return; // nothing is there
    }
    uint main = a.x >= a.y && a.x >= a.z ? 0u : a.y >= a.z ? 1u : 2u;
    uint map = uint(texel.x) / args.texels; // the axis
    lattice_box box = lattice_box_of(args.extent, ivec3(args.dims));
    ivec3 dims = box.dims + 1, c = ivec3(floor(lattice_from_m(box, p.xyz) + 0.5));
    if (map != main || any(lessThan(c, ivec3(0))) || any(greaterThanEqual(c, dims))) {
        return;
    }
    // max(0, n.O) is n.O / 2 + 1/4 in two bands.
    bool up = uint(texel.y) < args.texels; // this row of maps looks along the axes, the other one against them
    n = (n[main] > 0.0) == up ? -n : n;
    vec4 lobe = args.area[main] / (a[main] * box.dx * box.dx) * vec4(0.25, 0.5 * n) * LPV_BLOCKERS_UNIT;
    uint at = 4u * uint((c.z * dims.y + c.y) * dims.x + c.x);
    DEPOSIT_ADD(potential, at, lobe, rng_float(rng_pcg4d(uvec4(texel, 0u, 0u)).x))
}
