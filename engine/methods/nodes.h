// nodes.h -- parts of a frame that several methods have in common.
#pragma once
#include "methods/surfaces.h"
#include "passes/raymarch/raymarch.h"

enum { TYN_METHOD_MAX_SUNS = 4 }; // suns that have their own aligned grid

// {0} without a medium.
typedef struct tyn_media_refs {
    tyn_medium_refs medium;
    tyn_ref bricks, distance;
} tyn_media_refs;
tyn_result tyn_add_medium(tyn_graph *g, const tyn_job *job, tyn_media_refs *media);

// Optical depth along the suns.
tyn_result tyn_add_beams(tyn_graph *g, const tyn_job *job, const tyn_medium_refs *medium,
                         uint32_t num_suns, tyn_beam_refs *beams);

// Local lights (methods/lamps.h).
typedef struct tyn_lamps {
    tyn_radial_refs radials;
    uint32_t num_lamps; // of them
    uint32_t num_fine;  // that have grids as fine as the medium, the first ones
    bool vpls;          // virtual point lights follow them
} tyn_lamps;

// What the picture is gathered from; {0} refs are left out.
typedef struct tyn_picture_inputs {
    tyn_media_refs media;
    tyn_beam_refs beams;
    tyn_lamps lamps;
    uint32_t num_marched_lamps;
    uint32_t num_near_lamps; // that are marched nearby, the next ones
    tyn_ref lut, lut_block;  // given: all forward orders of the suns, else the first
    tyn_ref inscatter;
    tyn_wall_refs walls;        // surfaces among the cells of inscatter
    tyn_ref rooms;              // cells that are joined, and VPLs in them
    tyn_shadow_refs shadows;    // surfaces before the lights
    tyn_ref light_cells;        // where looks at their maps are needed (light_cells_args.h)
    tyn_vpl_refs vpls;          // light that surfaces send on (methods/shading.h)
    tyn_ref surface, distances; // radiance and distances of surfaces before the camera
    tyn_ref glow;               // the map scattered forward (env_glow)
    uint32_t num_suns;
    float cell;       // of the lattice behind inscatter, m; 0 = none
    bool one_channel; // inscatter has one channel, to be multiplied with tint
    float tint[3];
    uint32_t field;     // RAYMARCH_INSCATTER_*
    bool mean_in_field; // the environment's mean came in through inscatter
} tyn_picture_inputs;

// Marches, and makes what the job wants of the result: layers, the host's picture, the display image.
// `in` may be NULL: an empty scene.
tyn_result tyn_add_picture(tyn_graph *g, const tyn_job *job, const tyn_picture_inputs *in);

// The display image of a radiance.
tyn_result tyn_add_display(tyn_graph *g, const tyn_job *job, tyn_ref radiance);

// Outputs that tyn_add_picture makes.
#define TYN_PICTURE_OUTPUTS                                                                        \
    (TYN_OUTPUT_RADIANCE | TYN_OUTPUT_TRANSMITTANCE | TYN_OUTPUT_DEPTH | TYN_OUTPUT_SINGLE |       \
     TYN_OUTPUT_MULTIPLE | TYN_OUTPUT_DISPLAY | TYN_OUTPUT_COMPOSITE)

// Suns with an aligned grid, the first of frame->suns: at most TYN_METHOD_MAX_SUNS.
uint32_t tyn_method_suns(const tyn_job *job);
// Says that the other suns do not light `what`, and how much light that is; nothing if there are none.
void tyn_method_warn_suns(const tyn_job *job, const char *what);

// A line among the report's warnings.
void tyn_method_warn(const tyn_job *job, const char *format, ...) TYN_PRINTF(2, 3);

// TYN_ERR_PARAMS with a log line if a shape of the scene is periodic.
tyn_result tyn_method_refuse_repeat(const tyn_job *job, const char *method);
// Warns of what a method does not do with surfaces, if there are any: "are left out".
void tyn_method_warn_surfaces(const tyn_job *job, const char *what);
