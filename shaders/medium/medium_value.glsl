// medium_value.glsl -- what is integrated of a medium along a line: its density, or coefficients. Include after
// medium.glsl.
//
// TYN_DENSITY is defined in the builds for mode DENSITY, not in those for the others (passes/meson.build).
#ifndef TYN_MEDIUM_VALUE_GLSL
#define TYN_MEDIUM_VALUE_GLSL

#ifdef TYN_DENSITY
#define MEDIUM_VALUE float

// At a texture coordinate, clamped to the edge.
float medium_value(vec3 uvw)
{
    return textureLod(density_tex, uvw, 0.0).r;
}
#else
#define MEDIUM_VALUE mat3 // sigma_s, sigma_a, (1 - f) sigma_s

mat3 medium_value(vec3 uvw)
{
    vec3 sigma_s = textureLod(density_tex, uvw, 0.0).rgb;
    vec3 sigma_a = textureLod(sigma_a_tex, uvw, 0.0).rgb;
    phase p[3] = medium_phase(uvw);
    similarity_clamp(sigma_s, p);
    return mat3(sigma_s, sigma_a, sigma_s * (1.0 - delta_fraction(p)));
}
#endif

#endif
