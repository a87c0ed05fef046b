// shade_place.glsl -- where VPLs light a pixel.
#ifndef SHADE_PLACE_GLSL
#define SHADE_PLACE_GLSL
#include "shade.glsl"
#include "shade_part.glsl"

// Of a pixel on one piece of surface its middle, of others their first sample that meets a surface, from the middle
// on. `part`: with no light yet. Without a surface: facing nothing.
shade_point shade_place(ivec2 pixel, out shade_part part)
{
    const int count = shade_samples * shade_samples, start = (shade_samples / 2) * (shade_samples + 1);
    ivec2 corner = pixel * shade_samples, texel = corner;
    vec4 emission = texelFetch(emission_tex, corner, 0);
    gbuffer_point found = gbuffer_unpack(texelFetch(surface_tex, corner, 0), texelFetch(albedo_tex, corner, 0), emission);
    bool one = gbuffer_whole(emission);
    found.distance = one ? found.distance : 0.0;
    for (int k = start; k < start + count && found.distance <= 0.0 && !one && !gbuffer_none(emission); k++) {
        texel = shade_texel(corner, k < count ? k : k - count);
        found = shade_sample(texel);
    }
    vec3 position = shade_position(texel, found.distance);
    camera_ray ray = camera_ray_through(camera, vec2(pixel) + 0.5);
    float facing = dot(ray.direction, found.facet), distance = dot(position - ray.origin, found.facet) / facing;
    distance = abs(facing) > 0.02 && distance > 0.0 ? distance : found.distance;
    bool none = found.distance <= 0.0;
    part = shade_part(vec3(0.0), none ? 0.0 : distance * dot(ray.direction, camera.forward), found.facet, true);
    return shade_point(one ? ray.origin + distance * ray.direction : position, found.normal, found.facet);
}

#endif
