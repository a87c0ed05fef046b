// vpl.glsl -- light of a VPL on a surface. No bindings.
#ifndef TYN_VPL_GLSL
#define TYN_VPL_GLSL
#include "radial_args.h"

// Irradiance on a surface at p with the normal n (M), per intensity along the light's axis, 1/m^2 x sr.
//
// A VPL is a disc of radius R and constant radiance I / (pi R^2). Its irradiance on a plane parallel to it,
// at the height h and the distance r, is known in closed form,
//   E = 2 I h^2 / (s (s + r^2 - R^2)),   s^2 = (r^2 - R^2)^2 + 4 R^2 h^2
// (I cos^2 / r^2 where R is small), which sends exactly the disc's power through the plane: nothing is lost to
// the bound. A surface that is turned gets it in proportion to its cosine, and no more than if the disc
// filled all of its view of the disc's half space.
float vpl_irradiance(radial_light light, vec3 p, vec3 n)
{
    vec3 away = p - light.position;
    float h = dot(away, light.axis), towards = -dot(away, n);
    // The other side of the VPL's own surface is in its plane, give or take rounding. No early return: lavapipe would
    // go on anyway, under a mask.
    bool lit = h > 1e-3 * light.radius && towards > 0.0;
    // In units of the distance, whose fourth power may be too small or too large a number.
    float per_area = 1.0 / max(dot(away, away), 1e-36), RR = light.radius * light.radius * per_area, d = 1.0 - RR;
    h *= sqrt(per_area);
    towards *= sqrt(per_area);
    float s = sqrt(d * d + 4.0 * RR * h * h);
    // s + d without cancellation: (s + d) (s - d) = 4 R^2 h^2.
    float sum = d >= 0.0 ? s + d : 4.0 * RR * h * h / max(s - d, 1e-30);
    float most = (0.5 - 0.5 * dot(n, light.axis)) / max(RR, 1e-20);
    return lit ? min(2.0 * h * towards / max(s * sum, 1e-30), most) * per_area : 0.0;
}

#endif
