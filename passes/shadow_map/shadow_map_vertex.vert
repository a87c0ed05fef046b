// shadow_map_vertex.vert -- the corners of the scene's triangles as a light sees them.
#include "shaders/surfaces/surface_args.h"
#include "shaders/light/shadow_args.h"

TYN_READ(0, triangles, surface_triangle triangles[]);
TYN_READ(1, vertices, surface_vertex vertices[]);
TYN_ARGS(shadow_map_args args);

void main()
{
    surface_triangle t = triangles[gl_VertexIndex / 3];
    int corner = gl_VertexIndex % 3;
    uint v = corner == 0 ? t.v0 : corner == 1 ? t.v1 : t.v2;
    vec4 p = vec4(vertices[v].position, 1.0);
    gl_Position = vec4(dot(args.clip[0], p), dot(args.clip[1], p), dot(args.clip[2], p),
                       dot(args.clip[3], p));
}
