// bare.c -- chooses what makes a volume worth looking at: coefficients, a camera, a sun, a sky.
#include "io/bare.h"
#include "io/volume.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <tyndall/extend/hash.h>
#include "scene/matrix.h"

// Column density (density times metres) along a grid axis: that of the ray which meets most.
static double densest_column(const tyn_volume *v, int axis)
{
    const uint32_t *n = v->size;
    const size_t stride[3] = {1, n[0], (size_t)n[0] * n[1]};
    int b = (axis + 1) % 3, c = (axis + 2) % 3;
    const double *m = v->index_to_world + 4 * axis;
    double most = 0.0, step = sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
    for (uint32_t j = 0; j < n[c]; j++) {
        for (uint32_t i = 0; i < n[b]; i++) {
            const float *p = v->data + i * stride[b] + j * stride[c];
            double sum = 0.0;
            for (uint32_t k = 0; k < n[axis]; k++) {
                sum += p[k * stride[axis]];
            }
            most = fmax(most, sum);
        }
    }
    return most * step;
}

// A cloud-like medium whose thickest line of sight has an optical depth of 32 (mean of the axes):
// dense enough to be bright and to cast its own shadow, thin enough at its rim to show its
// structure.
static void choose_medium(tyn_medium *medium, const tyn_volume *volume)
{
    double column = 0.0;
    for (int a = 0; a < 3; a++) {
        column += densest_column(volume, a) / 3.0;
    }
    *medium = (tyn_medium){.density_scale = 1.0f};
    for (int c = 0; c < 3; c++) {
        medium->sigma_s[c] = column > 0.0 ? (float)fmin(32.0 / column, 1e30) : 0.0f;
        medium->phase[c].g = 0.75f;
    }
}

// From the left of the default camera, thirty degrees up, a little behind it: the near side shows
// the terminator. Irradiance so that the lit side has a radiance of about 1.
static void add_sun(tyn_scene *scene)
{
    double d[3] = {0.85, -0.50, -0.15};
    vec_normalize(d);
    scene->num_lights = 1;
    scene->lights[0] = (tyn_light){
        .name = strdup("sun"),
        .kind = TYN_LIGHT_DIRECTIONAL,
        .color = {6.6f, 6.0f, 5.2f},
        .direction = {(float)d[0], (float)d[1], (float)d[2]},
    };
}

// Radiance by elevation: deep blue above, pale at the horizon, dark haze below.
static tyn_result add_sky(tyn_environment *env, const tyn_log *log)
{
    enum { WIDTH = 16, HEIGHT = 128 };
    static const float zenith[3] = {0.05f, 0.13f, 0.36f}, horizon[3] = {0.15f, 0.25f, 0.42f},
                       nadir[3] = {0.012f, 0.02f, 0.036f};
    env->data = malloc(WIDTH * HEIGHT * 3 * sizeof *env->data);
    if (!env->data) {
        return TYN_FAULT(log, TYN_ERR_MEMORY, "no memory for the sky");
    }
    for (int y = 0; y < HEIGHT; y++) {
        float up = cosf(3.14159265f * ((float)y + 0.5f) / HEIGHT);
        float t = 1.0f - expf(-fabsf(up) * 3.0f);
        for (int x = 0; x < WIDTH; x++) {
            float *rgb = env->data + 3 * (y * WIDTH + x);
            for (int c = 0; c < 3; c++) {
                rgb[c] = horizon[c] + t * ((up > 0.0f ? zenith[c] : nadir[c]) - horizon[c]);
            }
        }
    }
    env->present = true;
    env->size[0] = WIDTH;
    env->size[1] = HEIGHT;
    env->hash = tyn_hash_bytes(TYN_HASH_SEED, env->data, WIDTH * HEIGHT * 3 * sizeof *env->data);
    return TYN_OK;
}

static tyn_result place(tyn_shape *shape, const tyn_volume *volume, const tyn_log *log)
{
    double m[16];
    tyn_grid_box(m, volume->index_to_world, volume->size);
    if (!mat_invertible(m)) {
        return TYN_FAULT(log, TYN_ERR_PARAMS,
                         "%s: its index-to-world transform must be affine and invertible, its "
                         "determinant is %g",
                         volume->name ? volume->name : "volume", mat_det3(m));
    }
    *shape = (tyn_shape){.kind = TYN_SHAPE_BOX, .medium = 0};
    for (int i = 0; i < 16; i++) {
        shape->to_world[i] = (float)m[i];
    }
    return TYN_OK;
}

tyn_result tyn_bare_scene(tyn_scene *scene, tyn_volume *volume, const char *environment,
                          const tyn_log *log)
{
    tyn_result r = place(&scene->shapes[0], volume, log);
    scene->volumes = malloc(sizeof *scene->volumes);
    scene->cameras = calloc(1, sizeof *scene->cameras);
    if (r || !scene->volumes || !scene->cameras) {
        tyn_volume_finish(volume);
        tyn_scene_finish(scene);
        return r ? r : TYN_ERR_MEMORY;
    }
    scene->volumes[0] = *volume;
    memset(volume, 0, sizeof *volume);
    scene->num_volumes = scene->num_media = scene->num_shapes = 1;
    choose_medium(&scene->media[0], &scene->volumes[0]);
    scene->num_cameras = 1;
    tyn_camera_frame_scene(&scene->cameras[0], scene);
    if (environment) {
        r = tyn_environment_load(&scene->environment, environment, log);
    } else {
        add_sun(scene);
        r = add_sky(&scene->environment, log);
    }
    if (!r) {
        r = tyn_scene_check(scene, log);
    }
    if (r) {
        tyn_scene_finish(scene);
    }
    return r;
}
