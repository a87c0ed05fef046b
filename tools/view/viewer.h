// viewer.h -- all that the viewer holds, and what its parts ask of each other.
#pragma once
#include "layers.h"
#include "scene_setup.h"
#include "sequence.h"
#include "view/camera_control.h"
#include "view/comparison.h"
#include "view/estimate.h"
#include "view/picture.h"
#include "view/probe_point.h"
#include "view/rebuild.h"
#include "view/rendering.h"
#include "view/resolution.h"
#include "view/run.h"
#include "view/source.h"
#include "view/surface.h"
#include "view/view_args.h"
#include "view/watch.h"

// What the device computes. One frame is under way at a time.
typedef enum viewer_task {
    TASK_NONE = 0,
    TASK_SMALL,     // a picture while something moves, or the first of a method
    TASK_REST,      // a sharper one
    TASK_SAMPLES,   // more of its samples
    TASK_REFERENCE, // samples of the reference
} viewer_task;

typedef struct viewer_stats {
    double moving_seconds, rest_seconds; // between pictures shown
    uint32_t moving_frames, rest_frames; // pictures shown
    uint32_t most_pending;               // kernels
    double sharp_ms; // the last picture at rest: from the end of the movement until it was shown
    double
        first_ms; // the first picture after the last change of method: from the change until it was shown
    double deaf_ms;    // the longest time in which the window did not look for events
    uint32_t num_lost; // devices
} viewer_stats;

struct viewer {
    app *app;
    const view_args *args;

    GLFWwindow *window;
    char *title, *said; // of the window: the scene's; what it says now, NULL: the scene's
    gpu gpu, library;   // for the window; for the library
    surface surface;
    picture picture;
    VkDescriptorPool panel_pool;

    // What is shown.
    scene_options source;
    char *scene_path, *environment_path; // of what was dropped; NULL: as the arguments say
    tyn_scene scene, loaded; // as edited; `loaded` has the numbers of the file and owns nothing
    bool edited;             // in the panel
    watch watch;
    rebuild rebuild;
    double last_look; // at the files, seconds
    sequence sequence;
    uint32_t number; // of the picture of the sequence
    bool playing;
    double next_picture; // seconds
    camera_control camera, first_camera;
    method_options how;
    method method;
    uint32_t method_index, quality; // in the registry; in viewer_qualities
    tyn_view view;                  // size of the window, seed, depths
    uint32_t layer;                 // in the table of layers

    rendering rest, moving; // as sharp as may be; smaller, for while something moves
    rendering retired;      // of an earlier method, its last frame under way; else closed
    rendering *busy;        // whose frame is under way; NULL: none is
    viewer_task task;       // what for
    viewer_task last_task;  // what the last one begun was for
    uint32_t task_divisor;
    resolution small;          // the size while something moves
    uint32_t rest_divisor;     // of the first picture at rest; 0: not known
    uint32_t rest_next;        // of the one that sharpens it; 0: none does
    uint32_t rest_shown;       // of the picture at rest that is shown
    resolution_cost rest_cost; // of that
    const rendering *shown;    // the one whose picture is shown; NULL: none
    bool whole;                // the next one has the window's size, whatever it takes
    bool fresh;                // nothing of the method, or the scene, is shown yet
    double asked_at;           // the method, or the scene; seconds
    bool has_picture;
    bool sharp;         // the picture is of what is asked for, as sharp as it gets at rest
    bool outdated;      // something changed since the last picture was begun
    double last_change; // seconds
    comparison comparison;
    probe_point probe;
    estimate estimate;
    bool save_wanted; // when the picture is sharp
    float *pixels;    // of the sharp picture, radiance, four floats a pixel
    uint32_t pixels_width, pixels_height;
    float low, high; // of the layer's values

    float exposure;
    int curve;                                    // PICTURE_CURVE_*
    float light_strength[TYN_MAX_LIGHTS];         // times that of the file
    float environment_strength, environment_turn; // times that of the file; degrees about +Y
    float density[TYN_MAX_MEDIA],
        albedo[TYN_MAX_MEDIA][3]; // times that of the file; of each medium
    bool show_panel, turntable;
    double mouse[2]; // pixels of the picture
    bool splitting;  // the line between method and reference is dragged
    bool dragging,
        woken;         // the buttons are for the picture, not the panel; the window is to be drawn
    double last_frame; // seconds: looked for events
    double last_drawn; // the window
    double last_shown; // a picture
    bool last_was_moving;
    viewer_stats stats;
    char note[512]; // the newest of what happened, for the panel
};

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

void viewer_frame_scene(viewer *v); // the camera to the scene's own, or so that all is seen

// input.c
void input_open(viewer *v); // before the panel
// The window in the units of the pointer and of the panel, which are not pixels on every screen.
void input_window_size(const viewer *v, float *width, float *height);
void input_step(viewer *v, double seconds); // keys that are held

// controls.c: the widgets of the panel.
void controls_draw(viewer *v);
void controls_draw_marks(const viewer *v); // over the picture
void controls_reset(viewer *v);            // the scene is another

// pictures.c: what the method is asked for, and when.
void pictures_step(viewer *v);
// Waits for the frame under way, `seconds` at most. False: it still is.
bool pictures_wait(viewer *v, double seconds);
bool pictures_computing(const viewer *v); // a frame is under way
// What it is, for the title and the panel: "drawing 640x480, 3 s"; empty within the first half second.
void pictures_say(const viewer *v, char *text, size_t size);
bool pictures_working(const viewer *v);     // something is to be computed now, or soon
uint32_t pictures_pending(const viewer *v); // kernels that pictures wait for
bool pictures_show(viewer *v, const rendering *r, picture_slot slot); // the layer of its last frame
enum { VIEWER_SAMPLES = 4096 }; // a pixel, where nothing is said
uint32_t pictures_samples_wanted(const viewer *v);
void pictures_args(const viewer *v, struct picture_args *args);
// Does the method make it, and can it be looked at? `layer`: in picture_layers.
bool pictures_has_layer(const viewer *v, uint32_t layer);
uint32_t pictures_next_layer(const viewer *v); // of those after the one that is shown
// The method or the scene is another: what pictures take is not known any more.
void pictures_forget(viewer *v);
void pictures_close(viewer *v); // a frame under way goes on, and is closed when it is done
// A rendering that is not needed any more; so for each.
void pictures_retire(viewer *v, rendering *r);

// comparison.c
void comparison_toggle(viewer *v);
void comparison_close(viewer *v);
bool comparison_working(const viewer *v);
bool comparison_seen(const viewer *v); // there is something of it to show
rendering_state comparison_begin(viewer *v, const tyn_view *view); // more samples of the reference
void comparison_take(viewer *v);                                   // they are computed
void comparison_fail(viewer *v);
// The error says something about the method: it is clearly more than the noise of the reference explains.
bool comparison_tells(const comparison *c);

// probe_point.c
void probe_place(viewer *v); // under the pointer
void probe_remove(viewer *v);
void probe_ask(const viewer *v, tyn_view *view); // for what it needs of a sharp picture
void probe_take(viewer *v, const rendering *r);  // what that gave

// estimate.c: as the method tells it, of pictures at rest while the panel is there.
bool estimate_told(const viewer *v);
void estimate_ask(const viewer *v, tyn_view *view); // for the layers
// `more`: the picture is the last one with more samples.
void estimate_take(viewer *v, const rendering *r, bool more);
bool estimate_missing(const viewer *v); // of the samples that there are
// In the curve: eight for each doubling of the samples, as all pixels are read for one.
uint32_t estimate_place(uint32_t samples);

// save.c
void save_picture(viewer *v); // the sharp picture
