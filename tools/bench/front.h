// front.h -- what points of error against time say: the Pareto front, the time for an error, who is fastest.
//
// Pure functions of numbers. A line is the points of one method over its settings. The points of a method
// that samples are one curve, along which its error falls with time, and between two of them it is
// interpolated; the points of any other are what they are.
//
// An error that the noise of the reference hides is known to be at most that noise, and no more: such a point
// stands at the noise, `bound`, and nothing is said of errors below it.
#pragma once
#include <stdbool.h>
#include <stdint.h>

typedef struct front_point {
    double ms, error; // > 0 and >= 0; a point with anything else is not looked at
    uint32_t line;
    bool sampling;
    bool bound; // the error is this or less
} front_point;

// Indices of the points that no other beats in both, by time; gives their number. Of equal points the
// first. `indices` has room for `count`.
uint32_t front_pareto(const front_point *points, uint32_t count, uint32_t *indices);

typedef struct front_time {
    double ms;     // NAN: the line does not get there
    int32_t point; // that has this error or less; -1: between points, or beyond them
    bool measured; // false: beyond the points of a sampling line, by 1/sqrt(samples)
} front_time;

// How long a line needs for an error. Sampling: log-log between the neighbours on the lower envelope of the
// curve; by 1/sqrt(samples) towards a bound one, as far as its time. Else: the fastest point with this error or less.
front_time front_time_at(const front_point *points, uint32_t count, uint32_t line, double error);

// A range of errors in which one line is the fastest of all.
typedef struct front_error {
    double error;  // NAN: nothing of the line is that fast
    bool measured; // false: beyond the points, by 1/sqrt(samples)
} front_error;

// The error of a line of samples after a time: log-log between the neighbours on the lower envelope of the curve. What
// the noise of the reference hides stands at it; beyond such a point the error is not known.
front_error front_error_at(const front_point *points, uint32_t count, uint32_t line, double ms);

typedef struct front_range {
    uint32_t line;
    double low, high;
    bool lowest, highest; // the range has no lower, no upper end
} front_range;
// From the least error of any point to that of the fastest, from which on nothing changes, in steps of 1 %; from small
// to large errors. Where the least is bound the first range ends there. Nothing is counted as faster than its fastest
// point. Ranges of less than 5 % go to the one below, the first of all to the one above. Gives the number of ranges, at most `max`;
// what does not fit is left out at the upper end.
uint32_t front_ranges(const front_point *points, uint32_t count, front_range *ranges, uint32_t max);

// NAN where any is not finite or not > 0, and of none: a mean that leaves values out is one of other things.
double front_geometric_mean(const double *values, uint32_t count);
