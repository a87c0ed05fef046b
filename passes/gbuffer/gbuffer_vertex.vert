// gbuffer_vertex.vert -- the corners of the scene's triangles in the camera's clip space.
//
// Depth is reversed. Perspective: 0 at infinity, and what is nearer to the eye than a millionth of the
// scene is cut off; orthographic: 1 in the plane of the camera, 0 behind the scene.
#include "shaders/common/camera.glsl"
#include "shaders/surfaces/surface_args.h"
#include "shaders/surfaces/surface_frame.glsl"

TYN_UNIFORM(0, camera, camera_block camera);
#define GEOMETRY_AT 1
#include "shaders/surfaces/surfaces.glsl"

layout(location = 0) flat out uint triangle;

void main()
{
    triangle = uint(gl_VertexIndex) / 3u;
    uint corner = uint(gl_VertexIndex) % 3u;
    vec3 p = surface_transform(surfaces.from_world, surface_position(surface_triangle_at(triangle)[corner])) - camera.origin;
    vec2 across = vec2(dot(p, camera.right) / camera.half_width, dot(p, camera.up) / camera.half_height);
    float z = dot(p, camera.forward);
    vec3 size = surfaces.hi - surfaces.lo;
    // Of parallel rays the depth is a share of that of the farthest corner of the scene's box.
    vec3 forward = surface_turn(surfaces.to_world, camera.forward);
    vec3 middle = surface_transform(surfaces.from_world, 0.5 * (surfaces.lo + surfaces.hi)) - camera.origin;
    float farthest = dot(middle, camera.forward) + 0.501 * dot(size, abs(forward)) + 1e-6 * length(size);
    float depth = 1.0 - z / max(farthest, 1e-6 * length(size));
    float w = camera_select(camera, 1.0, z);
    across -= w * camera.shift;
    vec2 part = camera_whole(camera) / vec2(camera.size);
    across = part * vec2(across.x, -across.y) - w * (2.0 * vec2(camera.corner) - vec2(camera.beyond)) / vec2(camera.size);
    gl_Position = vec4(across, camera_select(camera, depth, 1e-6 * length(size)), w);
}
