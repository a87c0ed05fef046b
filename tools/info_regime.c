// info_regime.c -- a scene's regime in words, and all of `tyndall info SCENE` as JSON.
#include "info_scene.h"
#include "stats.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

// ---- in words ---------------------------------------------------------------------------------

static void print_length(double m)
{
    static const struct {
        double unit;
        const char *name;
    } units[] = {{1e3, "km"}, {1, "m"}, {1e-2, "cm"}, {1e-3, "mm"}, {1e-6, "um"}};
    size_t i = 0;
    while (i + 1 < ARRAY_SIZE(units) && m < units[i].unit) {
        i++;
    }
    printf("%.3g %s", m / units[i].unit, units[i].name);
}

static void print_medium(const regime *r)
{
    const double *rgb = r->depth_rgb;
    const bool even = rgb[0] == rgb[1] && rgb[1] == rgb[2];
    printf("  optical depth    %.3g on average", r->optical_depth);
    if (!even) {
        printf(" (R %.3g, G %.3g, B %.3g)", rgb[0], rgb[1], rgb[2]);
    }
    printf(", %.3g along the densest axis, %.3g at most\n", r->depth_densest, r->depth_deepest);
    printf(
        "  scattering       albedo %.4g, mean cosine %.3g; %.0f %% of what has scattered does so "
        "again\n",
        r->albedo, r->g, 100 * regime_multiple(r));
    printf("  mean free path   ");
    print_length(r->mean_free_path);
    printf(" where light meets the medium; transport ");
    print_length(r->transport_mean_free_path);
    printf(",\n                   %.3g and %.3g cells of the lattice of pop (%d along the longest "
           "side)\n",
           r->mean_free_path / r->cell, r->transport_mean_free_path / r->cell,
           REGIME_LATTICE_CELLS);
    if (r->contrast > 1.001) {
        printf("  density          up to %.3g times its mean, in %.0f %% of its box\n", r->contrast,
               100 * r->fill);
    } else {
        printf("  density          even, in %.0f %% of its box\n", 100 * r->fill);
    }
    printf("  in the picture   %s%.0f %% of it, optical depth %.3g\n",
           r->camera_inside ? "the camera stands in the medium; " : "", 100 * r->view_fill,
           r->view_depth);
}

static void print_light(const regime *r)
{
    static const char *const words[REGIME_NUM_LIGHTS] = {
        "suns", "even sky", "map", "lamps", "media that emit", "surfaces that emit"};
    const char *separator = "  light            ";
    for (int i = 0; i < REGIME_NUM_LIGHTS; i++) {
        if (r->share[i] > 0) {
            printf("%s%s %.0f %%", separator, words[i], 100 * r->share[i]);
            separator = ", ";
        }
    }
    printf("%s\n", *separator == ',' ? " of the power, about" : "  light            none");
}

// Words in lines of up to 76 characters, the later ones indented.
static void print_words(const char *text)
{
    enum { WIDTH = 76, INDENT = 23 };
    size_t used = 0;
    while (*text) {
        const size_t length = strcspn(text, " ");
        if (used > 0 && used + 1 + length > WIDTH) {
            printf("\n%*s", INDENT, "");
            used = 0;
        }
        used += (size_t)printf("%s%.*s", used > 0 ? " " : "", (int)length, text);
        text += length + (text[length] == ' ');
    }
    printf("\n");
}

void info_print_regime(const regime *r)
{
    advice list[REGIME_MAX_ADVICE];
    const uint32_t count = regime_advise(r, list);
    printf("regime:\n");
    if (r->optical_depth > 0) {
        print_medium(r);
    }
    print_light(r);
    printf("methods:\n");
    for (uint32_t i = 0; i < count; i++) {
        const bool again = i > 0 && strcmp(list[i].method, list[i - 1].method) == 0;
        printf("  %-10s %-9s ", again ? "" : list[i].method, advice_level_names[list[i].level]);
        print_words(list[i].text);
        printf("%23s[%s]\n", "", list[i].source);
    }
}

// ---- as JSON ----------------------------------------------------------------------------------

