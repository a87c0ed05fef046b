// regime_parts.h -- what a scene's regime is read from: its box, the medium at a point, vectors.
#pragma once
#include "regime.h"
#include <math.h>

static inline double regime_mean(const double v[3])
{
    return (v[0] + v[1] + v[2]) / 3;
}

static inline double regime_luminance(const double rgb[3])
{
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

static inline double regime_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void regime_cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

// ---- regime_box.c -----------------------------------------------------------------------------

typedef struct regime_box {
    double origin[3], edge[3][3], length[3];
    bool repeat[3];
} regime_box;

// A lone shape's own box if it is not sheared; else that of the world around all shapes, or around all
// surfaces. False: there is nothing, and the box is a cube of 1 m.
bool regime_box_of(const tyn_scene *scene, regime_box *b);
double regime_box_longest(const regime_box *b);
double regime_box_surface(const regime_box *b);
double regime_box_shadow(const regime_box *b, const double direction[3]); // area across a direction

// Where a ray is in the box, in units of its direction; false: nowhere.
typedef struct regime_ray {
    double from[3], along[3];
} regime_ray;
bool regime_box_cut(const regime_box *b, const regime_ray *r, double *enter, double *leave);

// ---- regime_media.c ---------------------------------------------------------------------------

// Shapes with the inverses of their matrices.
typedef struct regime_media {
    const tyn_scene *scene;
    double to_local[TYN_MAX_SHAPES][3][4];
} regime_media;

typedef struct regime_coefficients {
    double sigma_s[3], sigma_a[3], g_sigma_s[3], emission[3];
    double scaled[3];       // extinction without what is scattered straight on: sigma_t - f sigma_s
    double least_g, most_g; // of what scatters; 1 and -1: nothing does
} regime_coefficients;

void regime_media_make(const tyn_scene *scene, regime_media *m);

// All shapes at a point of the world add up. False: there is nothing.
bool regime_media_at(const regime_media *m, const double world[3], regime_coefficients *out);

// ---- what is read of them ---------------------------------------------------------------------

// Depths, albedo, mean free paths, ... False: out of memory. `emitted`: mean emission over the box.
bool regime_of_medium(const regime_media *m, const regime_box *b, regime *r, double emitted[3]);
void regime_of_light(const tyn_scene *scene, const regime_box *b, const double emitted[3],
                     regime *r);
void regime_of_view(const regime_media *m, const regime_box *b, const tyn_camera *camera,
                    regime *r);
