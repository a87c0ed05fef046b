// solids.c -- surfaces made by hand.
#include "solids.h"
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
