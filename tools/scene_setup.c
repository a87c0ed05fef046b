// scene_setup.c -- SCENE and the options that change it: coefficients, environment, camera, size.
#include "scene_setup.h"
#include "sequence.h"
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tyndall/io.h>

static const char *const light_units[] = {"radiometric", "photometric", NULL};

#define SCENE_AT(field) offsetof(scene_options, field)
const option scene_table[SCENE_TABLE_SIZE] = {
    {0, "env", OPT_TEXT, SCENE_AT(env), "FILE", "replace the scene's environment (.exr, .hdr)",
     .file = OPT_READS},
    {0, "env-rotate", OPT_NUMBER, SCENE_AT(env_rotate), "DEG",
     "turn the environment about +Y, right-handed", 0},
    {0, "env-strength", OPT_NUMBER, SCENE_AT(env_strength), "S", "multiply the environment", 1, 0,
     1e9},
    {0, "sigma-s", OPT_COLOR, SCENE_AT(sigma_s), "R,G,B", "scattering of every medium, 1/m"},
    {0, "sigma-a", OPT_COLOR, SCENE_AT(sigma_a), "R,G,B", "absorption of every medium, 1/m"},
    {0, "g", OPT_COLOR, SCENE_AT(g), "R,G,B",
     "Henyey-Greenstein mean cosine of every medium, -1 to 1"},
    {0, "albedo", OPT_COLOR, SCENE_AT(albedo), "R,G,B",
     "albedo of every medium, 0 to 1; last, keeping sigma_s + sigma_a"},
    {0, "density-scale", OPT_NUMBER, SCENE_AT(density_scale), "S", "multiply every density", NAN, 0,
     1e30},
    {0, "frame", OPT_NUMBER, SCENE_AT(frame), "N",
     "picture N of a sequence: the number for %04d or #### in names of files", NAN, 0, 100000},
    {0, "time", OPT_NUMBER, SCENE_AT(time), "S",
     "where a glTF file's animations put nodes and cameras after S seconds; else picture N of a "
     "sequence is at N / fps",
     NAN, -1e6, 1e6},
    {0, "fps", OPT_NUMBER, SCENE_AT(fps), "F", "pictures a second of a sequence", 24, 1e-3, 1e6},
    {0, "light-units", OPT_TEXT, SCENE_AT(light_units), "radiometric|photometric",
     "what a glTF file's lights are given in: W/m^2 and W/sr, or lux and candela (683 lm/W); else "
     "what it says of its generator: watts without one; surfaces emit in W/(m^2 sr) in either",
     .names = light_units},
};

#define VIEW_AT(field) offsetof(view_options, field)
const option view_table[VIEW_TABLE_SIZE] = {
    {0, "size", OPT_SIZE, VIEW_AT(size), "WxH",
     "pixels; else height 512, width from the camera's aspect ratio, else 16:9"},
    {0, "camera", OPT_TEXT, VIEW_AT(camera), "NAME|INDEX",
     "which camera: index, name of its node, name of the camera; else the first"},
    {0, "fov", OPT_NUMBER, VIEW_AT(fov), "DEG", "vertical field of view", NAN, 1e-3, 179.9},
    {0, "look-from", OPT_VECTOR, VIEW_AT(look_from), "X,Y,Z", "position of the camera, m"},
    {0, "look-at", OPT_VECTOR, VIEW_AT(look_at), "X,Y,Z",
     "what it looks at, m; up is +Y, -Z if parallel"},
};

// ---- the scene --------------------------------------------------------------------------------

// The rotation by `degrees` about +Y after `q` (x, y, z, w; all zero = identity).
static void rotate_about_y(float q[4], float degrees)
{
    const double half = degrees * 3.14159265358979323846 / 360, s = sin(half), c = cos(half);
    bool zero = q[0] == 0 && q[1] == 0 && q[2] == 0 && q[3] == 0;
    const double x = q[0], y = q[1], z = q[2], w = zero ? 1 : q[3];
    q[0] = (float)(c * x + s * z); // (0, s, 0, c) * (x, y, z, w)
    q[1] = (float)(c * y + s * w);
    q[2] = (float)(c * z - s * x);
    q[3] = (float)(c * w - s * y);
}

