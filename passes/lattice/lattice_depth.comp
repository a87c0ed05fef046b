// lattice_depth.comp -- leaves out the launches of further cycles of the diffusion correction where the medium is thin.
//
// There light goes from wall to wall, which corrections do little about: a second cycle brings nothing.
#include "shaders/lattice/lattice_args.h"
#include "shaders/common/quotient.glsl"

layout(local_size_x = LATTICE_DEPTH_GROUP) in; // one workgroup
#define WORKGROUP_SIZE LATTICE_DEPTH_GROUP
#define WORKGROUP_SUM float
#include "shaders/common/workgroup.glsl"
TYN_ARGS(lattice_args args);
layout(binding = 0) uniform sampler3D cells;
TYN_UPDATE(1, launches, uint launches[3 * LATTICE_MAX_LAUNCHES]); // workgroups, as indirect dispatches read them


const float THICK = 5.0; // mean sigma_s' times the longest side

void main()
{
    uint me = gl_LocalInvocationIndex;
    ivec3 size = ivec3(args.dims.xy, args.dims.z * args.channels);
    uint count = size.x * size.y * size.z;
    float sum = 0.0;
    for (uint i = me; i < count; i += LATTICE_DEPTH_GROUP) {
        sum += texelFetch(cells, quotient_place(i, size), 0).x;
    }
    sum = workgroup_total(sum);
    float longest = args.dx * float(max(args.dims.x, max(args.dims.y, args.dims.z)));
    if (me < LATTICE_MAX_LAUNCHES && sum / float(count) * longest <= THICK) {
        launches[3 * me] = 0u;
    }
}
