// importance_twin.h -- the importance map on the CPU, in double precision; and by photons.
#pragma once
#include <stdbool.h>

enum { TWIN_WIDTH = 32, TWIN_HEIGHT = 16 };

typedef struct twin_scene {
    const float *density; // voxel means
    int size[3];
    double extent[3];
    double sigma_s, sigma_a, g; // at density 1, mean of the channels
    bool scaled;                // the last scattering is that of the delta-scaled medium
    int cells, iterations;
    double origin[3], right[3], up[3], forward[3], half[2], shift[2];
    bool orthographic;
} twin_scene;

// Direction of a texel of the map.
void twin_direction(int texel, double w[3]);
// By the scheme of the pass; field = importance scattered, times mean cosine, sigma_t per cell.
void twin_importance(const twin_scene *scene, double map[TWIN_WIDTH * TWIN_HEIGHT],
                     double (*field)[3]);
// By `count` photons from the camera that scatter at least once in the homogeneous box (no absorption);
// filtered over the sphere as the pass does.
void twin_photons(const twin_scene *scene, int count, double map[TWIN_WIDTH * TWIN_HEIGHT]);
