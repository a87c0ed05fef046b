// job.h -- what a method is asked for in a frame, and helpers for it. Tier 6.
//
// A method turns a job into graph nodes. It is called for every frame and must be cheap and deterministic: no GPU calls, no
// allocation.
#pragma once
#include "../registry.h"
#include "frame_scene.h"
#include "refs.h"

#ifdef __cplusplus
extern "C" {
#endif

// Resources every method starts from; a {0} ref does not exist in this scene.
typedef struct tyn_scene_refs {
    tyn_ref atlas;       // 3D R16F or R32F, all density grids (sampled)
    tyn_ref colors;      // 3D RGBA16F or RGBA32F, all grids of colours; {0} without
    tyn_ref medium;      // struct medium_block
    tyn_ref shapes;      // struct shape_block[]
    tyn_ref lights;      // struct light_block[]: tyn_lights.scene
    tyn_ref suns;        // struct light_block[]: tyn_lights.suns
    tyn_ref camera;      // struct camera_block
    tyn_ref environment; // struct env_block
    tyn_ref env_map;     // 2D RGBA32F; {0} if constant
    tyn_ref env_cdf;     // its alias table; {0} if constant or not read (tyn_method.reads_env_cdf)
    tyn_geometry_refs geometry;  // {0} without surfaces, as the next
    tyn_material_refs materials; // textures and texels: one at least
    tyn_ref emitters; // struct surface_table and cells; {0} if nothing emits, or if it is not read
    tyn_ref areas;    // the same; {0} but for BALANCE
    tyn_ref points;   // PROBE: vec3 in M, scalar
    tyn_ref depth;    // COMPOSITE: host depth, as large as the view
    tyn_ref color;    // COMPOSITE: host colour, as large as the view or twice that
    tyn_ref
        full_depth; // COMPOSITE: host depth as large as a colour image of twice the view; else {0}
    tyn_ref images[3]; // host images for RADIANCE, TRANSMITTANCE, DEPTH: tyn_job_output fills them
    tyn_ref light[3];  // LIGHT: host images of red, green and blue
    // Where a hook has put another in the place of `camera`, one that sees all of the media: that of the picture. Else {0}.
    tyn_ref shown_camera;
    // Tables of phase functions (phase_table.glsl); {0}: every phase function is one lobe.
    tyn_ref phases;
    // Light that has scattered, red, green and blue: 3D images over the media's box of fluence (x) and net flux along M's axes, W/m^2.
    // Paths of view.max_depth scatterings end in it; {0}: they end in the dark.
    tyn_ref field[3];
    // What paths are guided by: fluence and net flux likewise, means of all channels, of what the lattice holds and of beams; {0}:
    // the method path asks pop.
    tyn_ref guide[2];
    tyn_ref resumed[6]; // tyn_view.resume: its images, in their order; {0}: none
} tyn_scene_refs;

typedef struct tyn_picture_hook tyn_picture_hook;

// What is asked for. All of it lives until `declare` returns.
typedef struct tyn_job {
    const tyn_method_info *method; // the one that is asked
    const tyn_scene *scene;        // as the host gave it: world space
    const tyn_view *view;          // size, camera, samples
    const tyn_settings *settings;  // for tyn_settings_params
    const tyn_frame_scene *frame;  // the scene in M
    tyn_scene_refs refs;
    // Of the device. Beside sizes of dispatches: a processor reads uniform arrays thread by thread.
    tyn_capacity capacity;
    // Where tyn_method.batch is asked: milliseconds of a sample of this picture, measured; 0: not known.
    double sample_ms;
    uint32_t outputs; // set of tyn_output that is wanted, all of them in method->outputs
    bool readback;    // copy the outputs to host memory
    bool half_view;   // COMPOSITE: the host's colour image is twice as large as the view
    // SINGLE and MULTIPLE may be interpolated where the picture is smooth.
    bool sparse_layers;
    // Of the host's depth: (host_depth[0] z + host_depth[1]) / (host_depth[2] z + host_depth[3]) at z = -distance along
    // the camera's `forward`, m.
    float host_depth[4];
    const tyn_frame_lights *light; // LIGHT: what goes into refs.light
    // Between march and composite: all that are registered. tyn_add_results calls them.
    const tyn_picture_hook *const *hooks;
    uint32_t num_hooks;
    // By TYN_INDEX_*: outputs go here, to be read in the same frame (tyn_job_declare). NULL: they are given out.
    tyn_ref *made;
    // Not NULL: the method puts images for tyn_scene_refs.guide here (tyn_add_views). Methods that have no lattice leave it.
    tyn_ref *guide;
    const tyn_log *log; // for what makes the frame impossible; warnings: tyn_job_warn
    void (*warn)(void *user, const char *line); // goes to the report's warnings, once per text
    void *warn_user;
} tyn_job;

// What a march has made, on its way to the outputs: RGBA32F images as large as the view, with the texels of the outputs of
// these names (TYN_OUTPUT_RADIANCE, ...); {0}: nobody has asked for it.
typedef struct tyn_picture {
    tyn_ref radiance, transmittance, depth;
} tyn_picture;

// What stands between march and composite: nodes that read the picture and hand it on, before outputs, composite and tone
// curve are made of it. Hooks follow each other in the order in which they were registered. Each needs `prepare`, or `reads`
// and `declare`.
struct tyn_picture_hook {
    const char *name;
    // What it reads in this job, a set of TYN_OUTPUT_RADIANCE, _TRANSMITTANCE and _DEPTH; 0: it leaves the picture as it is.
    // A hook that is turned on by a setting asks tyn_settings_params(job->settings, &my_pass, &params) here.
    uint32_t (*reads)(const tyn_job *job);
    // Adds its nodes and puts what they have made into `picture`. Not called where `reads` is 0.
    void (*declare)(tyn_graph *g, const tyn_job *job, tyn_picture *picture);
    // Before the method declares: changes what it starts from (job->refs). NULL: nothing.
    void (*prepare)(tyn_graph *g, tyn_job *job);
    // The passes that it may declare, NULL at the end: methods that name the pass `follows`, and are registered with it or
    // later, list them behind that one. NULL: they are not listed.
    const char *follows;
    const char *const *passes;
};
// What all hooks of the job read.
TYN_API uint32_t tyn_job_hooks_read(const tyn_job *job);

// Gives the graph what was made for an output; nothing happens if it is not wanted.
TYN_API void tyn_job_output(tyn_graph *g, const tyn_job *job, tyn_output which, tyn_ref ref);

// A line among the report's warnings.
TYN_API void tyn_job_warn(const tyn_job *job, const char *format, ...) TYN_PRINTF(2, 3);
// Says that the suns without beams do not light `what`, and how much light that is; nothing if there are none.
TYN_API void tyn_job_warn_suns(const tyn_job *job, const char *what);
// Warns of what a method does not do with surfaces, if there are any: "are left out".
TYN_API void tyn_job_warn_surfaces(const tyn_job *job, const char *what);
// False with a log line if a shape of the scene is periodic.
TYN_API bool tyn_job_refuse_repeat(const tyn_job *job);

// Least and largest mean cosine of what scatters in the scene; 0 and 0 if nothing does.
TYN_API void tyn_range_of_g(const tyn_scene *scene, float *least, float *most);
// Bounds in M of the world box around the surfaces; empty without surfaces.
TYN_API void tyn_surfaces_box(const tyn_frame_scene *frame, float lo[3], float hi[3]);
// Bounds in M of a box a little larger than media, surfaces and lamps together, but for periodic axes.
TYN_API void tyn_scene_box(const tyn_frame_scene *frame, float lo[3], float hi[3]);
// Do surfaces come near the media's box? Else the lattice has no walls.
TYN_API bool tyn_has_walls(const tyn_frame_scene *frame);
// Does the medium repeat along an axis?
TYN_API bool tyn_is_periodic(const tyn_frame_scene *frame);
// Have the surfaces a hierarchy, or are they so few that rays need none?
TYN_API bool tyn_can_trace(const tyn_job *job);

#ifdef __cplusplus
}
#endif
