// solids.c -- surfaces made by hand.
#include "solids.h"
#include "vector.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static void *grow(void *array, uint32_t count, size_t size)
{
    void *grown = realloc(array, count * size);
    if (!grown) {
        abort();
    }
    return grown;
}

uint32_t solids_material(tyn_scene *scene, const float albedo[3], const float emission[3])
{
    tyn_surfaces *s = &scene->surfaces;
    s->materials = grow(s->materials, s->num_materials + 1, sizeof *s->materials);
    tyn_surface_material *m = &s->materials[s->num_materials];
    *m = (tyn_surface_material){.texture = TYN_NO_TEXTURE};
    memcpy(m->albedo, albedo, sizeof m->albedo);
    memcpy(m->emission, emission, sizeof m->emission);
    return s->num_materials++;
}

void solids_quad(tyn_scene *scene, const float corner[3], const float u[3], const float v[3],
                 uint32_t material)
{
    tyn_surfaces *s = &scene->surfaces;
    const uint32_t first = s->num_vertices;
    s->vertices = grow(s->vertices, first + 4, sizeof *s->vertices);
    s->triangles = grow(s->triangles, s->num_triangles + 2, sizeof *s->triangles);
    float n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    const float length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int k = 0; k < 4; k++) {
        const float a = k == 1 || k == 2, b = k >= 2;
        tyn_surface_vertex *vertex = &s->vertices[first + (uint32_t)k];
        for (int c = 0; c < 3; c++) {
            vertex->position[c] = corner[c] + a * u[c] + b * v[c];
            vertex->normal[c] = n[c] / length;
        }
        vertex->u = a;
        vertex->v = b;
    }
    s->num_vertices += 4;
    s->triangles[s->num_triangles++] =
        (tyn_surface_triangle){{first, first + 1, first + 2}, material};
    s->triangles[s->num_triangles++] =
        (tyn_surface_triangle){{first, first + 2, first + 3}, material};
}

void solids_box(tyn_scene *scene, const float lo[3], const float hi[3], float angle, bool inwards,
                uint32_t material)
{
    const float cosine = cosf(angle), sine = sinf(angle);
    for (int face = 0; face < 6; face++) {
        const int a = face / 2, high = face % 2;
        // u x v is the face's outward axis: the next two axes for a high face, swapped for a low one.
        const int i = (a + (high ? 1 : 2)) % 3, j = (a + (high ? 2 : 1)) % 3;
        float axes[3][3] = {{0}}; // corner from the centre, u, v
        for (int c = 0; c < 3; c++) {
            axes[0][c] = (c == a && high ? 0.5f : -0.5f) * (hi[c] - lo[c]);
        }
        axes[inwards ? 2 : 1][i] = hi[i] - lo[i];
        axes[inwards ? 1 : 2][j] = hi[j] - lo[j];
        for (int k = 0; k < 3; k++) {
            const float x = axes[k][0], z = axes[k][2];
            axes[k][0] = cosine * x + sine * z;
            axes[k][2] = cosine * z - sine * x;
        }
        for (int c = 0; c < 3; c++) {
            axes[0][c] += 0.5f * (lo[c] + hi[c]);
        }
        solids_quad(scene, axes[0], axes[1], axes[2], material);
    }
}

void solids_sphere(tyn_scene *scene, const float centre[3], float radius, uint32_t rings,
                   bool inwards, uint32_t material)
{
    tyn_surfaces *s = &scene->surfaces;
    const uint32_t first = s->num_vertices, around = 2 * rings;
    s->vertices = grow(s->vertices, first + (rings + 1) * around, sizeof *s->vertices);
    s->triangles =
        grow(s->triangles, s->num_triangles + 2 * (rings - 1) * around, sizeof *s->triangles);
    for (uint32_t j = 0; j <= rings; j++) {
        for (uint32_t i = 0; i < around; i++) {
            const double theta = M_PI * j / rings, phi = 2 * M_PI * i / around;
            const bool pole = j == 0 || j == rings;
            const double n[3] = {pole ? 0 : sin(theta) * cos(phi), j == rings ? -1 : cos(theta),
                                 pole ? 0 : -sin(theta) * sin(phi)};
            tyn_surface_vertex *v = &s->vertices[first + j * around + i];
            *v = (tyn_surface_vertex){.u = (float)i / (float)around, .v = (float)j / (float)rings};
            for (int c = 0; c < 3; c++) {
                v->position[c] = (float)n[c]; // of the unit sphere, until the area is known
                v->normal[c] = (float)(inwards ? -n[c] : n[c]);
            }
        }
    }
    double area = 0;
    for (uint32_t j = 0; j < rings; j++) {
        for (uint32_t i = 0; i < around; i++) {
            const uint32_t a = first + j * around + i, b = first + j * around + (i + 1) % around,
                           c = b + around, d = a + around;
            const uint32_t corners[2][3] = {{a, d, c}, {a, c, b}};
            for (uint32_t k = j == rings - 1; k < (j == 0 ? 1u : 2u); k++) {
                const uint32_t *t = corners[k];
                tyn_surface_triangle *to = &s->triangles[s->num_triangles++];
                *to = (tyn_surface_triangle){{t[0], inwards ? t[2] : t[1], inwards ? t[1] : t[2]},
                                             material};
                double e[2][3], n[3];
                for (int x = 0; x < 6; x++) {
                    e[x / 3][x % 3] = (double)s->vertices[t[x / 3 + 1]].position[x % 3] -
                                      (double)s->vertices[t[0]].position[x % 3];
                }
                for (int x = 0; x < 3; x++) {
                    n[x] = e[0][(x + 1) % 3] * e[1][(x + 2) % 3] -
                           e[0][(x + 2) % 3] * e[1][(x + 1) % 3];
                }
                area += 0.5 * sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
            }
        }
    }
    const double scale = radius * sqrt(4 * M_PI / area);
    for (uint32_t i = first; i < first + (rings + 1) * around; i++) {
        for (int c = 0; c < 3; c++) {
            s->vertices[i].position[c] = (float)(centre[c] + scale * s->vertices[i].position[c]);
        }
    }
    s->num_vertices = first + (rings + 1) * around;
}

