// medium.glsl -- coefficients of the medium at a point, as the solvers see them.
//
// Before including, define the bindings that the kernel has:
//   MEDIUM_BLOCK      uniform buffer medium_block
//   MEDIUM_DENSITY    sampler: `density` (mode DENSITY) or `sigma_s` (mode COEFFICIENTS)
//   MEDIUM_SIGMA_A, MEDIUM_G, MEDIUM_EMISSION   samplers, read in mode COEFFICIENTS only; what is not
//                     defined reads as 0 there. In mode DENSITY bind anything (the zero image).
//   MEDIUM_SPEC       id of the specialisation constant with the mode; default 0
//
// Texels are means at voxel centres; between them trilinear, in the outer half voxel constant. Along
// periodic axes positions wrap, and the outer half voxels stay constant there too.
#ifndef TYN_MEDIUM_GLSL
#define TYN_MEDIUM_GLSL
#include "scene_args.h"
#include "hg.glsl"

#ifndef MEDIUM_SPEC
#define MEDIUM_SPEC 0
#endif

layout(constant_id = MEDIUM_SPEC) const uint medium_mode = TYN_MEDIUM_DENSITY;
layout(set = 0, binding = MEDIUM_BLOCK, scalar) uniform medium_uniform
{
    medium_block medium;
};
layout(set = 0, binding = MEDIUM_DENSITY) uniform sampler3D medium_density_tex;
#ifdef MEDIUM_SIGMA_A
layout(set = 0, binding = MEDIUM_SIGMA_A) uniform sampler3D medium_sigma_a_tex;
#endif
#ifdef MEDIUM_G
layout(set = 0, binding = MEDIUM_G) uniform sampler3D medium_g_tex;
#endif
#ifdef MEDIUM_EMISSION
layout(set = 0, binding = MEDIUM_EMISSION) uniform sampler3D medium_emission_tex;
#endif

struct medium_point {
    vec3 sigma_s; // 1/m
    vec3 sigma_a; // 1/m
    vec3 g;
    vec3 emission; // W/(m^3 sr)
};

// Position within the first period of the periodic axes.
vec3 medium_wrap(vec3 p)
{
    return p - vec3(medium.repeat) * medium.extent * floor(p / medium.extent);
}

// Texture coordinate of a position; periodic axes wrap.
vec3 medium_uvw(vec3 p)
{
    vec3 uvw = p / medium.extent;
    return uvw - vec3(medium.repeat) * floor(uvw);
}

bool medium_inside(vec3 uvw)
{
    return all(greaterThanEqual(uvw, vec3(0.0))) && all(lessThanEqual(uvw, vec3(1.0)));
}

// Texture value of mode DENSITY, which the coefficients in the block are multiplied with; 0 outside.
float medium_density(vec3 p)
{
    vec3 uvw = medium_uvw(p);
    return medium_inside(uvw) ? textureLod(medium_density_tex, uvw, 0.0).r : 0.0;
}

// Coefficients of mode DENSITY at a texture value.
medium_point medium_of_density(float density)
{
    return medium_point(medium.sigma_s * density, medium.sigma_a * density, medium.g,
                        medium.emission * density);
}

// Coefficients of either mode; 0 outside. One fetch (DENSITY) or one per defined texture.
medium_point medium_sample(vec3 p)
{
    if (medium_mode == TYN_MEDIUM_DENSITY) {
        return medium_of_density(medium_density(p));
    }
    medium_point m = medium_point(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
    vec3 uvw = medium_uvw(p);
    if (medium_inside(uvw)) {
        m.sigma_s = textureLod(medium_density_tex, uvw, 0.0).rgb;
#ifdef MEDIUM_SIGMA_A
        m.sigma_a = textureLod(medium_sigma_a_tex, uvw, 0.0).rgb;
#endif
#ifdef MEDIUM_G
        m.g = textureLod(medium_g_tex, uvw, 0.0).rgb;
#endif
#ifdef MEDIUM_EMISSION
        m.emission = textureLod(medium_emission_tex, uvw, 0.0).rgb;
#endif
    }
    return m;
}

#endif
