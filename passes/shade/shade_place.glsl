// shade_place.glsl -- where VPLs light a pixel.
#ifndef SHADE_PLACE_GLSL
#define SHADE_PLACE_GLSL
#include "shade.glsl"
#include "shade_part.glsl"

// Of a pixel on one piece of surface its middle, of others their sample that `facing` is for. `part`: with no light
// yet. Without a surface: facing nothing.
shade_point shade_place(ivec2 pixel, out shade_part part)
{
    gbuffer_facing found = shade_facing(pixel);
    bool none = found.shown == GBUFFER_NONE, one = found.shown == GBUFFER_WHOLE;
    ivec2 texel = shade_texel(pixel * shade_samples, found.which);
    float away = none ? 0.0 : shade_distance(texel);
    vec3 position = shade_position(texel, away);
    camera_ray ray = camera_ray_through(camera, vec2(pixel) + 0.5);
    float facing = dot(ray.direction, found.facet), distance = dot(position - ray.origin, found.facet) / facing;
    distance = abs(facing) > 0.02 && distance > 0.0 ? distance : away;
    part = shade_part(vec3(0.0), none ? 0.0 : distance * dot(ray.direction, camera.forward), found.facet, true);
    return shade_point(one ? ray.origin + distance * ray.direction : position, found.normal, found.facet);
}

#endif
