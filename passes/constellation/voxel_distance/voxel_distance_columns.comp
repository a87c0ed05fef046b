// voxel_distance_columns.comp -- squared distance within a slice; a thread per column along y, neighbours along x.
#include "voxel_distance_args.h"

layout(local_size_x = 64) in;
TYN_ARGS(voxel_distance_args args);
layout(binding = 0) uniform sampler3D along_x_tex;
layout(binding = 1, r32f) uniform writeonly image3D along_y_image;
TYN_UPDATE(2, envelope, uint envelope[]);

#define VOXEL_BEFORE along_x_tex

ivec3 place(int i)
{
    return ivec3(gl_GlobalInvocationID.x, i, gl_GlobalInvocationID.y);
}

int column_last()
{
    return int(args.size.y) - 1;
}

uint envelope_index(int k)
{
    return (uint(k) * args.size.z + gl_GlobalInvocationID.y) * args.size.x + gl_GlobalInvocationID.x;
}

void keep(int q, float squared)
{
    imageStore(along_y_image, place(q), vec4(squared));
}

#include "voxel_distance.glsl"

void main()
{
    if (gl_GlobalInvocationID.x < args.size.x && gl_GlobalInvocationID.y < args.size.z) {
        column_distances(int(args.size.y), args.side.y);
    }
}
