// gltf_material.h -- materials of a glTF file as diffuse surfaces.
#pragma once
#include "io/gltf_texture.h"

// What the scene's material does not say.
typedef struct gltf_material {
    uint32_t index;    // in surfaces->materials
    uint32_t texcoord; // which TEXCOORD_n its texture wants
    float uv[2][3];    // texture coordinates = uv (TEXCOORD, 1): KHR_texture_transform
} gltf_material;

// What is not done, told once each with the first material it is about.
typedef enum gltf_material_lack {
    LACK_METAL,
    LACK_METAL_TEXTURE,
    LACK_EMISSIVE_TEXTURE,
    LACK_NORMAL_TEXTURE,
    LACK_ALPHA,
    NUM_LACKS
} gltf_material_lack;

typedef struct gltf_materials {
    tyn_scene *scene;
    gltf_textures textures;
    json_list list;
    gltf_material *loaded; // list.count of them and, last, glTF's default
    bool *is_loaded;
    struct {
        char name[64];
        uint32_t count;
    } lacks[NUM_LACKS];
} gltf_materials;
tyn_result tyn_gltf_materials_open(gltf_materials *m, const gltf_data *data, tyn_scene *scene);
void tyn_gltf_materials_close(gltf_materials *m); // the scene is warned of what is not done

// -1: glTF's default. Valid until the next call.
tyn_result tyn_gltf_material_get(gltf_materials *m, int64_t index, const gltf_material **out);

// The same material with another albedo (a factor on it), which is added if it is not there yet.
tyn_result tyn_gltf_material_tinted(gltf_materials *m, uint32_t index, const float tint[3],
                                    uint32_t *tinted);
