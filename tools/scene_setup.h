// scene_setup.h -- SCENE and the options that change it: coefficients, environment, camera, size.
#pragma once
#include "app.h"
#include <tyndall/context.h>
#include <tyndall/io.h>
#include <tyndall/registry.h>

typedef struct scene_options {
    const char *scene, *environment; // positional
    const char *env;
    const char *light_units; // NULL: what the file says of its generator
    float env_rotate, env_strength;
    opt_vector sigma_s, sigma_a, g, albedo;
    float density_scale;
    float frame; // NAN: not given
    float time;  // s; NAN: not given
    float fps;   // of numbered pictures
    // Of a picture of a sequence, for the files that a scene names; NULL: none.
    const uint32_t *number;
} scene_options;
extern const option scene_table[];
enum { SCENE_TABLE_SIZE = 12 };
#define SCENE_POSITIONALS(args, member)                                                            \
    {"SCENE", "a scene or a volume: .gltf, .glb" TYN_VOLUME_ENDINGS, true,                         \
     offsetof(args, member.scene)},                                                                \
    {                                                                                              \
        "ENVIRONMENT", "a latitude-longitude map (.exr, .hdr), as --env", false,                   \
            offsetof(args, member.environment)                                                     \
    }

typedef struct view_options {
    opt_size size;
    const char *camera;
    float fov;
    opt_vector look_from, look_at;
} view_options;
extern const option view_table[];
enum { VIEW_TABLE_SIZE = 5 };

// Loads and changes the scene. Gives the exit code; tyn_scene_finish is due in any case.
int scene_open(app *a, const scene_options *options, tyn_scene *scene);

// Builds a hierarchy of the scene's surfaces; without one methods that trace rays are refused. Gives the exit
// code.
int scene_prepare(app *a, const tyn_method_info *method, tyn_scene *scene);

// Fills camera, width and height.
int view_setup(app *a, const view_options *options, const tyn_scene *scene, tyn_view *view);
