// propagate_run.c -- see propagate_run.h.
#include "propagate_run.h"
#include "numbers.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PORT(name) PROPAGATE_RECT_PORT_##name

double sent(const outcome *o, int q)
{
    const float *c = o->state[q].c;
    return (double)c[0] + 4.0 * (double)c[1] + (double)c[2];
}

double light_of(const outcome *o, int q, double stretch)
{
    const float *c = o->state[q].c;
    const double depth = 0.5 * o->cells[q].c[1];
    return ((double)c[0] + (double)c[2]) * exp(depth) + 4.0 * (double)c[1] * exp(stretch * depth);
}

double kept_cosine(const outcome *o, int q, bool exact)
{
    double depth = o->cells[q].c[0], g = o->cells[q].c[2];
    return depth <= 0 ? 1 : exact || g < 0 ? exp(-0.5 * (1 - g) * depth) : pow(g, 0.5 * depth);
}

void set_medium(setup *s, const float extent[3], const uint32_t size[3], const float *density)
{
    s->density = density;
    for (int i = 0; i < 3; i++) {
        s->medium.extent[i] = extent[i];
        s->medium.size[i] = size[i];
        s->medium.voxel[i] = extent[i] / (float)size[i];
    }
}

setup unit_cube(const float *density, float sigma_s, float g, const float to_eye[3])
{
    setup s = {.suns[0] = {.color = {1, 1, 1}, .direction = {0, 0, 1}}};
    set_medium(&s, (float[]){1, 1, 1}, (uint32_t[]){STATE_CELLS, STATE_CELLS, STATE_CELLS},
               density);
    tyn_pass_defaults(&tyn_pass_propagate_rect, &s.params);
    s.params.cells = STATE_CELLS;
    s.params.iterations = STATE_CELLS;
    s.num_suns = s.params.channels = 1;
    for (int i = 0; i < 3; i++) {
        s.params.extent[i] = s.medium.extent[i];
        s.params.size[i] = s.medium.size[i];
    }
    s.camera.orthographic = 1;
    for (int i = 0; i < 3; i++) {
        s.medium.sigma_s[i] = sigma_s;
        s.medium.phase[i].g = g;
        s.camera.forward[i] = -to_eye[i];
    }
    return s;
}

// A plate at y = 0.7 that ends at x = 0.5 and is wide otherwise; M is the world.
static const struct surface_block plate = {
    .to_world = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}},
    .from_world = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}},
    .lo = {-5, 0.7f, -5},
    .num_triangles = 2,
    .hi = {0.5f, 0.7f, 5},
    .num_nodes = 1,
};
static const tyn_surface_node plate_leaf = {
    .lo = {-5, 0.7f, -5}, .hi = {0.5f, 0.7f, 5}, .count = 2};
static const struct surface_vertex plate_corners[] = {
    {.position = {-5, 0.7f, -5}},
    {.position = {0.5f, 0.7f, -5}},
    {.position = {0.5f, 0.7f, 5}},
    {.position = {-5, 0.7f, 5}},
};
static const struct surface_triangle plate_triangles[] = {{0, 1, 2, 0}, {0, 2, 3, 0}};

