// propagate_rect_copy.comp -- the last state that was made, where the last iteration would have put it.
#include "../common/propagate.glsl"
#include "propagate_rect_args.h"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
TYN_READ(0, state_other, vec4 in_state[]);
TYN_WRITE(1, state, vec4 out_state[]);
TYN_ARGS(propagate_rect_args args);

void main()
{
    uint groups = propagate_groups(args.along, PROPAGATE_RECT_GROUP), stack = gl_WorkGroupID.z / groups;
    ivec3 cell = ivec3(gl_GlobalInvocationID.xy,
                       gl_GlobalInvocationID.z - stack * groups * PROPAGATE_RECT_GROUP);
    if (all(lessThan(uvec3(cell), uvec3(args.cells, args.cells, args.along)))) {
        uint q = propagate_index(cell, stack, args.cells, args.along);
        out_state[q] = in_state[q];
    }
}
