// gltf_texture.h -- textures of a glTF file, read when a material wants them.
#pragma once
#include "io/gltf_accessor.h"

typedef struct gltf_textures {
    const gltf_data *data;
    tyn_scene *scene;
    tyn_surfaces *surfaces; // of the scene
    const json_list *textures, *images, *samplers;
    bool *missing;    // for every texture: it is not there
    uint32_t *loaded; // for every texture its index in surfaces->textures, or TYN_NO_TEXTURE
} gltf_textures;
tyn_result tyn_gltf_textures_open(gltf_textures *t, const gltf_data *data, tyn_scene *scene);
void tyn_gltf_textures_close(gltf_textures *t); // the scene is warned of those that are not there

// A texture whose file is not there, or that has no source, is one texel of 0.5 in all channels. `info` is a checked
// textureInfo: the texture into the scene, once however often it is asked for.
tyn_result tyn_gltf_texture_get(gltf_textures *t, const cJSON *info, uint32_t *index);

// The texture itself, which the caller gives back.
tyn_result tyn_gltf_texture_read(gltf_textures *t, const cJSON *info, tyn_texture *out);

// Mean of a channel as it is stored, 0 to 1.
tyn_result tyn_gltf_texture_mean(gltf_textures *t, const cJSON *info, int channel, double *mean);
