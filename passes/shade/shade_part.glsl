// shade_part.glsl -- what neighbouring pixels tell each other about VPLs' light, in one texel. Needs camera.glsl's block
// `camera`.
//
// The facet's normal is folded to 2 x 16 bits.
#ifndef SHADE_PART_GLSL
#define SHADE_PART_GLSL
#include "packed_colour.glsl"

struct shade_part {
    vec3 irradiance; // of some VPLs, W/m^2
    float along;     // where the facet's plane meets the ray through the pixel's middle: m along the camera's axis; 0: no surface
    vec3 facet;      // the facet's normal (M)
    bool whole;      // all VPLs that the irradiance is to have are in it
};

uvec4 shade_pack(shade_part p)
{
    uvec2 colour = colour_pack(p.irradiance);
    return uvec4(colour.x, colour.y | (p.whole ? 1u << 30 : 0u), floatBitsToUint(p.along),
                 packSnorm2x16(gbuffer_fold(p.facet)));
}

shade_part shade_unpack(uvec4 texel)
{
    return shade_part(colour_unpack(texel.xy), uintBitsToFloat(texel.z), gbuffer_unfold(unpackSnorm2x16(texel.w)),
                      (texel.y & 1u << 30) != 0u);
}

vec3 shade_part_position(ivec2 pixel, float along)
{
    camera_ray ray = camera_ray_through(camera, vec2(pixel) + 0.5);
    return ray.origin + along / dot(ray.direction, camera.forward) * ray.direction;
}

#endif
