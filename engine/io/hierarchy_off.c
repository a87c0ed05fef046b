// hierarchy_off.c -- stands in for hierarchy.c in builds without Embree.
#include <tyndall/io.h>
#include "base/given.h"

tyn_result tyn_surfaces_build_nodes(tyn_surfaces *surfaces, const tyn_log *log)
{
    if (!TYN_GIVEN(log, surfaces)) {
        return TYN_ERR_PARAMS;
    }
    if (!surfaces->num_triangles) {
        return TYN_OK;
    }
    return TYN_FAULT(
        log, TYN_ERR_UNSUPPORTED,
        "this build cannot trace rays against surfaces: build with -Dembree=enabled (needs "
        "Embree 3), or use a method that rasterises them (--method pop)");
}