static void change_environment(app *a, const scene_options *options, tyn_environment *env)
{
    bool changed = options->env_rotate != 0 || options->env_strength != 1;
    if (changed && !env->present) {
        app_warn(a, "--env-rotate and --env-strength change nothing: the scene has no environment");
        return;
    }
    if (options->env_rotate != 0) {
        rotate_about_y(env->rotation, options->env_rotate);
    }
    env->strength = tyn_environment_strength(env) * options->env_strength;
    for (int c = 0; c < 3 && options->env_strength == 0; c++) {
        env->radiance[c] = 0; // a strength of 0 is one that is not given
    }
}

static const float *given(const opt_vector *v)
{
    return v->given ? v->v : NULL;
}

static tyn_result load(app *a, const scene_options *options, const char *environment,
                       tyn_scene *scene)
{
    tyn_moment moment = {.timed = !isnan(options->time), .seconds = (double)options->time};
    if (options->number || !isnan(options->frame)) {
        moment.numbered = true;
        moment.frame = options->number ? *options->number : (uint32_t)options->frame;
    }
    if (moment.numbered && !moment.timed) {
        moment.timed = true;
        moment.seconds = moment.frame / (double)options->fps;
    }
    if (options->number || !moment.numbered) { // names have their numbers, or none
        return tyn_scene_load_moment(scene, options->scene, environment, &moment, &a->log);
    }
    const uint32_t number = moment.frame;
    char *file = sequence_path(options->scene, number);
    char *map = environment ? sequence_path(environment, number) : NULL;
    tyn_result result = file && (map || !environment)
                            ? tyn_scene_load_moment(scene, file, map, &moment, &a->log)
                            : TYN_ERR_MEMORY;
    free(file);
    free(map);
    return result;
}

static bool scene_emits(const tyn_scene *scene)
{
    for (uint32_t i = 0; i < scene->surfaces.num_materials; i++) {
        const float *e = scene->surfaces.materials[i].emission;
        if (e[0] + e[1] + e[2] > 0) {
            return true;
        }
    }
    return false;
}

// Which units were taken, where that is not what the library computes with.
static void choose_light_units(app *a, const char *units, tyn_scene *scene)
{
    if (units) {
        tyn_scene_take_lights_as(scene, strcmp(units, light_units[1]) == 0
                                            ? TYN_LIGHTS_PHOTOMETRIC
                                            : TYN_LIGHTS_RADIOMETRIC);
    } else if (scene->num_lights && scene->light_units == TYN_LIGHTS_PHOTOMETRIC) {
        app_note(
            a,
            "lights are taken in lux and candela, 683 lm to the watt, as '%.100s' writes them; "
            "if they are in watts: --light-units radiometric%s",
            scene->generator ? scene->generator : "",
            scene_emits(scene) ? "; surfaces emit in W/(m^2 sr) all the same" : "");
    }
}

int scene_open(app *a, const scene_options *options, tyn_scene *scene)
{
    tyn_scene_init(scene);
    if (options->env && options->environment) {
        app_error(a, "the environment is given twice: '%s' and --env '%s'", options->environment,
                  options->env);
        return EXIT_WRONG;
    }
    const char *environment = options->env ? options->env : options->environment;
    progress_start(&a->bar, "loading", a->quiet);
    tyn_result result = load(a, options, environment, scene);
    progress_stop(&a->bar);
    if (result != TYN_OK) {
        return app_exit_code(a, result, true);
    }
    for (uint32_t i = 0; i < scene->num_warnings; i++) {
        app_warn(a, "%s", scene->warnings[i]);
    }
    choose_light_units(a, options->light_units, scene);
    change_environment(a, options, &scene->environment);
    const tyn_medium_override override = {
        .sigma_s = given(&options->sigma_s),
        .sigma_a = given(&options->sigma_a),
        .g = given(&options->g),
        .albedo = given(&options->albedo),
        .density_scale = isnan(options->density_scale) ? 0 : options->density_scale,
    };
    result = tyn_scene_override(scene, &override, &a->log);
    for (uint32_t i = 0; i < scene->num_media && options->density_scale == 0; i++) {
        tyn_medium_clear(&scene->media[i]); // the override takes 0 for "not given"
    }
    if (result == TYN_OK) {
        result = tyn_scene_check(scene, &a->log);
    }
    return app_exit_code(a, result, true);
}

