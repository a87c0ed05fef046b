// rsm_vertex.vert -- the corners of the scene's triangles as a light sees them.
#include "rsm_bindings.glsl"

invariant gl_Position; // two kernels must agree on depths
layout(location = 0) flat out uint triangle;
layout(location = 1) out vec3 weights; // of the corners

void main()
{
    triangle = uint(gl_VertexIndex) / 3u;
    uint corner = uint(gl_VertexIndex) % 3u;
    vec4 p = vec4(surface_position(surface_triangle_at(triangle)[corner]), 1.0);
    weights = vec3(equal(uvec3(corner), uvec3(0u, 1u, 2u)));
    gl_Position = vec4(dot(args.clip[0], p), dot(args.clip[1], p), dot(args.clip[2], p),
                       dot(args.clip[3], p));
}
