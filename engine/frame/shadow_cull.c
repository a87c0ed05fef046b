// shadow_cull.c -- see shadow_cull.h.
//
// Branches of the hierarchy outside the frustum are left out, those inside it are taken whole. What is left are
// ranges of triangles; the smallest gaps between them are closed until they are few.
#include "frame/shadow_cull.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 32 }; // ranges on the way

typedef struct range {
    uint32_t first, end;
} range;

typedef struct range_list {
    uint32_t count;
    range list[MOST + 1]; // sorted, apart
} range_list;

static void close_smallest_gap(range_list *l)
{
    uint32_t best = 0;
    for (uint32_t i = 1; i + 1 < l->count; i++) {
        const uint32_t gap = l->list[i + 1].first - l->list[i].end;
        best = gap < l->list[best + 1].first - l->list[best].end ? i : best;
    }
    l->list[best].end = l->list[best + 1].end;
    l->count--;
    memmove(&l->list[best + 1], &l->list[best + 2], (l->count - best - 1) * sizeof(range));
}

static void add(range_list *l, range r)
{
    uint32_t from = l->count; // what starts behind it
    while (from > 0 && l->list[from - 1].end >= r.first) {
        from--;
    }
    uint32_t to = from; // ... and what it touches
    while (to < l->count && l->list[to].first <= r.end) {
        r.first = r.first < l->list[to].first ? r.first : l->list[to].first;
        r.end = r.end > l->list[to].end ? r.end : l->list[to].end;
        to++;
    }
    memmove(&l->list[from + 1], &l->list[to], (l->count - to) * sizeof(range));
    l->list[from] = r;
    l->count = l->count + 1 - (to - from);
    if (l->count > MOST) {
        close_smallest_gap(l);
    }
}

// The least and the largest value of dot(row, (p, 1)) in a box.
static void span_of(const double row[4], const tyn_surface_node *n, double *least, double *most)
{
    *least = *most = row[3];
    for (int a = 0; a < 3; a++) {
        const double lo = row[a] * (double)n->lo[a], hi = row[a] * (double)n->hi[a];
        *least += lo < hi ? lo : hi; // calls of fmin take most of the time
        *most += lo < hi ? hi : lo;
    }
}

struct surface_range *tyn_views_prepare(const tyn_surfaces *s)
{
    struct surface_range *below = s->num_nodes ? malloc(s->num_nodes * sizeof *below) : NULL;
    for (uint32_t i = s->num_nodes; below && i-- > 0;) { // children follow their parents
        const tyn_surface_node *n = &s->nodes[i];
        below[i] = (struct surface_range){n->first, n->count};
        if (n->count == 0) {
            const struct surface_range *a = &below[n->first], *b = a + 1;
            const uint32_t end_a = a->first + a->count, end_b = b->first + b->count;
            below[i].first = a->first < b->first ? a->first : b->first;
            below[i].count = (end_a > end_b ? end_a : end_b) - below[i].first;
        }
    }
    return below;
}

// -1: outside; 1: inside.
static int place_of(double planes[6][4], const tyn_surface_node *n)
{
    int place = 1;
    for (int i = 0; i < 6 && place >= 0; i++) {
        double least, most;
        span_of(planes[i], n, &least, &most);
        place = most < 0 ? -1 : least < 0 ? 0 : place;
    }
    return place;
}

void tyn_view_cull(const tyn_surfaces *s, const struct surface_range *below, const tyn_vec4 clip[4],
                   struct surface_range drawn[TYN_SURFACE_RANGES])
{
    memset(drawn, 0, TYN_SURFACE_RANGES * sizeof *drawn);
    if (!below) {
        drawn[0].count = s->num_triangles;
        return;
    }
    // Inside is where -w <= x <= w, likewise y, and 0 <= z <= w; a little more, for the rounding of shaders.
    double planes[6][4];
    for (int i = 0; i < 6; i++) {
        double sizes = 0;
        for (int c = 0; c < 4; c++) {
            const double row = (double)clip[i / 2][c], w = (double)clip[3][c];
            planes[i][c] = i == 5 ? row : i % 2 ? w + row : w - row;
            const double reach =
                c < 3 ? fmax(fabs((double)s->nodes[0].lo[c]), fabs((double)s->nodes[0].hi[c])) : 1;
            sizes += (fabs(row) + fabs(w)) * reach;
        }
        planes[i][3] += 1e-6 * sizes;
    }
    range_list found = {0};
    uint32_t stack[TYN_SURFACE_STACK], depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const uint32_t i = stack[--depth];
        const tyn_surface_node *n = &s->nodes[i];
        const int place = place_of(planes, n);
        if (place > 0 || (place == 0 && n->count)) {
            add(&found, (range){below[i].first, below[i].first + below[i].count});
        } else if (place == 0) {
            stack[depth++] = n->first + 1;
            stack[depth++] = n->first;
        }
    }
    while (found.count > TYN_SURFACE_RANGES) {
        close_smallest_gap(&found);
    }
    for (uint32_t i = 0; i < found.count; i++) {
        const range *r = &found.list[i];
        drawn[i] = (struct surface_range){r->first, r->end - r->first};
    }
}

void tyn_view_cull_seen(tyn_views_seen *seen, uint32_t view, const tyn_surfaces *s,
                        const struct surface_range *below, const tyn_vec4 clip[4],
                        struct surface_range drawn[TYN_SURFACE_RANGES])
{
    if (!seen || view >= TYN_VIEWS_SEEN) {
        tyn_view_cull(s, below, clip, drawn);
        return;
    }
    struct tyn_view_seen *v = &seen->views[view];
    if (!v->known || memcmp(v->clip, clip, sizeof v->clip) != 0) {
        memcpy(v->clip, clip, sizeof v->clip);
        tyn_view_cull(s, below, clip, v->drawn);
        v->known = true;
    }
    memcpy(drawn, v->drawn, sizeof v->drawn);
}
