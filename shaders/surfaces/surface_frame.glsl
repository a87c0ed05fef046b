// surface_frame.glsl -- from M into the world and back, by the rows of surface_args.h's block.
#ifndef TYN_SURFACE_FRAME_GLSL
#define TYN_SURFACE_FRAME_GLSL

vec3 surface_turn(vec4 rows[3], vec3 v)
{
    return vec3(dot(rows[0].xyz, v), dot(rows[1].xyz, v), dot(rows[2].xyz, v));
}

vec3 surface_transform(vec4 rows[3], vec3 p)
{
    return surface_turn(rows, p) + vec3(rows[0].w, rows[1].w, rows[2].w);
}

#endif
