// surface_table_args.h -- a table by which paths draw triangles. Included by C and GLSL.
#ifndef TYN_SURFACE_TABLE_ARGS_H
#define TYN_SURFACE_TABLE_ARGS_H
#include "shaders/common/shared.h"

// Head of the storage buffers "emitters" (triangles drawn by area times the largest channel of their emission)
// and "areas" (by area); `count` cells follow.
struct surface_table {
    tyn_vec3 centre; // of the box around the triangles, world, m
    float radius;    // half the box's diagonal, m
    tyn_vec3 power;  // W, of what the triangles emit
    float weight;    // sum of the weights by which they are drawn: m^2 or W/sr
    tyn_uint count;
    tyn_uint pad[3];
};
TYN_ASSERT_SIZE(surface_table, 48);

// Walker's alias method: draw a cell uniformly, take its triangle with probability `keep`, else `alias`.
struct surface_cell {
    float keep;
    tyn_uint alias, triangle; // indices of triangles
};
TYN_ASSERT_SIZE(surface_cell, 12);

#endif
