// check.c -- is every number of a scene one that the solvers can take?
#include "scene/check.h"
#include "base/fault.h"
#include "base/given.h"
#include <math.h>
#include <stdio.h>
#include "scene/matrix.h"
#include "scene/phase.h"
#include "scene/surfaces.h"

static bool unit3(const float v[3])
{
    float length2 = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    return length2 > 0.999f && length2 < 1.001f;
}

static float dot3(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// Every component >= 0 and finite.
static bool amount3(const float v[3])
{
    return vec_finite(v, 3) && v[0] >= 0.0f && v[1] >= 0.0f && v[2] >= 0.0f;
}

static tyn_result check_volume(const tyn_volume *volume, uint32_t i, const tyn_log *log)
{
    for (int a = 0; a < 3; a++) {
        if (volume->size[a] < 1 || volume->size[a] > 65536) {
            FAULT("volumes[%u].size[%d] = %u: must be 1 to 65536 voxels", i, a, volume->size[a]);
        }
    }
    if (!isfinite(volume->max_density) || volume->max_density < 0.0f) {
        FAULT("volumes[%u].max_density = %g: must be >= 0 and finite", i, volume->max_density);
    }
    if (!volume->data && volume->max_density <= 0.0f) {
        FAULT("volumes[%u].max_density = 0: required (> 0) where data is NULL", i);
    }
    return TYN_OK;
}

static tyn_result check_color_grid(const tyn_color_grid *grid, uint32_t i, const tyn_log *log)
{
    for (int a = 0; a < 3; a++) {
        if (grid->size[a] < 1 || grid->size[a] > 65536) {
            FAULT("color_grids[%u].size[%d] = %u: must be 1 to 65536 voxels", i, a, grid->size[a]);
        }
    }
    if (grid->channels != 1 && grid->channels != 3) {
        FAULT("color_grids[%u].channels = %u: must be 1 or 3", i, grid->channels);
    }
    if (!grid->data) {
        FAULT("color_grids[%u].data = NULL: required", i);
    }
    if (!isfinite(grid->max) || grid->max < 0.0f) {
        FAULT("color_grids[%u].max = %g: must be >= 0 and finite", i, grid->max);
    }
    return TYN_OK;
}

static tyn_result check_colors(const tyn_color_grid *grid, uint32_t i, const tyn_log *log)
{
    uint64_t values = (uint64_t)grid->size[0] * grid->size[1] * grid->size[2] * grid->channels;
    for (uint64_t v = 0; v < values; v++) {
        float value = grid->data[v];
        if (!(value >= 0.0f && value <= grid->max)) {
            FAULT("color_grids[%u].data[%llu] = %g: must be between 0 and max = %g", i,
                  (unsigned long long)v, value, grid->max);
        }
    }
    return TYN_OK;
}

static tyn_result check_densities(const tyn_volume *volume, uint32_t i, const tyn_log *log)
{
    uint64_t voxels = (uint64_t)volume->size[0] * volume->size[1] * volume->size[2];
    for (uint64_t v = 0; volume->data && v < voxels; v++) {
        float density = volume->data[v];
        if (!(density >= 0.0f && density <= volume->max_density)) {
            FAULT("volumes[%u].data[%llu] = %g: density must be between 0 and max_density = %g", i,
                  (unsigned long long)v, density, volume->max_density);
        }
    }
    return TYN_OK;
}

static tyn_result check_medium_grids(const tyn_scene *scene, uint32_t i, const tyn_log *log)
{
    const tyn_medium *m = &scene->media[i];
    const struct {
        const char *name;
        uint32_t grid;
    } slots[] = {{"emission_grid", m->emission_grid},
                 {"radiance_grid", m->radiance_grid},
                 {"albedo_grid", m->albedo_grid}};
    for (int k = 0; k < 3; k++) {
        if (slots[k].grid > scene->num_color_grids) {
            FAULT("media[%u].%s = %u: there are %u color_grids (1 is the first, 0 = none)", i,
                  slots[k].name, slots[k].grid, scene->num_color_grids);
        }
    }
    if (m->albedo_grid && scene->color_grids[m->albedo_grid - 1].max > 1.0f) {
        FAULT("media[%u].albedo_grid: color_grids[%u].max = %g: an albedo must be 0 to 1", i,
              m->albedo_grid - 1, scene->color_grids[m->albedo_grid - 1].max);
    }
    return TYN_OK;
}

static tyn_result check_medium(const tyn_scene *scene, uint32_t i, const tyn_log *log)
{
    const tyn_medium *m = &scene->media[i];
    const struct {
        const char *name;
        const float *v;
    } amounts[] = {{"sigma_s", m->sigma_s}, {"sigma_a", m->sigma_a}, {"emission", m->emission}};
    for (int k = 0; k < 3; k++) {
        const float *v = amounts[k].v;
        if (!amount3(v)) {
            FAULT("media[%u].%s = %g, %g, %g: must be >= 0 and finite", i, amounts[k].name, v[0],
                  v[1], v[2]);
        }
    }
    char of[24];
    snprintf(of, sizeof of, "media[%u]", i);
    if (tyn_phase_check(m->phase, of, log)) {
        return TYN_ERR_PARAMS;
    }
    for (int c = 0; c < 3; c++) {
        const tyn_phase *p = &m->phase[c];
        if (!(p->delta >= 0 && p->delta < 1 && p->forward >= 0 && p->forward < 1 &&
              p->backward >= 0 && p->backward < 1)) {
            FAULT("media[%u].phase[%d]: delta %g, forward %g and backward %g must be in [0, 1)", i,
                  c, (double)p->delta, (double)p->forward, (double)p->backward);
        }
        if (m->phase[c].table > scene->num_phase_tables) {
            FAULT("media[%u].phase[%d].table = %u: there are %u (0 = a Henyey-Greenstein lobe)", i,
                  c, m->phase[c].table, scene->num_phase_tables);
        }
    }
    if (!(m->density_scale >= 0.0f && isfinite(m->density_scale))) {
        FAULT("media[%u].density_scale = %g: must be > 0 and finite (0 = 1)", i, m->density_scale);
    }
    if (m->volume < -1 || (m->volume >= 0 && (uint32_t)m->volume >= scene->num_volumes)) {
        FAULT("media[%u].volume = %d: there are %u volumes (-1 = homogeneous)", i, m->volume,
              scene->num_volumes);
    }
    return TYN_OK;
}

static tyn_result check_shape(const tyn_scene *scene, uint32_t i, const tyn_log *log)
{
    const tyn_shape *s = &scene->shapes[i];
    double m[16];
    for (int k = 0; k < 16; k++) {
        m[k] = s->to_world[k];
    }
    if (s->kind != TYN_SHAPE_BOX && s->kind != TYN_SHAPE_SPHERE) {
        FAULT("shapes[%u].kind = %d: must be a box or a sphere", i, (int)s->kind);
    }
    if (s->medium >= scene->num_media) {
        FAULT("shapes[%u].medium = %u: there are %u media", i, s->medium, scene->num_media);
    }
    if (m[3] != 0.0 || m[7] != 0.0 || m[11] != 0.0 || m[15] != 1.0 || !mat_invertible(m)) {
        FAULT("shapes[%u].to_world: must be affine and invertible, its determinant is %g", i,
              mat_det3(m));
    }
    if (s->kind == TYN_SHAPE_SPHERE && (s->repeat[0] || s->repeat[1] || s->repeat[2])) {
        FAULT("shapes[%u].repeat: only a box can be periodic", i);
    }
    return TYN_OK;
}

static tyn_result check_light(const tyn_light *l, uint32_t i, const tyn_log *log)
{
    const tyn_light_traits *traits = tyn_light_traits_of(l->kind);
    if (!traits) {
        FAULT("lights[%u].kind = %d: must be one of tyn_light_kind", i, (int)l->kind);
    }
    if (!amount3(l->color)) {
        FAULT("lights[%u].color = %g, %g, %g: must be >= 0 and finite", i, l->color[0], l->color[1],
              l->color[2]);
    }
    if (traits->has_position && !vec_finite(l->position, 3)) {
        FAULT("lights[%u].position = %g, %g, %g: must be finite", i, l->position[0], l->position[1],
              l->position[2]);
    }
    if (traits->has_direction && !unit3(l->direction)) {
        FAULT("lights[%u].direction = %g, %g, %g: must have length 1", i, l->direction[0],
              l->direction[1], l->direction[2]);
    }
    return tyn_light_check_lobe(l, i, log);
}

tyn_result tyn_camera_check(const tyn_camera *c, uint32_t i, const tyn_log *log)
{
    if (c->projection != TYN_PERSPECTIVE && c->projection != TYN_ORTHOGRAPHIC) {
        FAULT("cameras[%u].projection = %d: must be perspective or orthographic", i,
              (int)c->projection);
    }
    if (!vec_finite(c->position, 3)) {
        FAULT("cameras[%u].position = %g, %g, %g: must be finite", i, c->position[0],
              c->position[1], c->position[2]);
    }
    if (!unit3(c->right) || !unit3(c->up) || !unit3(c->back) ||
        fabsf(dot3(c->right, c->up)) > 1e-3f || fabsf(dot3(c->right, c->back)) > 1e-3f ||
        fabsf(dot3(c->up, c->back)) > 1e-3f) {
        FAULT("cameras[%u]: right, up and back must be orthonormal", i);
    }
    if (c->projection == TYN_PERSPECTIVE && !(c->yfov > 0.0f && c->yfov < 3.14159f)) {
        FAULT("cameras[%u].yfov = %g: must be between 0 and pi radians, both excluded", i, c->yfov);
    }
    if (c->projection == TYN_ORTHOGRAPHIC && !(c->ymag > 0.0f && isfinite(c->ymag))) {
        FAULT("cameras[%u].ymag = %g: must be > 0 and finite, metres", i, c->ymag);
    }
    return TYN_OK;
}

static tyn_result check_environment(const tyn_environment *e, const tyn_log *log)
{
    if (!e->present) {
        return TYN_OK;
    }
    if (!amount3(e->radiance)) {
        FAULT("environment.radiance = %g, %g, %g: must be >= 0 and finite", e->radiance[0],
              e->radiance[1], e->radiance[2]);
    }
    if (!(e->strength >= 0.0f && isfinite(e->strength))) {
        FAULT("environment.strength = %g: must be > 0 and finite (0 = 1)", e->strength);
    }
    float n = e->rotation[0] * e->rotation[0] + e->rotation[1] * e->rotation[1] +
              e->rotation[2] * e->rotation[2] + e->rotation[3] * e->rotation[3];
    if (n != 0.0f && !(n > 0.999f && n < 1.001f)) {
        FAULT("environment.rotation: must be a unit quaternion, its squared length is %g", n);
    }
    if (!e->data != (e->size[0] == 0 || e->size[1] == 0)) {
        FAULT("environment: a map needs both data and a size, a constant has neither (%ux%u)",
              e->size[0], e->size[1]);
    }
    return TYN_OK;
}

static tyn_result check_texels(const tyn_environment *e, const tyn_log *log)
{
    for (size_t t = 0; e->present && e->data && t < 3 * (size_t)e->size[0] * e->size[1]; t++) {
        if (!(e->data[t] >= 0.0f && isfinite(e->data[t]))) {
            FAULT("environment.data[%zu] = %g: must be >= 0 and finite", t, e->data[t]);
        }
    }
    return TYN_OK;
}

// Arrays that are to hold something are there.
static tyn_result check_arrays(const tyn_scene *scene, const tyn_log *log)
{
    if (scene->num_volumes && !scene->volumes) {
        FAULT("volumes = NULL, but there are to be %u", scene->num_volumes);
    }
    if (scene->num_color_grids && !scene->color_grids) {
        FAULT("color_grids = NULL, but there are to be %u", scene->num_color_grids);
    }
    if (scene->num_phase_tables && !scene->phase_tables) {
        FAULT("phase_tables = NULL, but there are to be %u", scene->num_phase_tables);
    }
    if (scene->num_cameras && !scene->cameras) {
        FAULT("cameras = NULL, but there are to be %u", scene->num_cameras);
    }
    return tyn_surfaces_check_arrays(&scene->surfaces, log);
}

tyn_result tyn_scene_check_values(const tyn_scene *scene, const tyn_log *log)
{
    TYN_TRY(TYN_GIVEN(log, scene) ? check_arrays(scene, log) : TYN_ERR_PARAMS);
    if (scene->num_media > TYN_MAX_MEDIA || scene->num_shapes > TYN_MAX_SHAPES ||
        scene->num_lights > TYN_MAX_LIGHTS) {
        FAULT("scene: %u media, %u shapes, %u lights: at most %d, %d, %d", scene->num_media,
              scene->num_shapes, scene->num_lights, TYN_MAX_MEDIA, TYN_MAX_SHAPES, TYN_MAX_LIGHTS);
    }
    if (scene->num_phase_tables > TYN_MAX_PHASE_TABLES) {
        FAULT("num_phase_tables = %u: at most %d", scene->num_phase_tables, TYN_MAX_PHASE_TABLES);
    }
    for (uint32_t i = 0; i < scene->num_volumes; i++) {
        TYN_TRY(check_volume(&scene->volumes[i], i, log));
    }
    for (uint32_t i = 0; i < scene->num_color_grids; i++) {
        TYN_TRY(check_color_grid(&scene->color_grids[i], i, log));
    }
    for (uint32_t i = 0; i < scene->num_media; i++) {
        TYN_TRY(check_medium(scene, i, log));
        TYN_TRY(check_medium_grids(scene, i, log));
    }
    for (uint32_t i = 0; i < scene->num_shapes; i++) {
        TYN_TRY(check_shape(scene, i, log));
    }
    for (uint32_t i = 0; i < scene->num_lights; i++) {
        TYN_TRY(check_light(&scene->lights[i], i, log));
    }
    for (uint32_t i = 0; i < scene->num_cameras; i++) {
        TYN_TRY(tyn_camera_check(&scene->cameras[i], i, log));
    }
    return check_environment(&scene->environment, log);
}

tyn_result tyn_scene_check_data(const tyn_scene *scene, const tyn_log *log)
{
    for (uint32_t i = 0; i < scene->num_volumes; i++) {
        TYN_TRY(check_densities(&scene->volumes[i], i, log));
    }
    for (uint32_t i = 0; i < scene->num_color_grids; i++) {
        TYN_TRY(check_colors(&scene->color_grids[i], i, log));
    }
    TYN_TRY(tyn_phase_check_tables(scene, log));
    return check_texels(&scene->environment, log);
}

tyn_result tyn_scene_check(const tyn_scene *scene, const tyn_log *log)
{
    TYN_TRY(tyn_scene_check_values(scene, log));
    TYN_TRY(tyn_scene_check_data(scene, log));
    return tyn_surfaces_check(&scene->surfaces, log);
}
