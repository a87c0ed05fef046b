// hierarchy.c -- a hierarchy of boxes over triangles, by Embree's builder (surface area heuristic).
#include <tyndall/io.h>
#include <embree3/rtcore.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/given.h"
#include <tyndall/extend/hash.h>

enum { LEAF_TRIANGLES = 4 };

// ---- what the builder calls -------------------------------------------------------------------

// Lives in the builder's memory, until its tree has been copied.
typedef struct tree_node {
    struct tree_node *children[2];
    struct RTCBounds boxes[2]; // of the children
    uint32_t count;            // triangles of a leaf; 0: inner
    uint32_t triangles[];
} tree_node;

static void *create_inner(RTCThreadLocalAllocator memory, unsigned children, void *user)
{
    (void)children, (void)user;
    tree_node *node = rtcThreadLocalAlloc(memory, sizeof *node, 16);
    memset(node, 0, sizeof *node);
    return node;
}

static void set_children(void *inner, void **children, unsigned count, void *user)
{
    (void)user;
    for (unsigned i = 0; i < count; i++) {
        ((tree_node *)inner)->children[i] = children[i];
    }
}

static void set_boxes(void *inner, const struct RTCBounds **boxes, unsigned count, void *user)
{
    (void)user;
    for (unsigned i = 0; i < count; i++) {
        ((tree_node *)inner)->boxes[i] = *boxes[i];
    }
}

static void *create_leaf(RTCThreadLocalAllocator memory, const struct RTCBuildPrimitive *primitives,
                         size_t count, void *user)
{
    (void)user;
    tree_node *leaf =
        rtcThreadLocalAlloc(memory, sizeof *leaf + count * sizeof leaf->triangles[0], 16);
    memset(leaf, 0, sizeof *leaf);
    leaf->count = (uint32_t)count;
    for (size_t i = 0; i < count; i++) {
        leaf->triangles[i] = primitives[i].primID;
    }
    return leaf;
}

// ---- the tree as an array ---------------------------------------------------------------------

typedef struct flattening {
    const tyn_surface_triangle *from;
    tyn_surface_triangle *triangles;
    tyn_surface_node *nodes;
    uint32_t num_triangles, num_nodes; // so far
} flattening;

static void set_box(tyn_surface_node *node, const struct RTCBounds *box)
{
    const float lo[3] = {box->lower_x, box->lower_y, box->lower_z};
    const float hi[3] = {box->upper_x, box->upper_y, box->upper_z};
    memcpy(node->lo, lo, sizeof lo);
    memcpy(node->hi, hi, sizeof hi);
}

// Depth first: what a ray visits in turn lies close together. The builder bounds the depth.
static void flatten(flattening *f, const tree_node *tree, uint32_t index)
{
    tyn_surface_node *node = &f->nodes[index];
    if (tree->count) {
        node->first = f->num_triangles;
        node->count = tree->count;
        for (uint32_t i = 0; i < tree->count; i++) {
            f->triangles[f->num_triangles++] = f->from[tree->triangles[i]];
        }
        return;
    }
    const uint32_t children = f->num_nodes;
    node->first = children;
    node->count = 0;
    f->num_nodes += 2;
    for (uint32_t i = 0; i < 2; i++) {
        set_box(&f->nodes[children + i], &tree->boxes[i]);
        flatten(f, tree->children[i], children + i);
    }
}

// ---- all --------------------------------------------------------------------------------------

// Boxes of the triangles; the box of all into `bounds`.
static void find_boxes(const tyn_surfaces *s, struct RTCBuildPrimitive *boxes,
                       struct RTCBounds *bounds)
{
    float all_lo[3] = {INFINITY, INFINITY, INFINITY}, all_hi[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t i = 0; i < s->num_triangles; i++) {
        float lo[3], hi[3];
        for (int a = 0; a < 3; a++) {
            const uint32_t *v = s->triangles[i].vertices;
            const float p = s->vertices[v[0]].position[a], q = s->vertices[v[1]].position[a],
                        r = s->vertices[v[2]].position[a];
            lo[a] = fminf(p, fminf(q, r));
            hi[a] = fmaxf(p, fmaxf(q, r));
            all_lo[a] = fminf(all_lo[a], lo[a]);
            all_hi[a] = fmaxf(all_hi[a], hi[a]);
        }
        boxes[i] = (struct RTCBuildPrimitive){lo[0], lo[1], lo[2], 0, hi[0], hi[1], hi[2], i};
    }
    *bounds =
        (struct RTCBounds){all_lo[0], all_lo[1], all_lo[2], 0, all_hi[0], all_hi[1], all_hi[2], 0};
}

static const tree_node *build_tree(RTCBVH bvh, struct RTCBuildPrimitive *boxes, uint32_t count)
{
    struct RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.maxBranchingFactor = 2;
    arguments.maxLeafSize = LEAF_TRIANGLES;
    arguments.bvh = bvh;
    arguments.primitives = boxes;
    arguments.primitiveCount = arguments.primitiveArrayCapacity = count;
    arguments.createNode = create_inner;
    arguments.setNodeChildren = set_children;
    arguments.setNodeBounds = set_boxes;
    arguments.createLeaf = create_leaf;
    return rtcBuildBVH(&arguments);
}

tyn_result tyn_surfaces_build_nodes(tyn_surfaces *surfaces, const tyn_log *log)
{
    if (!TYN_GIVEN(log, surfaces)) {
        return TYN_ERR_PARAMS;
    }
    if (surfaces->num_triangles) {
        const void *triangles = surfaces->triangles, *vertices = surfaces->vertices;
        if (!TYN_GIVEN(log, triangles, vertices)) {
            return TYN_ERR_PARAMS;
        }
    }
    tyn_surfaces *s = surfaces;
    const uint32_t count = s->num_triangles;
    if (!count) {
        return TYN_OK;
    }
    // One thread, so that the same triangles always give the same tree.
    RTCDevice device = rtcNewDevice("threads=1,set_affinity=0");
    RTCBVH bvh = device ? rtcNewBVH(device) : NULL;
    struct RTCBuildPrimitive *boxes = aligned_alloc(32, count * sizeof *boxes);
    flattening f = {.from = s->triangles,
                    .triangles = malloc(count * sizeof *f.triangles),
                    .nodes = calloc(2 * (size_t)count, sizeof *f.nodes),
                    .num_nodes = 1};
    const tree_node *root = NULL;
    if (bvh && boxes && f.triangles && f.nodes) {
        struct RTCBounds bounds;
        find_boxes(s, boxes, &bounds);
        set_box(&f.nodes[0], &bounds);
        root = build_tree(bvh, boxes, count);
    }
    if (root) {
        flatten(&f, root, 0);
        free(s->triangles);
        free(s->nodes);
        tyn_surface_node *fitted = realloc(f.nodes, f.num_nodes * sizeof *f.nodes);
        s->triangles = f.triangles;
        s->nodes = fitted ? fitted : f.nodes;
        s->num_nodes = f.num_nodes;
        s->hash = s->hash ? tyn_hash_string(s->hash, "nodes") : 0;
    } else {
        free(f.triangles);
        free(f.nodes);
        tyn_log_print(log, TYN_LOG_ERROR,
                      "no memory for a ray hierarchy of %u triangles (Embree's error %d)", count,
                      (int)rtcGetDeviceError(device));
    }
    free(boxes);
    if (bvh) {
        rtcReleaseBVH(bvh);
    }
    if (device) {
        rtcReleaseDevice(device);
    }
    return root ? TYN_OK : TYN_ERR_MEMORY;
}
