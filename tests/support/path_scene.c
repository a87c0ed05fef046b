// path_scene.c -- small scenes for the path tracer and runs of it.
#include "path_scene.h"
#include <tyndall/extend/hash.h>
#include "frame/env_cdf.h"
#include "vector.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void copy3(float to[3], const float from[3])
{
    memcpy(to, from, 3 * sizeof(float));
}

static float largest(const float v[3])
{
    return fmaxf(v[0], fmaxf(v[1], v[2]));
}

void path_scene_box(path_scene *s, const float extent[3], const float sigma_s[3],
                    const float sigma_a[3], const float g[3], const float *grid,
                    const uint32_t grid_size[3])
{
    *s = (path_scene){.samples = 16, .grid = grid};
    float max_density = grid ? 0 : 1, sigma_t[3];
    struct shape_block *shape = &s->shapes[0];
    struct medium_block *m = &s->medium;
    m->mode = TYN_MEDIUM_DENSITY;
    m->num_shapes = 1;
    for (int i = 0; i < 3; i++) {
        s->grid_size[i] = grid ? grid_size[i] : 1;
        m->extent[i] = extent[i];
        m->size[i] = s->grid_size[i];
        m->voxel[i] = extent[i] / (float)m->size[i];
        m->bricks[i] = (m->size[i] + TYN_BRICK - 1) / TYN_BRICK;
        m->brick_size[i] = m->voxel[i] * TYN_BRICK;
        shape->rows[i][i] = 1 / extent[i];
        shape->rows[i][3] = -0.5f;
        shape->size[i] = s->grid_size[i];
        sigma_t[i] = sigma_s[i] + sigma_a[i];
    }
    size_t count = (size_t)s->grid_size[0] * s->grid_size[1] * s->grid_size[2];
    for (size_t i = 0; grid && i < count; i++) {
        max_density = fmaxf(max_density, grid[i]);
    }
    m->max_density = max_density;
    m->sigma_t_max = largest(sigma_t);
    copy3(m->sigma_s, sigma_s);
    copy3(m->sigma_a, sigma_a);
    copy3(shape->sigma_s, sigma_s);
    copy3(shape->sigma_a, sigma_a);
    for (int c = 0; c < 3; c++) {
        m->phase[c].g = shape->phase[c].g = g[c];
    }

    tyn_pass_defaults(&tyn_pass_path, &s->params);
    s->params.num_shapes = 1;
    s->params.homogeneous = grid ? 0 : 1;
    s->params.grey = 1;
    for (int i = 1; i < 3; i++) {
        if (sigma_s[i] != sigma_s[0] || sigma_a[i] != sigma_a[0] || g[i] != g[0]) {
            s->params.grey = 0;
        }
    }
    s->params.sigma_guess = grid ? 0.5f * m->sigma_t_max * max_density : m->sigma_t_max;
    for (int i = 0; i < 3; i++) {
        s->params.world[i][i] = 1;
    }
}

void path_scene_cube(path_scene *s, float sigma_s, float sigma_a, float g, bool grid)
{
    static const float one[1] = {1};
    path_scene_box(s, (float[]){1, 1, 1}, (float[]){sigma_s, sigma_s, sigma_s},
                   (float[]){sigma_a, sigma_a, sigma_a}, (float[]){g, g, g}, grid ? one : NULL,
                   (uint32_t[]){1, 1, 1});
    path_scene_orthographic(s, (float[]){0.5f, 0.5f, 0.5f}, (float[]){0, -1, 0}, (float[]){0, 0, 1},
                            0.5f, 16);
    s->samples = 64;
}

void path_scene_sun(path_scene *s, const float direction[3], const float irradiance[3])
{
    struct light_block *l = &s->lights[s->params.num_lights++];
    l->kind = TYN_LIGHT_KIND_DIRECTIONAL;
    copy3(l->color, irradiance);
    copy3(l->direction, direction);
    vector_normalisef(l->direction);
}

void path_scene_lamp(path_scene *s, const float position[3], const float intensity[3])
{
    struct light_block *l = &s->lights[s->params.num_lights++];
    l->kind = TYN_LIGHT_KIND_POINT;
    copy3(l->color, intensity);
    copy3(l->position, position);
    l->direction[2] = 1;
    l->cos_inner = l->cos_outer = -1;
    s->params.num_lamps++;
    s->params.near_lamps++;
}