// ---- hierarchy --------------------------------------------------------------------------------

typedef struct sorted {
    float middle[3];
    tyn_surface_triangle triangle;
} sorted;

static int sort_axis;

static int compare_sorted(const void *a, const void *b)
{
    float x = ((const sorted *)a)->middle[sort_axis], y = ((const sorted *)b)->middle[sort_axis];
    return (x > y) - (x < y);
}

static void build_node(tyn_surfaces *s, sorted *items, uint32_t node, uint32_t first,
                       uint32_t count, uint32_t leaf)
{
    tyn_surface_node *n = &s->nodes[node];
    float lo[3], hi[3];
    for (int a = 0; a < 3; a++) {
        n->lo[a] = lo[a] = INFINITY;
        n->hi[a] = hi[a] = -INFINITY;
        for (uint32_t i = first; i < first + count; i++) {
            lo[a] = fminf(lo[a], items[i].middle[a]);
            hi[a] = fmaxf(hi[a], items[i].middle[a]);
            for (int k = 0; k < 3; k++) {
                float p = s->vertices[items[i].triangle.vertices[k]].position[a];
                n->lo[a] = fminf(n->lo[a], p);
                n->hi[a] = fmaxf(n->hi[a], p);
            }
        }
    }
    n->first = first;
    n->count = count;
    if (count <= leaf) {
        return;
    }
    sort_axis = 0;
    for (int a = 1; a < 3; a++) {
        sort_axis = hi[a] - lo[a] > hi[sort_axis] - lo[sort_axis] ? a : sort_axis;
    }
    qsort(items + first, count, sizeof *items, compare_sorted);
    uint32_t children = s->num_nodes;
    s->num_nodes += 2;
    n->first = children;
    n->count = 0;
    build_node(s, items, children, first, count / 2, leaf);
    build_node(s, items, children + 1, first + count / 2, count - count / 2, leaf);
}

void solids_hierarchy(tyn_scene *scene, uint32_t leaf)
{
    tyn_surfaces *s = &scene->surfaces;
    sorted *items = grow(NULL, s->num_triangles, sizeof *items);
    for (uint32_t i = 0; i < s->num_triangles; i++) {
        items[i].triangle = s->triangles[i];
        for (int a = 0; a < 3; a++) {
            items[i].middle[a] = 0;
            for (int k = 0; k < 3; k++) {
                items[i].middle[a] += s->vertices[s->triangles[i].vertices[k]].position[a] / 3;
            }
        }
    }
    s->nodes = grow(s->nodes, 2 * s->num_triangles, sizeof *s->nodes);
    s->num_nodes = 1;
    build_node(s, items, 0, 0, s->num_triangles, leaf);
    for (uint32_t i = 0; i < s->num_triangles; i++) {
        s->triangles[i] = items[i].triangle;
    }
    free(items);
}

solids_hit solids_ray(const tyn_surfaces *s, const double origin[3], const double direction[3])
{
    solids_hit best = {.triangle = -1, .distance = INFINITY};
    for (uint32_t i = 0; i < s->num_triangles; i++) {
        double e[2][3], from[3], n[3], q[3];
        const float *v[3];
        for (int k = 0; k < 3; k++) {
            v[k] = s->vertices[s->triangles[i].vertices[k]].position;
        }
        for (int c = 0; c < 3; c++) {
            e[0][c] = (double)v[1][c] - (double)v[0][c];
            e[1][c] = (double)v[2][c] - (double)v[0][c];
            from[c] = origin[c] - (double)v[0][c];
        }
        vector_cross(e[0], e[1], n);
        vector_cross(from, direction, q);
        const double det = -vector_dot(direction, n), distance = vector_dot(from, n) / det;
        const double b = vector_dot(e[1], q) / det, c = -vector_dot(e[0], q) / det;
        const double least = fmin(fmin(b, c), 1 - b - c);
        best.doubtful = best.doubtful || (distance > 0 && fabs(least) < 1e-4);
        if (least >= 0 && distance > 0 && distance < best.distance) {
            best.triangle = (int)i;
            best.distance = distance;
            memcpy(best.weights, (double[]){1 - b - c, b, c}, sizeof best.weights);
        }
    }
    return best;
}
