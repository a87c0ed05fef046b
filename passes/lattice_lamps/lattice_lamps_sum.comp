// lattice_lamps_sum.comp -- the factor that makes the cells lose what the beams of local lights lose.
//
// One workgroup per group of lights and channel. What surfaces keep from the cells is left out after
// scaling. Sums have a fixed order: every thread its own terms, then pairwise.
#include "shaders/lattice/lattice_args.h"
#include "shaders/common/quotient.glsl"
#define MEDIUM_BLOCK 0
#define RADIALS_AT 1
#define RADIALS_STORAGE
#include "shaders/medium/medium.glsl"
#include "shaders/beams/radial.glsl"
#include "shaders/lattice/lattice.glsl"

layout(local_size_x = LATTICE_SUN_GROUP) in;
#define WORKGROUP_SIZE LATTICE_SUN_GROUP
#define WORKGROUP_SUM vec4
#include "shaders/common/workgroup.glsl"
TYN_ARGS(lattice_lamps_args args);
layout(binding = 5) uniform sampler3D cells;
layout(binding = 6) uniform sampler3D unshadowed;
TYN_READ(7, losses, vec4 losses[]); // of lattice_lamps_lost.comp
TYN_WRITE(8, power, lattice_lamp_power power[]);
#include "lattice_lamps.glsl"

float collided_in_cells(uint group, uint ch, float volume)
{
    float collided = 0.0;
    uint plane = args.dims.x * args.dims.y, count = plane * args.dims.z;
    for (uint i = gl_LocalInvocationIndex; i < count; i += LATTICE_SUN_GROUP) {
        ivec3 c = quotient_place(i, ivec3(args.dims));
        vec4 cell = texelFetch(cells, c + ivec3(0, 0, ch * args.dims.z), 0);
        float phi = texelFetch(unshadowed, c + ivec3(0, 0, (group * args.channels + ch) * args.dims.z), 0).x;
        collided += volume * (cell.x + cell.y) * phi;
    }
    return collided;
}

void main()
{
    uint group = gl_WorkGroupID.x, ch = gl_WorkGroupID.y, me = gl_LocalInvocationIndex;
    uvec2 range = lattice_lamps_of(group);
    vec4 sum = vec4(0.0); // entering, emitted, lost; collided
    for (uint n = range.x + me; n < range.y; n += LATTICE_SUN_GROUP) {
        sum += losses[n * args.channels + ch];
    }
    float dx = lattice_box_of(medium.extent, ivec3(args.dims)).dx;
    sum.w = collided_in_cells(group, ch, dx * dx * dx);
    sum = workgroup_total(sum);
    if (me == 0u) {
        // Close to 1 where the pieces of the cells resolve the light; large where it is lost within a
        // fraction of one, or where the depth of the cells is bounded.
        float scale = sum.w > 0.0 ? min(sum.z / sum.w, 1e6) : 1.0;
        power[group * args.channels + ch] = lattice_lamp_power(sum.x, sum.y, sum.z, scale);
    }
}
