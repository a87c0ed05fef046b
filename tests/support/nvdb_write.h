// nvdb_write.h -- writes small NanoVDB files for tests, byte by byte after the published layout.
#pragma once
#include <stdint.h>
#include <stddef.h>

// VEC3F: a voxel's value times 1, 1/2, 1/4.
enum {
    NVDB_FLOAT = 1,
    NVDB_VEC3F = 6,
    NVDB_HALF = 9,
    NVDB_FP4 = 13,
    NVDB_FP8 = 14,
    NVDB_FP16 = 15,
    NVDB_FPN = 16
};
enum { NVDB_PLAIN = 0, NVDB_ZIP = 1, NVDB_BLOSC = 2 };

typedef struct nvdb_spec {
    const char *name;     // of the grid
    uint32_t type, codec; // NVDB_*
    uint32_t grid_class;  // 2 = fog volume, 1 = level set
    int32_t lo[3], hi[3]; // active voxels, inclusive
    // Of every voxel of a leaf, active or not; in [0, 1] for the quantised types. NULL: 1
    // everywhere.
    float (*value)(int32_t i, int32_t j, int32_t k);
    float background;
    int32_t tile[3];  // origin of one 8^3 block that is stored as a tile of value tile_value
    float tile_value; // 0: no tile
    double voxel;     // size of a voxel, m; world = voxel * index
} nvdb_spec;

// The whole file; freed with free(). `grid_offset` (may be NULL): where the packed grid starts.
uint8_t *nvdb_write(const nvdb_spec *spec, size_t *size, size_t *grid_offset);
