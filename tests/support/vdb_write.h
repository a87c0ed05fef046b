// vdb_write.h -- writes small OpenVDB files for tests, by OpenVDB itself.
#pragma once
#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct vdb_spec {
    const char *name;
    bool vector;          // three floats a voxel, else one
    int32_t lo[3], hi[3]; // active voxels, inclusive
    double voxel, turn;   // edge of a voxel; about +Z, radians
    double origin[3];     // where voxel 0, 0, 0 is
    float (*value)(int32_t i, int32_t j, int32_t k, int c);
} vdb_spec;

// False: nothing was written.
bool vdb_write(const char *path, const vdb_spec *specs, int count);

#ifdef __cplusplus
}
#endif
