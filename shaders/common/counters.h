// counters.h -- what kernels count for the stats. Included by C and GLSL. A pass that counts has an OUT
// port "counters" of this struct, which TYN_COUNTS names.
#ifndef TYN_COUNTERS_H
#define TYN_COUNTERS_H
#include "light_sum.h"

struct counters_block {
    tyn_uint steps;      // march steps, or tentative collisions / 16 (path)
    tyn_uint non_finite; // NaN or infinity met and replaced by 0
    tyn_uint clamped;    // negative sums set to 0
    tyn_uint cut;        // paths ended by the safety cap
    tyn_uint pixels;     // pixels or points that hit a medium
    // lattice: by channel, share of the solution that further sweeps would change, about
    float unsettled[3];
    tyn_uint ghosts;                 // merge: cells around the lattice that were set to 0
    TYN_STRUCT(light_clamp) clamp_0; // what was set to 0, and what was not
};
TYN_ASSERT_SIZE(counters_block, 36 + 2048);

// Rows of tyn_pass_desc.counters.
// clang-format off
#define TYN_COUNTERS                                                                               \
    {"steps", offsetof(struct counters_block, steps)},                                             \
    {"pixels", offsetof(struct counters_block, pixels)},                                           \
    TYN_COUNTER_NON_FINITE,                                                                        \
    {"clamped", offsetof(struct counters_block, clamped)},                                         \
    {"cut", offsetof(struct counters_block, cut)}
// ... of those that count nothing else.
#define TYN_COUNTER_NON_FINITE {"non_finite", offsetof(struct counters_block, non_finite)}
// The light that `clamped` took away, as a share of what is left; %g of the warning's text is that in percent.
#define TYN_COUNTER_HIDDEN(of, text)                                                               \
    {.name = "hidden", .offset = offsetof(struct counters_block, clamp_0), .clamp = true,          \
     .unit = of, .limit = TYN_HIDDEN_LIMIT, .warning = text}
#define TYN_HIDDEN_LIMIT 0.001
// clang-format on

#endif
