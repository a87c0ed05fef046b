// reflectance.glsl -- what a material does to light: what it reflects, given its texture's colour, and what it emits.
//
// Define MATERIALS_AT (surfaces.glsl).
#ifndef TYN_REFLECTANCE_GLSL
#define TYN_REFLECTANCE_GLSL
#include "surfaces.glsl"

// The share of irradiance that leaves again, evenly in all directions (a Lambertian surface), on both sides.
// `colour`: of the material's texture, 1 without one.
vec3 surface_reflected(const surface_material m, vec3 colour)
{
    return m.albedo * colour;
}

// Radiance that leaves the front or the back by itself, W/(m^2 sr).
vec3 surface_emitted(const surface_material m, bool front)
{
    return front || (m.flags & TYN_SURFACE_DOUBLE_SIDED) != 0u ? m.emission : vec3(0.0);
}

#endif
