// gbuffer_edge_args.h -- the list of pixels that show several pieces of surface. Included by C and GLSL.
#ifndef TYN_GBUFFER_EDGE_ARGS_H
#define TYN_GBUFFER_EDGE_ARGS_H
#include "shaders/common/shared.h"

#define GBUFFER_EDGES 64 // pixels of a workgroup that goes through the list of edges
// Workgroups along x, at most; further ones follow along y: devices run 65535 along an axis.
#define GBUFFER_ROW 32768

// Pixels that show several pieces of surface, or one beside nothing: buffers "edge_count" and "edges"; an element of
// the latter is x | y << 16. Their order does not matter.
struct gbuffer_edge_count {
    tyn_uvec3 groups; // workgroups of GBUFFER_EDGES pixels, in rows; all start as zeros
    tyn_uint count;
};
TYN_ASSERT_SIZE(gbuffer_edge_count, 16);

#endif
