// sky_shadows_corners.comp -- the triangles' vertices, for draws that compute a vertex once for all its triangles.
#include "shaders/light/sky_map_args.h"
#include "shaders/surfaces/surface_args.h"

layout(local_size_x = 256) in;
TYN_ARGS(sky_corners_args args);
TYN_READ(0, triangles, surface_triangle triangles[]);
TYN_WRITE(1, corners, uint corners[]);

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i < args.num_triangles) {
        surface_triangle t = triangles[i];
        corners[3u * i] = t.v0;
        corners[3u * i + 1u] = t.v1;
        corners[3u * i + 2u] = t.v2;
    }
}
