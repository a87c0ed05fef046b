// lattice_recall_power.comp -- the power that light has in its first collisions, and that is emitted: the
// measure by which an earlier solution is scaled. The solution is linear in all lights together, so one
// that is dimmed or switched off leaves little behind.
//
// One workgroup per channel; the sum has a fixed order: every thread its own terms, then pairwise.
#include "shaders/lattice/lattice_args.h"
#include "shaders/lattice/lattice.glsl"
#define LATTICE_ENVIRONMENT 2
#include "shaders/lattice/lattice_unhindered.glsl"

layout(local_size_x = LATTICE_SUN_GROUP) in;
#define WORKGROUP_SIZE LATTICE_SUN_GROUP
#define WORKGROUP_SUM vec2
#include "shaders/common/workgroup.glsl"
TYN_ARGS(lattice_recall_args args);
layout(binding = 0) uniform sampler3D cells;
layout(binding = 1) uniform sampler3D source;
TYN_WRITE(3, power, float power[3]);

void main()
{
    uint ch = gl_WorkGroupID.x, me = gl_LocalInvocationIndex;
    uint plane = args.dims.x * args.dims.y, n = plane * args.dims.z;
    vec2 sum = vec2(0.0); // of the suns' light and emission; sigma_s' for the environment
    for (uint i = me; i < n; i += LATTICE_SUN_GROUP) {
        ivec3 c = ivec3(i % args.dims.x, i / args.dims.x % args.dims.y,
                        i / plane + ch * args.dims.z);
        vec4 cell = texelFetch(cells, c, 0); // sigma_s', sigma_a, g', emission
        float beams = lattice_fetch_source(source, cells, c).x;
        sum += vec2(cell.x * abs(beams) + LATTICE_4PI * cell.w, cell.x);
    }
    sum = workgroup_total(sum);
    if (me == 0) {
        float dx = lattice_box_of(args.extent, ivec3(args.dims)).dx;
        float fluence = lattice_unhindered(args.channels, ch, args.tint).x;
        // Of the environment no more collides than comes in through the box.
        vec3 e = args.extent;
        float entering = 0.5 * (e.x * e.y + e.y * e.z + e.z * e.x) * fluence;
        vec2 watts = dx * dx * dx * sum;
        power[ch] = watts.x + min(watts.y * fluence, entering);
    }
}
