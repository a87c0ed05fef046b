// wall_mesh.c -- closed meshes, and the pass walls on them, for tests.
#include "wall_mesh.h"
#include "passes/walls/walls.h"
#include "shaders/surfaces/surface_args.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

void mesh_add(mesh *m, const double a[3], const double b[3], const double c[3], float albedo)
{
    if (m->n == m->capacity) {
        m->capacity = m->capacity ? 2 * m->capacity : 64;
        m->tri = realloc(m->tri, m->capacity * sizeof *m->tri);
        m->albedo = realloc(m->albedo, m->capacity * sizeof *m->albedo);
    }
    memcpy(m->tri[m->n][0], a, 3 * sizeof(double));
    memcpy(m->tri[m->n][1], b, 3 * sizeof(double));
    memcpy(m->tri[m->n][2], c, 3 * sizeof(double));
    for (int i = 0; i < 3; i++) {
        m->albedo[m->n][i] = albedo;
    }
    m->n++;
}

void mesh_free(mesh *m)
{
    free(m->tri);
    free(m->albedo);
    *m = (mesh){0};
}

// A box of half sizes h around `centre`, turned by `angle` about (1, 1, 0).
mesh mesh_box(const double centre[3], const double h[3], double angle)
{
    mesh m = {0};
    double k[3] = {sqrt(0.5), sqrt(0.5), 0}, v[8][3];
    for (int i = 0; i < 8; i++) {
        double p[3] = {i & 1 ? h[0] : -h[0], i & 2 ? h[1] : -h[1], i & 4 ? h[2] : -h[2]};
        double along = p[0] * k[0] + p[1] * k[1] + p[2] * k[2];
        double x[3] = {k[1] * p[2] - k[2] * p[1], k[2] * p[0] - k[0] * p[2],
                       k[0] * p[1] - k[1] * p[0]};
        for (int a = 0; a < 3; a++) {
            v[i][a] =
                centre[a] + p[a] * cos(angle) + x[a] * sin(angle) + k[a] * along * (1 - cos(angle));
        }
    }
    static const int faces[6][4] = {{0, 2, 6, 4}, {1, 5, 7, 3}, {0, 4, 5, 1},
                                    {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 6, 7, 5}};
    for (int f = 0; f < 6; f++) {
        // Both diagonals, and both orders of vertices, are met.
        mesh_add(&m, v[faces[f][0]], v[faces[f][1]], v[faces[f][2]], 0.5f);
        mesh_add(&m, v[faces[f][3]], v[faces[f][0]], v[faces[f][2]], 0.5f);
    }
    return m;
}

static void split(mesh *m, const double a[3], const double b[3], const double c[3], int depth,
                  const double centre[3], double radius)
{
    if (depth == 0) {
        double p[3][3];
        const double *from[3] = {a, b, c};
        for (int i = 0; i < 3; i++) {
            double r =
                sqrt(from[i][0] * from[i][0] + from[i][1] * from[i][1] + from[i][2] * from[i][2]);
            for (int k = 0; k < 3; k++) {
                p[i][k] = centre[k] + radius * from[i][k] / r;
            }
        }
        mesh_add(m, p[0], p[1], p[2], 0.25f);
        return;
    }
    double ab[3], bc[3], ca[3];
    for (int k = 0; k < 3; k++) {
        ab[k] = (a[k] + b[k]) / 2, bc[k] = (b[k] + c[k]) / 2, ca[k] = (c[k] + a[k]) / 2;
    }
    split(m, a, ab, ca, depth - 1, centre, radius);
    split(m, ab, b, bc, depth - 1, centre, radius);
    split(m, ca, bc, c, depth - 1, centre, radius);
    split(m, ab, bc, ca, depth - 1, centre, radius);
}

mesh mesh_sphere(const double centre[3], double radius, int depth)
{
    mesh m = {0};
    for (int i = 0; i < 8; i++) {
        double x[3] = {i & 1 ? 1 : -1, 0, 0}, y[3] = {0, i & 2 ? 1 : -1, 0},
               z[3] = {0, 0, i & 4 ? 1 : -1};
        split(&m, x, y, z, depth, centre, radius);
    }
    return m;
}

grid grid_of(int nx, int ny, int nz, double dx)
{
    return (grid){{nx, ny, nz}, {nx * dx, ny * dx, nz * dx}, dx};
}