void path_scene_sky(path_scene *s, float radiance)
{
    for (int i = 0; i < 3; i++) {
        s->environment.radiance[i] = radiance;
        s->environment.mean[i] = radiance;
        s->environment.rows[i][i] = 1;
    }
    s->params.environment = TYN_PATH_ENV_CONSTANT;
    s->camera.background = 1;
}

void path_scene_orthographic(path_scene *s, const float centre[3], const float direction[3],
                             const float up[3], float half, uint32_t n)
{
    struct camera_block *c = &s->camera;
    copy3(c->origin, centre);
    copy3(c->forward, direction);
    vector_normalisef(c->forward);
    vector_crossf(up, c->forward, c->right);
    vector_normalisef(c->right);
    vector_crossf(c->forward, c->right, c->up);
    // Start well outside: the camera's plane cuts the media otherwise.
    float back = 2 * (s->medium.extent[0] + s->medium.extent[1] + s->medium.extent[2]);
    for (int i = 0; i < 3; i++) {
        c->origin[i] -= back * c->forward[i];
    }
    c->orthographic = 1;
    c->half_width = c->half_height = half;
    c->background = 1;
    c->size[0] = c->size[1] = n;
}

// Bounds of the trilinear interpolant over each brick: its texels and their neighbours.
static float *brick_bounds(const path_scene *s)
{
    const uint32_t *b = s->medium.bricks, *n = s->grid_size;
    float *bounds = malloc((size_t)b[0] * b[1] * b[2] * 2 * sizeof(float)), *out = bounds;
    for (uint32_t k = 0; k < b[2]; k++) {
        for (uint32_t j = 0; j < b[1]; j++) {
            for (uint32_t i = 0; i < b[0]; i++, out += 2) {
                int lo[3] = {(int)(i * TYN_BRICK) - 1, (int)(j * TYN_BRICK) - 1,
                             (int)(k * TYN_BRICK) - 1};
                out[0] = INFINITY;
                out[1] = 0;
                for (int q = 0; q < 1000; q++) {
                    int at[3] = {lo[0] + q % 10, lo[1] + q / 10 % 10, lo[2] + q / 100};
                    for (int a = 0; a < 3; a++) {
                        at[a] = at[a] < 0 ? 0 : at[a] >= (int)n[a] ? (int)n[a] - 1 : at[a];
                    }
                    float v =
                        s->grid[((size_t)at[2] * n[1] + (size_t)at[1]) * n[0] + (size_t)at[0]];
                    out[0] = fminf(out[0], v);
                    out[1] = fmaxf(out[1], v);
                }
            }
        }
    }
    return bounds;
}

static void map_fill(void *user, void *staging)
{
    const tyn_environment *e = user;
    float *out = staging;
    for (size_t i = 0; i < (size_t)e->size[0] * e->size[1]; i++) {
        memcpy(out + 4 * i, e->data + 3 * i, 3 * sizeof(float));
        out[4 * i + 3] = 1;
    }
}

void path_scene_declare(gpu_test *t, path_scene *s, tyn_ref *refs)
{
    refs[PATH_PORT_MEDIUM] = gpu_buffer(t, "medium", &s->medium, sizeof s->medium);
    refs[PATH_PORT_SHAPES] =
        gpu_buffer(t, "shapes", s->shapes, s->medium.num_shapes * sizeof *s->shapes);
    if (s->params.num_lights) {
        refs[PATH_PORT_LIGHTS] =
            gpu_buffer(t, "lights", s->lights, s->params.num_lights * sizeof *s->lights);
    }
    if (s->grid) {
        const uint32_t *n = s->grid_size, *b = s->medium.bricks;
        refs[PATH_PORT_ATLAS] =
            gpu_image(t, "atlas", TYN_IMAGE_3D, (tyn_extent){n[0], n[1], n[2]}, 1, s->grid);
        float *bounds = brick_bounds(s);
        refs[PATH_PORT_BRICKS] =
            gpu_image(t, "bricks", TYN_IMAGE_3D, (tyn_extent){b[0], b[1], b[2]}, 2, bounds);
        free(bounds);
    }
    if (s->map.data) {
        size_t size = tyn_env_cdf_size(&s->map);
        void *table = malloc(size);
        assert_true(tyn_env_cdf_build(&s->map, table));
        refs[PATH_PORT_ENV_TABLE] = gpu_buffer(t, "env_table", table, size);
        free(table);
        refs[PATH_PORT_ENV_MAP] = tyn_graph_upload_image(
            t->graph, "env_map", TYN_IMAGE_2D, VK_FORMAT_R32G32B32A32_SFLOAT,
            (tyn_extent){s->map.size[0], s->map.size[1], 1}, map_fill, &s->map, s->map.hash);
        s->environment.has_map = 1;
        s->params.environment = TYN_PATH_ENV_MAP;
    }
    refs[PATH_PORT_ENVIRONMENT] =
        gpu_buffer(t, "environment", &s->environment, sizeof s->environment);
}