outcome propagate_run(gpu_test *t, const setup *s)
{
    const uint32_t *size = s->medium.size;
    struct ordinates_block list = {.count = s->num_suns + s->ordinates.count};
    for (uint32_t i = 0; i < list.count; i++) {
        struct ordinate *o = &list.list[i];
        if (i < s->num_suns) {
            memcpy(o->irradiance, s->suns[i].color, sizeof o->irradiance);
            memcpy(o->direction, s->suns[i].direction, sizeof o->direction);
            o->mean_cosine = 1;
        } else {
            *o = s->ordinates.list[i - s->num_suns];
        }
    }
    tyn_propagate_rect_params params = s->params;
    params.num_ordinates += s->num_suns;
    tyn_ref refs[PROPAGATE_RECT_NUM_PORTS] = {0};
    tyn_graph_begin(t->graph);
    refs[PORT(MEDIUM)] = gpu_buffer(t, "medium", &s->medium, sizeof s->medium);
    refs[PORT(ORDINATES)] = gpu_buffer(t, "ordinates", &list, sizeof list);
    refs[PORT(CAMERA)] = gpu_buffer(t, "camera", &s->camera, sizeof s->camera);
    tyn_extent texels = {size[0], size[1], size[2]};
    int channels = s->params.mode == TYN_MEDIUM_COEFFICIENTS ? 4 : 1;
    refs[PORT(DENSITY)] = gpu_image(t, "density", TYN_IMAGE_3D, texels, channels, s->density);
    if (s->sigma_a) {
        refs[PORT(SIGMA_A)] = gpu_image(t, "sigma_a", TYN_IMAGE_3D, texels, 4, s->sigma_a);
        refs[PORT(G)] = gpu_image(t, "g", TYN_IMAGE_3D, texels, 4, s->g);
    }
    static struct shadow_light maps[TYN_SHADOW_MAX];
    maps[0] = s->map;
    if (s->atlas) {
        refs[PORT(SHADOW_ATLAS)] =
            gpu_image(t, "shadow_atlas", TYN_IMAGE_2D, (tyn_extent){ATLAS, ATLAS, 1}, 1, s->atlas);
        refs[PORT(SHADOWS)] = gpu_buffer(t, "shadows", maps, sizeof maps);
    }
    if (params.num_triangles) {
        refs[PORT(SURFACES)] = gpu_buffer(t, "surfaces", &plate, sizeof plate);
        refs[PORT(VERTICES)] = gpu_buffer(t, "vertices", plate_corners, sizeof plate_corners);
        refs[PORT(TRIANGLES)] = gpu_buffer(t, "triangles", plate_triangles, sizeof plate_triangles);
        refs[PORT(NODES)] = gpu_buffer(t, "nodes", &plate_leaf, sizeof plate_leaf);
    }
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_propagate_rect, &params, refs), TYN_OK);
    static const int ports[] = {PORT(GRIDS), PORT(CELLS), PORT(STATE),
                                PORT(SUM),   PORT(LIT),   PORT(PLACES)};
    for (size_t i = 0; i < sizeof ports / sizeof *ports; i++) {
        tyn_graph_output(t->graph, tyn_pass_propagate_rect.ports[ports[i]].name, refs[ports[i]],
                         true);
    }
    tyn_graph_output(t->graph, "seen", refs[PORT(SEEN)], true);
    if (params.threshold > 0) { // else no light in flight is summed
        tyn_graph_output(t->graph, "flight", refs[PORT(FLIGHT)], true);
    }
    if (params.keep_light) {
        tyn_graph_output(t->graph, "light", refs[PORT(LIGHT)], true);
    }
    gpu_run(t);
    return (outcome){gpu_map(t, "state"), gpu_map(t, "cells"), gpu_map(t, "sum"),
                     gpu_map(t, "grids"), gpu_map(t, "lit"),   gpu_map(t, "places")};
}

double total(const outcome *o, int first, int n)
{
    double sum = 0;
    for (int q = first; q < first + n; q++) {
        sum += sent(o, q);
    }
    return sum;
}

double worst(const double *found, const double *expected, int n, const double *weight)
{
    double top = 0, result = 0;
    for (int i = 0; i < n; i++) {
        top = fmax(top, weight[i]);
    }
    for (int i = 0; i < n; i++) {
        if (weight[i] > 1e-6 * top) {
            double scale = fmax(fabs(expected[i]), 1e-6);
            result = maximum(result, fabs(found[i] - expected[i]) / scale);
        }
    }
    return result;
}

setup oblique(float *density)
{
    static const uint32_t size[3] = {12, 16, 10};
    static const float extent[3] = {1.0f, 1.4f, 0.8f};
    setup s = {
        .suns = {{.color = {1, 2, 3}, .direction = {0.48f, 0.6f, 0.64f}},
                 {.color = {4, 0.5f, 1}, .direction = {0, -1, 0}}},
        .camera = {.origin = {0.3f, 0.9f, 3}, .forward = {0, 0, -1}},
        .medium = {.sigma_s = {2, 5, 9},
                   .sigma_a = {0.5f, 0.1f, 0},
                   .phase = {{.g = 0.8f}, {.g = 0}, {.g = -0.3f}}},
    };
    srand(7);
    for (uint32_t q = 0; q < size[0] * size[1] * size[2]; q++) {
        density[q] = rand() % 4 ? (float)(rand() % 1000) * 1e-3f : 0;
    }
    set_medium(&s, extent, size, density);
    tyn_pass_defaults(&tyn_pass_propagate_rect, &s.params);
    s.params.cells = N;
    s.params.iterations = 7;
    s.num_suns = MAX_SUNS;
    s.params.channels = 3;
    memcpy(s.params.extent, extent, sizeof extent);
    memcpy(s.params.size, size, sizeof size);
    return s;
}

