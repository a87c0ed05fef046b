// regime_limits.c -- errors that methods are known to make in a regime.
//
// Measured on boxes in one sun against `path` (docs/choosing.md, docs/stress.md); straight lines of logarithms
// between, and no more than the last beyond.
#include "regime_limits.h"
#include <math.h>
#include <string.h>

const char *const regime_limit_names[LIMIT_NUM] = {
    [LIMIT_THICK] = "thick lattice cells",     [LIMIT_THIN] = "few lattice cells through the box",
    [LIMIT_BACKWARD] = "a backward peak",      [LIMIT_FORWARD] = "a narrow forward lobe",
    [LIMIT_MULTIPLE] = "one scattering alone", [LIMIT_HOPS] = "propagation as published",
    [LIMIT_STEPS] = "paths that are ended",    [LIMIT_FLOATS] = "depths beyond single precision",
};

typedef struct point {
    double x, error;
} point;

// Depth of a lattice cell. (Half a per cent and less below.)
static const point thick[] = {{1, 0.02}, {2, 0.1}, {7, 0.2}, {24, 0.4}, {300, 1}};
// Lattice cells through the box: share of the light that has scattered more than once.
static const point thin[] = {{0.5, 1.2}, {1, 0.35}, {2, 0.3}, {3, 0.15},
                             {4, 0.07},  {6, 0.04}, {8, 0.01}};
// 1 / (1 + g): g -0.5, -0.7, -0.8, -0.9, -0.99; from depth 1 on.
static const point backward[] = {{2, 0.025}, {1 / 0.3, 0.09}, {5, 0.2}, {10, 0.6}, {100, 10}};
// 1 / (1 - g): g 0.98 and 0.995.
static const point forward[] = {{50, 0.05}, {200, 0.4}};
// Optical depth of the box.
static const point floats[] = {{3e6, 0.1}, {1e8, 0.4}};
#define COUNT(table) (sizeof(table) / sizeof(table)[0])

// 0 before the first.
static double along(const point *table, size_t count, double x)
{
    if (!(x >= table[0].x)) {
        return 0;
    }
    for (size_t i = 1; i < count; i++) {
        const point *a = &table[i - 1], *b = &table[i];
        if (x < b->x) {
            const double t = log(x / a->x) / log(b->x / a->x);
            return a->error * pow(b->error / a->error, t);
        }
    }
    return table[count - 1].error;
}

// Of `length`, in the shorter of scaled and transport mean free paths.
static double depth_of(const regime *r, double length)
{
    const double scaled = r->scaled_mean_free_path, transport = r->transport_mean_free_path;
    return fmax(scaled > 0 ? length / scaled : 0, transport > 0 ? length / transport : 0);
}

double regime_cell_depth(const regime *r, double cells)
{
    return depth_of(r, regime_longest(r) / regime_cells(r, cells));
}

double regime_cells_thick(const regime *r, double cells)
{
    return regime_longest(r) > 0 ? r->thickness / regime_longest(r) * regime_cells(r, cells)
                                 : cells;
}

// Is there light on the lattice at all?
static bool scatters_again(const regime *r)
{
    return r->albedo * depth_of(r, regime_longest(r)) > 0.05;
}

double regime_thick_error(const regime *r, double cells)
{
    return scatters_again(r) ? along(thick, COUNT(thick), regime_cell_depth(r, cells)) : 0;
}

double regime_thin_error(const regime *r, double cells)
{
    const double x = regime_cells_thick(r, cells);
    if (!scatters_again(r) || !(depth_of(r, r->thickness) > 0.1) || x > thin[COUNT(thin) - 1].x) {
        return 0;
    }
    return fmin(1, along(thin, COUNT(thin), fmax(x, thin[0].x)) * regime_multiple(r));
}

double regime_backward_error(const regime *r)
{
    const double peak = along(backward, COUNT(backward), 1 / (1 + fmax(r->least_g, -0.999)));
    return scatters_again(r) ? peak * fmin(1, pow(r->optical_depth, 0.7)) : 0;
}

static double forward_error(const regime *r)
{
    const double lobe = along(forward, COUNT(forward), 1 / (1 - fmin(r->most_g, 0.9999)));
    return lobe * fmin(1, r->optical_depth);
}

static double floats_error(const regime *r)
{
    const double mean_free_path = r->mean_free_path;
    return mean_free_path > 0 ? along(floats, COUNT(floats), regime_longest(r) / mean_free_path)
                              : 0;
}

// Paths are ended after some steps: what is left of them is lost where hardly anything is absorbed.
static double steps_error(const regime *r)
{
    const bool deep = r->mean_free_path > 0 && regime_longest(r) / r->mean_free_path > 1e5;
    return deep && r->albedo > 0.9999 ? 0.1 : 0;
}

regime_limit regime_limit_of(const regime *r, const char *method, double cells)
{
    const bool pop = strcmp(method, "pop") == 0, path = strcmp(method, "path") == 0;
    const bool single = strcmp(method, "single") == 0, paper = strcmp(method, "pop-paper") == 0;
    const regime_limit limits[] = {
        {LIMIT_THICK, pop ? regime_thick_error(r, cells) : 0},
        {LIMIT_THIN, pop ? regime_thin_error(r, cells) : 0},
        {LIMIT_BACKWARD, pop ? regime_backward_error(r) : 0},
        {LIMIT_FORWARD, pop ? forward_error(r) : 0},
        {LIMIT_MULTIPLE, single ? regime_multiple(r) : 0},
        {LIMIT_HOPS, paper && scatters_again(r) ? 0.2 : 0},
        {LIMIT_STEPS, path ? steps_error(r) : 0},
        {LIMIT_FLOATS, floats_error(r)},
    };
    regime_limit worst = {LIMIT_NONE, 0};
    double squares = 0;
    for (size_t i = 0; i < COUNT(limits); i++) {
        worst = limits[i].error > worst.error ? limits[i] : worst;
        squares += limits[i].error * limits[i].error;
    }
    worst.error = sqrt(squares);
    return worst;
}