int scene_prepare(app *a, const tyn_method_info *method, tyn_scene *scene)
{
    tyn_surfaces *surfaces = &scene->surfaces;
    if (surfaces->nodes) {
        return EXIT_DONE;
    }
    // Other methods are better for one, and say so where there is none.
    const tyn_log nobody = {0};
    tyn_result result = tyn_surfaces_build_nodes(surfaces, method->traces_rays ? &a->log : &nobody);
    return method->traces_rays ? app_exit_code(a, result, true) : EXIT_DONE;
}

// ---- the camera -------------------------------------------------------------------------------

static bool same_name(const char *a, const char *b)
{
    return a && strcmp(a, b) == 0;
}

// INDEX|NAME -> index into scene->cameras, or -1. A number is an index into the file's list where that
// has one which a node uses.
static int find_camera(const tyn_scene *scene, const char *name)
{
    char *end;
    unsigned long index = strtoul(name, &end, 10);
    bool number = isdigit((unsigned char)*name) && *end == '\0';
    for (uint32_t i = 0; number && i < scene->num_cameras; i++) {
        if (scene->cameras[i].index == index) {
            return (int)i;
        }
    }
    for (uint32_t i = 0; i < scene->num_cameras; i++) {
        if (same_name(scene->cameras[i].name, name)) {
            return (int)i;
        }
    }
    for (uint32_t i = 0; i < scene->num_cameras; i++) {
        if (same_name(scene->cameras[i].camera_name, name)) {
            return (int)i;
        }
    }
    return -1;
}

static void say_which_cameras(app *a, const tyn_scene *scene, const char *name)
{
    char line[1024] = " none";
    size_t used = 0;
    for (uint32_t i = 0; i < scene->num_cameras && used < sizeof line; i++) {
        const tyn_camera *c = &scene->cameras[i];
        const char *title = c->name ? c->name : c->camera_name ? c->camera_name : "";
        used += (size_t)snprintf(line + used, sizeof line - used, "%s %u '%s'", i ? "," : "",
                                 c->index, title);
    }
    app_error(a, "%s: there is no camera '%s'; the scene has:%s", app_word(a, "--camera", "camera"),
              name, line);
}

// The options' camera position and target; where one is missing, the camera's own position and the
// middle of the scene.
static tyn_result aim(app *a, const view_options *options, const tyn_scene *scene,
                      tyn_camera *camera)
{
    float lo[3], hi[3], from[3], at[3];
    tyn_scene_bounds(scene, lo, hi);
    for (int i = 0; i < 3; i++) {
        from[i] = options->look_from.given ? options->look_from.v[i] : camera->position[i];
        at[i] = options->look_at.given ? options->look_at.v[i] : 0.5f * (lo[i] + hi[i]);
    }
    tyn_result result = tyn_camera_look_at(camera, from, at);
    if (result != TYN_OK) {
        app_error(a, "%s: %g,%g,%g and %g,%g,%g do not give a direction",
                  app_word(a, "--look-from and --look-at", "look_from and look_at"), from[0],
                  from[1], from[2], at[0], at[1], at[2]);
    }
    return result;
}

int view_setup(app *a, const view_options *options, const tyn_scene *scene, tyn_view *view)
{
    if (scene->num_cameras > 0) {
        int index = options->camera ? find_camera(scene, options->camera) : 0;
        if (index < 0) {
            say_which_cameras(a, scene, options->camera);
            return EXIT_WRONG;
        }
        view->camera = scene->cameras[index];
    } else if (options->camera && strcmp(options->camera, "0") != 0) {
        say_which_cameras(a, scene, options->camera);
        return EXIT_WRONG;
    } else {
        tyn_camera_frame_scene(&view->camera, scene);
    }
    if (!isnan(options->fov)) {
        if (view->camera.projection != TYN_PERSPECTIVE) {
            app_error(a, "%s: the camera is orthographic and has no field of view",
                      app_word(a, "--fov", "fov"));
            return EXIT_WRONG;
        }
        view->camera.yfov = options->fov * 3.14159265f / 180;
    }
    if ((options->look_from.given || options->look_at.given) &&
        aim(a, options, scene, &view->camera) != TYN_OK) {
        return EXIT_WRONG;
    }
    if (options->size.width) {
        view->width = options->size.width;
        view->height = options->size.height;
    } else {
        float aspect = view->camera.aspect > 0 ? view->camera.aspect : 16.0f / 9;
        view->height = 512;
        view->width = (uint32_t)fminf(fmaxf(roundf(512 * aspect), 1), 16384);
    }
    return EXIT_DONE;
}
