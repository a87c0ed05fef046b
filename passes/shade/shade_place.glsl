// shade_place.glsl -- where light of VPLs and of the lattice is taken for a block of pixels.
#include "shade.glsl"
#include "shade_part.glsl"

// Of a block's first pixel on one piece of surface the plane, at the block's middle; where there is none, the sample
// nearest the middle of the first pixel that shows a surface. `part`: with no light yet.
shade_point shade_place(ivec2 block, out shade_part part)
{
    ivec2 pixel = block * shade_step, last = ivec2(camera.size) - 1;
    gbuffer_pixel found = shade_pixel(pixel);
    bool none = gbuffer_is_none(found);
    for (int k = 1; k < shade_step * shade_step && (gbuffer_is_several(found) || none); k++) {
        gbuffer_pixel other = shade_pixel(min(pixel + ivec2(k % shade_step, k / shade_step), last));
        if (!gbuffer_is_none(other) && (!gbuffer_is_several(other) || none)) {
            found = other;
            none = false;
        }
    }
    bool several = gbuffer_is_several(found);
    int count = found.side * found.side, nearest = found.side / 2 * (found.side + 1);
    for (int k = 0; k < count && several && gbuffer_index(found, nearest) == 0u; k++) {
        nearest = nearest + 1 < count ? nearest + 1 : 0;
    }
    gbuffer_point p = gbuffer_point(0.0, camera.origin, vec3(0.0, 0.0, 1.0), vec3(0.0, 0.0, 1.0), true);
    if (!none) {
        vec2 at = several ? gbuffer_place(found, nearest) : vec2(found.at) + 0.5;
        p = gbuffer_point_of(gbuffer_triangle_of(gbuffer_index(found, nearest) - 1u), camera_ray_through(camera, at));
    }
    camera_ray ray = camera_ray_through(camera, shade_middle(block));
    float facing = dot(ray.direction, p.facet), distance = dot(p.at - ray.origin, p.facet) / facing;
    distance = abs(facing) > 0.02 && distance > 0.0 ? distance : p.distance;
    part = shade_part(vec3(0.0), none ? 0.0 : distance * dot(ray.direction, camera.forward), p.facet, true, false, false);
    return shade_point(several ? p.at : ray.origin + distance * ray.direction, p.normal, p.facet);
}

// Does the light of VPLs of which shade_vpls found `nearest` change within the pattern around a block?
bool shade_near(const shade_point p, ivec2 block, float nearest)
{
    float reach = SHADE_VPL_NEAR * shade_footprint_of(p, vec4(block, block + 1) * float(shade_step)).width / float(shade_step);
    return nearest < reach * reach;
}
