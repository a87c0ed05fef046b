// scene.c -- life of a scene, its bounds, overrides of its media.
#include <tyndall/scene.h>
#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "scene/phase.h"
#include "scene/surfaces.h"
#include "base/given.h"

void tyn_scene_init(tyn_scene *scene)
{
    if (!scene) {
        return;
    }
    memset(scene, 0, sizeof *scene);
    scene->environment.strength = 1.0f;
    for (int c = 0; c < 3; c++) {
        scene->environment.radiance[c] = 1.0f;
    }
    scene->environment.rotation[3] = 1.0f;
}

void tyn_scene_finish(tyn_scene *scene)
{
    if (!scene) {
        return;
    }
    for (uint32_t i = 0; i < scene->num_volumes; i++) {
        free(scene->volumes[i].name);
        free(scene->volumes[i].data);
    }
    for (uint32_t i = 0; i < scene->num_color_grids; i++) {
        free(scene->color_grids[i].name);
        free(scene->color_grids[i].data);
    }
    for (uint32_t i = 0; i < scene->num_media; i++) {
        free(scene->media[i].name);
    }
    for (uint32_t i = 0; i < scene->num_lights; i++) {
        free(scene->lights[i].name);
    }
    for (uint32_t i = 0; i < scene->num_cameras; i++) {
        free(scene->cameras[i].name);
        free(scene->cameras[i].camera_name);
    }
    for (uint32_t i = 0; i < scene->num_warnings; i++) {
        free(scene->warnings[i]);
    }
    free(scene->name);
    free(scene->generator);
    free(scene->volumes);
    free(scene->color_grids);
    free(scene->phase_tables);
    free(scene->cameras);
    free(scene->warnings);
    free(scene->environment.data);
    tyn_surfaces_free(&scene->surfaces);
    tyn_scene_init(scene);
}

void tyn_scene_take_lights_as(tyn_scene *scene, tyn_light_units units)
{
    static const float lumens = 683; // of a watt at 555 nm, as glTF's exporters take for any colour
    if (!scene || scene->light_units == units) {
        return;
    }
    const float factor = units == TYN_LIGHTS_PHOTOMETRIC ? 1 / lumens : lumens;
    for (uint32_t i = 0; i < scene->num_lights; i++) {
        for (int c = 0; c < 3; c++) {
            scene->lights[i].color[c] *= factor;
        }
    }
    scene->light_units = units;
}

void tyn_medium_clear(tyn_medium *medium)
{
    for (int c = 0; medium && c < 3; c++) {
        medium->sigma_s[c] = medium->sigma_a[c] = medium->emission[c] = 0.0f;
    }
    if (medium) {
        medium->emission_grid = medium->radiance_grid = medium->albedo_grid = 0;
    }
}

void tyn_scene_warn(tyn_scene *scene, const char *format, ...)
{
    char line[1024];
    if (!scene || !format) {
        return;
    }
    va_list args;
    va_start(args, format);
    vsnprintf(line, sizeof line, format, args);
    va_end(args);
    char **grown = realloc(scene->warnings, (scene->num_warnings + 1) * sizeof *grown);
    if (grown) {
        scene->warnings = grown;
        char *copy = strdup(line);
        if (copy) {
            grown[scene->num_warnings++] = copy;
        }
    }
}

bool tyn_scene_bounds(const tyn_scene *scene, float lo[3], float hi[3])
{
    if (!scene || !lo || !hi) {
        for (int a = 0; a < 3; a++) {
            *(lo ? &lo[a] : &(float){0}) = *(hi ? &hi[a] : &(float){0}) = 0.0f;
        }
        return false;
    }
    if (!scene->num_shapes) {
        return tyn_surfaces_bounds(&scene->surfaces, lo, hi);
    }
    for (int a = 0; a < 3; a++) {
        lo[a] = FLT_MAX;
        hi[a] = -FLT_MAX;
    }
    for (uint32_t i = 0; i < scene->num_shapes; i++) {
        const tyn_shape *shape = &scene->shapes[i];
        const float *m = shape->to_world;
        for (int a = 0; a < 3; a++) {
            // Half extent of the image of the shape: of a cube the sum of the half axes'
            // components, of a sphere the length of the matrix row.
            float x = m[a], y = m[4 + a], z = m[8 + a];
            float half = shape->kind == TYN_SHAPE_SPHERE ? 0.5f * sqrtf(x * x + y * y + z * z)
                                                         : 0.5f * (fabsf(x) + fabsf(y) + fabsf(z));
            lo[a] = fminf(lo[a], m[12 + a] - half);
            hi[a] = fmaxf(hi[a], m[12 + a] + half);
        }
    }
    return true;
}

static bool all_in(const float *v, float lo, float hi)
{
    return !v || (v[0] >= lo && v[0] <= hi && v[1] >= lo && v[1] <= hi && v[2] >= lo && v[2] <= hi);
}

tyn_result tyn_scene_override(tyn_scene *scene, const tyn_medium_override *override,
                              const tyn_log *log)
{
    const tyn_medium_override *o = override;
    const tyn_phase_parameter *g = tyn_phase_parameters();
    if (!TYN_GIVEN(log, scene, override)) {
        return TYN_ERR_PARAMS;
    }
    const struct {
        const char *name, *right;
        const float *value;
        float lo, hi;
    } checks[] = {
        {"sigma_s", ">= 0 and finite, 1/m", o->sigma_s, 0.0f, FLT_MAX},
        {"sigma_a", ">= 0 and finite, 1/m", o->sigma_a, 0.0f, FLT_MAX},
        {g->name, g->right, o->g, g->lo, g->hi},
        {"albedo", "between 0 and 1", o->albedo, 0.0f, 1.0f},
    };
    for (size_t i = 0; i < sizeof checks / sizeof checks[0]; i++) {
        const float *v = checks[i].value;
        if (!all_in(v, checks[i].lo, checks[i].hi)) {
            return TYN_FAULT(log, TYN_ERR_PARAMS, "%s = %g, %g, %g: must be %s", checks[i].name,
                             v[0], v[1], v[2], checks[i].right);
        }
    }
    if (!isfinite(o->density_scale)) {
        return TYN_FAULT(log, TYN_ERR_PARAMS, "density scale = %g: must be finite and > 0",
                         o->density_scale);
    }
    for (uint32_t i = 0; i < scene->num_media; i++) {
        tyn_medium *medium = &scene->media[i];
        for (int c = 0; c < 3; c++) {
            medium->sigma_s[c] = o->sigma_s ? o->sigma_s[c] : medium->sigma_s[c];
            medium->sigma_a[c] = o->sigma_a ? o->sigma_a[c] : medium->sigma_a[c];
            medium->phase[c] = o->g ? tyn_phase_of_mean_cosine(o->g[c]) : medium->phase[c];
            if (o->albedo) {
                float sigma_t = medium->sigma_s[c] + medium->sigma_a[c];
                medium->sigma_s[c] = sigma_t * o->albedo[c];
                medium->sigma_a[c] = sigma_t - medium->sigma_s[c];
            }
        }
        if (o->albedo) {
            medium->albedo_grid = 0;
        }
        if (o->density_scale > 0.0f) {
            medium->density_scale = o->density_scale;
        }
    }
    return TYN_OK;
}
