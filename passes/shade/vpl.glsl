// vpl.glsl -- light of a VPL on a surface. No bindings.
#include "shaders/beams/radial_args.h"

// Irradiance on a surface at p with the normal n (M), per intensity along the light's axis, 1/m^2 x sr.
//
// A VPL is a disc of radius R and constant radiance I / (pi R^2). Its irradiance on a plane parallel to it,
// at the height h and the distance r, is known in closed form,
//   E = 2 I h^2 / (s (s + r^2 - R^2)),   s^2 = (r^2 - R^2)^2 + 4 R^2 h^2
// (I cos^2 / r^2 where R is small), which sends exactly the disc's power through the plane: nothing is lost to
// the bound. On a plane at right angles to it, as a wall beside a floor is, it is (r from the disc's centre, of which
// the plane is the distance t away)
//   E = 2 I h t / (s (s + r^2 + R^2)).
// A plane that is turned gets either in proportion. That is exact if the disc is all before the plane. Of one that the
// plane cuts, what lies beyond is subtracted, so that all such discs together would send too little: a wall at the end of a
// floor, or a column on it, has on its side what the wall cuts off others. Far off, what the plane sees of parts on its
// side is their mean distance from it; a disc whose middle is beyond sends nothing, so in the mean over t from 0 to R
// that of all parts, t + 0.129 R, is due. The second term gets as much more: from nothing, where t = 0, as the
// horizon of a curved surface is no edge. Close by, at the height u R, it takes 1 + 1.35 / (u + 0.6 u^3) times as much to
// be right in the mean; closer than 0.9 R that is bounded, as so much light would change faster than pixels do.
const float VPL_CUT = 12.0 * 0.129, VPL_CUT_NEAR = 1.35;

float vpl_irradiance(const light_block light, vec3 p, vec3 n)
{
    vec3 away = p - light.position;
    float h = dot(away, light.direction), towards = -dot(away, n), facing = -dot(n, light.direction);
    // The other side of the VPL's own surface is in its plane, give or take rounding. No early return: lavapipe would
    // go on anyway, under a mask.
    bool lit = h > 1e-3 * light.radius && towards > 0.0;
    // In units of the distance, whose fourth power may be too small or too large a number.
    float unit = inversesqrt(max(dot(away, away), 1e-36)), per_radius = 1.0 / max(light.radius, 1e-18);
    float u = clamp(h * per_radius, 0.9, 64.0), v = u * (1.0 + 0.6 * u * u);
    // How much of the disc, as far as it reaches towards the plane, lies beyond that.
    float beyond = max(1.0 - towards * per_radius * inversesqrt(max(1.0 - facing * facing, 1e-12)), 0.0);
    h *= unit;
    towards *= unit;
    float R = light.radius * unit, RR = R * R, d = 1.0 - RR;
    float s = sqrt(d * d + 4.0 * RR * h * h), t = s + 1.0 + RR;
    // 1 / (s + d) without cancellation, (s + d) (s - d) = 4 R^2 h^2, as a ratio. All is over one denominator.
    vec2 inverse = d >= 0.0 ? vec2(1.0, s + d) : vec2(s - d, 4.0 * RR * h * h);
    float along = h * facing; // the rest of `towards` is beside the axis
    float beside = (towards - along) * v + VPL_CUT * (v + VPL_CUT_NEAR) * towards * beyond * beyond;
    float E = 2.0 * h * (along * v * t * inverse.x + beside * inverse.y) / max(s * t * v * inverse.y, 1e-30);
    float most = (0.5 + 0.5 * facing) * per_radius * per_radius;
    return lit ? clamp(E * unit * unit, 0.0, most) : 0.0;
}
