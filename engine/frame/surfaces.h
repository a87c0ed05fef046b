// surfaces.h -- surfaces as the GPU gets them: checked, textures with their mip chains.
#pragma once
#include "scene/surfaces.h"
#include "shaders/surfaces/surface_args.h"

// Made when the surfaces' hash changes and kept until the next one.
typedef struct tyn_surface_data {
    uint64_t hash; // 0: no surfaces
    float lo[3], hi[3];
    float most_lo[3], most_hi[3]; // world box of most triangles
    // At least one element, so that there is always a buffer to bind.
    struct surface_texture *textures;
    uint32_t num_textures;
    uint32_t *texels; // of all levels of all textures; at least one
    size_t num_texels;
    struct surface_range *below; // of every node (frame/shadow_cull.h); NULL without a hierarchy
    struct tyn_views_seen *seen; // with `below`
    uint32_t num_nodes;
    tyn_surface_node leaf;  // of all triangles, for surfaces without a hierarchy
    void *emitters, *areas; // frame/surface_tables.h; NULL if there are none or nobody reads them
    size_t emitters_size, areas_size;
    bool has_emitters, has_areas; // were asked for and made
} tyn_surface_data;

// Checks the surfaces and makes the data anew if they changed. Errors are one log line.
tyn_result tyn_surface_data_update(tyn_surface_data *data, const tyn_surfaces *surfaces,
                                   const tyn_log *log);
// Makes the tables by which triangles are drawn, the second only if wanted.
tyn_result tyn_surface_data_tables(tyn_surface_data *data, const tyn_surfaces *surfaces,
                                   bool areas);
void tyn_surface_data_finish(tyn_surface_data *data);
