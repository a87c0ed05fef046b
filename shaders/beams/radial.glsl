// radial.glsl -- local lights: what they send to a point, and the optical depth on the way.
//
// Include after medium.glsl and define:
//   RADIALS_AT        first binding of the bundle TYN_RADIALS (bundles.h)
//   RADIALS_STORAGE, RADIALS_TEXELS   if its buffer is a storage buffer or one of texels: a uniform one is faster on
//                     lavapipe, which has room for seven
//
// The textures hold the mean of the medium between the light, or where the way from it enters the box,
// and a point. Times the exact length of that way it is the depth: where the medium is the same
// everywhere no grid shows, and there is no singularity at the light.
#ifndef TYN_RADIAL_GLSL
#define TYN_RADIAL_GLSL
#include "radial_args.h"
#include "shaders/common/octahedral.glsl"
#include "beam_tau.glsl"

#ifdef RADIALS_TEXELS
#include "radial_texels.glsl"
layout(set = 0, binding = RADIALS_AT) uniform usamplerBuffer radials_texels;

radial_grid radial_grid_of(uint n)
{
    return radial_grid_at(radials_texels, 1 + 10 * int(n));
}
#else
#ifndef RADIALS_STORAGE
TYN_UNIFORM(RADIALS_AT, radials, uint radial_count; uint radial_num_lamps; uvec2 radial_pad;
            radial_grid radials[TYN_RADIAL_LAMPS_MAX + TYN_RADIAL_VPLS_MAX]);
#else
TYN_READ(RADIALS_AT, radials, uint radial_count; uint radial_num_lamps; uvec2 radial_pad; radial_grid radials[]);
#endif

radial_grid radial_grid_of(uint n)
{
    return radials[n];
}
#endif
// Means of the density (mode DENSITY) or of sigma_s, of sigma_a and of (1 - f) sigma_s.
layout(set = 0, binding = RADIALS_AT + 1) uniform sampler3D radial_column_tex;
layout(set = 0, binding = RADIALS_AT + 2) uniform sampler3D radial_tau_a_tex;
layout(set = 0, binding = RADIALS_AT + 3) uniform sampler3D radial_tau_p_tex;

struct radial_place {
    vec3 uvw;
    float inside; // length of the way from the light to the point within the box, m
};

// `away`: from the light to a point in the box; r = its length.
radial_place radial_place_in(const radial_grid grid, vec3 away, float r)
{
    vec3 d = vec3(dot(grid.to_map[0], away), dot(grid.to_map[1], away), dot(grid.to_map[2], away));
    float way = log(1.0 + max(r - grid.begin, 0.0) * grid.inverse_near);
    // At the light itself any direction will do.
    vec2 e = r > 0.0 ? octahedral_of(d) : vec2(0.0);
    radial_place place;
    place.uvw = grid.base + grid.scale * vec3(e, way);
    place.inside = r;
    if (grid.inside == 0u) {
        vec3 o = grid.light.position;
        vec3 gap = max(-o, vec3(0.0)) - max(o - medium.extent, vec3(0.0));
        vec3 f = mix(vec3(0.0), gap / away, notEqual(gap, vec3(0.0)));
        place.inside = r * clamp(1.0 - max(f.x, max(f.y, f.z)), 0.0, 1.0);
    }
    return place;
}

radial_place radial_place_of(uint n, vec3 away, float r)
{
    return radial_place_in(radial_grid_of(n), away, r);
}

// Share of the light's intensity that goes along `away`, r = its length.
float radial_share_of(const light_block light, vec3 away, float r)
{
    return light_lobe(light, dot(away / max(r, 1e-20), light.direction));
}

float radial_share(uint n, vec3 away, float r)
{
    return radial_share_of(radial_grid_of(n).light, away, r);
}

// Mean of 1 / r^2 over a cube of edge d whose middle is at r, both squared: 1 / r^2 (1 + d^2 / (12 r^2) + ...)
// far away, 7.67 / d^2 around its own middle.
float radial_mean_inverse_square(float r2, float d2)
{
    return r2 < d2 ? 1.0 / (0.1304 * d2 + 0.79 * r2) : (1.0 + d2 / (12.0 * r2)) / r2;
}

// Of most lamps only the light that is near them is followed exactly, with the weight (1 - (r / reach)^4)^2; the rest,
// which is smooth even at the lamp, is left to cells. A narrow beam is followed until it is as wide as the reach
// of lamps that shine all around, m.
float radial_reach(const light_block light, float around)
{
    float c = max(light.cos_outer, 0.0);
    return around * inversesqrt(max(1.0 - c * c, 1e-4));
}

// What is left to cells of 1 / r^2; r squared.
float radial_rest(float r2, float reach)
{
    float q = 1.0 / (reach * reach), t2 = r2 * q, t4 = t2 * t2;
    return t2 < 1.0 ? q * t2 * (2.0 - t4) : 1.0 / r2;
}

// ... and the integral of what is followed, from a to b on a line that passes the light at a distance of sqrt(h2).
// `all`: that of 1 / r^2.
float radial_near(float all, float h2, float a, float b, float reach)
{
    float q = 1.0 / reach;
    h2 *= q * q;
    vec2 x = vec2(a, b) * q, x2 = x * x;
    vec2 r2 = x * (h2 + x2 / 3.0);
    vec2 r6 = x * (h2 * h2 * h2 + x2 * (h2 * h2 + x2 * (0.6 * h2 + x2 / 7.0)));
    return max(all - q * ((2.0 * r2 - r6).y - (2.0 * r2 - r6).x), 0.0);
}

#ifdef RADIAL_SHADOWS // shadow.glsl was included
// Share of the light of lamp n that surfaces let through to the point p.
float radial_visibility(uint n, vec3 p)
{
    uint shadow = radial_grid_of(n).light.shadow;
    return shadow != TYN_LIGHT_NO_SHADOW ? shadow_visibility_lamp(shadow, p) : 1.0;
}
#endif

// Mode DENSITY: column density, m times texture value.
float radial_column(const radial_place place)
{
    return place.inside * textureLod(radial_column_tex, place.uvw, 0.0).r;
}

// Any mode.
beam_tau radial_tau(const radial_place place)
{
    if (medium_mode == TYN_MEDIUM_DENSITY) {
        return beam_of_column(radial_column(place));
    }
    return beam_tau(place.inside * textureLod(radial_column_tex, place.uvw, 0.0).rgb,
                    place.inside * textureLod(radial_tau_a_tex, place.uvw, 0.0).rgb,
                    place.inside * textureLod(radial_tau_p_tex, place.uvw, 0.0).rgb);
}

#endif
