// residuum_step.comp -- one iteration: every cell takes a sixth of what each of its neighbours has.
#include "residuum_args.h"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
TYN_READ(0, state_other, vec4 in_state[]);
TYN_WRITE(1, state, vec4 out_state[]);
TYN_READ(2, kept, vec4 kept[]);
TYN_UPDATE(3, sum, vec4 sum[]);
TYN_ARGS(residuum_args args);

// Beyond the grid is vacuum: nothing comes in.
vec3 from(uint q, int step, bool there)
{
    return there ? in_state[q + uint(step)].rgb : vec3(0.0);
}

void main()
{
    ivec3 cell = ivec3(gl_GlobalInvocationID), dims = ivec3(args.dims), last = dims - 1;
    if (any(greaterThan(cell, last))) {
        return;
    }
    int row = dims.x, layer = dims.x * dims.y;
    uint q = uint(cell.z * layer + cell.y * row + cell.x);
    vec3 light = from(q, -1, cell.x > 0) + from(q, 1, cell.x < last.x) + from(q, -row, cell.y > 0) +
                 from(q, row, cell.y < last.y) + from(q, -layer, cell.z > 0) +
                 from(q, layer, cell.z < last.z);
    light *= kept[q].rgb / 6.0;
    sum[q] += vec4(light, 0.0);
    out_state[q] = vec4(light * kept[q].rgb, 0.0);
}
