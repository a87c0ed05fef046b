// shade_part.glsl -- what neighbouring pixels tell each other about VPLs' light, in one texel. Needs camera.glsl's block
// `camera`.
//
// Colours are three numbers of 18 bits with a common exponent; the facet's normal is folded to 2 x 16 bits.
#ifndef SHADE_PART_GLSL
#define SHADE_PART_GLSL

struct shade_part {
    vec3 irradiance; // of some VPLs, W/m^2
    float along;     // where the facet's plane meets the ray through the pixel's middle: m along the camera's axis; 0: no surface
    vec3 facet;      // the facet's normal (M)
    bool whole;      // all VPLs that the irradiance is to have are in it
};

uvec4 shade_pack(shade_part p)
{
    float most = max(p.irradiance.r, max(p.irradiance.g, p.irradiance.b));
    uint exponent = clamp(floatBitsToUint(most) >> 23, 20u, 254u);
    float scale = uintBitsToFloat((271u - exponent) << 23); // 2^18 times this is above the largest one
    uvec3 c = min(uvec3(p.irradiance * scale + 0.5), uvec3(0x3ffffu));
    return uvec4(c.r | c.b << 18, c.g | (c.b >> 14) << 18 | exponent << 22 | (p.whole ? 1u << 30 : 0u),
                 floatBitsToUint(p.along), packSnorm2x16(gbuffer_fold(p.facet)));
}

shade_part shade_unpack(uvec4 texel)
{
    float scale = uintBitsToFloat(((texel.y >> 22 & 0xffu) - 17u) << 23);
    uvec3 c = uvec3(texel.x & 0x3ffffu, texel.y & 0x3ffffu, texel.x >> 18 | (texel.y >> 18 & 0xfu) << 14);
    return shade_part(vec3(c) * scale, uintBitsToFloat(texel.z), gbuffer_unfold(unpackSnorm2x16(texel.w)),
                      (texel.y & 1u << 30) != 0u);
}

vec3 shade_part_position(ivec2 pixel, float along)
{
    camera_ray ray = camera_ray_through(camera, vec2(pixel) + 0.5);
    return ray.origin + along / dot(ray.direction, camera.forward) * ray.direction;
}

#endif
