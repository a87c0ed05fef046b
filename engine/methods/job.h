// job.h -- what a method is given and the helpers that every method uses.
//
// A method turns a job into graph nodes. It is called for every frame and must be
// cheap and deterministic: no GPU calls, no allocation.
#pragma once
#include <tyndall/context.h>
#include "methods/refs.h"
#include "scene/env_suns.h"
#include "shaders/common/scene_args.h"
#include "shaders/surfaces/surface_args.h"

// The scene in the medium frame, made once per frame by the engine.
typedef struct tyn_frame_scene {
    struct medium_block medium;
    struct shape_block shapes[TYN_MAX_SHAPES];
    struct light_block lights[TYN_LIGHTS_MAX];
    uint32_t num_lights, num_suns; // suns = directional lights, first in `lights`, strongest first
    // The directional lights and the num_map_suns of the environment's map, strongest first.
    struct light_block suns[TYN_LIGHTS_MAX];
    uint32_t num_map_suns; // `path` has them in the map
    tyn_map_light map;     // of the environment, in the map's frame and units
    struct camera_block camera;
    struct env_block environment;
    bool direct; // one unsheared box: the atlas is the density texture, `medium` need not resample
    bool grey;   // sigma_s, sigma_a, g equal in all channels (and no coefficient textures)
    bool emissive;
    // Of the box, where the density may not be 0: bit 2 a + (1: high face of axis a).
    uint32_t open_faces;
    float typical_density; // mean over the medium's mass, likewise; 0 = not known
    // Over the box, mode DENSITY: in units of the texture's values; 0 = not known.
    float mean_density;
    bool empty;             // no medium at all, or no coefficient above 0
    uint32_t num_triangles; // of the surfaces; 0: there are none, nor their refs
    uint32_t num_textures;  // of their materials
    struct surface_block surfaces;
    const struct surface_range *below; // of every node (methods/views.h); NULL without a hierarchy
    struct tyn_views_seen *seen;       // with `below`
    float m_from_world[16];            // rigid
} tyn_frame_scene;

// Resources every method starts from; a {0} ref does not exist in this scene.
typedef struct tyn_scene_refs {
    tyn_ref atlas;               // 3D R16F or R32F, all density grids (sampled)
    tyn_ref medium;              // struct medium_block
    tyn_ref shapes;              // struct shape_block[]
    tyn_ref lights;              // struct light_block[]
    tyn_ref suns;                // struct light_block[]: tyn_frame_scene.suns
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
    const tyn_scene *scene;
    const tyn_view *view;
    const tyn_settings *settings;
    const tyn_frame_scene *frame;
    tyn_scene_refs refs;
    uint32_t outputs;       // set of tyn_output that is wanted
    bool readback;          // copy the outputs to host memory
    float view_to_clip[16]; // of the host's depth
    const tyn_log *log;
    void (*warn)(void *user, const char *line); // goes to the report's warnings, once per text
    void *warn_user;
} tyn_job;

// Gives the graph what was made for an output; nothing happens if it is not wanted.
void tyn_job_output(tyn_graph *g, const tyn_job *job, tyn_output which, tyn_ref ref);
// Has a pass's struct counters_block read back, for the report, or its struct ordinates_block. `pass` =
// its node's name.
void tyn_job_counters(tyn_graph *g, const tyn_job *job, const char *pass, tyn_ref ref);
// The names of outputs in the graph: "radiance", ...
const char *tyn_output_name(tyn_output which);

typedef struct tyn_method {
    const char *name, *summary;
    const tyn_pass_desc *const *passes; // NULL-terminated, frame order
    uint32_t outputs;                   // set of tyn_output it can make
    bool progressive;                   // uses view.first_sample, num_samples
    bool reads_env_cdf;                 // wants refs.env_cdf
    // Wants refs.geometry.nodes and refs.emitters where there are surfaces, and refs.areas for a balance.
    bool traces_rays;
    // Largest work a single record may be given (view.num_samples) to keep a dispatch short; NULL if
    // not progressive.
    uint32_t (*batch)(const tyn_job *job);
    tyn_result (*declare)(tyn_graph *g, const tyn_job *job);
} tyn_method;

extern const tyn_method tyn_method_pop, tyn_method_pop_paper, tyn_method_single, tyn_method_path;
