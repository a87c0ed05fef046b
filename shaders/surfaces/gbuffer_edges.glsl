// gbuffer_edges.glsl -- lists of pixels, and the workgroups that go through them. No bindings.
#ifndef TYN_GBUFFER_EDGES_GLSL
#define TYN_GBUFFER_EDGES_GLSL
#include "gbuffer_edge_args.h"

// Element of the list that this thread is for; it may lie beyond the list's end. Only a full row has another after it.
uint gbuffer_edge()
{
    return (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * GBUFFER_EDGES + gl_LocalInvocationIndex;
}

// Workgroups along x and y for a list whose last element is n, `row` of them along x at most.
uvec2 gbuffer_edge_groups(uint n, uint row)
{
    uint group = n / GBUFFER_EDGES;
    return uvec2(min(group + 1u, row), group / row + 1u);
}

#endif
