// voxel_distance_layers.comp -- the distance, beside the density; a thread per column along z, neighbours along x. Built
// for both modes of the medium.
#include "voxel_distance_args.h"

layout(local_size_x = 64) in;
TYN_ARGS(voxel_distance_args args);
layout(binding = 0) uniform sampler3D along_y_tex;
TYN_UPDATE(1, envelope, uint envelope[]);
layout(binding = 2) uniform sampler3D density_tex; // or sigma_s
#ifdef TYN_DENSITY
layout(binding = 3, rg32f) uniform writeonly image3D voxels_image;
#else
layout(binding = 3, rgba32f) uniform writeonly image3D voxels_image;
layout(binding = 4) uniform sampler3D sigma_a_tex;
#endif

#define VOXEL_BEFORE along_y_tex

ivec3 place(int i)
{
    return ivec3(gl_GlobalInvocationID.xy, i);
}

int column_last()
{
    return int(args.size.z) - 1;
}

uint envelope_index(int k)
{
    return (uint(k) * args.size.y + gl_GlobalInvocationID.y) * args.size.x + gl_GlobalInvocationID.x;
}

void keep(int q, float squared)
{
    const float m = squared < VOXEL_DISTANCE_NONE ? args.unit * sqrt(squared) : VOXEL_DISTANCE_EMPTY;
    const ivec3 at = place(q);
#ifdef TYN_DENSITY
    imageStore(voxels_image, at, vec4(texelFetch(density_tex, at, 0).r, m, 0.0, 0.0));
#else
    imageStore(voxels_image, at, vec4(texelFetch(density_tex, at, 0).rgb + texelFetch(sigma_a_tex, at, 0).rgb, m));
#endif
}

#include "voxel_distance.glsl"

void main()
{
    if (gl_GlobalInvocationID.x < args.size.x && gl_GlobalInvocationID.y < args.size.y) {
        column_distances(int(args.size.z), args.side.z);
    }
}
