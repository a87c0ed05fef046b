// sky_scene.h -- surfaces before a few principal ordinates, on the device and for rays on the CPU.
#pragma once
#include "gpu_test.h"
#include "passes/sky_shadows/sky_shadows.h"
#include "solids.h"

typedef struct sky_scene {
    tyn_scene
        scene; // a floor with a wall, and a closed box at (0.5, 0.5, 0.5) to (1.7, 1.7, 1.7), in M
    struct surface_block surfaces;
    struct medium_block medium;
    struct ordinates_block ordinates, directions;
} sky_scene;

// `count` ordinates all around, the first `fixed` of them suns, with `fan` directions each of the others.
void sky_scene_make(sky_scene *s, uint32_t count, uint32_t fixed, uint32_t fan);
void sky_scene_free(sky_scene *s);

// Adds sky_shadows, of the directions.
void sky_scene_upload(gpu_test *t, const sky_scene *s, tyn_ref *refs,
                      const tyn_sky_shadows_params *params);

typedef enum sky_ray { SKY_RAY_FREE, SKY_RAY_BLOCKED, SKY_RAY_DOUBTFUL } sky_ray;
// From p (M) on; doubtful where rays `around` m beside it disagree.
sky_ray sky_scene_ray(const sky_scene *s, const double p[3], const double towards[3],
                      double around);
