// nvdb.h -- NanoVDB files (.nvdb).
#pragma once
#include "io/volume.h"

// Reads one grid of a NanoVDB file in memory: uncompressed, ZIP, or BLOSC where the build has it;
// float, half and the quantised float types, vec3f for colours. Faults are one line that names `file`.
tyn_result tyn_nvdb_read(tyn_grid_job *job, const void *bytes, size_t size, const char *file);
tyn_result tyn_nvdb_read_file(tyn_grid_job *job, const char *path);
