// fog_host.h -- a host with a device of its own and one scene, fog in a box and a sun; its cameras and their matrices.
#pragma once
#include <tyndall/context.h>
#include <tyndall/registry.h>

#include "host.h"

enum { WIDTH = 64, HEIGHT = 48, PIXELS = WIDTH * HEIGHT };

typedef struct fixture {
    host host;
    tyn_device *dev;
    tyn_settings *settings;
    int lines; // of level error
    char last_line[256];
} fixture;

int set_up(void **state);
int tear_down(void **state);
tyn_context *new_context(fixture *f, const char *method);

// A box of 2 x 2 x 2 m of fog about the origin, turned about y, and a sun.
void make_scene(tyn_scene *scene);
tyn_camera make_camera(bool orthographic);
tyn_view make_view(uint32_t outputs);
// The camera's matrices; `unit`: metres in a unit of view space.
void set_world_to_view(tyn_frame *frame, const tyn_camera *c, float unit);
enum { NEAR_FAR, REVERSED_INFINITE };
void set_view_to_clip(tyn_frame *frame, const tyn_camera *c, float aspect, int depth);

// ---- cases of the test `outputs`, which is in more than one file --------------------------------

// views.c
void matrices(void **state);
void jitter(void **state);
void bad_views(void **state);
// laid_over.c
void depth_under_matrices(void **state);
void half_resolution(void **state);
void depth_with_stencil(void **state);
void refined_without_depth(void **state);
