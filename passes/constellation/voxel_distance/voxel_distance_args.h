// voxel_distance_args.h -- push constants of voxel_distance. Included by C and GLSL.
#include "shaders/common/shared.h"

struct voxel_distance_args {
    tyn_uvec3 size; // voxels
    float unit;     // shortest side of a voxel, m
    tyn_vec3 side;  // sides of a voxel, in units
    tyn_uint reach; // 1: to where density that is blended between voxels begins, else to centres
};
TYN_ASSERT_SIZE(voxel_distance_args, 32);

// Squared distance, in units, where a line of voxels has nothing but empty ones: above all that are distances.
#define VOXEL_DISTANCE_NONE 1e30f
// What the result is in a medium that is empty everywhere, m: above all that are distances, and half floats hold it.
#define VOXEL_DISTANCE_EMPTY 65504.0f
