// importance_field.comp -- what each cell scatters for the last time.
#include "importance_args.h"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
TYN_READ(0, cells, importance_cell cells[]);
TYN_READ(1, tracks, vec2 tracks[]);
layout(set = 0, binding = 2, rgba32f) uniform writeonly image3D field;
TYN_ARGS(importance_args args);

void main()
{
    uvec3 cell = gl_GlobalInvocationID;
    if (any(greaterThanEqual(cell, uvec3(args.cells)))) {
        return;
    }
    uint index = (cell.z * args.cells + cell.y) * args.cells + cell.x;
    importance_cell here = cells[index];
    vec2 track = tracks[index];
    // Power times length over the volume is the fluence; HG of g after HG of a is HG of g a.
    float fluence = here.volume > 0.0 ? track.x / here.volume : 0.0;
    float cosine = track.x > 0.0 ? 1.0 - track.y / track.x : 0.0;
    float scattered = fluence * here.sigma_s;
    imageStore(field, ivec3(cell), vec4(scattered, scattered * cosine * here.g, here.sigma_t, 0.0));
}
