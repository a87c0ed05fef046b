// medium.glsl -- coefficients of the medium at a point, as the solvers see them.
//
// Before including, define one of
//   MEDIUM_AT      first binding of the bundle TYN_MEDIUM (bundles.h)
//   MEDIUM_BLOCK   binding of a uniform buffer medium_block, where no coefficient is looked up
// and MEDIUM_SPEC, id of the specialisation constant with the mode, if it is not 0.
//
// Texels are means at voxel centres; between them trilinear, in the outer half voxel constant. Along
// periodic axes positions wrap, and the outer half voxels stay constant there too.
#ifndef TYN_MEDIUM_GLSL
#define TYN_MEDIUM_GLSL
#include "shaders/common/scene_args.h"
#include "shaders/phase/phase.glsl"

#ifndef MEDIUM_SPEC
#define MEDIUM_SPEC 0
#endif

layout(constant_id = MEDIUM_SPEC) const uint medium_mode = TYN_MEDIUM_DENSITY;
#ifdef MEDIUM_AT
#define MEDIUM_BLOCK MEDIUM_AT
layout(set = 0, binding = MEDIUM_AT + 1) uniform sampler3D density_tex; // of the other modes: sigma_s
layout(set = 0, binding = MEDIUM_AT + 2) uniform sampler3D sigma_a_tex; // this and the next are there in these alone
layout(set = 0, binding = MEDIUM_AT + 3) uniform sampler3D g_tex;
layout(set = 0, binding = MEDIUM_AT + 4) uniform sampler3D emission_tex;
#endif
TYN_UNIFORM(MEDIUM_BLOCK, medium, medium_block medium);

struct medium_point {
    vec3 sigma_s; // 1/m
    vec3 sigma_a; // 1/m
    phase phase[3]; // of each channel
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

// Coefficients of mode DENSITY at a texture value.
medium_point medium_of_density(float density)
{
    return medium_point(medium.sigma_s * density, medium.sigma_a * density, medium.phase,
                        medium.emission * density);
}

#ifdef MEDIUM_AT
// Texture value of mode DENSITY, which the coefficients in the block are multiplied with; 0 outside.
float medium_density(vec3 p)
{
    vec3 uvw = medium_uvw(p);
    return medium_inside(uvw) ? textureLod(density_tex, uvw, 0.0).r : 0.0;
}

// Phase functions at a texture coordinate.
phase[3] medium_phase(vec3 uvw)
{
    phase p[3] = medium.phase;
    if (medium_mode == TYN_MEDIUM_COEFFICIENTS) {
        p = phase_of_mean_cosine(textureLod(g_tex, uvw, 0.0).rgb);
    }
    return p;
}

// Coefficients of any mode; 0 outside. One fetch (DENSITY) or one per coefficient that is used.
medium_point medium_sample(vec3 p)
{
    if (medium_mode == TYN_MEDIUM_DENSITY) {
        return medium_of_density(medium_density(p));
    }
    medium_point m = medium_point(vec3(0.0), vec3(0.0), phase_of_mean_cosine(vec3(0.0)), vec3(0.0));
    vec3 uvw = medium_uvw(p);
    if (medium_inside(uvw)) {
        m.sigma_s = textureLod(density_tex, uvw, 0.0).rgb;
        m.sigma_a = textureLod(sigma_a_tex, uvw, 0.0).rgb;
        m.phase = medium_phase(uvw);
        m.emission = textureLod(emission_tex, uvw, 0.0).rgb;
    }
    return m;
}
#endif

#endif
