// dispatch_sizes.h -- how large dispatches are on a device: one table for all passes. Tier 2.
//
// Figures of a software device are measured on lavapipe with two cores. A card's size is `held` times the threads that it holds at
// once, clamped to `least` and `most`. On an NVIDIA H200, which holds 262144, `path` is 5 to 70 times as fast with as many threads as
// with the software device's (docs/on-a-card.md).
#pragma once
#include "../device.h"

// X(name, software, held, least, most): what it is.
// clang-format off
#define TYN_DISPATCH_SIZES(X) \
    X(PATH_THREADS,     16384, 2,  8192, 1048576) /* of path and path_probe: most */ \
    X(PATH_LONG,         1024, 1,  4096, 1048576) /* ... at least, where paths are long */ \
    X(PATH_SLOTS,       16384, 0,  4096,    4096) /* ... of a pixel or point, most: one thread merges them */ \
    X(FLUX_THREADS,       512, 0,  4096,    4096) /* of path_fluxes; a sample has 4096 paths */ \
    X(BALANCE_THREADS,   4096, 0, 16384,   16384) /* of path_balance: one thread merges them */ \
    X(BALANCE_SAMPLES,      1, 0,  1024,    1024) /* ... samples of a record, most */ \
    X(PHOTONS_LEAST,     1024, 1, 16384, 1048576) /* of photon_trace; a thread follows four */ \
    X(PHOTONS_MOST,     65536, 8, 65536, 4194304) \
    X(DISPATCH_MS,         20, 0,    50,      50) /* aimed at; drivers end what takes seconds */ \
    X(RECORD_MS,         1000, 0,   250,     250) /* of samples: Ctrl-C is answered after one */
// clang-format on

typedef enum tyn_dispatch_size {
#define TYN_SIZE_NAME(name, software, held, least, most) TYN_SIZE_##name,
    TYN_DISPATCH_SIZES(TYN_SIZE_NAME) TYN_NUM_DISPATCH_SIZES
#undef TYN_SIZE_NAME
} tyn_dispatch_size;

static inline uint32_t tyn_dispatch_size_of(const tyn_capacity *capacity, tyn_dispatch_size which)
{
    static const struct tyn_dispatch_size_row {
        uint32_t software, held, least, most;
    } rows[TYN_NUM_DISPATCH_SIZES] = {
#define TYN_SIZE_ROW(name, software, held, least, most) {software, held, least, most},
        TYN_DISPATCH_SIZES(TYN_SIZE_ROW)
#undef TYN_SIZE_ROW
    };
    const struct tyn_dispatch_size_row *row = &rows[which];
    const uint64_t wanted = (uint64_t)row->held * capacity->threads;
    return capacity->software    ? row->software
           : wanted < row->least ? row->least
           : wanted > row->most  ? row->most
                                 : (uint32_t)wanted;
}
