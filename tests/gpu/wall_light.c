// wall_light.c -- light of suns on the walls of a periodic lattice's cells: as much as they send.
#include "bound.h"
#include "gpu_test.h"
#include "homogeneous.h"
#include "passes/wall_light/wall_light.h"
#include "shaders/common/scene_args.h"
#include "shaders/surfaces/surface_args.h"
#include "wall_mesh.h"
#include <stdio.h>
#include <stdlib.h>

static const double pi = 3.14159265358979;

enum { CELLS = 24, N = CELLS * CELLS * CELLS };

// What pass walls says of a mesh, to be given to wall_light alone.
typedef struct wall_data {
    uint32_t *links, *hits;
    struct wall_cell *cells;
    size_t hit_bytes;
    const mesh *m;
} wall_data;

static wall_data walls_of(gpu_test *t, const grid *g, const mesh *m)
{
    tyn_graph_begin(t->graph);
    const wall_refs w = mesh_walls(t, g, m);
    tyn_graph_output(t->graph, "links", w.links, true);
    tyn_graph_output(t->graph, "cells", w.cells, true);
    tyn_graph_output(t->graph, "hits", w.hits, true);
    gpu_run(t);
    tyn_extent size;
    const void *hits = tyn_graph_map(t->graph, "hits", &size, NULL);
    wall_data d = {malloc(4 * N), malloc(size.x), malloc(N * sizeof *d.cells), size.x, m};
    memcpy(d.links, gpu_map(t, "links"), 4 * N);
    memcpy(d.cells, gpu_map(t, "cells"), N * sizeof *d.cells);
    memcpy(d.hits, hits, size.x);
    return d;
}

static void wall_data_free(wall_data *d)
{
    free(d->links);
    free(d->hits);
    free(d->cells);
}

// Connects all but the suns. The medium is a cube of 1 m; `absorption` of it.
static void connect(gpu_test *t, const wall_data *d, float absorption, tyn_ref *refs,
                    tyn_wall_light_params *params)
{
    const tyn_pass_desc *pass = &tyn_pass_wall_light;
    struct medium_block medium = {.extent = {1, 1, 1}, .size = {1, 1, 1}, .max_density = 1};
    struct surface_block surfaces = {.num_triangles = (uint32_t)d->m->n};
    struct surface_vertex *vertices = calloc((size_t)d->m->n * 3, sizeof *vertices);
    struct surface_triangle *triangles = calloc((size_t)d->m->n, sizeof *triangles);
    tyn_pass_defaults(pass, params);
    for (int a = 0; a < 3; a++) {
        params->extent[a] = 1;
        params->dims[a] = CELLS;
        medium.sigma_a[a] = absorption;
        surfaces.to_world[a][a] = surfaces.from_world[a][a] = 1;
        for (int i = 0; i < 3 * d->m->n; i++) {
            vertices[i].position[a] = (float)d->m->tri[i / 3][i % 3][a];
        }
    }
    for (uint32_t i = 0; i < (uint32_t)d->m->n; i++) {
        triangles[i] = (struct surface_triangle){3 * i, 3 * i + 1, 3 * i + 2, i};
    }
    tyn_graph_begin(t->graph);
    *gpu_port(pass, refs, "medium") = gpu_buffer(t, "medium", &medium, sizeof medium);
    *gpu_port(pass, refs, "surfaces") = gpu_buffer(t, "surfaces", &surfaces, sizeof surfaces);
    *gpu_port(pass, refs, "vertices") =
        gpu_buffer(t, "vertices", vertices, (size_t)d->m->n * 3 * sizeof *vertices);
    *gpu_port(pass, refs, "triangles") =
        gpu_buffer(t, "triangles", triangles, (size_t)d->m->n * sizeof *triangles);
    *gpu_port(pass, refs, "wall_links") = gpu_buffer(t, "links", d->links, 4 * N);
    *gpu_port(pass, refs, "wall_cells") = gpu_buffer(t, "cells", d->cells, N * sizeof *d->cells);
    *gpu_port(pass, refs, "hits") = gpu_buffer(t, "hits", d->hits, d->hit_bytes);
    free(vertices);
    free(triangles);
}

static const float (*run(gpu_test *t, const tyn_wall_light_params *params, tyn_ref *refs))[3]
{
    const tyn_pass_desc *pass = &tyn_pass_wall_light;
    assert_int_equal(tyn_graph_add(t->graph, pass, params, refs), TYN_OK);
    tyn_graph_output(t->graph, "wall_light", *gpu_port(pass, refs, "wall_light"), true);
    gpu_run(t);
    return (const float(*)[3])gpu_map(t, "wall_light");
}

