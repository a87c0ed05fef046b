// surfaces.h -- the surfaces' part of a frame: what lights and camera see of them.
#pragma once
#include "methods/job.h"
#include "shaders/light/rsm_args.h"

// Shadow maps of the suns that have beams, the first of frame->suns, and of the lamps; in `cells` where looks at the
// maps are needed (light_cells_args.h).
tyn_result tyn_add_shadows(tyn_graph *g, const tyn_job *job, uint32_t num_suns,
                           tyn_shadow_refs *shadows, tyn_ref *cells);

// Surfaces as the camera sees them: what shaders/surfaces/gbuffer.glsl reads. {0} without surfaces.
typedef struct tyn_gbuffer_refs {
    tyn_ref distances;         // 2D R32F, gbuffer.samples^2 texels a pixel
    tyn_ref facing, colours;   // 2D RGBA32UI
    tyn_ref edge_count, edges; // gbuffer_edge_args.h
} tyn_gbuffer_refs;
tyn_result tyn_add_gbuffer(tyn_graph *g, const tyn_job *job, tyn_gbuffer_refs *gbuffer);

// What the lights shine on: reflective shadow maps of the same lights as tyn_add_shadows.
typedef struct tyn_rsm {
    tyn_rsm_refs maps;
    uint32_t num_tiles;
    struct rsm_tile tiles[TYN_RSM_MAX_TILES];
} tyn_rsm;
tyn_result tyn_add_rsm(tyn_graph *g, const tyn_job *job, uint32_t num_suns, tyn_rsm *rsm);

// Bounds in M of the world box around the surfaces; empty without surfaces.
void tyn_surfaces_box(const tyn_frame_scene *frame, float lo[3], float hi[3]);

// Bounds in M of a box a little larger than media, surfaces and lamps together, but for periodic axes.
void tyn_scene_box(const tyn_frame_scene *frame, float lo[3], float hi[3]);
