// job.h -- what a method is asked for, the scene of the frame, and helpers that every floor above uses.
//
// A method turns a job into graph nodes. It is called for every frame and must be
// cheap and deterministic: no GPU calls, no allocation.
#pragma once
#include <tyndall/registry.h>
#include "job/lights.h"
#include "job/refs.h"
#include "scene/env_suns.h"
#include "shaders/common/scene_args.h"
#include "shaders/surfaces/surface_args.h"

// The scene in the medium frame, made once per frame by the engine.
typedef struct tyn_frame_scene {
    struct medium_block medium;
    struct shape_block shapes[TYN_MAX_SHAPES];
    tyn_lights lights;
    tyn_map_light map; // of the environment, in the map's frame and units
    struct camera_block camera;
    struct env_block environment;
    bool direct; // one unsheared box: the atlas is the density texture, `medium` need not resample
    bool grey;   // sigma_s, sigma_a, g equal in all channels (and no coefficient textures)
    bool emissive;
    // Of the box, where the density may not be 0: bit 2 a + (1: high face of axis a).
    uint32_t open_faces;
    float typical_density; // mean over the medium's mass, likewise; 0 = not known
    // Over what is not empty, mode DENSITY: in units of the texture's values; 0 = not known.
    float mean_density;
    bool empty;             // no medium at all, or no coefficient above 0
    uint32_t num_triangles; // of the surfaces; 0: there are none, nor their refs
    uint32_t num_textures;  // of their materials
    struct surface_block surfaces;
    const struct surface_range
        *below;                  // of every node (light/shadow_cull.h); NULL without a hierarchy
    struct tyn_views_seen *seen; // with `below`
    float m_from_world[16];      // rigid
} tyn_frame_scene;

// Resources every method starts from; a {0} ref does not exist in this scene.
typedef struct tyn_scene_refs {
    tyn_ref atlas;               // 3D R16F or R32F, all density grids (sampled)
    tyn_ref medium;              // struct medium_block
    tyn_ref shapes;              // struct shape_block[]
    tyn_ref lights;              // struct light_block[]: tyn_lights.scene
    tyn_ref suns;                // struct light_block[]: tyn_lights.suns
    tyn_ref camera;              // struct camera_block
    tyn_ref environment;         // struct env_block
    tyn_ref env_map;             // 2D RGBA32F; {0} if constant
    tyn_ref env_cdf;             // frame/env_cdf.h; {0} if constant or not read
    tyn_geometry_refs geometry;  // {0} without surfaces, as the next
    tyn_material_refs materials; // textures and texels: one at least
    tyn_ref emitters; // struct surface_table and cells; {0} if nothing emits, or if it is not read
    tyn_ref areas;    // the same; {0} but for BALANCE
    tyn_ref points;   // PROBE: vec3 in M, scalar
    tyn_ref depth;    // COMPOSITE: host depth
    tyn_ref color;    // COMPOSITE: host colour
} tyn_scene_refs;

typedef struct tyn_job {
    const tyn_method_info *method;
    const tyn_scene *scene;
    const tyn_view *view;
    const tyn_settings *settings;
    const tyn_frame_scene *frame;
    tyn_scene_refs refs;
    uint32_t outputs;       // set of tyn_output that is wanted
    bool readback;          // copy the outputs to host memory
    bool cpu_device;        // the device is a processor: it reads uniform arrays thread by thread
    float view_to_clip[16]; // of the host's depth
    const tyn_log *log;
    void (*warn)(void *user, const char *line); // goes to the report's warnings, once per text
    void *warn_user;
} tyn_job;

// Gives the graph what was made for an output; nothing happens if it is not wanted.
void tyn_job_output(tyn_graph *g, const tyn_job *job, tyn_output which, tyn_ref ref);
// Has the buffer read back in which a pass counts (tyn_pass_desc.counters), for the report.
void tyn_job_counters(tyn_graph *g, const tyn_job *job, const tyn_pass_desc *pass, tyn_ref ref);
// The names of outputs in the graph: "radiance", ...
const char *tyn_output_name(tyn_output which);

// Outputs that are gathered along the rays of a camera.
#define TYN_PICTURE_OUTPUTS                                                                        \
    (TYN_OUTPUT_RADIANCE | TYN_OUTPUT_TRANSMITTANCE | TYN_OUTPUT_DEPTH | TYN_OUTPUT_SINGLE |       \
     TYN_OUTPUT_MULTIPLE | TYN_OUTPUT_DISPLAY | TYN_OUTPUT_COMPOSITE)

// A line among the report's warnings.
void tyn_job_warn(const tyn_job *job, const char *format, ...) TYN_PRINTF(2, 3);
// Says that the suns without beams do not light `what`, and how much light that is; nothing if there are none.
void tyn_job_warn_suns(const tyn_job *job, const char *what);
// Warns of what a method does not do with surfaces, if there are any: "are left out".
void tyn_job_warn_surfaces(const tyn_job *job, const char *what);
// False with a log line if a shape of the scene is periodic.
bool tyn_job_refuse_repeat(const tyn_job *job);

// Least and largest mean cosine of what scatters in the scene; 0 and 0 if nothing does.
void tyn_range_of_g(const tyn_scene *scene, float *least, float *most);
// Bounds in M of the world box around the surfaces; empty without surfaces.
void tyn_surfaces_box(const tyn_frame_scene *frame, float lo[3], float hi[3]);
// Bounds in M of a box a little larger than media, surfaces and lamps together, but for periodic axes.
void tyn_scene_box(const tyn_frame_scene *frame, float lo[3], float hi[3]);
// Do surfaces come near the media's box? Else the lattice has no walls.
bool tyn_has_walls(const tyn_frame_scene *frame);
// Does the medium repeat along an axis?
bool tyn_is_periodic(const tyn_frame_scene *frame);
// Have the surfaces a hierarchy, or are they so few that rays need none?
bool tyn_can_trace(const tyn_job *job);