static void add_text(cJSON *object, const char *name, const char *text)
{
    cJSON_AddItemToObject(object, name, text ? cJSON_CreateString(text) : cJSON_CreateNull());
}

static void add_floats(cJSON *object, const char *name, const float *values, int count)
{
    cJSON_AddItemToObject(object, name, json_floats(values, count));
}

// An index of color_grids, or null.
static void add_grid(cJSON *medium, const char *name, uint32_t slot)
{
    cJSON_AddItemToObject(medium, name, slot ? cJSON_CreateNumber(slot - 1) : cJSON_CreateNull());
}

static void add_media(cJSON *root, const tyn_scene *scene)
{
    cJSON *volumes = cJSON_AddArrayToObject(root, "volumes");
    for (uint32_t i = 0; i < scene->num_volumes; i++) {
        const tyn_volume *v = &scene->volumes[i];
        const int size[3] = {(int)v->size[0], (int)v->size[1], (int)v->size[2]};
        cJSON *volume = cJSON_CreateObject();
        add_text(volume, "name", v->name);
        cJSON_AddItemToObject(volume, "voxels", cJSON_CreateIntArray(size, 3));
        json_add_float(volume, "max_density", v->max_density);
        cJSON_AddItemToArray(volumes, volume);
    }
    cJSON *colors = cJSON_AddArrayToObject(root, "color_grids");
    for (uint32_t i = 0; i < scene->num_color_grids; i++) {
        const tyn_color_grid *g = &scene->color_grids[i];
        const int size[3] = {(int)g->size[0], (int)g->size[1], (int)g->size[2]};
        cJSON *color = cJSON_CreateObject();
        add_text(color, "name", g->name);
        cJSON_AddItemToObject(color, "voxels", cJSON_CreateIntArray(size, 3));
        cJSON_AddNumberToObject(color, "channels", g->channels);
        json_add_float(color, "max", g->max);
        cJSON_AddItemToArray(colors, color);
    }
    cJSON *media = cJSON_AddArrayToObject(root, "media");
    for (uint32_t i = 0; i < scene->num_media; i++) {
        const tyn_medium *m = &scene->media[i];
        cJSON *medium = cJSON_CreateObject();
        add_text(medium, "name", m->name);
        cJSON_AddItemToObject(medium, "volume",
                              m->volume < 0 ? cJSON_CreateNull() : cJSON_CreateNumber(m->volume));
        json_add_float(medium, "density_scale", tyn_medium_scale(m));
        add_floats(medium, "sigma_s", m->sigma_s, 3);
        add_floats(medium, "sigma_a", m->sigma_a, 3);
        for (const tyn_phase_parameter *p = tyn_phase_parameters(); p->name; p++) {
            float values[3];
            tyn_phase_get(m->phase, p, values);
            add_floats(medium, p->name, values, 3);
        }
        if (scene->num_phase_tables) { // beside lobes, -1
            int tables[3];
            for (int c = 0; c < 3; c++) {
                tables[c] = (int)m->phase[c].table - 1;
            }
            cJSON_AddItemToObject(medium, "phase_tables", cJSON_CreateIntArray(tables, 3));
        }
        add_floats(medium, "emission", m->emission, 3);
        add_grid(medium, "emission_grid", m->emission_grid);
        add_grid(medium, "radiance_grid", m->radiance_grid);
        add_grid(medium, "albedo_grid", m->albedo_grid);
        cJSON_AddItemToArray(media, medium);
    }
    cJSON *shapes = cJSON_AddArrayToObject(root, "shapes");
    for (uint32_t i = 0; i < scene->num_shapes; i++) {
        const tyn_shape *s = &scene->shapes[i];
        cJSON *shape = cJSON_CreateObject();
        add_text(shape, "kind", s->kind == TYN_SHAPE_SPHERE ? "sphere" : "box");
        cJSON_AddNumberToObject(shape, "medium", s->medium);
        add_floats(shape, "to_world", s->to_world, 16);
        cJSON *repeat = cJSON_AddArrayToObject(shape, "repeat");
        for (int a = 0; a < 3; a++) {
            cJSON_AddItemToArray(repeat, cJSON_CreateBool(s->repeat[a]));
        }
        cJSON_AddItemToArray(shapes, shape);
    }
}

