// gbuffer_edge_args.h -- a list of pixels or blocks, and the workgroups that go through it. Included by C and GLSL.
#ifndef TYN_GBUFFER_EDGE_ARGS_H
#define TYN_GBUFFER_EDGE_ARGS_H
#include "shaders/common/shared.h"

#define GBUFFER_EDGES 64 // elements of a workgroup
// Workgroups along x, at most; further ones follow along y: devices run 65535 along an axis.
#define GBUFFER_ROW 32768

// Of a list whose elements begin with x | y << 16, in any order: pixels whose samples see several triangles (gbuffer, shade), or
// what takes all smooth light itself (shade_alone.glsl).
struct gbuffer_edge_count {
    tyn_uvec3 groups; // workgroups of GBUFFER_EDGES threads, in rows; all start as zeros
    tyn_uint count;
};
TYN_ASSERT_SIZE(gbuffer_edge_count, 16);

#endif
