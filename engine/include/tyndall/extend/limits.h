// limits.h -- what the tables of methods' limits (tyn_limit, docs/stress.md) are written with. Tier 7.
#pragma once
#include "job.h"
#include <math.h>

#ifdef __cplusplus
extern "C" {
#endif

#define TYN_FIGURE(name) offsetof(tyn_regime, name)
// clang-format off
#define TYN_ABOVE(name, x) {TYN_FIGURE(name), x, INFINITY}
#define TYN_BELOW(name, x) {TYN_FIGURE(name), -INFINITY, x}
// clang-format on

// Measured errors: straight lines of logarithms between, 0 before the first, and no more than the last beyond.
typedef struct tyn_limit_point {
    double x, error;
} tyn_limit_point;
TYN_API double tyn_limit_along(const tyn_limit_point *curve, size_t count, double x);

// Of every method that follows rays.
TYN_API double tyn_limit_floats(const tyn_regime *r);
#define TYN_LIMIT_FLOATS                                                                           \
    {                                                                                              \
        .key = "depths beyond single precision", .where = {TYN_ABOVE(depth, 3e6)},                 \
        .error = tyn_limit_floats, .source = "docs/stress.md, \"What is found\"", .warning = {     \
            "accuracy: a mean free path is %.2g of the medium's box; places are single precision " \
            "numbers, of which 1e-7 of the box is the finest",                                     \
            {TYN_FIGURE(mean_free_path)}                                                           \
        }                                                                                          \
    }

// Of methods that know no periodic media, and of those whose light scatters once; `page`: with the measurement.
#define TYN_LIMIT_NOT_PERIODIC(page)                                                               \
    {                                                                                              \
        .key = "periodic media", .where = {TYN_ABOVE(repeats, 0)}, .level = TYN_LIMIT_REFUSED,     \
        .advice = {"media that repeat: refused"}, .source = page                                   \
    }
TYN_API double tyn_limit_again(const tyn_regime *r);
#define TYN_LIMIT_ONE_SCATTERING(page)                                                             \
    {                                                                                              \
        .key = "one scattering alone", .where = {TYN_ABOVE(mean_depth, 0)},                        \
        .error = tyn_limit_again,                                                                  \
        .advice = {"one scattering: about %g %% of the scattered light has scattered again "       \
                   "(albedo %.3g, depth %.4g) and is missing",                                     \
                   {TYN_LIMIT_ERROR, TYN_FIGURE(albedo), TYN_FIGURE(mean_depth)}},                 \
        .source = page, .warned = {TYN_ABOVE(scatterings, 0.3)}, .warning = {                      \
            "accuracy: light that has scattered more than once is left out; the medium is up to "  \
            "%.3g scattering mean free paths (delta scaled) deep",                                 \
            {TYN_FIGURE(scatterings)}                                                              \
        }                                                                                          \
    }

// How many scattering mean free paths (delta scaled) the longest side of the media's box is where they are dense; of the
// largest channel.
TYN_API float tyn_limit_scatterings(const tyn_job *job);

// Warns of what the job's method is known to lose in its scene (each line begins with "accuracy:"): from the scene's
// figures alone, so that it costs nothing. `cell`: of the lattice, m; 0: there is none, or none yet.
TYN_API void tyn_limits_warn(const tyn_job *job, float cell);

#ifdef __cplusplus
}
#endif
