// maps.h -- the environment maps of the sample scenes: latitude-longitude, row 0 up, centre -Z.
#pragma once
#include <stdbool.h>

typedef struct gen_map {
    int width, height;
    float *rgb; // radiance, W/(m^2 sr)
} gen_map;

gen_map gen_map_new(int width, int height); // black; ends the program if memory is short
void gen_map_free(gen_map *map);

// The direction of a texel's centre.
void gen_map_direction(const gen_map *map, int x, int y, double direction[3]);
// Solid angle of a texel of row y.
double gen_map_solid_angle(const gen_map *map, int y);

typedef struct gen_sky {
    double elevation;  // of the sun's centre above the horizon, degrees
    double azimuth;    // degrees from -Z towards +X
    double turbidity;  // optical thickness of air and haze over that of air alone, >= 1
    double albedo[3];  // of the ground
    double irradiance; // of the sun on a plane that faces it, above the atmosphere, W/m^2
    double observer;   // height above the ground, m
} gen_sky;

// A clear sky with its sun, over a flat ground: sky.c.
gen_map gen_clear_sky(const gen_sky *sky, int width, int height);

// A narrow courtyard, open above and at one end, its walls in the shade: courtyard.c.
gen_map gen_courtyard(int width, int height);

// Writes FOLDER/FILE: R, G, B as floats, not compressed.
bool gen_write_exr(const char *folder, const char *file, const gen_map *map);
