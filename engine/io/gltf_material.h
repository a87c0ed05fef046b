// gltf_material.h -- materials of a glTF file as diffuse surfaces.
#pragma once
#include "io/gltf_picture.h"
#include "io/gltf_texture.h"

// Where a texture is on a surface.
typedef struct gltf_texture_place {
    uint32_t texcoord; // which TEXCOORD_n it wants
    float uv[2][3];    // texture coordinates = uv (TEXCOORD, 1): KHR_texture_transform
} gltf_texture_place;

typedef struct gltf_material {
    int64_t index;                // in the file; behind the last: glTF's default
    tyn_surface_material surface; // as it is without what varies over the surface
    gltf_texture_place color;     // of its texture
    // What varies over the surface, and is not in the scene's material; NULL: nothing.
    gltf_picture *alpha, *glow;
    gltf_texture_place glow_place;
    double opacity, cutoff; // factor of alpha, and how much is needed: 0: none
} gltf_material;

// What is not done, told once each with the first material it is about.
typedef enum gltf_material_lack {
    LACK_METAL,
    LACK_METAL_TEXTURE,
    LACK_NORMAL_TEXTURE,
    LACK_ALPHA,
    LACK_UNLIT,
    LACK_GLOSS,
    NUM_LACKS
} gltf_material_lack;

typedef struct gltf_materials {
    tyn_scene *scene;
    gltf_textures textures;
    const json_list *list;
    gltf_material *loaded; // list->count of them and, last, glTF's default
    bool *is_loaded;
    struct gltf_painted_material
        *painted; // open addressing: which of the scene's materials are what of these
    uint32_t num_painted, painted_room;
    gltf_note lacks[NUM_LACKS];
} gltf_materials;
tyn_result tyn_gltf_materials_open(gltf_materials *m, const gltf_data *data, tyn_scene *scene);
void tyn_gltf_materials_close(gltf_materials *m); // the scene is warned of what is not done

// -1: glTF's default. Valid until the next call.
tyn_result tyn_gltf_material_get(gltf_materials *m, int64_t index, const gltf_material **out);

// That material with factors on albedo (not above 1 together) and emission, as one of the scene's, which is added if it is
// not there yet.
tyn_result tyn_gltf_material_paint(gltf_materials *m, const gltf_material *material,
                                   const float tint[3], const float glow[3], uint32_t *index);
