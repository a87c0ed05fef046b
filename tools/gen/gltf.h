// gltf.h -- a scene as the sample generator describes it, and its glTF file.
#pragma once
#include <stdbool.h>
#include <stdint.h>

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

typedef struct gen_camera {
    const char *name;
    float from[3], at[3]; // metres
    float up[3];          // zeros = +Y
    float yfov;           // radians; 0 = orthographic
    float ymag;           // half height of an orthographic view, metres
} gen_camera;

enum { GEN_MAX = 4 };

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
} gen_scene;

// Writes FOLDER/NAME.gltf. False, with one line on stderr, if the file cannot be written.
bool gen_write_gltf(const char *folder, const gen_scene *scene);
