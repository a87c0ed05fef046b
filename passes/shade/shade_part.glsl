// shade_part.glsl -- what neighbouring places tell each other about light of VPLs and of the lattice, in one texel. Needs
// camera.glsl's block `camera` and `shade_step`.
//
// Such light is smooth: in large pictures each block of `shade_step` pixels along a side has one place.
//
// The facet's normal is folded to 2 x 16 bits.
#ifndef SHADE_PART_GLSL
#define SHADE_PART_GLSL
#include "shaders/colour/packed_colour.glsl"
#include "shaders/common/octahedral.glsl"

struct shade_part {
    vec3 irradiance; // of some VPLs, W/m^2
    float along;     // where the facet's plane meets the ray through the block's middle: m along the camera's axis; 0: no surface
    vec3 facet;      // the facet's normal (M)
    bool whole;      // all VPLs that the irradiance is to have are in it
    bool near;       // one of them is so near that its light changes within the pattern
    bool aside;      // of some places of the pattern the neighbours on one side only are on this piece
};

uvec4 shade_pack(const shade_part p)
{
    uvec2 colour = colour_pack(p.irradiance);
    return uvec4(colour.x, colour.y | (p.whole ? 1u << 30 : 0u) | (p.near ? 1u << 31 : 0u),
                 floatBitsToUint(p.along) | (p.aside ? 1u << 31 : 0u), packSnorm2x16(octahedral_of(p.facet)));
}

shade_part shade_unpack(uvec4 texel)
{
    return shade_part(colour_unpack(texel.xy), uintBitsToFloat(texel.z & 0x7fffffffu),
                      normalize(octahedral_point(unpackSnorm2x16(texel.w))), (texel.y & 1u << 30) != 0u,
                      (texel.y & 1u << 31) != 0u, (texel.z & 1u << 31) != 0u);
}

ivec2 shade_blocks()
{
    return (ivec2(camera.size) + shade_step - 1) / shade_step;
}

// The middle of a block, pixels.
vec2 shade_middle(ivec2 block)
{
    return (vec2(block) + 0.5) * float(shade_step);
}

vec3 shade_part_position(ivec2 block, float along)
{
    vec3 across = camera_across(camera, shade_middle(block));
    return camera.origin + along * camera.forward + camera_select(camera, 1.0, along) * across;
}

#endif
