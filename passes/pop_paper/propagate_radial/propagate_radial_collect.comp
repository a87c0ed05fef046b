// propagate_radial_collect.comp -- what a batch of grids sent to the eye, as tiles of an image. Beyond the first
// and the last cell of a direction theirs goes on, so that none is mixed with nothing.
#include "../common/propagate_radial.glsl"
#include "propagate_radial_args.h"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
TYN_READ(0, cells, vec4 cells[]);
TYN_READ(1, sum, float sum[]);
layout(set = 0, binding = 2, r32f) uniform writeonly image3D seen_image;
TYN_ARGS(propagate_radial_args args);

// The closest cell along a direction; in .y whether there is one.
vec2 along(ivec2 texel, int layer, uint stack)
{
    texel = octahedral_fold(texel, int(args.cells));
    for (int k = layer; k >= 0; k--) {
        uint q = propagate_radial_index(ivec3(texel, k), stack, args.cells, args.layers);
        if (cells[q].w >= -1.5) {
            return vec2(sum[q], 1.0);
        }
    }
    for (int k = layer + 1; k < int(args.layers); k++) {
        uint q = propagate_radial_index(ivec3(texel, k), stack, args.cells, args.layers);
        if (cells[q].w >= -1.5) {
            return vec2(sum[q], 1.0);
        }
    }
    return vec2(0.0);
}

void main()
{
    uint groups = propagate_groups(args.layers, PROPAGATE_RADIAL_GROUP);
    uint stack = gl_WorkGroupID.z / groups, tile = args.first * args.channels + stack;
    ivec3 at = ivec3(gl_GlobalInvocationID.xy,
                     gl_GlobalInvocationID.z - stack * groups * PROPAGATE_RADIAL_GROUP);
    int side = int(args.cells) + 2;
    if (at.x >= side || at.y >= side || at.z >= int(args.layers)) {
        return;
    }
    ivec2 texel = octahedral_fold(at.xy - 1, int(args.cells));
    vec2 found = along(texel, at.z, stack);
    if (found.y == 0.0) { // a direction without cells beside some that have
        found = along(texel + ivec2(1, 0), at.z, stack) + along(texel - ivec2(1, 0), at.z, stack) +
                along(texel + ivec2(0, 1), at.z, stack) + along(texel - ivec2(0, 1), at.z, stack);
    }
    ivec3 corner = ivec3(tile % args.tiles, tile / args.tiles, 0) * side;
    imageStore(seen_image, corner + at, vec4(found.x / max(found.y, 1.0)));
}
