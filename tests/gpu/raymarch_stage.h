// raymarch_stage.h -- a stage for tests of the pass raymarch: one medium, at most one sun, made by hand.
#pragma once
#include "gpu_test.h"
#include "passes/raymarch/raymarch.h"
#include "shaders/beams/beam_args.h"
#include "shaders/phase/scatter_lut_args.h"

enum { MAX_TEXELS = 16 * 16 * 16 };

// A three-dimensional texture of 1 or 4 channels.
typedef struct texture {
    uint32_t size[3];
    int channels;
    float texels[MAX_TEXELS * 4];
} texture;

// Everything a march reads. One medium of constant coefficients times density, at most one sun.
typedef struct march_scene {
    struct medium_block medium;
    struct shape_block shape;
    struct light_block light;
    struct beam_block beam;
    struct lut_block lut;
    struct camera_block camera;
    struct env_block env;
    texture density, distance, column, inscatter;
    float sums[2]; // the scattering table, constant
    float *host_depth, *surface;
    tyn_raymarch_params params;
} march_scene;

// The unit cube of an even medium, seen through 16 x 16 parallel rays, one each.
void march_cube(march_scene *s, float sigma_s, float sigma_a, float g);
void march_sun(march_scene *s, float x, float y, float z);
// Looks along d at the centre of the box from `distance`.
void march_camera(march_scene *s, float x, float y, float z, float distance);
void march_run(gpu_test *t, march_scene *s);
// Of an image that march_run made, four channels.
const float *march_pixel(gpu_test *t, const march_scene *s, const char *name, uint32_t x,
                         uint32_t y);

double march_hg(double g, double mu);
void march_close(double value, double expected, double relative, const char *what);
