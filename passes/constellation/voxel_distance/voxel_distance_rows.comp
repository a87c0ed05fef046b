// voxel_distance_rows.comp -- squared distance to the nearest voxel of the row that is not empty; a thread per row along x.
// Built for mode DENSITY and for the others.
#include "voxel_distance_args.h"

layout(local_size_x = 8, local_size_y = 8) in;
TYN_ARGS(voxel_distance_args args);
layout(binding = 0) uniform sampler3D density_tex; // or sigma_s
layout(binding = 1, r32f) uniform image3D along_x;
#ifndef TYN_DENSITY
layout(constant_id = 0) const uint emissive = 0u;
layout(binding = 2) uniform sampler3D sigma_a_tex;
layout(binding = 3) uniform sampler3D emission_tex;
#endif

bool is_empty(ivec3 at)
{
#ifdef TYN_DENSITY
    return !(texelFetch(density_tex, at, 0).r > 0.0);
#else
    vec3 sum = texelFetch(density_tex, at, 0).rgb + texelFetch(sigma_a_tex, at, 0).rgb;
    if (emissive != 0u) {
        sum += texelFetch(emission_tex, at, 0).rgb;
    }
    return !any(greaterThan(sum, vec3(0.0)));
#endif
}

void main()
{
    const ivec2 row = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(row, ivec2(args.size.yz)))) {
        return;
    }
    const int count = int(args.size.x);
    float away = 1e9; // voxels since the last one that is not empty
    for (int x = 0; x < count; x++) {
        away = is_empty(ivec3(x, row)) ? away + 1.0 : 0.0;
        imageStore(along_x, ivec3(x, row), vec4(away));
    }
    away = 1e9;
    for (int x = count - 1; x >= 0; x--) {
        const float before = imageLoad(along_x, ivec3(x, row)).r;
        away = before == 0.0 ? 0.0 : away + 1.0;
        const float least = max(min(before, away) - float(args.reach), 0.0), m = least * args.side.x;
        imageStore(along_x, ivec3(x, row), vec4(least < 1e8 ? m * m : VOXEL_DISTANCE_NONE));
    }
}
