// sky_shadows_vertex.vert -- the scene's vertices as a direction of the sky sees them.
#include "shaders/light/sky_map_args.h"
#include "shaders/surfaces/surface_args.h"

TYN_READ(0, vertices, surface_vertex vertices[]);
TYN_UNIFORM(1, surfaces, surface_block surfaces);
TYN_READ(2, sky_maps, shadow_light maps[]);
TYN_ARGS(sky_draw_args args);

void main()
{
    vec4 w = vec4(vertices[gl_VertexIndex].position, 1.0);
    vec4 p = vec4(dot(surfaces.from_world[0], w), dot(surfaces.from_world[1], w), dot(surfaces.from_world[2], w), 1.0);
    shadow_light map = maps[args.map];
    gl_Position = vec4(dot(map.rows[0], p), dot(map.rows[1], p), dot(map.rows[2], p), 1.0);
}
