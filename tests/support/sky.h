// sky.h -- skies for tests, light that crosses a scene without scattering, and tables of references.
//
// Shares no source with the engine beyond the scene's structs.
#pragma once
#include "picture.h"

// Radiance from direction w (unit, outwards, world).
typedef void (*sky_fn)(const double w[3], double out[3]);

// The sky of the shared reference images: zenith, horizon, ground and a soft sun.
void sky_of_references(const double w[3], double out[3]);
// A map of it, 2048 x 1023 averages over texels; the three rows at the horizon hold the horizon. Owned by the
// caller. `what`: everything, without its sun, or its sun alone.
typedef enum sky_part { SKY_WHOLE, SKY_WITHOUT_SUN, SKY_SUN } sky_part;
void sky_reference_map(tyn_environment *map, sky_part what);
// Every texel the same.
void sky_constant_map(tyn_environment *map, uint32_t width, uint32_t height, float radiance);
// Turns the map by `angle` radians about an axis.
void sky_turn(tyn_environment *map, float x, float y, float z, float angle);

// What the map shows, bilinear.
void sky_look(const tyn_environment *map, const double w[3], double out[3]);

// e^-tau_t x environment as averages over the pixels: what is seen of the environment without any
// scattering. `sky` NULL: that of the scene. Marched at half a voxel in double precision.
void picture_unscattered(picture *p, const tyn_scene *scene, const tyn_view *view, sky_fn sky);

// Means over blocks and the standard errors of these means, as a picture of blocks.
void picture_blocks(picture *blocks, const picture *p, uint32_t block);
void picture_subtract(picture *p, const picture *q);

// "x,y,r,g,b,se_r,se_g,se_b" per pixel after a line of comment. False if there is no such file.
bool picture_read_table(picture *p, const char *path);
void picture_write_table(const picture *p, const char *path, const char *comment);
