// primaries.c -- colours of a file's primaries as linear Rec. 709.
#include "io/primaries.h"
#include <math.h>
#include <stdbool.h>
#include <string.h>
#include "scene/matrix.h"

static const double rec709[8] = {0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290};

// Lam 1985: XYZ to the responses of cones.
static const double bradford[9] = {0.8951, 0.2664, -0.1614, -0.7502, 1.7135,
                                   0.0367, 0.0389, -0.0685, 1.0296};

static void multiply(const double a[9], const double b[9], double out[9])
{
    double m[9];
    for (int i = 0; i < 9; i++) {
        const double *row = a + i / 3 * 3, *column = b + i % 3;
        m[i] = row[0] * column[0] + row[1] * column[3] + row[2] * column[6];
    }
    memcpy(out, m, sizeof m);
}

static void apply(const double m[9], const double v[3], double out[3])
{
    for (int i = 0; i < 3; i++) {
        out[i] = m[3 * i] * v[0] + m[3 * i + 1] * v[1] + m[3 * i + 2] * v[2];
    }
}

static bool invert(const double m[9], double out[9])
{
    double columns[3][3]; // of the inverse, times the determinant
    const double det = mat_cofactors(columns, m, m + 3, m + 6);
    for (int i = 0; i < 9; i++) {
        out[i] = columns[i % 3][i / 3] / det;
    }
    return isfinite(det) && fabs(det) > 1e-9;
}

// XYZ of a chromaticity at Y = 1.
static bool white_of(const double xy[2], double out[3])
{
    out[0] = xy[0] / xy[1];
    out[1] = 1;
    out[2] = (1 - xy[0] - xy[1]) / xy[1];
    return xy[1] > 1e-6 && isfinite(out[0]) && isfinite(out[2]);
}

// RGB to XYZ: 1, 1, 1 is white at Y = 1.
static bool to_xyz(const double c[8], double out[9])
{
    double m[9], inverse[9], white[3], scale[3];
    for (int k = 0; k < 3; k++) {
        m[k] = c[2 * k];
        m[3 + k] = c[2 * k + 1];
        m[6 + k] = 1 - c[2 * k] - c[2 * k + 1];
    }
    if (!white_of(c + 6, white) || !invert(m, inverse)) {
        return false;
    }
    apply(inverse, white, scale);
    for (int i = 0; i < 9; i++) {
        out[i] = m[i] * scale[i % 3];
    }
    return true;
}

// Row by row. False where nothing is to be done.
static bool to_rec709(const double c[8], float m[9])
{
    double from[9], to[9], back[9], adapt[9], cones_back[9], whites[2][3], cones[2][3], all[9];
    double apart = 0;
    for (int i = 0; i < 8; i++) {
        apart = fmax(apart, fabs(c[i] - rec709[i]));
    }
    if (!(apart > 1e-3) || !to_xyz(c, from) || !to_xyz(rec709, to) || !invert(to, back) ||
        !invert(bradford, cones_back) || !white_of(c + 6, whites[0]) ||
        !white_of(rec709 + 6, whites[1])) {
        return false;
    }
    for (int k = 0; k < 2; k++) {
        apply(bradford, whites[k], cones[k]);
    }
    for (int i = 0; i < 9; i++) {
        adapt[i] = bradford[i] * cones[1][i / 3] / cones[0][i / 3];
    }
    multiply(cones_back, adapt, adapt);
    multiply(adapt, from, all);
    multiply(back, all, all);
    for (int i = 0; i < 9; i++) {
        if (!isfinite(all[i])) {
            return false;
        }
    }
    for (int i = 0; i < 9; i++) {
        m[i] = (float)all[i];
    }
    return true;
}

void tyn_pixels_to_rec709(float *pixels, size_t count, const double c[8])
{
    float m[9];
    if (!to_rec709(c, m)) {
        return;
    }
    for (size_t i = 0; i < count; i++) {
        float *p = pixels + 3 * i;
        const float rgb[3] = {p[0], p[1], p[2]};
        for (int k = 0; k < 3; k++) {
            p[k] = m[3 * k] * rgb[0] + m[3 * k + 1] * rgb[1] + m[3 * k + 2] * rgb[2];
        }
    }
}
