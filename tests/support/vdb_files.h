// vdb_files.h -- OpenVDB files in every way that the library stores values.
#pragma once
#include <stdbool.h>

enum { VDB_FILES = 10, VDB_NX = 21, VDB_NY = 18, VDB_NZ = 17 };

#ifdef __cplusplus
extern "C" {
#endif

// Writes file `i`, 0 to VDB_FILES - 1: grids "density", "Cd" (a color of a voxel) and "mask" (bool), none or zip or
// Blosc, with and without inactive values, as floats (even) or half floats (odd). Gives whether it could.
bool vdb_file_write(int i, const char *path);

// Density at a voxel of the box; where it is 0 the voxel is not active.
float vdb_file_density(int x, int y, int z);

#ifdef __cplusplus
}
#endif