void to_m(const struct propagate_grid *grid, const double cell[3], double p[3])
{
    for (int i = 0; i < 3; i++) {
        p[i] = grid->origin[i] +
               grid->cell * (grid->across_u[i] * cell[0] + grid->across_v[i] * cell[1]) +
               grid->along * grid->direction[i] * cell[2];
    }
}

double compare_channel(const setup *s, const outcome *o, int index, int c)
{
    static double sigma_s[CELLS], sigma_a[CELLS], g[CELLS], mu[CELLS], light[CELLS], cosine[CELLS],
        seen[CELLS], found[3][CELLS], spread[CELLS], lit[CELLS];
    const struct propagate_grid *grid = &o->grids[index];
    const int n[3] = {(int)grid->size[0], (int)grid->size[1], (int)grid->size[2]};
    const int across = s->params.cells,
              along = s->params.cells_along ? s->params.cells_along : across;
    int total = n[0] * n[1] * n[2], texels[CELLS];
    assert_true(total <= CELLS);
    for (int q = 0; q < total; q++) {
        int i = q % n[0], j = q / n[0] % n[1], k = q / (n[0] * n[1]);
        int at = texels[q] = (((3 * index + c) * along + k) * across + j) * across + i;
        double p[3], to_eye[3], r = 0;
        to_m(grid, (double[]){i + 0.5, j + 0.5, k + 0.5}, p);
        mu[q] = 0;
        for (int x = 0; x < 3; x++) {
            to_eye[x] = s->camera.origin[x] - p[x];
            r += to_eye[x] * to_eye[x];
            mu[q] += to_eye[x] * grid->direction[x];
        }
        mu[q] /= sqrt(r);
        sigma_s[q] = o->cells[at].c[0] / grid->along;
        sigma_a[q] = o->cells[at].c[1] / grid->along;
        g[q] = o->cells[at].c[2];
        lit[q] =
            s->params.num_triangles ? o->lit[((index * along + k) * across + j) * across + i] : 1;
    }
    twin_grid twin = {{n[0], n[1], n[2]},
                      grid->along,
                      sigma_s,
                      sigma_a,
                      g,
                      (twin_init)s->params.init,
                      s->params.rate == TYN_PROPAGATE_RATE_EXACT,
                      s->params.last_event != 0,
                      mu,
                      grid->mean_cosine,
                      lit,
                      grid->cell,
                      s->params.cones == TYN_PROPAGATE_CONES_CELL};
    twin_propagate(&twin, s->params.iterations, light, cosine, seen);
    for (int q = 0; q < total; q++) {
        found[0][q] = light_of(o, texels[q], grid->cell / grid->along);
        found[1][q] = o->state[texels[q]].c[3];
        found[2][q] = o->seen[texels[q]];
        spread[q] = 1 - cosine[q] * kept_cosine(o, texels[q], twin.exact_rate);
    }
    return maximum(
        maximum(worst(found[0], light, total, light), worst(found[1], spread, total, light)),
        worst(found[2], seen, total, seen));
}

void set_ordinates(setup *s, uint32_t count)
{
    s->ordinates.count = count;
    s->params.num_ordinates = count;
    for (uint32_t n = 0; n < count; n++) {
        struct ordinate *o = &s->ordinates.list[n];
        double z = 1 - (2 * n + 1.0) / count, r = sqrt(1 - z * z), phi = 2.399963 * n;
        o->direction[0] = (float)(r * cos(phi));
        o->direction[1] = (float)(r * sin(phi));
        o->direction[2] = (float)z;
        o->solid_angle = (float)(12.566371 / count * (n % 2 ? 0.5 : 1.5));
        o->mean_cosine = (float)(1 - o->solid_angle / 12.566371);
        for (int c = 0; c < 3; c++) {
            o->irradiance[c] = (float)(1 + (n + (uint32_t)c) % 3);
        }
    }
}
