// matrix.h -- the few 4x4 and vector operations scenes need. Column-major, M[col * 4 + row].
#pragma once
#include <math.h>
#include <stdbool.h>
#include <string.h>

static inline void mat_identity(double m[16])
{
    memset(m, 0, 16 * sizeof *m);
    m[0] = m[5] = m[10] = m[15] = 1.0;
}

static inline void mat_mul(double out[16], const double a[16], const double b[16]) // out = a b
{
    double r[16];
    for (int c = 0; c < 4; c++) {
        for (int i = 0; i < 4; i++) {
            r[c * 4 + i] = a[i] * b[c * 4] + a[4 + i] * b[c * 4 + 1] + a[8 + i] * b[c * 4 + 2] +
                           a[12 + i] * b[c * 4 + 3];
        }
    }
    memcpy(out, r, sizeof r);
}

static inline double mat_det3(const double m[16])
{
    return m[0] * (m[5] * m[10] - m[6] * m[9]) - m[4] * (m[1] * m[10] - m[2] * m[9]) +
           m[8] * (m[1] * m[6] - m[2] * m[5]);
}

// The linear part spans a volume: its determinant is not lost in rounding beside the product of its
// column lengths. Anything flatter cannot be inverted in single precision.
static inline bool mat_invertible(const double m[16])
{
    double lengths = 1.0;
    for (int i = 0; i < 16; i++) {
        if (!isfinite(m[i])) {
            return false;
        }
    }
    for (int c = 0; c < 3; c++) {
        lengths *=
            sqrt(m[c * 4] * m[c * 4] + m[c * 4 + 1] * m[c * 4 + 1] + m[c * 4 + 2] * m[c * 4 + 2]);
    }
    double det = fabs(mat_det3(m));
    return det > 1e-30 && det > 1e-6 * lengths && det < 1e30;
}

static inline bool vec_any(const float v[3]) // above 0
{
    return v[0] > 0 || v[1] > 0 || v[2] > 0;
}

static inline bool vec_grey(const float v[3]) // all are equal
{
    return v[0] == v[1] && v[1] == v[2];
}

static inline bool vec_finite(const float *v, int count)
{
    bool finite = true;
    for (int i = 0; i < count; i++) {
        finite = finite && isfinite(v[i]);
    }
    return finite;
}

static inline double vec_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline double vec_length(const double a[3])
{
    return sqrt(vec_dot(a, a));
}

static inline void vec_cross(double out[3], const double a[3], const double b[3])
{
    double r[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    memcpy(out, r, sizeof r);
}

// Rows of the inverse of the matrix with columns a, b and c, times its determinant, which is returned.
static inline double mat_cofactors(double rows[3][3], const double a[3], const double b[3],
                                   const double c[3])
{
    vec_cross(rows[0], b, c);
    vec_cross(rows[1], c, a);
    vec_cross(rows[2], a, b);
    return vec_dot(a, rows[0]);
}

static inline bool vec_normalize(double v[3]) // false where there is no direction
{
    double scale = fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2])));
    if (!(scale > 0.0) || !isfinite(scale)) {
        return false;
    }
    double x = v[0] / scale, y = v[1] / scale, z = v[2] / scale;
    double inv = 1.0 / sqrt(x * x + y * y + z * z);
    v[0] = x * inv, v[1] = y * inv, v[2] = z * inv;
    return true;
}
