// info_scene.c -- what is in a scene, for people.
#include "info_scene.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const char *name_or(const char *name)
{
    return name ? name : "(no name)";
}

static void print_color(const char *title, const float v[3], const char *after)
{
    printf("%s%g %g %g%s", title, v[0], v[1], v[2], after);
}

// Of phase functions that are no Henyey-Greenstein lobes.
static void print_tables(const tyn_phase phase[3])
{
    static const char *const colours[3] = {"red", "green", "blue"};
    for (int c = 0; c < 3; c++) {
        if (phase[c].table) {
            printf("  phase function of %s: table %u, %.4g of it straight on\n", colours[c],
                   phase[c].table - 1, tyn_phase_delta_fraction(phase[c]));
        }
    }
}

static void print_media(const tyn_scene *scene)
{
    for (uint32_t i = 0; i < scene->num_volumes; i++) {
        const tyn_volume *v = &scene->volumes[i];
        printf("volume %u '%s': %ux%ux%u voxels, density up to %g\n", i, name_or(v->name),
               v->size[0], v->size[1], v->size[2], v->max_density);
    }
    for (uint32_t i = 0; i < scene->num_color_grids; i++) {
        const tyn_color_grid *g = &scene->color_grids[i];
        printf("colours %u '%s': %ux%ux%u voxels, %s, values up to %g\n", i, name_or(g->name),
               g->size[0], g->size[1], g->size[2], g->channels == 3 ? "RGB" : "grey", g->max);
    }
    for (uint32_t i = 0; i < scene->num_media; i++) {
        const tyn_medium *m = &scene->media[i];
        printf("medium %u '%s': ", i, name_or(m->name));
        if (m->volume < 0) {
            printf("homogeneous");
        } else {
            printf("density of volume %d x %g", m->volume, tyn_medium_scale(m));
        }
        print_color("\n  scattering  ", m->sigma_s, " 1/m\n");
        print_color("  absorption  ", m->sigma_a, " 1/m\n");
        for (const tyn_phase_parameter *p = tyn_phase_parameters(); p->name; p++) {
            float values[3];
            tyn_phase_get(m->phase, p, values);
            printf("  %s", p->title);
            print_color(" ", values, "\n");
        }
        print_tables(m->phase);
        if (m->emission[0] > 0 || m->emission[1] > 0 || m->emission[2] > 0) {
            print_color("  emission    ", m->emission, " W/(m^3 sr)");
            if (m->emission_grid) {
                printf(" x colours %u", m->emission_grid - 1);
            }
            printf("\n");
        }
        if (m->radiance_grid) {
            printf("  black bodies of colours %u, W/(m^2 sr), x absorption\n",
                   m->radiance_grid - 1);
        }
        if (m->albedo_grid) {
            printf("  albedo of colours %u\n", m->albedo_grid - 1);
        }
    }
    for (uint32_t i = 0; i < scene->num_shapes; i++) {
        const tyn_shape *s = &scene->shapes[i];
        const float *m = s->to_world;
        printf("shape %u: %s of medium %u, at %g %g %g, edges %g %g %g m%s\n", i,
               s->kind == TYN_SHAPE_SPHERE ? "sphere" : "box", s->medium, m[12], m[13], m[14],
               sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]),
               sqrt(m[4] * m[4] + m[5] * m[5] + m[6] * m[6]),
               sqrt(m[8] * m[8] + m[9] * m[9] + m[10] * m[10]),
               s->repeat[0] || s->repeat[1] || s->repeat[2] ? ", periodic" : "");
    }
}

static double triangle_area(const tyn_surfaces *s, uint32_t triangle)
{
    const float *p[3];
    double n2 = 0;
    for (int k = 0; k < 3; k++) {
        p[k] = s->vertices[s->triangles[triangle].vertices[k]].position;
    }
    for (int a = 0; a < 3; a++) {
        const int b = (a + 1) % 3, c = (a + 2) % 3;
        const double n = ((double)p[1][b] - p[0][b]) * ((double)p[2][c] - p[0][c]) -
                         ((double)p[1][c] - p[0][c]) * ((double)p[2][b] - p[0][b]);
        n2 += n * n;
    }
    return 0.5 * sqrt(n2);
}

// Power over the emission of a Lambertian emitter.
static double emitted_per_radiance(const tyn_surface_material *m, double area)
{
    return 3.14159265358979 * area * (m->flags & TYN_SURFACE_EMITS_BOTH_SIDES ? 2 : 1);
}

static void print_material(uint32_t index, const tyn_surface_material *m, double area)
{
    printf("material %u: %.4g m^2", index, area);
    if (m->texture != TYN_NO_TEXTURE) {
        printf(", texture %u", m->texture);
    }
    for (int k = 0; k < TYN_MATERIAL_NUM_FIELDS; k++) {
        const tyn_material_field *f = &tyn_material_fields[k];
        const float *v = (const float *)((const char *)m + f->offset);
        for (uint32_t c = 0; c < f->count; c++) {
            printf("%s%s %g", c ? "" : ", ", c ? "" : f->name, v[c]);
        }
        printf("%s%s", *f->unit ? " " : "", f->unit);
    }
    printf("\n");
    if (m->emission[0] > 0 || m->emission[1] > 0 || m->emission[2] > 0) {
        const double factor = emitted_per_radiance(m, area);
        printf("  emits from %s, %.4g %.4g %.4g W\n",
               m->flags & TYN_SURFACE_EMITS_BOTH_SIDES ? "both sides" : "the front",
               factor * m->emission[0], factor * m->emission[1], factor * m->emission[2]);
    }
}

