// vector.h -- three numbers as a vector, for tests' twins; the names that end in f take floats.
#pragma once
#include <math.h>

static inline double vector_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline float vector_dotf(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// `out` is none of the factors.
static inline void vector_cross(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++) {
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
    }
}

static inline void vector_crossf(const float a[3], const float b[3], float out[3])
{
    for (int i = 0; i < 3; i++) {
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
    }
}

static inline double vector_length(const double v[3])
{
    return sqrt(vector_dot(v, v));
}

// Returns the length that it had.
static inline double vector_normalise(double v[3])
{
    const double length = vector_length(v);
    for (int i = 0; i < 3; i++) {
        v[i] /= length;
    }
    return length;
}

static inline float vector_normalisef(float v[3])
{
    const float length = sqrtf(vector_dotf(v, v));
    for (int i = 0; i < 3; i++) {
        v[i] /= length;
    }
    return length;
}
