// frame_scene.h -- turns a scene and a view into the blocks that shaders read.
#pragma once
#include <tyndall/extend/job.h>
#include "frame/projection.h"
#include "frame/surfaces.h"
#include "scene/env_suns.h"

// Everything in the medium frame M (scene_args.h). `map` is what tyn_map_light_find says of the scene's
// environment, `surfaces` what was made of its surfaces. Errors are one log line.
tyn_result tyn_frame_scene_build(tyn_frame_scene *out, const tyn_scene *scene, const tyn_view *view,
                                 const tyn_frame_projection *projection, const tyn_map_light *map,
                                 const tyn_surface_data *surfaces, const tyn_log *log);

// The atlas: every density grid, stacked along z in the order of scene.volumes, then one texel of 1 for
// homogeneous media. {0,0,0} extent if the only grid is the host's image.
typedef struct tyn_atlas {
    const tyn_scene *scene;
    bool colors; // that of the grids of colours, RGBA, in the order of scene.color_grids
    tyn_extent extent;
    bool half; // R16F or RGBA16F holds all values well
    bool host; // the host brings the image
} tyn_atlas;
tyn_result tyn_atlas_plan(tyn_atlas *atlas, const tyn_scene *scene, const tyn_log *log);
void tyn_colors_plan(tyn_atlas *colors, const tyn_scene *scene); // z = 0: there are none
void tyn_atlas_fill(void *atlas, void *texels);                  // either
uint64_t tyn_atlas_hash(const tyn_atlas *atlas);
uint32_t tyn_atlas_offset(const tyn_scene *scene, int32_t volume); // first z
// Where a grid of colours is, `slot` as in tyn_medium: 1 + its index, 0: none.
struct shape_colors tyn_colors_place(const tyn_scene *scene, uint32_t slot);

// At which faces of its box a grid is not 0: bit 2 a for the low face of axis a, 2 a + 1 for the high one.
uint32_t tyn_volume_open_faces(const tyn_volume *volume);

// Mean of a grid's values that are above 0; 0 if the host brings them.
float tyn_volume_mean(const tyn_volume *volume);
float tyn_volume_typical(const tyn_volume *volume); // its mean weighted with itself
