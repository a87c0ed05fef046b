// shade_place.glsl -- where light of VPLs and of the lattice is taken for a block of pixels.
#include "shade.glsl"
#include "shade_part.glsl"

// Of a block's first pixel on one piece of surface the plane, at the block's middle; where there is none, a sample of the
// first pixel that shows a surface: the one that `facing` is for. `part`: with no light yet. Without a surface: facing
// nothing.
shade_point shade_place(ivec2 block, out shade_part part)
{
    ivec2 pixel = block * shade_step, last = ivec2(camera.size) - 1;
    gbuffer_facing found = shade_facing(pixel);
    for (int k = 1; k < shade_step * shade_step && found.shown != GBUFFER_WHOLE; k++) {
        ivec2 next = min(block * shade_step + ivec2(k % shade_step, k / shade_step), last);
        gbuffer_facing other = shade_facing(next);
        if (other.shown == GBUFFER_WHOLE || found.shown == GBUFFER_NONE) {
            found = other;
            pixel = next;
        }
    }
    bool none = found.shown == GBUFFER_NONE, one = found.shown == GBUFFER_WHOLE;
    ivec2 texel = shade_texel(pixel * shade_samples, found.which);
    float away = none ? 0.0 : shade_distance(texel);
    vec3 position = shade_position(texel, away);
    camera_ray ray = camera_ray_through(camera, shade_middle(block));
    float facing = dot(ray.direction, found.facet), distance = dot(position - ray.origin, found.facet) / facing;
    distance = abs(facing) > 0.02 && distance > 0.0 ? distance : away;
    part = shade_part(vec3(0.0), none ? 0.0 : distance * dot(ray.direction, camera.forward), found.facet, true, false,
                      false);
    return shade_point(one ? ray.origin + distance * ray.direction : position, found.normal, found.facet);
}

// Does the light of VPLs of which shade_vpls found `nearest` change within the pattern around a block?
bool shade_near(const shade_point p, ivec2 block, float nearest)
{
    float reach = SHADE_VPL_NEAR * shade_footprint_of(p, vec4(block, block + 1) * float(shade_step)).width / float(shade_step);
    return nearest < reach * reach;
}