static tyn_ref history(gpu_test *t, const char *name, uint32_t width, uint32_t height)
{
    return tyn_graph_history_image(t->graph, name, TYN_IMAGE_2D, VK_FORMAT_R32G32B32A32_SFLOAT,
                                   (tyn_extent){width, height, 1}, 1);
}

static void render_some(gpu_test *t, path_scene *s)
{
    tyn_ref refs[PATH_NUM_PORTS] = {{0}};
    uint32_t w = s->camera.size[0], h = s->camera.size[1], layers = s->params.layers;
    tyn_graph_begin(t->graph);
    path_scene_declare(t, s, refs);
    refs[PATH_PORT_CAMERA] = gpu_buffer(t, "camera", &s->camera, sizeof s->camera);
    refs[PATH_PORT_MEAN] = history(t, "mean", w, h);
    refs[PATH_PORT_LOW] = history(t, "low", w, h);
    refs[PATH_PORT_DEVIATION] = history(t, "deviation", w, h);
    refs[PATH_PORT_MEAN_SINGLE] = history(t, "mean_single", layers ? w : 1, layers ? h : 1);
    refs[PATH_PORT_MEAN_MULTIPLE] = history(t, "mean_multiple", layers ? w : 1, layers ? h : 1);
    refs[PATH_PORT_MEAN_TRANSMITTANCE] =
        history(t, "mean_transmittance", layers ? w : 1, layers ? h : 1);
    s->params.short_loops = t->dev->capacity.short_loops;
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_path, &s->params, refs), TYN_OK);
    tyn_graph_output(t->graph, "radiance", refs[PATH_PORT_RADIANCE], true);
    tyn_graph_output(t->graph, "error", refs[PATH_PORT_ERROR], true);
    tyn_graph_output(t->graph, "counters", refs[PATH_PORT_COUNTERS], true);
    if (layers) {
        tyn_graph_output(t->graph, "single", refs[PATH_PORT_SINGLE], true);
        tyn_graph_output(t->graph, "multiple", refs[PATH_PORT_MULTIPLE], true);
        tyn_graph_output(t->graph, "transmittance", refs[PATH_PORT_TRANSMITTANCE], true);
    }
    gpu_run(t);
    const struct counters_block *counters = gpu_map(t, "counters");
    assert_int_equal(counters->non_finite, 0);
    assert_true(s->may_cut || counters->cut == 0);
}

void path_scene_render(gpu_test *t, path_scene *s, uint32_t samples, const float **radiance,
                       const float **error)
{
    for (uint32_t done = 0; done < samples; done += s->params.num_samples) {
        s->params.first_sample = done;
        s->params.num_samples = samples - done < s->samples ? samples - done : s->samples;
        render_some(t, s);
    }
    *radiance = gpu_map(t, "radiance");
    if (error) {
        *error = gpu_map(t, "error");
    }
}

