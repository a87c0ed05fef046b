// vdb.h -- OpenVDB files (.vdb): vdb.cpp where the build has OpenVDB, else vdb_off.c.
#pragma once
#include <tyndall/io.h>

#ifdef __cplusplus
extern "C" {
#endif

tyn_result tyn_vdb_load(tyn_volume *volume, const char *path, const char *grid,
                        uint64_t *clamped_negative, const tyn_log *log);

#ifdef __cplusplus
}
#endif
