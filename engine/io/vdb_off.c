// vdb_off.c -- stands in for vdb.cpp in builds without OpenVDB.
#include "io/vdb.h"

tyn_result tyn_vdb_read_file(tyn_grid_job *job, const char *path)
{
    return TYN_FAULT(job->log, TYN_ERR_UNSUPPORTED,
                     "%s: this build cannot read .vdb files: build with -Dopenvdb=enabled (needs "
                     "OpenVDB), or convert the file to .nvdb",
                     path);
}
