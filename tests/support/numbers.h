// numbers.h -- comparisons that NaN does not pass.
//
// fmax, fmin and `if (error > worst)` drop a NaN: what is broken would have the smallest error of all. Asserts say what
// must hold, assert_true(error <= bound), which is false for NaN; never that what must not hold does not.
#pragma once
#include <math.h>

// The larger and the smaller of two numbers; NaN if one of them is.
static inline double maximum(double a, double b)
{
    return isnan(a) || isnan(b) ? (double)NAN : fmax(a, b);
}

static inline double minimum(double a, double b)
{
    return isnan(a) || isnan(b) ? (double)NAN : fmin(a, b);
}

// Relative to a scale; 0 where nothing is off, whatever the scale.
static inline double relative(double off, double scale)
{
    return off == 0 ? 0 : off / scale;
}

// cmocka's assert_float_equal takes NaN for equal to every number.
#define assert_near(value, expected, epsilon)                                                      \
    do {                                                                                           \
        const double value_ = (value), expected_ = (expected);                                     \
        assert_false(isnan(value_) || isnan(expected_));                                           \
        assert_float_equal(value_, expected_, epsilon);                                            \
    } while (0)
