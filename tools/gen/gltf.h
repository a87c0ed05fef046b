// gltf.h -- a scene as the sample generator describes it, and its glTF file.
#pragma once
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "mesh.h"

typedef struct gen_volume {
    const char *uri;  // file beside the scene; NULL: the medium is homogeneous
    const char *type; // "f16" or "u8"
    uint32_t size[3]; // voxels
} gen_volume;

typedef struct gen_medium {
    const char *name;
    float scattering[3], absorption[3]; // 1/m at density 1
    float anisotropy;                   // Henyey-Greenstein g
    gen_volume density;
} gen_medium;

typedef struct gen_shape {
    const char *name;
    uint32_t medium;
    bool sphere;          // else a box
    float translation[3]; // of the centre, metres
    float rotation[4];    // quaternion x, y, z, w; zeros = none
    float scale[3];       // edge lengths, metres
    bool repeat[3];
} gen_shape;

typedef struct gen_sun {
    float direction[3]; // of travel, any length
    float irradiance;   // on a perpendicular plane, W/m^2
    float color[3];     // zeros = white
} gen_sun;

// A Lambertian surface.
typedef struct gen_material {
    const char *name;
    float albedo[3];
    const char *texture; // PNG file beside the scene, sRGB, which multiplies the albedo; or NULL
    float emission[3];   // radiance from the front, W/(m^2 sr)
} gen_material;

typedef struct gen_camera {
    const char *name;
    float from[3], at[3]; // metres
    float up[3];          // zeros = +Y
    float yfov;           // radians; 0 = orthographic
    float ymag;           // half height of an orthographic view, metres
} gen_camera;

enum { GEN_MAX = 4, GEN_MAX_MATERIALS = 8 };

// Entries end at the first one without a name (suns: without irradiance).
typedef struct gen_scene {
    const char *name, *about;
    gen_medium media[GEN_MAX];
    gen_shape shapes[GEN_MAX];
    gen_sun suns[GEN_MAX];
    gen_camera cameras[GEN_MAX + 1]; // the first is the default
    bool environment;
    const char *environment_uri;   // NULL: constant
    float environment_radiance[3]; // W/(m^2 sr)
    gen_material materials[GEN_MAX_MATERIALS];
    void (*build)(gen_model *model); // makes meshes and lamps; NULL: there are none
} gen_scene;

// Writes FOLDER/NAME.gltf, and NAME.bin if the scene has meshes. False, with one line on stderr, if a
// file cannot be written.
bool gen_write_gltf(const char *folder, const gen_scene *scene);

// "[a, b, c]": nine digits bring every float back exactly.
void gen_put_floats(FILE *f, const float *v, int n);
// The meshes' members of the root: materials, textures, meshes, accessors, buffers. Ends with a comma.
void gen_put_meshes(FILE *f, const gen_scene *scene, const gen_model *model);
// What they refer to.
bool gen_write_buffer(const char *folder, const char *name, const gen_model *model);
