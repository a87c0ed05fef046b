// context.h -- what a context keeps, and the way of a frame through it: check, build, upload, declare, record.
#pragma once
#include <tyndall/context.h>
#include <tyndall/extend/method.h>
#include "frame/frame_scene.h"
#include "graph/graph.h"
#include "scene/env_suns.h"

enum { MAX_WARNINGS = 32, MAX_IN_FLIGHT = 8 };

// Of an image that a picture is gone on from.
typedef struct tyn_resumed_image {
    const float *texels; // RGBA, the caller's; read while a frame is prepared or recorded
    size_t size;         // bytes
} tyn_resumed_image;

struct tyn_context {
    tyn_device *dev;
    const tyn_method *method;
    tyn_settings *settings;
    bool readback;
    const char *inspect; // pass to look at; NULL = none
    tyn_graph *graph;
    // What the last declaration was made from; the graph reads it until it has recorded.
    tyn_frame_scene frame;
    tyn_atlas atlas, colors;
    const tyn_scene *scene;
    float (*points)[3]; // probe points in M
    uint32_t num_points;
    uint32_t outputs;
    uint64_t sizes; // tyn_frame_sizes of what was prepared last; 0 = nothing
    // The environment's tables, made again when its texels change.
    uint64_t env_hash;
    uint64_t grid_hash; // of the grid that the two below were found for
    uint32_t open_faces;
    float mean_density, typical_density;
    uint64_t checked_data; // hash of the densities and texels that were found fit
    tyn_map_light map_light;
    void *env_cdf;          // of a method that reads it
    float (*phase_rows)[4]; // tables of phase functions, as shaders read them
    uint64_t phase_hash;    // of the tables that they are of; 0: none
    tyn_surface_data surfaces;
    tyn_resumed_image resumed[6]; // tyn_view.resume
    // Records that have added samples to the picture, by their number (tyn_graph_records).
    struct {
        uint64_t number;
        uint32_t samples;
    } sampled[MAX_IN_FLIGHT];
    char *warnings[MAX_WARNINGS];
    uint32_t num_warnings;
    uint64_t logged[MAX_WARNINGS]; // hashes of those that went to the log: once each
    uint32_t num_logged;
    tyn_node_report *nodes; // of the last report
    tyn_balance balance;
};

// Each step is a file of its name; what is wrong is one log line.

// sizes.c: identifies what of a declared frame must be as it was prepared; what differs beside it is a value.
uint64_t tyn_frame_sizes(const tyn_context *ctx, const tyn_frame *frame);
// phases.c: what the method knows of the scene's phase functions, in ctx->frame.
tyn_result tyn_frame_phases(tyn_context *ctx, const tyn_scene *scene);
uint64_t tyn_phase_tables_hash(const tyn_scene *scene); // 0: there are none
// check.c: are the frame's numbers fit?
tyn_result tyn_frame_check(const tyn_context *ctx, const tyn_frame *frame);
uint32_t tyn_frame_most_pixels(const tyn_device *dev); // along a side of a picture
// check_images.c: are the images fit that the host lends? Of a frame whose scene is.
tyn_result tyn_frame_check_images(const tyn_context *ctx, const tyn_frame *frame, uint32_t outputs);
// ... and have those a content that are read? Of a frame that has been declared and is to be recorded.
tyn_result tyn_frame_check_content(const tyn_context *ctx, const tyn_frame *frame);
// build.c: the frame's scene in M and tables of it, made anew where they have changed, and the job without its refs.
tyn_result tyn_frame_build(tyn_context *ctx, const tyn_frame *frame, tyn_job *job);
// upload.c: what shaders read of the scene, as resources of the graph.
void tyn_frame_upload(tyn_context *ctx, const tyn_frame *frame, tyn_scene_refs *refs);
// declare.c: all of these, and then the method's nodes.
tyn_result tyn_frame_declare(tyn_context *ctx, const tyn_frame *frame);

// pace.c: notes the samples of the frame that was recorded last; and gives the milliseconds of a sample of the view's picture by
// the newest finished record, and how many that had. 0: there is none.
void tyn_frame_sampled(tyn_context *ctx, const tyn_frame *frame);
double tyn_frame_sample_ms(tyn_context *ctx, const tyn_view *view, uint32_t *samples);

// A line among the report's warnings, once each; `user` is the context.
void tyn_context_warn(void *user, const char *line);
void tyn_context_clear_warnings(tyn_context *ctx);
