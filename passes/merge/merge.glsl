// merge.glsl -- where merge keeps what each cell scatters towards the eye, and the way there.
//
// Include after lattice.glsl and merge_args.h, with the push constants args.
//
// The buffer "field" has planes of one float per cell: J of each channel, before the clamp at 0, then
// the largest sigma_s' of the channels.
#ifndef TYN_MERGE_GLSL
#define TYN_MERGE_GLSL
#include "shaders/common/camera.glsl"

uint merge_index(ivec3 cell, uint plane)
{
    uvec3 c = uvec3(cell);
    return ((plane * args.dims.z + c.z) * args.dims.y + c.y) * args.dims.x + c.x;
}

// Direction from the middle of a cell to the eye.
vec3 merge_towards_eye(camera_block camera, lattice_box box, ivec3 cell)
{
    vec3 v = camera.origin - lattice_to_m(box, vec3(cell) + 0.5);
    return camera_select(camera, -camera.forward, v / max(length(v), 1e-20));
}

#endif
