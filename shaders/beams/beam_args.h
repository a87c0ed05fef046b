// beam_args.h -- the aligned grid of a directional light. Included by C and GLSL; scalar layout.
//
// Slices of the grid are planes of the medium's box across its `axis`, the first and the last slice
// being faces of the box; columns run along the light. So the grid is rectilinear in the coordinates
// (u, v, w) = (where the ray meets the first slice, slice). All suns lie above each other along z in
// one texture. Computed by tyn_beam_plan.
#ifndef TYN_BEAM_ARGS_H
#define TYN_BEAM_ARGS_H
#include "shaders/common/shared.h"

#define TYN_BEAM_MAX_SUNS 4

struct beam_block {      // element of storage buffer "beams", one per sun
    tyn_vec4 rows[3];    // M -> texture coordinate: dot(rows[i].xyz, p) + rows[i].w
    tyn_vec4 depth_row;  // M -> distance from slice 0 along the light, m, likewise
    tyn_vec3 clip_scale; // distance to p from where its ray enters the box, m:
    tyn_uint light;      //   least component of p clip_scale + clip_offset
    tyn_vec3 clip_offset;
    tyn_uint first_slice; // z of slice 0 in the texture
    tyn_uint even;        // 1: the mean is the same everywhere: homogeneous, or a box without sides
    tyn_uint edges; // 1: there is something beside the box, at its other faces; set by the sweep
    float z_rate;   // texture z per m along the light
    tyn_vec2 period_first; // texture u, v of the first node of a periodic axis
    tyn_vec2 period;       // its period in texture u, v; 0 = not periodic
    tyn_uvec3 nodes;       // columns along u and v, slices
    tyn_uint axis;         // of M across which the slices are
    tyn_vec3 origin;       // M position of node (0, 0, 0), m
    tyn_vec3 step_u;       // between columns, m
    tyn_vec3 step_v;
    tyn_vec3 step_w;    // from slice to slice along the light, m
    tyn_vec3 direction; // of travel, unit
    tyn_uint samples;   // of the medium between two slices
};
TYN_ASSERT_SIZE(beam_block, 204);

#endif