// Power that arrives at all walls, in a channel: what they send out over their albedo.
static double arriving(const wall_data *d, const float (*light)[3], int channel)
{
    double sum = 0;
    for (int i = 0; i < N; i++) {
        const double area = 4 * (double)d->cells[i].area / (CELLS * CELLS);
        const double albedo = (double)d->cells[i].albedo[channel];
        sum += albedo > 0 ? pi * (double)light[i][channel] / albedo * area : 0;
    }
    return sum;
}

// A floor that is seen aslant and a tilted one, across all of the box, through an absorbing medium.
static void suns(void **state)
{
    gpu_test *t = *state;
    const double slopes[] = {0, 0.4};
    for (int k = 0; k < 2; k++) {
        const grid g = grid_of(CELLS, CELLS, CELLS, 1.0 / CELLS);
        const double lo = 0.41 - 0.5 * slopes[k], hi = 0.41 + 0.5 * slopes[k];
        mesh m = {0};
        mesh_add(&m, (double[]){-1, -1, lo - slopes[k]}, (double[]){2, -1, hi + slopes[k]},
                 (double[]){2, 2, hi + slopes[k]}, 0.5f);
        mesh_add(&m, (double[]){-1, -1, lo - slopes[k]}, (double[]){2, 2, hi + slopes[k]},
                 (double[]){-1, 2, lo - slopes[k]}, 0.5f);
        wall_data d = walls_of(t, &g, &m);
        const struct light_block lights[] = {
            {.color = {3, 2, 1}, .direction = {0, 0, -1}, .mean_cosine = 1},
            {.color = {1, 1, 4}, .direction = {0.6f, 0, -0.8f}, .mean_cosine = 1}};
        struct beam_block beams[TYN_BEAM_MAX_SUNS] = {{.light = 0}};
        const float extent[3] = {1, 1, 1}, one = 1;
        for (uint32_t n = 0; n < 2; n++) {
            homogeneous_beam(&beams[n], extent, lights[n].direction, n);
        }
        tyn_wall_light_params params;
        tyn_ref refs[TYN_MAX_PORTS] = {{0}};
        connect(t, &d, 1.5f, refs, &params);
        params.num_suns = 2;
        const tyn_pass_desc *pass = &tyn_pass_wall_light;
        *gpu_port(pass, refs, "lights") = gpu_buffer(t, "lights", lights, sizeof lights);
        *gpu_port(pass, refs, "beams") = gpu_buffer(t, "beams", beams, sizeof beams);
        *gpu_port(pass, refs, "column") =
            gpu_image(t, "column", TYN_IMAGE_3D, (tyn_extent){1, 1, 1}, 1, &one);
        const float(*light)[3] = run(t, &params, refs);
        // Irradiance times area is that of the beam times the floor's shadow, a square metre of x and y.
        double right[3] = {0};
        enum { SIDE = 200 };
        for (int i = 0; i < SIDE * SIDE; i++) {
            const double x = (i % SIDE + 0.5) / SIDE, y = (i / SIDE + 0.5) / SIDE;
            const double p[3] = {x, y, lo + slopes[k] * x};
            for (int n = 0; n < 2; n++) {
                const float *l = lights[n].direction;
                const double far[3] = {p[0] - 9 * (double)l[0], p[1] - 9 * (double)l[1],
                                       p[2] - 9 * (double)l[2]};
                const double left = exp(-1.5 * homogeneous_length(extent, p, far));
                for (int c = 0; c < 3; c++) {
                    right[c] += left * (slopes[k] * (double)l[0] - (double)l[2]) *
                                (double)lights[n].color[c] / (SIDE * SIDE);
                }
            }
        }
        for (int c = 0; c < 3; c++) {
            const double found = arriving(&d, light, c);
            print_message("slope %.1f: %.4f W arrive, should be %.4f\n", slopes[k], found,
                          right[c]);
            assert_true(within(fabs(found / right[c] - 1), k ? 0.01 : 1.5e-3, NULL,
                               "suns, slope %g", slopes[k]));
        }
        // Below the floor it is dark.
        for (int i = 0; i < N; i++) {
            const double x = (i % CELLS + 0.5) / CELLS, z = (i / CELLS / CELLS + 0.5) / CELLS;
            assert_true(z > lo + slopes[k] * x || light[i][0] == 0);
        }
        wall_data_free(&d);
        mesh_free(&m);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(suns)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
