// viewer.h -- all that the viewer holds, and what its parts ask of each other.
#pragma once
#include "scene_setup.h"
#include "sequence.h"
#include "view/camera_control.h"
#include "view/layers.h"
#include "view/picture.h"
#include "view/rendering.h"
#include "view/run.h"
#include "view/surface.h"
#include "view/view_args.h"

typedef struct viewer_stats {
    double moving_seconds, rest_seconds; // between pictures shown
    uint32_t moving_frames, rest_frames; // pictures shown
    double sharp_ms;   // the last picture at rest: from the end of the movement until it was shown
    uint32_t num_lost; // devices
} viewer_stats;

typedef struct viewer {
    app *app;
    const view_args *args;

    GLFWwindow *window;
    gpu gpu;
    surface surface;
    picture picture;
    VkDescriptorPool panel_pool;

    // What is shown.
    scene_options source;
    char *scene_path, *environment_path; // of what was dropped; NULL: as the arguments say
    tyn_scene scene, loaded; // as edited; `loaded` has the numbers of the file and owns nothing
    camera_control camera, first_camera;
    method_options how;
    method method;
    uint32_t method_index, quality; // in the registry; in viewer_qualities
    tyn_view view;                  // size of the window, seed, depths
    uint32_t layer;                 // in the table of layers

    rendering rest, moving; // at the window's size; smaller, for while something moves
    uint32_t divisor;       // of the window's size, for the smaller one
    bool has_picture;
    bool sharp;         // the picture is at the window's size and of what is asked for
    bool outdated;      // something changed since the last picture
    double last_change; // seconds
    float *pixels;      // of the sharp picture, radiance, four floats a pixel
    uint32_t pixels_width, pixels_height;
    float low, high; // of the layer's values

    float exposure;
    int curve;                                    // PICTURE_CURVE_*
    float light_strength[TYN_MAX_LIGHTS];         // times that of the file
    float environment_strength, environment_turn; // times that of the file; degrees about +Y
    float density[TYN_MAX_MEDIA],
        albedo[TYN_MAX_MEDIA][3]; // times that of the file; of each medium
    bool show_panel, turntable;
    double mouse[2];      // pixels
    bool dragging, woken; // the buttons are for the picture, not the panel; something came in
    double last_frame;    // seconds
    double last_shown;    // a picture
    bool last_was_moving;
    viewer_stats stats;
    char note[512]; // the newest of what happened, for the panel
} viewer;

extern const char *const viewer_qualities[]; // NULL-terminated
enum { VIEWER_NORMAL = 1 };                  // its place there

// Something changed: a smaller picture follows at once and a sharp one when it rests.
void viewer_touch(viewer *v);
void viewer_note(viewer *v, const char *format, ...) TYN_PRINTF(2, 3);
// An old method stays if the new one cannot be made.
void viewer_set_method(viewer *v, uint32_t index);
void viewer_set_quality(viewer *v, uint32_t index);
void viewer_set_layer(viewer *v, uint32_t layer);
float viewer_aspect(const viewer *v);

// input.c
void input_open(viewer *v);                 // before the panel
void input_step(viewer *v, double seconds); // keys that are held

// controls.c: the widgets of the panel.
void controls_draw(viewer *v);
void controls_reset(viewer *v); // the scene is another

// pictures.c: what the method is asked for, and when.
void pictures_step(viewer *v);
bool pictures_working(const viewer *v); // something is to be computed now, or soon
void pictures_args(const viewer *v, struct picture_args *args);
void pictures_close(viewer *v);