// The first ones; facets of what is painted on triangles may have thousands.
static void print_materials(const tyn_surfaces *s)
{
    enum { MOST = 24 };
    double *areas = calloc(s->num_materials + 1, sizeof *areas), rest = 0, power[3] = {0};
    for (uint32_t i = 0; areas && i < s->num_triangles; i++) {
        areas[s->triangles[i].material] += triangle_area(s, i);
    }
    const uint32_t shown = s->num_materials <= MOST + 1 ? s->num_materials : MOST;
    for (uint32_t i = 0; areas && i < s->num_materials; i++) {
        const tyn_surface_material *m = &s->materials[i];
        if (i < shown) {
            print_material(i, m, areas[i]);
            continue;
        }
        rest += areas[i];
        for (int c = 0; c < 3; c++) {
            power[c] += emitted_per_radiance(m, areas[i]) * m->emission[c];
        }
    }
    if (shown < s->num_materials) {
        printf("%u more materials: %.4g m^2, emit %.4g %.4g %.4g W\n", s->num_materials - shown,
               rest, power[0], power[1], power[2]);
    }
    free(areas);
}

static void print_surfaces(const tyn_scene *scene)
{
    static const char *const wraps[] = {"repeats", "clamped", "mirrored"};
    const tyn_surfaces *s = &scene->surfaces;
    if (!s->num_triangles) {
        return;
    }
    printf("surfaces: %u meshes, %u triangles, %u vertices\n", scene->num_meshes, s->num_triangles,
           s->num_vertices);
    print_materials(s);
    for (uint32_t i = 0; i < s->num_textures; i++) {
        const tyn_texture *t = &s->textures[i];
        printf("texture %u '%s': %ux%u texels, %s along u, %s along v\n", i, name_or(t->name),
               t->size[0], t->size[1], wraps[t->wrap[0]], wraps[t->wrap[1]]);
    }
}

static void print_lights(const tyn_scene *scene)
{
    if (scene->num_lights) {
        printf("lights: taken in %s%s%s%s\n",
               scene->light_units == TYN_LIGHTS_PHOTOMETRIC
                   ? "lux and candela, 683 lm to the watt (emission in W/(m^2 sr))"
                   : "W/m^2 and W/sr",
               scene->generator ? "; the file is from '" : "",
               scene->generator ? scene->generator : "", scene->generator ? "'" : "");
    }
    for (uint32_t i = 0; i < scene->num_lights; i++) {
        const tyn_light *l = &scene->lights[i];
        const tyn_light_traits *traits = tyn_light_traits_of(l->kind);
        printf("light %u '%s': %s,", i, name_or(l->name), traits->name);
        print_color(" ", l->color, " ");
        const float *v = traits->has_position ? l->position : l->direction;
        printf("%s, %s %g %g %g\n", traits->unit, traits->has_position ? "at" : "travels along",
               0 + v[0], 0 + v[1], 0 + v[2]);
    }
    const tyn_environment *env = &scene->environment;
    if (env->present && env->data) {
        printf("environment: %ux%u texels,", env->size[0], env->size[1]);
    } else if (env->present) {
        printf("environment: constant,");
    }
    if (env->present) {
        print_color(" radiance ", env->radiance, "");
        printf(" x %g\n", env->strength);
        tyn_environment_sun suns[TYN_MAX_MAP_SUNS];
        const uint32_t count = tyn_environment_suns(env, suns);
        for (uint32_t i = 0; i < count; i++) {
            const tyn_environment_sun *s = &suns[i];
            printf("  sun %u of the map:", i);
            print_color(" ", s->irradiance, " W/m^2,");
            print_color(" travels along ", s->direction, "");
            printf(", radius %.3g deg\n", s->radius * 180 / 3.14159265358979);
        }
    }
}

static void print_cameras(const tyn_scene *scene)
{
    for (uint32_t i = 0; i < scene->num_cameras; i++) {
        const tyn_camera *c = &scene->cameras[i];
        printf("camera %u '%s': ", c->index, name_or(c->name ? c->name : c->camera_name));
        if (c->projection == TYN_PERSPECTIVE) {
            printf("perspective, vertical field of view %g deg", c->yfov * 180 / 3.14159265358979);
        } else {
            printf("orthographic, half height %g m", c->ymag);
        }
        printf(", at %g %g %g, looks along %g %g %g\n", c->position[0], c->position[1],
               c->position[2], 0 - c->back[0], 0 - c->back[1], 0 - c->back[2]);
    }
}

void info_print_scene(const tyn_scene *scene)
{
    print_media(scene);
    print_surfaces(scene);
    print_lights(scene);
    print_cameras(scene);
    float lo[3], hi[3];
    if (tyn_scene_bounds(scene, lo, hi)) {
        printf("bounds of the %s: %g %g %g to %g %g %g m\n",
               scene->num_shapes ? "media" : "surfaces", lo[0], lo[1], lo[2], hi[0], hi[1], hi[2]);
    }
    if (scene->clamped_negative) {
        printf("negative densities set to 0: %llu\n", (unsigned long long)scene->clamped_negative);
    }
}
