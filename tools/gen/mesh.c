// mesh.c -- meshes of a sample scene: vertices and triangles, and where they are placed.
#include "mesh.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void fail(const char *what)
{
    fprintf(stderr, "too many %s in a scene, or out of memory\n", what);
    exit(1);
}

gen_mesh *gen_mesh_new(gen_model *model, const char *name, uint32_t material)
{
    if (model->num_meshes == GEN_MAX_MESHES) {
        fail("meshes");
    }
    gen_mesh *mesh = &model->meshes[model->num_meshes++];
    *mesh = (gen_mesh){.name = name, .material = material};
    return mesh;
}

void gen_place(gen_model *model, float x, float y, float z, float turn, float scale)
{
    if (model->num_parts == GEN_MAX_PARTS) {
        fail("parts");
    }
    model->parts[model->num_parts++] = (gen_part){model->num_meshes - 1, {x, y, z}, turn, scale};
}

void gen_place_here(gen_model *model)
{
    gen_place(model, 0, 0, 0, 0, 1);
}

void gen_add_lamp(gen_model *model, const gen_lamp *lamp)
{
    if (model->num_lamps == GEN_MAX_LAMPS) {
        fail("lamps");
    }
    model->lamps[model->num_lamps++] = *lamp;
}

void gen_model_free(gen_model *model)
{
    for (uint32_t i = 0; i < model->num_meshes; i++) {
        free(model->meshes[i].vertices);
        free(model->meshes[i].indices);
    }
    *model = (gen_model){0};
}

// Room for `more` elements in an array that grows by doubling.
static void *reserve(void *array, uint32_t count, uint32_t more, size_t size)
{
    uint32_t room = 64, used = 64;
    while (used < count) {
        used *= 2;
    }
    while (room < count + more) {
        room *= 2;
    }
    if (array && room == used) {
        return array;
    }
    void *grown = realloc(array, room * size);
    if (!grown) {
        fail("vertices");
    }
    return grown;
}

uint32_t gen_add_vertex(gen_mesh *mesh, const float position[3], const float normal[3],
                        const float uv[2])
{
    mesh->vertices = reserve(mesh->vertices, mesh->num_vertices, 1, sizeof(gen_vertex));
    gen_vertex *v = &mesh->vertices[mesh->num_vertices];
    memcpy(v->position, position, sizeof(v->position));
    memcpy(v->normal, normal, sizeof(v->normal));
    memcpy(v->uv, uv, sizeof(v->uv));
    return mesh->num_vertices++;
}

static bool same_place(const gen_mesh *mesh, uint32_t a, uint32_t b)
{
    const float *p = mesh->vertices[a].position, *q = mesh->vertices[b].position;
    return p[0] == q[0] && p[1] == q[1] && p[2] == q[2];
}

void gen_add_triangle(gen_mesh *mesh, uint32_t a, uint32_t b, uint32_t c)
{
    if (same_place(mesh, a, b) || same_place(mesh, b, c) || same_place(mesh, c, a)) {
        return;
    }
    mesh->indices = reserve(mesh->indices, mesh->num_indices, 3, sizeof(uint32_t));
    mesh->indices[mesh->num_indices++] = a;
    mesh->indices[mesh->num_indices++] = b;
    mesh->indices[mesh->num_indices++] = c;
}

// Twice the area of a triangle, along its front's normal.
static void area_of(const float a[3], const float b[3], const float c[3], float out[3])
{
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        out[k] = (b[i] - a[i]) * (c[j] - a[j]) - (b[j] - a[j]) * (c[i] - a[i]);
    }
}

static void normalize(float v[3])
{
    const float length = sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int k = 0; k < 3; k++) {
        v[k] /= length;
    }
}

static void flat_uv(const float p[3], const float normal[3], float tile, float uv[2])
{
    const float x = fabsf(normal[0]), y = fabsf(normal[1]), z = fabsf(normal[2]);
    const int axis = y >= x && y >= z ? 1 : x >= z ? 0 : 2;
    uv[0] = (axis == 0 ? p[2] : p[0]) / tile;
    // Rows of a texture run downwards.
    uv[1] = (axis == 1 ? p[2] : -p[1]) / tile;
}

static uint32_t add_flat(gen_mesh *mesh, const float p[3], const float normal[3], float tile)
{
    float uv[2];
    flat_uv(p, normal, tile, uv);
    return gen_add_vertex(mesh, p, normal, uv);
}

void gen_add_quad(gen_mesh *mesh, const float a[3], const float b[3], const float c[3],
                  const float d[3], float tile)
{
    float normal[3], rest[3];
    area_of(a, b, c, normal);
    area_of(a, c, d, rest);
    for (int k = 0; k < 3; k++) {
        normal[k] += rest[k];
    }
    normalize(normal);
    const uint32_t first = add_flat(mesh, a, normal, tile);
    add_flat(mesh, b, normal, tile);
    add_flat(mesh, c, normal, tile);
    add_flat(mesh, d, normal, tile);
    gen_add_triangle(mesh, first, first + 1, first + 2);
    gen_add_triangle(mesh, first, first + 2, first + 3);
}

void gen_smooth(gen_mesh *mesh)
{
    float(*sum)[3] = calloc(mesh->num_vertices, sizeof(*sum));
    if (!sum) {
        fail("vertices");
    }
    for (uint32_t i = 0; i < mesh->num_indices; i += 3) {
        const uint32_t *corner = mesh->indices + i;
        const gen_vertex *v = mesh->vertices;
        float area[3];
        area_of(v[corner[0]].position, v[corner[1]].position, v[corner[2]].position, area);
        for (int c = 0; c < 3; c++) {
            for (int k = 0; k < 3; k++) {
                sum[corner[c]][k] += area[k];
            }
        }
    }
    for (uint32_t i = 0; i < mesh->num_vertices; i++) {
        float *normal = mesh->vertices[i].normal;
        memset(normal, 0, 3 * sizeof(float));
        for (uint32_t j = 0; j < mesh->num_vertices; j++) {
            for (int k = 0; k < 3 && same_place(mesh, i, j); k++) {
                normal[k] += sum[j][k];
            }
        }
        normalize(normal);
    }
    free(sum);
}
