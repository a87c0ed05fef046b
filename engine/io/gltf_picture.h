// gltf_picture.h -- a texture as it is asked over areas: least and largest values and means, by a pyramid.
#pragma once
#include <tyndall/scene.h>

// A cell covers 2^level texels along each side.
typedef struct gltf_picture_cell {
    uint8_t lo[4], hi[4]; // as stored
    float mean[3];        // of red, green and blue as light
} gltf_picture_cell;

enum { GLTF_PICTURE_LEVELS = 15 };
typedef struct gltf_picture {
    tyn_texture texture;                            // level 0
    gltf_picture_cell *levels[GLTF_PICTURE_LEVELS]; // from level 1 on; NULL behind the last
} gltf_picture;

// Takes the texture over, also where there is no memory: false.
bool tyn_gltf_picture_make(gltf_picture *picture, const tyn_texture *texture);
void tyn_gltf_picture_finish(gltf_picture *picture);

// Least and largest value of each channel, 0 to 1 as stored, wherever texture coordinates are in the box; where it is large,
// of a box a little larger.
void tyn_gltf_picture_range(const gltf_picture *picture, const double lo[2], const double hi[2],
                            double least[4], double largest[4]);

// Alpha between texel centres.
double tyn_gltf_picture_alpha(const gltf_picture *picture, const double uv[2]);

// Colour as light around a place, between texel centres or over about `size` of the texture coordinates.
void tyn_gltf_picture_light(const gltf_picture *picture, const double uv[2], const double size[2],
                            double light[3]);
double tyn_gltf_light_of(double srgb); // 0 to 1