// Every triangle has vertices of its own and a material of its own.
wall_refs mesh_walls(gpu_test *t, const grid *g, const mesh *m)
{
    struct surface_block block = {.num_triangles = (uint32_t)m->n};
    for (int a = 0; a < 3; a++) {
        block.to_world[a][a] = block.from_world[a][a] = 1;
    }
    struct surface_vertex *v = calloc((size_t)m->n * 3, sizeof *v);
    struct surface_triangle *tri = calloc((size_t)m->n, sizeof *tri);
    struct surface_material *mat = calloc((size_t)m->n, sizeof *mat);
    for (int i = 0; i < m->n; i++) {
        for (int k = 0; k < 3; k++) {
            for (int a = 0; a < 3; a++) {
                v[3 * i + k].position[a] = (float)m->tri[i][k][a];
            }
        }
        uint32_t u = (uint32_t)i;
        tri[i] = (struct surface_triangle){3 * u, 3 * u + 1, 3 * u + 2, u};
        memcpy(mat[i].albedo, m->albedo[i], sizeof mat[i].albedo);
        mat[i].texture = TYN_SURFACE_NO_TEXTURE;
    }
    tyn_walls_params params;
    tyn_pass_defaults(&tyn_pass_walls, &params);
    for (int a = 0; a < 3; a++) {
        params.extent[a] = (float)g->extent[a];
        params.dims[a] = (uint32_t)g->n[a];
    }
    tyn_ref p[WALLS_NUM_PORTS] = {
        [WALLS_PORT_SURFACES] = gpu_buffer(t, "surfaces", &block, sizeof block),
        [WALLS_PORT_VERTICES] = gpu_buffer(t, "vertices", v, (size_t)m->n * 3 * sizeof *v),
        [WALLS_PORT_TRIANGLES] = gpu_buffer(t, "triangles", tri, (size_t)m->n * sizeof *tri),
        [WALLS_PORT_MATERIALS] = gpu_buffer(t, "materials", mat, (size_t)m->n * sizeof *mat),
    };
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_walls, &params, p), TYN_OK);
    free(v);
    free(tri);
    free(mat);
    return (wall_refs){p[WALLS_PORT_WALL_LINKS], p[WALLS_PORT_WALL_CELLS], p[WALLS_PORT_HITS],
                       p[WALLS_PORT_SURFACES],   p[WALLS_PORT_VERTICES],   p[WALLS_PORT_TRIANGLES]};
}

void wall_step(int link, int d[3])
{
    d[0] = d[1] = d[2] = 0;
    if (link < 6) {
        d[link / 2] = link % 2 ? -1 : 1;
    } else if (link < 14) {
        for (int a = 0; a < 3; a++) {
            d[a] = (link - 6) >> a & 1 ? -1 : 1;
        }
    } else {
        int zero = (link - 14) / 4, s = (link - 14) % 4, u = zero == 0 ? 1 : 0,
            v = zero == 2 ? 1 : 2;
        d[u] = s & 1 ? -1 : 1;
        d[v] = s & 2 ? -1 : 1;
    }
}

int mesh_flood(const grid *g, const uint32_t *links, int from, bool *outside)
{
    int total = g->n[0] * g->n[1] * g->n[2], found = 0, head = 0;
    bool *seen = calloc(total, 1);
    int *queue = malloc(total * sizeof *queue);
    *outside = false;
    queue[found++] = from;
    seen[from] = true;
    while (head < found) {
        int i = queue[head++], c[3] = {i % g->n[0], i / g->n[0] % g->n[1], i / g->n[0] / g->n[1]};
        for (int link = 0; link < TYN_WALLS_LINKS; link++) {
            int e[3];
            wall_step(link, e);
            if (links[i] >> link & 1) {
                continue;
            }
            bool inside = true;
            for (int a = 0; a < 3; a++) {
                inside = inside && c[a] + e[a] >= 0 && c[a] + e[a] < g->n[a];
            }
            *outside = *outside || !inside;
            int q = i + (e[2] * g->n[1] + e[1]) * g->n[0] + e[0];
            if (inside && !seen[q]) {
                seen[q] = true;
                queue[found++] = q;
            }
        }
    }
    free(seen);
    free(queue);
    return found;
}
