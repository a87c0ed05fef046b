// picture.h -- small scenes made in code, pictures of them by any method, and how far apart two pictures
// are.
#pragma once
#include <tyndall/offline.h>

typedef struct picture {
    uint32_t width, height;
    float *rgb; // 3 floats a pixel, row 0 on top
    float *se;  // standard errors likewise, or NULL
} picture;
void picture_free(picture *p);

// ---- scenes -----------------------------------------------------------------------------------

tyn_medium grey_medium(float sigma_s, float sigma_a, float g);
// An axis-aligned box of the medium; with `grid` (x fastest; copied) as its density, else homogeneous.
// Returns the shape, whose matrix may be changed.
tyn_shape *scene_add_box(tyn_scene *scene, const tyn_medium *medium, const float lo[3],
                         const float hi[3], const uint32_t size[3], const float *grid);
void scene_add_sun(tyn_scene *scene, float x, float y, float z, float r, float g, float b);
void scene_set_sky(tyn_scene *scene, float radiance); // constant, all channels

// n x n pixels; rays travel along (x, y, z). Like the reference images: up is `up`, but columns run
// along direction x up (theirs are mirrored, picture_reference turns them over).
void view_orthographic(tyn_view *view, const float centre[3], float x, float y, float z,
                       const float up[3], float half, uint32_t n);

// ---- pictures ---------------------------------------------------------------------------------

// `settings`: "lattice.cells=16 lattice.sweeps=6" or NULL. spp: samples of progressive methods. Fails the
// test on any error.
void picture_render(picture *p, tyn_device *dev, const char *method, const tyn_scene *scene,
                    const tyn_view *view, const char *settings, uint32_t spp);

// The same of a method that is open (scene_open), for several views of a scene: what does not depend on the camera is not
// computed again. `sampled`: with standard errors.
void picture_frame(picture *p, tyn_device *dev, tyn_offline *off, const tyn_scene *scene,
                   const tyn_view *view, bool sampled);

// images/NAME.npy of the shared references. False if it is absent.
bool picture_reference(picture *p, const char *name);

typedef struct picture_error {
    double rel_l1;   // sum |a - b| / sum |b| over blocks and channels
    double noise;    // the part of it that the standard errors explain
    double reported; // sqrt(max(0, rel_l1^2 - noise^2))
    double bias;     // sum a / sum b - 1
    double worst;    // largest |a - b| / (|b| + mean |b| / 100) of a block
} picture_error;
picture_error picture_compare(const picture *a, const picture *reference, uint32_t block);

// Why the bound of a bias may be wide, or NULL: a mean over 25 blocks and more has a fifth of their noise at most, and one
// that is less is 0 as far as the reference tells.
const char *picture_bias_why(const picture_error *e);

// A method with settings: "pass.option=value ...", or NULL.
tyn_offline *scene_open(tyn_device *dev, const char *method, const char *settings);

// A frame of n points (num_points of tyn_view), and what it finds there.
const tyn_probe_result *scene_probes(tyn_device *dev, tyn_offline *off, const tyn_scene *scene,
                                     const float (*points)[3], uint32_t n);

// The balance of a method: imbalance of the worst channel.
double scene_imbalance(tyn_device *dev, const char *method, const tyn_scene *scene,
                       const char *settings);
