// vdb.h -- OpenVDB files (.vdb): vdb.cpp where the build has OpenVDB, else vdb_off.c.
#pragma once
#include "io/volume.h"

#ifdef __cplusplus
extern "C" {
#endif

tyn_result tyn_vdb_read_file(tyn_grid_job *job, const char *path);

#ifdef __cplusplus
}
#endif
