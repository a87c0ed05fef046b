// sky_shadows_vertex.vert -- the corners of the scene's triangles as a direction of the sky sees them.
#include "shaders/light/ordinate_args.h"
#include "shaders/light/sky_map_args.h"
#include "shaders/surfaces/surface_args.h"

TYN_READ(0, triangles, surface_triangle triangles[]);
TYN_READ(1, vertices, surface_vertex vertices[]);
TYN_UNIFORM(2, surfaces, surface_block surfaces);
TYN_UNIFORM(3, ordinates, ordinates_block ordinates);
TYN_READ(4, sky_maps, shadow_light maps[]);
TYN_ARGS(sky_draw_args args);

void main()
{
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0); // nowhere: of directions that are not in use nothing is drawn
    if (args.direction < ordinates.count) {
        surface_triangle t = triangles[gl_VertexIndex / 3];
        int corner = gl_VertexIndex % 3;
        uint v = corner == 0 ? t.v0 : corner == 1 ? t.v1 : t.v2;
        vec4 w = vec4(vertices[v].position, 1.0);
        vec4 p = vec4(dot(surfaces.from_world[0], w), dot(surfaces.from_world[1], w), dot(surfaces.from_world[2], w), 1.0);
        shadow_light map = maps[args.map];
        gl_Position = vec4(dot(map.rows[0], p), dot(map.rows[1], p), dot(map.rows[2], p), 1.0);
    }
}
