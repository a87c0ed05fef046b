// bound.h -- bounds of errors, each near what is observed, or with its reason.
//
// A bound that is many times what is observed guards nothing, so of every bound that is named here the largest part that
// is ever observed must in the end be a third, or the bound must say why it is wider. Bounds of 1e-4 and less are of
// rounding, and need not come this way.
#pragma once
#include <stdbool.h>

// Reasons that many have.
#define BOUND_NOISE "of standard errors, which the samples drawn may use up or not"
#define BOUND_ROUNDING "of rounding, which other devices do otherwise"
#define BOUND_FILTER                                                                               \
    "of texture units, which may interpolate with weights of 8 bits: this device has more"
#define BOUND_PROMISE "what is promised for all scenes, of which these are some"

// Is `observed` at most `bound`? No NaN is. `why` (a literal, or NULL): the reason if the bound is wide. The name may be that
// of many checks, as in a loop: of these the one nearest to its bound is held. So a name is of one quantity, whose largest
// value over points or texels counts; scenes and settings that differ go by names and bounds of their own. With TYN_BOUNDS
// in the environment every check is printed.
bool within(double observed, double bound, const char *why, const char *name, ...)
    __attribute__((format(printf, 4, 5)));

// Fails a cmocka test; the name is that of the function and of what is observed.
#define assert_within(observed, bound, why)                                                        \
    assert_true(within(observed, bound, why, "%s, %s", __func__, #observed))

// To be called once, at the end: prints all bounds beside what was observed. `judged`: false if one of them was wide
// without a reason; else true. gpu_teardown does.
bool bounds_near(bool judged);
