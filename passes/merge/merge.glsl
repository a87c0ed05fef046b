// merge.glsl -- where merge keeps what each cell scatters towards the eye, and the way there.
//
// Include after lattice.glsl and merge_args.h, with the push constants args.
//
// The buffer "field" has planes of one float per cell: J of each channel, before the clamp at 0, then
// the largest sigma_s' of the channels.
#include "shaders/common/camera.glsl"

uint merge_index(ivec3 cell, uint plane)
{
    uvec3 c = uvec3(cell);
    return ((plane * args.dims.z + c.z) * args.dims.y + c.y) * args.dims.x + c.x;
}

// Direction from the middle of a cell to the eye.
vec3 merge_towards_eye(const camera_block camera, const lattice_box box, ivec3 cell)
{
    vec3 v = camera.origin - lattice_to_m(box, vec3(cell) + 0.5);
    return camera_select(camera, -camera.forward, v / max(length(v), 1e-20));
}

const float MERGE_REACH = 1.7; // edges of a cell: light of one that is farther outside the picture is not blended into it

// Weight of a cell in the picture: 1 over the square of its distance in edges; 0 where neither it nor a neighbour is seen.
float merge_weight(const camera_block camera, const lattice_box box, ivec3 cell)
{
    vec3 v = (lattice_to_m(box, vec3(cell) + 0.5) - camera.origin) / box.dx;
    vec2 slope = vec2(camera.half_width, camera.half_height); // of the picture's sides
    float depth = dot(v, camera.forward);
    vec2 most = slope * camera_select(camera, 1.0 / box.dx, max(depth, 0.0));
    vec2 reach = MERGE_REACH * sqrt(1.0 + slope * slope * camera_select(camera, 0.0, 1.0));
    vec2 at = vec2(dot(v, camera.right), dot(v, camera.up)) - camera.shift * most;
    bool seen = depth > -MERGE_REACH && all(lessThanEqual(abs(at), most + reach));
    return seen ? camera_select(camera, 1.0, 1.0 / max(dot(v, v), 1.0)) : 0.0;
}
