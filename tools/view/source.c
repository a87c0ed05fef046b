// source.c -- where the scene comes from: the arguments, files that were dropped or written anew, a sequence.
#include "view/source.h"
#include "view/viewer.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double look_every = 0.5; // seconds, at the files

static bool is_map(const char *path)
{
    return text_ends_with(path, ".exr") || text_ends_with(path, ".hdr");
}

// ---- loading ----------------------------------------------------------------------------------

static char *numbered(const viewer *v, const char *path)
{
    return v->sequence.numbered ? sequence_path(path, v->number) : text_format("%s", path);
}

static int load(viewer *v, const scene_options *source, tyn_scene *scene)
{
    scene_options options = *source;
    const char *map = source->env ? source->env : source->environment;
    char *path = numbered(v, source->scene), *map_path = map ? numbered(v, map) : NULL;
    options.scene = path;
    if (source->env) {
        options.env = map_path;
    } else {
        options.environment = map_path;
    }
    options.number = v->sequence.numbered ? &v->number : NULL;
    tyn_scene_init(scene);
    int code = path && (map_path || !map) ? scene_open(v->app, &options, scene)
                                          : app_exit_code(v->app, TYN_ERR_MEMORY, false);
    if (code == EXIT_DONE && v->method.settings) {
        code = scene_prepare(v->app, &v->method.info, scene);
    }
    free(path);
    free(map_path);
    return code;
}

static void watch_source(viewer *v)
{
    watch_finish(&v->watch);
    if (!v->sequence.numbered) {
        const bool numbered = !isnan(v->source.frame);
        const uint32_t frame = numbered ? (uint32_t)v->source.frame : 0;
        watch_add_scene(&v->watch, v->source.scene, numbered ? &frame : NULL);
        watch_add(&v->watch, v->source.env ? v->source.env : v->source.environment);
    }
}

// Pictures of a sequence keep what the user set, and what a volume was given to be looked at.
static void keep_numbers(const viewer *v, tyn_scene *scene)
{
    const tyn_scene *old = &v->scene;
    const bool keep = v->edited || tyn_is_volume(v->source.scene);
    for (uint32_t i = 0; keep && i < scene->num_media && i < old->num_media; i++) {
        tyn_medium *m = &scene->media[i];
        memcpy(m->sigma_s, old->media[i].sigma_s, sizeof m->sigma_s);
        memcpy(m->sigma_a, old->media[i].sigma_a, sizeof m->sigma_a);
        memcpy(m->phase, old->media[i].phase, sizeof m->phase);
        m->density_scale = old->media[i].density_scale;
    }
    for (uint32_t i = 0; v->edited && i < scene->num_lights && i < old->num_lights; i++) {
        memcpy(scene->lights[i].color, old->lights[i].color, sizeof old->lights[i].color);
        memcpy(scene->lights[i].direction, old->lights[i].direction,
               sizeof old->lights[i].direction);
    }
    if (v->edited && old->environment.present) {
        scene->environment.strength = old->environment.strength;
        memcpy(scene->environment.rotation, old->environment.rotation,
               sizeof old->environment.rotation);
    }
}

static void take(viewer *v, tyn_scene *scene, bool another_picture)
{
    const tyn_scene loaded = *scene;
    if (another_picture) {
        keep_numbers(v, scene);
    } else {
        v->edited = false;
    }
    tyn_scene_finish(&v->scene);
    v->scene = *scene;
    v->loaded = loaded;
    if (!another_picture) {
        controls_reset(v);
        pictures_forget(v);
    }
    viewer_touch(v);
}

int source_open(viewer *v)
{
    if (!sequence_parse(v->args->frames, &v->sequence) || (v->args->frames && v->sequence.repeat)) {
        app_error(v->app, "--frames: '%s' is not a range A-B, up to 100000", v->args->frames);
        return EXIT_WRONG;
    }
    v->number = v->sequence.first;
    v->playing = v->sequence.numbered;
    const int code = load(v, &v->source, &v->scene);
    v->loaded = v->scene;
    watch_source(v);
    return code;
}

void source_close(viewer *v)
{
    watch_finish(&v->watch);
    free(v->scene_path);
    free(v->environment_path);
    tyn_scene_finish(&v->scene);
}

// ---- other scenes -----------------------------------------------------------------------------

static bool replace(viewer *v, const scene_options *source, bool another_picture)
{
    tyn_scene scene;
    v->asked_at = app_seconds();
    if (load(v, source, &scene) != EXIT_DONE) {
        tyn_scene_finish(&scene);
        viewer_note(v, "%s", v->app->last_error);
        return false;
    }
    take(v, &scene, another_picture);
    return true;
}

void source_drop(viewer *v, const char *path)
{
    scene_options source = v->source;
    char *copy = text_format("%s", path);
    const bool map = is_map(path), played = v->sequence.numbered;
    if (!copy) {
        return;
    }
    if (map) {
        source.env = NULL;
        source.environment = copy;
    } else {
        source.scene = copy;
        source.frame = NAN;
        v->sequence.numbered = false; // and stays it if the scene can be read
    }
    if (!replace(v, &source, false)) {
        v->sequence.numbered = played;
        free(copy);
        return;
    }
    char **owner = map ? &v->environment_path : &v->scene_path;
    free(*owner);
    *owner = copy;
    v->source = source;
    watch_source(v);
    viewer_note(v, "%s", path);
    if (!map) {
        viewer_frame_scene(v);
    }
}

static void play(viewer *v, double now)
{
    if (!v->sequence.numbered || !v->playing || now < v->next_picture) {
        return;
    }
    v->next_picture = now + 1 / v->args->fps;
    source_turn_to(v, v->number == v->sequence.last ? v->sequence.first : v->number + 1);
}

void source_turn_to(viewer *v, uint32_t number)
{
    if (!v->sequence.numbered || number < v->sequence.first || number > v->sequence.last) {
        return;
    }
    const uint32_t old = v->number;
    v->number = number;
    if (replace(v, &v->source, true)) {
        v->view.time_index = number;
    } else {
        v->number = old;
        v->playing = false;
    }
}

void source_step(viewer *v)
{
    const double now = app_seconds();
    play(v, now);
    if (now - v->last_look > look_every) {
        v->last_look = now;
        if (watch_look(&v->watch) && replace(v, &v->source, false)) {
            watch_source(v);
            viewer_note(v, "%s was read again", v->source.scene);
        }
    }
}
