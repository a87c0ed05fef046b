// regime_light.c -- where the light in a scene comes from, and whether it is of one colour.
#include "regime_parts.h"
#include <string.h>

static const double pi = 3.14159265358979323846;

// ---- colours ----------------------------------------------------------------------------------

static bool all_grey(const tyn_scene *scene)
{
    bool grey = true;
    for (uint32_t i = 0; i < scene->num_media; i++) {
        const tyn_medium *m = &scene->media[i];
        for (int c = 1; c < 3; c++) {
            grey &= m->sigma_s[c] == m->sigma_s[0] && m->sigma_a[c] == m->sigma_a[0] &&
                    tyn_phase_equal(m->phase[c], m->phase[0]);
        }
    }
    return grey;
}

// Is a colour black or a multiple of `tint`? The first that is not black becomes it.
static bool of_tint(const float color[3], float tint[3])
{
    if (tint[0] == 0 && tint[1] == 0 && tint[2] == 0) {
        memcpy(tint, color, 3 * sizeof *tint);
    }
    bool same = true;
    for (int a = 0; a < 3; a++) {
        const int b = (a + 1) % 3;
        const float p = color[a] * tint[b], q = color[b] * tint[a];
        same &= fabsf(p - q) <= 1e-5f * fabsf(p);
    }
    return same;
}

// One colour of all lights, of media that emit and of the sky; of surfaces that reflect, grey.
static bool one_tint(const tyn_scene *scene)
{
    float tint[3] = {0};
    bool same = !scene->environment.data;
    for (uint32_t i = 0; i < scene->num_lights; i++) {
        same &= of_tint(scene->lights[i].color, tint);
    }
    for (uint32_t i = 0; i < scene->num_media; i++) {
        const tyn_medium *m = &scene->media[i];
        same &= of_tint(m->emission, tint);
        same &= !m->emission_grid && !m->radiance_grid && !m->albedo_grid;
    }
    if (scene->environment.present) {
        same &= of_tint(scene->environment.radiance, tint);
    }
    for (uint32_t i = 0; i < scene->surfaces.num_materials; i++) {
        const tyn_surface_material *m = &scene->surfaces.materials[i];
        float white[3] = {1, 1, 1};
        same &=
            of_tint(m->albedo, white) && m->texture == TYN_NO_TEXTURE && of_tint(m->emission, tint);
    }
    return same;
}

// ---- powers -----------------------------------------------------------------------------------

static double luminance(const float color[3])
{
    const double rgb[3] = {color[0], color[1], color[2]};
    return regime_luminance(rgb);
}

static double sun_power(const regime_box *b, const float direction[3], const float color[3])
{
    const double d[3] = {direction[0], direction[1], direction[2]};
    return luminance(color) * regime_box_shadow(b, d);
}

// What of a lamp's light meets the sphere around the box.
static double lamp_power(const regime_box *b, const tyn_light *light)
{
    double to[3], radius2 = 0;
    for (int a = 0; a < 3; a++) {
        const double middle = b->origin[a] + 0.5 * (b->edge[0][a] + b->edge[1][a] + b->edge[2][a]);
        to[a] = middle - light->position[a];
        radius2 += 0.25 * b->length[a] * b->length[a];
    }
    const double distance2 = regime_dot(to, to);
    double angle = tyn_light_solid_angle(light);
    if (distance2 > radius2) {
        angle = fmin(angle, 2 * pi * (1 - sqrt(1 - radius2 / distance2)));
    }
    return luminance(light->color) * angle;
}

// Mean luminance over the sphere of directions. Of all texels: a sun is a few of them.
static double mean_of_map(const tyn_environment *env)
{
    double sum[3] = {0}, weights = 0;
    for (uint32_t y = 0; y < env->size[1]; y++) {
        const float *row = env->data + 3 * (size_t)y * env->size[0];
        const double weight = sin(pi * (y + 0.5) / env->size[1]);
        double of_row[3] = {0};
        for (uint32_t x = 0; x < env->size[0]; x++) {
            for (int c = 0; c < 3; c++) {
                of_row[c] += row[3 * (size_t)x + c];
            }
        }
        for (int c = 0; c < 3; c++) {
            sum[c] += weight * of_row[c] * env->radiance[c];
        }
        weights += weight * env->size[0];
    }
    return weights > 0 ? regime_luminance(sum) / weights * tyn_environment_strength(env) : 0;
}

static void environment_power(const regime_box *b, const tyn_environment *env, regime *r)
{
    if (!env->present) {
        return;
    }
    if (!env->data) {
        r->share[REGIME_SKY] =
            pi * regime_box_surface(b) * luminance(env->radiance) * tyn_environment_strength(env);
        return;
    }
    tyn_environment_sun suns[TYN_MAX_MAP_SUNS];
    const uint32_t num = tyn_environment_suns(env, suns);
    double mean = mean_of_map(env);
    for (uint32_t i = 0; i < num; i++) {
        r->share[REGIME_SUN] += sun_power(b, suns[i].direction, suns[i].irradiance);
        mean -= luminance(suns[i].irradiance) / (4 * pi);
    }
    r->num_suns += num;
    r->share[REGIME_MAP] = pi * regime_box_surface(b) * fmax(mean, 0);
}

static double triangle_area(const tyn_surfaces *s, const tyn_surface_triangle *triangle)
{
    double e[2][3], n[3];
    const float *p = s->vertices[triangle->vertices[0]].position;
    for (int k = 0; k < 2; k++) {
        const float *q = s->vertices[triangle->vertices[k + 1]].position;
        for (int a = 0; a < 3; a++) {
            e[k][a] = (double)q[a] - p[a];
        }
    }
    regime_cross(e[0], e[1], n);
    return 0.5 * sqrt(regime_dot(n, n));
}

static double emitted_by(const tyn_surfaces *s)
{
    double power = 0;
    for (uint32_t i = 0; i < s->num_triangles; i++) {
        const tyn_surface_material *m = &s->materials[s->triangles[i].material];
        const double light = luminance(m->emission);
        if (light > 0) {
            const int sides = m->flags & TYN_SURFACE_EMITS_BOTH_SIDES ? 2 : 1;
            power += pi * light * triangle_area(s, &s->triangles[i]) * sides;
        }
    }
    return power;
}

void regime_of_light(const tyn_scene *scene, const regime_box *b, const double emitted[3],
                     regime *r)
{
    r->channels = all_grey(scene) && one_tint(scene) ? 1 : 3;
    for (uint32_t i = 0; i < scene->num_lights; i++) {
        const tyn_light *light = &scene->lights[i];
        if (light->kind == TYN_LIGHT_DIRECTIONAL) {
            r->share[REGIME_SUN] += sun_power(b, light->direction, light->color);
            r->num_suns++;
        } else {
            r->share[REGIME_LAMPS] += lamp_power(b, light);
            r->num_lamps++;
        }
    }
    environment_power(b, &scene->environment, r);
    const double volume = b->length[0] * b->length[1] * b->length[2];
    r->share[REGIME_EMISSION] = 4 * pi * regime_luminance(emitted) * volume;
    r->share[REGIME_SURFACES] = emitted_by(&scene->surfaces);
    double all = 0;
    for (int i = 0; i < REGIME_NUM_LIGHTS; i++) {
        all += r->share[i];
    }
    for (int i = 0; i < REGIME_NUM_LIGHTS && all > 0; i++) {
        r->share[i] /= all;
    }
}
