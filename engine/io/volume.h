// volume.h -- what the readers of density grids share.
#pragma once
#include <tyndall/io.h>

// Files are read whole; a grid is stored dense. Fuzzers look for wrong accesses, not for big grids.
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
#define TYN_MAX_VOXELS (1ull << 21)
#else
#define TYN_MAX_VOXELS (1ull << 30)
#endif
#define TYN_MAX_FILE_BYTES (1ull << 34)

// Allocates zeroed data for a grid; faults are one line that names `file`.
tyn_result tyn_volume_alloc(tyn_volume *volume, const int64_t size[3], const char *file,
                            const tyn_log *log);

// After data is filled: refuses non-finite values, clamps and counts negative ones, finds the
// maximum, hashes, names the volume.
tyn_result tyn_volume_seal(tyn_volume *volume, const char *file, const char *grid,
                           uint64_t *clamped_negative, const tyn_log *log);

// Chooses among the grids of a file, those that are readable as density. `grid` NULL = "density",
// else the first readable one. Returns its index, or -1 after one line that lists the grids there
// are.
int tyn_volume_choose(const char *const *names, const char *const *types, const bool *readable,
                      uint32_t count, const char *grid, const char *file, const tyn_log *log);