static void add_lights(cJSON *root, const tyn_scene *scene)
{
    cJSON *lights = cJSON_AddArrayToObject(root, "lights");
    for (uint32_t i = 0; i < scene->num_lights; i++) {
        const tyn_light *l = &scene->lights[i];
        const tyn_light_traits *traits = tyn_light_traits_of(l->kind);
        cJSON *light = cJSON_CreateObject();
        add_text(light, "name", l->name);
        add_text(light, "kind", traits->name);
        add_floats(light, "color", l->color, 3);
        if (traits->has_position) {
            add_floats(light, "position", l->position, 3);
        }
        if (traits->has_direction) {
            add_floats(light, "direction", l->direction, 3);
        }
        cJSON_AddItemToArray(lights, light);
    }
    const tyn_environment *env = &scene->environment;
    cJSON *environment = env->present ? cJSON_CreateObject() : cJSON_CreateNull();
    if (env->present) {
        const int size[2] = {(int)env->size[0], (int)env->size[1]};
        cJSON_AddItemToObject(environment, "texels", cJSON_CreateIntArray(size, 2));
        add_floats(environment, "radiance", env->radiance, 3);
        json_add_float(environment, "strength", tyn_environment_strength(env));
    }
    cJSON_AddItemToObject(root, "environment", environment);
}

static void add_cameras(cJSON *root, const tyn_scene *scene)
{
    cJSON *cameras = cJSON_AddArrayToObject(root, "cameras");
    for (uint32_t i = 0; i < scene->num_cameras; i++) {
        const tyn_camera *c = &scene->cameras[i];
        const bool perspective = c->projection == TYN_PERSPECTIVE;
        const float along[3] = {0 - c->back[0], 0 - c->back[1], 0 - c->back[2]};
        cJSON *camera = cJSON_CreateObject();
        cJSON_AddNumberToObject(camera, "index", c->index);
        add_text(camera, "name", c->name ? c->name : c->camera_name);
        add_text(camera, "projection", perspective ? "perspective" : "orthographic");
        json_add_float(camera, perspective ? "yfov" : "ymag", perspective ? c->yfov : c->ymag);
        add_floats(camera, "position", c->position, 3);
        add_floats(camera, "direction", along, 3);
        cJSON_AddItemToArray(cameras, camera);
    }
}

static void add_methods(cJSON *root, const regime *r)
{
    advice list[REGIME_MAX_ADVICE];
    const uint32_t count = regime_advise(r, list);
    cJSON *methods = cJSON_AddArrayToObject(root, "methods");
    for (uint32_t i = 0; i < count; i++) {
        cJSON *item = cJSON_CreateObject();
        add_text(item, "method", list[i].method);
        add_text(item, "level", advice_level_names[list[i].level]);
        add_text(item, "text", list[i].text);
        add_text(item, "source", list[i].source);
        cJSON_AddItemToArray(methods, item);
    }
}

cJSON *info_json_scene(const char *path, const tyn_scene *scene, const regime *r)
{
    cJSON *root = cJSON_CreateObject();
    add_text(root, "scene", path);
    add_media(root, scene);
    cJSON *surfaces = cJSON_AddObjectToObject(root, "surfaces");
    cJSON_AddNumberToObject(surfaces, "meshes", scene->num_meshes);
    cJSON_AddNumberToObject(surfaces, "triangles", scene->surfaces.num_triangles);
    cJSON_AddNumberToObject(surfaces, "materials", scene->surfaces.num_materials);
    cJSON_AddNumberToObject(surfaces, "textures", scene->surfaces.num_textures);
    add_lights(root, scene);
    add_cameras(root, scene);
    float lo[3], hi[3];
    if (tyn_scene_bounds(scene, lo, hi)) {
        add_floats(root, "bounds_lo", lo, 3);
        add_floats(root, "bounds_hi", hi, 3);
    }
    cJSON_AddItemToObject(root, "regime", regime_json(r));
    add_methods(root, r);
    return root;
}