static void probe_some(gpu_test *t, path_scene *s, const float (*points)[3], uint32_t num_points)
{
    tyn_ref refs[PATH_PROBE_NUM_PORTS] = {{0}};
    tyn_graph_begin(t->graph);
    path_scene_declare(t, s, refs);
    refs[PATH_PROBE_PORT_POINTS] = gpu_buffer(t, "points", points, num_points * sizeof *points);
    refs[PATH_PROBE_PORT_STATE] =
        tyn_graph_history_buffer(t->graph, "state", tyn_path_probe_state_size(num_points), 1);
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_path_probe, &s->params, refs), TYN_OK);
    tyn_graph_output(t->graph, "results", refs[PATH_PROBE_PORT_RESULTS], true);
    tyn_graph_output(t->graph, "counters", refs[PATH_PROBE_PORT_COUNTERS], true);
    gpu_run(t);
    const struct counters_block *counters = gpu_map(t, "counters");
    assert_int_equal(counters->non_finite, 0);
    assert_true(s->may_cut || counters->cut == 0);
}

const tyn_probe_result *path_scene_probe_more(gpu_test *t, path_scene *s, const float (*points)[3],
                                              uint32_t num_points, uint32_t done)
{
    s->params.first_sample = done;
    s->params.num_samples = s->samples;
    probe_some(t, s, points, num_points);
    return gpu_map(t, "results");
}

const tyn_probe_result *path_scene_probe(gpu_test *t, path_scene *s, const float (*points)[3],
                                         uint32_t num_points, uint32_t samples)
{
    const tyn_probe_result *results = NULL;
    for (uint32_t done = 0; done < samples; done += s->samples) {
        results = path_scene_probe_more(t, s, points, num_points, done);
    }
    return results;
}

const struct path_balance_result *path_scene_balance(gpu_test *t, path_scene *s, uint32_t samples,
                                                     const tyn_balance **balance)
{
    tyn_ref refs[PATH_BALANCE_NUM_PORTS] = {{0}};
    tyn_graph_begin(t->graph);
    path_scene_declare(t, s, refs);
    refs[PATH_BALANCE_PORT_STATE] =
        tyn_graph_history_buffer(t->graph, "state", sizeof(struct path_balance_state), 1);
    s->params.first_sample = 0;
    s->params.chunks = 4;
    s->params.threads = 1024;
    s->params.num_samples = 1;
    s->params.paths = samples / s->params.chunks;
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_path_balance, &s->params, refs), TYN_OK);
    tyn_graph_output(t->graph, "balance", refs[PATH_BALANCE_PORT_BALANCE], true);
    tyn_graph_output(t->graph, "result", refs[PATH_BALANCE_PORT_RESULT], true);
    tyn_graph_output(t->graph, "counters", refs[PATH_BALANCE_PORT_COUNTERS], true);
    gpu_run(t);
    assert_int_equal(((const struct counters_block *)gpu_map(t, "counters"))->non_finite, 0);
    *balance = gpu_map(t, "balance");
    return gpu_map(t, "result");
}

const tyn_fluxes *path_scene_fluxes(gpu_test *t, path_scene *s, uint32_t samples)
{
    tyn_ref refs[PATH_FLUXES_NUM_PORTS] = {{0}};
    tyn_graph_begin(t->graph);
    path_scene_declare(t, s, refs);
    refs[PATH_FLUXES_PORT_STATE] =
        tyn_graph_history_buffer(t->graph, "state", sizeof(struct path_fluxes_state), 1);
    memcpy(s->params.box[1], s->medium.extent, sizeof s->params.box[1]);
    s->params.first_sample = 0;
    s->params.chunks = 4;
    s->params.threads = 1024;
    s->params.num_samples = samples / s->params.chunks / s->params.threads;
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_path_fluxes, &s->params, refs), TYN_OK);
    tyn_graph_output(t->graph, "fluxes", refs[PATH_FLUXES_PORT_FLUXES], true);
    tyn_graph_output(t->graph, "counters", refs[PATH_FLUXES_PORT_COUNTERS], true);
    gpu_run(t);
    const struct counters_block *counters = gpu_map(t, "counters");
    assert_int_equal(counters->non_finite + counters->cut, 0);
    return gpu_map(t, "fluxes");
}

void path_scene_check(const char *what, double value, double error, double expected)
{
    printf("%-44s %.6f +- %.6f  expected %.6f\n", what, value, error, expected);
    assert_true(fabs(value - expected) <= 3.5 * error + 2e-5 * fabs(expected));
}
