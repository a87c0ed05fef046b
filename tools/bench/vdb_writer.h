// vdb_writer.h -- writes OpenVDB files by OpenVDB itself: for tyndall-raw-to-vdb, and for tests.
//
// OpenVDB's headers take as long to compile as half of the library: its reader (engine/io/vdb.cpp) and this writer are the
// only files that include them.
#pragma once
#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum vdb_values { VDB_FLOATS, VDB_VECTORS, VDB_BOOLS } vdb_values;

// openvdb::io's flags.
enum { VDB_PLAIN = 0, VDB_ZIP = 1, VDB_ACTIVE_MASK = 2, VDB_BLOSC = 4 };

typedef struct vdb_spec {
    const char *name;
    vdb_values values;
    int32_t lo[3], hi[3];  // voxels, inclusive
    double voxel[3], turn; // edges of a voxel; about +Z, radians
    double origin[3];      // where the middle of voxel 0, 0, 0 is
    float (*value)(int32_t i, int32_t j, int32_t k, int c);
    bool sparse; // voxels of value 0 stay inactive
    bool half;   // stored as half floats
} vdb_spec;

// NULL, or what went wrong: nothing was written then. The text stands until the next call.
const char *vdb_write(const char *path, const vdb_spec *specs, int count, uint32_t compression);

#ifdef __cplusplus
}
#endif
