// surface_tables.c -- builds the tables by which triangles are drawn.
#include "frame/surface_tables.h"
#include "frame/alias_table.h"
#include "scene/matrix.h"
#include "shaders/surfaces/surface_table_args.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static double triangle_area(const tyn_surfaces *s, const tyn_surface_triangle *t)
{
    double e[2][3];
    for (int k = 0; k < 2; k++) {
        for (int a = 0; a < 3; a++) {
            e[k][a] = (double)s->vertices[t->vertices[k + 1]].position[a] -
                      (double)s->vertices[t->vertices[0]].position[a];
        }
    }
    double n[3];
    vec_cross(n, e[0], e[1]);
    return 0.5 * vec_length(n);
}

static double triangle_weight(const tyn_surfaces *s, uint32_t index, tyn_surface_table_kind kind)
{
    const tyn_surface_triangle *t = &s->triangles[index];
    const float *e = s->materials[t->material].emission;
    double weight = kind == TYN_SURFACE_AREAS ? 1 : fmax(e[0], fmax(e[1], e[2]));
    return weight > 0 ? weight * triangle_area(s, t) : 0;
}

// Box and power of the triangles in the table.
static void sum_up(struct surface_table *head, const tyn_surfaces *s,
                   const struct surface_cell *cells)
{
    double power[3] = {0}, lo[3] = {INFINITY, INFINITY, INFINITY}, hi[3], diagonal2 = 0;
    for (int a = 0; a < 3; a++) {
        hi[a] = -INFINITY;
    }
    for (uint32_t i = 0; i < head->count; i++) {
        const tyn_surface_triangle *t = &s->triangles[cells[i].triangle];
        const tyn_surface_material *m = &s->materials[t->material];
        double area = triangle_area(s, t);
        double sides = m->flags & TYN_SURFACE_EMITS_BOTH_SIDES ? 2 : 1;
        for (int a = 0; a < 3; a++) {
            power[a] += M_PI * sides * area * m->emission[a];
            for (int k = 0; k < 3; k++) {
                double p = s->vertices[t->vertices[k]].position[a];
                lo[a] = fmin(lo[a], p);
                hi[a] = fmax(hi[a], p);
            }
        }
    }
    for (int a = 0; a < 3; a++) {
        head->power[a] = (float)power[a];
        head->centre[a] = (float)(0.5 * (lo[a] + hi[a]));
        diagonal2 += (hi[a] - lo[a]) * (hi[a] - lo[a]);
    }
    head->radius = (float)(0.5 * sqrt(diagonal2));
}

bool tyn_surface_table_build(const tyn_surfaces *surfaces, tyn_surface_table_kind kind,
                             void **table, size_t *size)
{
    struct surface_table head = {.count = 0};
    *table = NULL;
    *size = 0;
    double total = 0;
    for (uint32_t i = 0; i < surfaces->num_triangles; i++) {
        double weight = triangle_weight(surfaces, i, kind);
        head.count += weight > 0;
        total += weight;
    }
    if (!head.count) {
        return true;
    }
    *size = sizeof head + head.count * sizeof(struct surface_cell);
    *table = malloc(*size);
    double *weights = malloc(head.count * sizeof *weights);
    bool ok = *table && weights;
    if (ok) {
        struct surface_cell *cells = (struct surface_cell *)((char *)*table + sizeof head);
        for (uint32_t i = 0, n = 0; i < surfaces->num_triangles; i++) {
            double weight = triangle_weight(surfaces, i, kind);
            if (weight > 0) {
                weights[n] = weight;
                cells[n++].triangle = i;
            }
        }
        ok = tyn_alias_build(weights, head.count, &cells->keep, sizeof *cells);
        for (uint32_t i = 0; ok && i < head.count; i++) {
            cells[i].alias = cells[cells[i].alias].triangle;
        }
        head.weight = (float)total;
        sum_up(&head, surfaces, cells);
        memcpy(*table, &head, sizeof head);
    }
    free(weights);
    if (!ok) {
        free(*table);
        *table = NULL;
    }
    return ok;
}
