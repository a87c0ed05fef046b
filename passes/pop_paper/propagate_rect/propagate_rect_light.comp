// propagate_rect_light.comp -- what is still in a batch of grids, as tiles of an image.
#include "../common/propagate.glsl"
#include "propagate_rect_args.h"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
TYN_READ(0, cells, vec4 cells[]);
TYN_READ(1, state, vec4 state[]);
layout(set = 0, binding = 2, r32f) uniform writeonly image3D light_image;
TYN_READ(3, grids, propagate_grid grids[]);
layout(constant_id = 0) const uint stretched = 0u; // 1: cells need not be cubes
TYN_ARGS(propagate_rect_args args);

void main()
{
    uint groups = propagate_groups(args.along, PROPAGATE_RECT_GROUP);
    uint stack = gl_WorkGroupID.z / groups, tile = args.first * args.channels + stack;
    ivec3 cell = ivec3(gl_GlobalInvocationID.xy,
                       gl_GlobalInvocationID.z - stack * groups * PROPAGATE_RECT_GROUP);
    if (any(greaterThanEqual(uvec3(cell), uvec3(args.cells, args.cells, args.along)))) {
        return;
    }
    uint q = propagate_index(cell, stack, args.cells, args.along);
    propagate_cell here = propagate_cell_of(cells[q]);
    float kept = propagate_kept(here); // 0 where no light comes through: none is left there
    vec4 out_parts = here.mu >= -1.5 && kept > 0.0 ? state[q] / kept : vec4(0.0);
    if (stretched != 0u) {
        propagate_cell across = propagate_sideways(here, propagate_stretch(grids[args.first + stack / args.channels]));
        float kept_across = propagate_kept(across);
        out_parts.y = here.mu >= -1.5 && kept_across > 0.0 ? state[q].y / kept_across : 0.0;
    }
    ivec3 corner = ivec3(tile % args.tiles, tile / args.tiles, 0) * int(args.cells);
    imageStore(light_image, corner + cell, vec4(out_parts.x + 4.0 * out_parts.y + out_parts.z));
}
