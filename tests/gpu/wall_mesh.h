// wall_mesh.h -- closed meshes, and the pass walls on them, for tests.
#pragma once
#include "gpu_test.h"
#include "shaders/walls/walls_args.h"

typedef struct mesh {
    double (*tri)[3][3]; // world
    float (*albedo)[3];  // per triangle
    int n, capacity;
} mesh;

void mesh_add(mesh *m, const double a[3], const double b[3], const double c[3], float albedo);
void mesh_free(mesh *m);
// A box of half sizes h around `centre`, turned by `angle` about (1, 1, 0); albedo 0.5.
mesh mesh_box(const double centre[3], const double h[3], double angle);
// An octahedron split `depth` times, pushed out to a sphere; albedo 0.25.
mesh mesh_sphere(const double centre[3], double radius, int depth);

typedef struct grid {
    int n[3];
    double extent[3], dx;
} grid;
grid grid_of(int nx, int ny, int nz, double dx);

typedef struct wall_refs {
    tyn_ref links, cells, hits;
    tyn_ref surfaces, vertices, triangles; // what the pass was given
} wall_refs;
// Adds the pass. Every triangle has vertices of its own and a material of its own.
wall_refs mesh_walls(gpu_test *t, const grid *g, const mesh *m);
// The step d to the neighbour that link 0..25 of walls_args.h goes to.
void wall_step(int link, int d[3]);
// Cells that can be reached from cell `from` along links that are not cut; whether the outside can.
int mesh_flood(const grid *g, const uint32_t *links, int from, bool *outside);
