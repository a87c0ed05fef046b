// shade_piece.glsl -- radiance of one piece of surface in a pixel.
//
//   L = emission + albedo / pi (suns + lamps + VPLs + light of the lattice, or of the sky where that is not)
//
// Samples of a pixel on one piece of surface are shaded together.
#ifndef TYN_SHADE_PIECE_GLSL
#define TYN_SHADE_PIECE_GLSL
#include "shade.glsl"
#include "lattice.glsl"
#include "walls_links.glsl"

layout(binding = 21) uniform sampler2D indirect_tex;
layout(binding = 22) uniform sampler2D place_tex;
layout(binding = 23) uniform sampler2D part_tex;
layout(binding = 24) uniform sampler3D moments_tex;
#define WALLS_TABLE 25
#define WALLS_OTHERS TYN_BEAM_MAX_SUNS
#include "walls_irradiance.glsl"
layout(binding = 26, scalar) uniform env_uniform
{
    env_block environment;
};
layout(binding = 27) uniform sampler3D forward_tex; // shade_forward.comp
layout(binding = 28, rgba32f) uniform writeonly image2D radiance_image; // and distance, or infinity

const float PI = 3.14159265358979;
#define NOWHERE uintBitsToFloat(0x7f800000u) // infinity

// Light of the medium and of far walls, and of the sky where it comes along the lattice's lines.
// `inside` the lattice: from where sunlight comes that was scattered forward. Its places may be
// beyond a wall; where the lattice is dark, as where surfaces let no light in, it is, too.
vec3 light_of_lattice(shade_point p, out vec4 around[TYN_BEAM_MAX_SUNS], out bool inside)
{
    inside = false;
    vec3 sky = shade_has(SHADE_SKY) ? PI * environment.sky : vec3(0.0);
    if (!shade_has(SHADE_LATTICE)) {
        return sky;
    }
    ivec3 dims = textureSize(moments_tex, 0);
    if (!shade_has(SHADE_ONE_CHANNEL)) {
        dims.z /= 3;
    }
    lattice_box box = lattice_box_of(medium.extent, dims);
    vec3 x = lattice_from_m(box, p.position + 0.02 * box.dx * p.facet);
    if (any(lessThan(x, vec3(-0.02))) || any(greaterThan(x, vec3(dims) + 0.02))) {
        return sky; // outside
    }
    int channels = shade_has(SHADE_ONE_CHANNEL) ? 1 : 3;
    uint num_suns = shade_has(SHADE_SPREAD) ? shade_num_suns : 0u;
    inside = true;
    vec3 irradiance = walls_irradiance_at(moments_tex, box, p.position, p.normal, channels, forward_tex, num_suns,
                                          around);
    return channels == 1 ? irradiance.r * args.tint : irradiance;
}

vec3 irradiance_at(shade_point p)
{
    vec4 around[TYN_BEAM_MAX_SUNS];
    bool inside;
    vec3 lattice = light_of_lattice(p, around, inside);
    return shade_suns(p, around, inside && shade_has(SHADE_SPREAD)) + shade_lamps(p) + lattice;
}

#endif
