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

// Adds an element to a list, and declares the variable n, its place. `counted`: the list's gbuffer_edge_count, in a buffer.
// The list's dispatch gets `threads` for every `many` elements. GBUFFER_EDGES is a multiple of `threads`.
#define GBUFFER_ADD(n, counted, threads, many, row)                                    \
    uint n = atomicAdd(counted.count, 1u);                                             \
    if (n * (threads) / (many) % GBUFFER_EDGES == 0u) { /* the first of a workgroup */ \
        uvec2 groups = gbuffer_edge_groups(n * (threads) / (many), row);               \
        atomicMax(counted.groups.x, groups.x);                                         \
        atomicMax(counted.groups.y, groups.y);                                         \
        atomicMax(counted.groups.z, 1u);                                               \
    }

#endif
