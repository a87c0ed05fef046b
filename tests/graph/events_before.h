// events_before.h -- what the events of events.c cost at commit f021a6b, before compilations kept what they could: the same program, run there.
#pragma once
#include <stdint.h>

// By method and event: may record go on without prepare ('y') or does it refuse ('n'); nodes, objects, allocations, kernels' objects.
static const struct before {
    char record;
    uint32_t nodes, objects, allocations, kernels;
} costs_before[3][28] = {
    {
        // pop
        {'y', 0, 0, 0, 0},     // nothing changed
        {'y', 4, 0, 0, 0},     // camera moved
        {'y', 4, 0, 0, 0},     // camera turned
        {'n', 4, 112, 2, 0},   // picture resized
        {'n', 1, 103, 2, 4},   // one more output
        {'y', 9, 0, 0, 0},     // lamp of four: strength 2.4 to 2.8
        {'n', 12, 106, 2, 8},  // lamp of four off
        {'n', 12, 106, 2, 12}, // lamp of four on
        {'y', 12, 0, 0, 0},    // lamp moved
        {'y', 9, 0, 0, 0},     // lamp grey to coloured
        {'n', 18, 308, 5, 8},  // lamp added
        {'y', 10, 0, 0, 0},    // sun's strength
        {'y', 10, 0, 0, 0},    // sun off
        {'y', 10, 0, 0, 0},    // sun on
        {'y', 13, 0, 0, 0},    // sun turned
        {'n', 13, 103, 2, 0},  // sun crosses a side
        {'y', 6, 0, 0, 0},     // sun grey to coloured, no surfaces
        {'n', 6, 76, 2, 20},   // sun grey to coloured, no surfaces, no map
        {'y', 10, 0, 0, 0},    // sun grey to coloured
        {'n', 15, 210, 5, 16}, // medium grey to coloured
        {'y', 12, 0, 0, 0},    // density scale of the medium
        {'n', 12, 1, 1, 0},    // grid replaced by one of equal size
        {'y', 14, 0, 0, 0},    // medium moved
        {'y', 4, 0, 0, 0},     // map's strength
        {'y', 4, 0, 0, 0},     // map turned
        {'n', 4, 1, 1, 0},     // map replaced
        {'y', 14, 0, 0, 0},    // surface moved
        {'n', 9, 122, 2, 0},   // `lattice.cells` 32 to 24
    },
    {
        // lpv
        {'y', 0, 0, 0, 0},    // nothing changed
        {'y', 4, 0, 0, 0},    // camera moved
        {'y', 4, 0, 0, 0},    // camera turned
        {'n', 4, 72, 2, 0},   // picture resized
        {'n', 1, 63, 2, 4},   // one more output
        {'y', 8, 0, 0, 0},    // lamp of four: strength 2.4 to 2.8
        {'n', 11, 66, 2, 8},  // lamp of four off
        {'n', 11, 66, 2, 12}, // lamp of four on
        {'y', 11, 0, 0, 0},   // lamp moved
        {'n', 10, 75, 2, 28}, // lamp grey to coloured
        {'n', 17, 222, 5, 8}, // lamp added
        {'y', 8, 0, 0, 0},    // sun's strength
        {'y', 8, 0, 0, 0},    // sun off
        {'y', 8, 0, 0, 0},    // sun on
        {'y', 11, 0, 0, 0},   // sun turned
        {'n', 11, 63, 2, 0},  // sun crosses a side
        {'y', 6, 0, 0, 0},    // sun grey to coloured, no surfaces
        {'n', 6, 45, 2, 20},  // sun grey to coloured, no surfaces, no map
        {'n', 9, 75, 2, 28},  // sun grey to coloured
        {'n', 13, 46, 2, 16}, // medium grey to coloured
        {'y', 11, 0, 0, 0},   // density scale of the medium
        {'n', 11, 1, 1, 0},   // grid replaced by one of equal size
        {'y', 13, 0, 0, 0},   // medium moved
        {'y', 4, 0, 0, 0},    // map's strength
        {'y', 4, 0, 0, 0},    // map turned
        {'n', 8, 76, 3, 28},  // map replaced
        {'y', 12, 0, 0, 0},   // surface moved
        {'y', 0, 0, 0, 0},    // `lattice.cells` 32 to 24
    },
    {
        // pop-paper
        {'y', 0, 0, 0, 0},    // nothing changed
        {'y', 10, 0, 0, 0},   // camera moved
        {'y', 10, 0, 0, 0},   // camera turned
        {'n', 10, 85, 2, 0},  // picture resized
        {'n', 2, 76, 2, 4},   // one more output
        {'y', 9, 0, 0, 0},    // lamp of four: strength 2.4 to 2.8
        {'n', 12, 85, 2, 0},  // lamp of four off
        {'n', 12, 85, 2, 0},  // lamp of four on
        {'y', 11, 0, 0, 0},   // lamp moved
        {'y', 9, 0, 0, 0},    // lamp grey to coloured
        {'n', 17, 283, 5, 0}, // lamp added
        {'y', 10, 0, 0, 0},   // sun's strength
        {'y', 10, 0, 0, 0},   // sun off
        {'y', 10, 0, 0, 0},   // sun on
        {'y', 13, 0, 0, 0},   // sun turned
        {'n', 14, 76, 2, 0},  // sun crosses a side
        {'y', 5, 0, 0, 0},    // sun grey to coloured, no surfaces
        {'y', 5, 0, 0, 0},    // sun grey to coloured, no surfaces, no map
        {'y', 10, 0, 0, 0},   // sun grey to coloured
        {'n', 8, 42, 2, 10},  // medium grey to coloured
        {'y', 13, 0, 0, 0},   // density scale of the medium
        {'n', 13, 1, 1, 0},   // grid replaced by one of equal size
        {'y', 14, 0, 0, 0},   // medium moved
        {'y', 6, 0, 0, 0},    // map's strength
        {'y', 6, 0, 0, 0},    // map turned
        {'n', 7, 1, 1, 0},    // map replaced
        {'y', 12, 0, 0, 0},   // surface moved
        {'y', 0, 0, 0, 0},    // `lattice.cells` 32 to 24
    },
};
