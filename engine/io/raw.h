// raw.h -- bare arrays of values, x fastest, little-endian.
#pragma once
#include "io/volume.h"

typedef enum tyn_raw_type { TYN_RAW_F32 = 0, TYN_RAW_F16, TYN_RAW_U8 } tyn_raw_type;

// `channels` values a voxel, one behind the other; u8 0..255 becomes 0..1. `bytes` must have exactly the size of the grid.
// Faults name `file`.
tyn_result tyn_raw_read(tyn_grid_job *job, const void *bytes, size_t num_bytes,
                        const int64_t size[3], uint32_t channels, tyn_raw_type type,
                        const char *file);
