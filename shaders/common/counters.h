// counters.h -- what kernels count for the stats. Included by C and GLSL. A pass that counts has an OUT
// port "counters" of this struct, filled with zeros at the start of its record.
#ifndef TYN_COUNTERS_H
#define TYN_COUNTERS_H
#include "shared.h"

struct counters_block {
    tyn_uint steps;      // march steps, or tentative collisions / 16 (path)
    tyn_uint non_finite; // NaN or infinity met and replaced by 0
    tyn_uint clamped;    // negative sums set to 0
    tyn_uint cut;        // paths ended by the safety cap
    tyn_uint pixels;     // pixels or points that hit a medium
    // lattice: by channel, share of the solution that further sweeps would change, about
    float unsettled[3];
};
TYN_ASSERT_SIZE(counters_block, 32);

#endif
