// scatter_lut.glsl -- radiance scattered from a beam, with everything that was scattered forward before.
//
// The phase function is split by a smooth window h(theta) into a forward lobe p h, which holds the part
// f of the scattering that delta scaling counts as going straight on, and the rest p (1 - h). A beam
// that has come through the scattering depth tau has lobes of all orders around it (Goudsmit and
// Saunderson 1940):
//   K_lobe = p h e^-tau     + sum_l (2l+1)/(4 pi) P_l F_l       (e^{-tau (1 - F_l)} - e^-tau)
//   K_tms  = p (1-h) e^-tau + sum_l (2l+1)/(4 pi) P_l (g^l-F_l) (e^{-tau (1 - F_l)} - e^-tau)
// F_l the Legendre moments of p h, F_0 = f. Radiance per m and unit irradiance: sigma_s e^-tau_a K; the
// light of K_tms has left the beam for good and goes to the eye through e^-tau', that of K_lobe through
// e^-tau_t. For tau -> 0 the sum is p: single scattering is exact.
//
// The first terms are evaluated here; the table holds the sums as
//   ln( sum / (f (1 - e^-tau) e^{-tau (1 - f)}) )
// over ln(1 + tau / 4) and ln(1 + theta / width): nearly straight there, so few texels do.
//
// Define SCATTER_LUT (sampler2D) and SCATTER_LUT_BLOCK (uniform buffer) before including.
#ifndef TYN_SCATTER_LUT_GLSL
#define TYN_SCATTER_LUT_GLSL
#include "hg.glsl"
#include "scatter_lut_map.glsl"

layout(set = 0, binding = SCATTER_LUT) uniform sampler2D lut_tex;
layout(set = 0, binding = SCATTER_LUT_BLOCK, scalar) uniform lut_uniform
{
    lut_block lut;
};

// What the kernels need to know about the scattering angle; constant along a ray and a sun.
struct scatter_angle {
    vec2 first;  // p (1 - h), p h
    float v;     // texture coordinate of the angle in the row
    float f;
    float scale; // texture u per ln(1 + tau / 4)
};

scatter_angle scatter_angle_in_row(uint row, float g, float theta_1, float one_minus_mu)
{
    float theta = 2.0 * asin(sqrt(clamp(0.5 * one_minus_mu, 0.0, 1.0)));
    float p = hg_near(g, one_minus_mu);
    float h = lut_window(theta, theta_1);
    scatter_angle a;
    a.f = delta_fraction(g);
    a.first = vec2(p * (1.0 - h), p * h);
    a.v = (float(row) + lut_v(theta, g)) / float(lut.num_rows);
    a.scale = lut_depth_scale(a.f);
    return a;
}

// Mode DENSITY: `view` = direction in which the light goes to the eye, `light` = direction of the
// beam's travel, unit vectors.
scatter_angle scatter_angle_of(uint channel, vec3 view, vec3 light)
{
    uint row = lut.channel_row[channel];
    vec3 turn = view - light;
    return scatter_angle_in_row(row, lut.g[row], lut.theta_1[row], 0.5 * dot(turn, turn));
}

// K_tms and K_lobe, 1/sr, behind the scattering depth tau_s. One fetch.
vec2 scatter_kernels(scatter_angle a, float tau_s)
{
    float direct = exp(-tau_s);
    vec2 sums = textureLod(lut_tex, vec2(lut_u(tau_s, a.scale), a.v), 0.0).rg;
    return a.first * direct + a.f * (1.0 - direct) * exp(sums - tau_s * (1.0 - a.f));
}

// Mode COEFFICIENTS: the same where g varies. `g` is that of the last scattering; the earlier ones on
// the way had the mean 1 - f = tau_p / tau_s, which keeps the light that is still in the beam exact.
vec2 scatter_kernels_mixed(vec3 view, vec3 light, float g, float tau_s, float tau_p)
{
    vec3 turn = view - light;
    float one_minus_mu = 0.5 * dot(turn, turn);
    g = min(g, HG_MAX);
    float row = lut_row(lut.log_first, lut.log_step, lut.num_rows, g);
    uint below = uint(row), above = min(below + 1u, lut.num_rows - 1u);
    float theta_1 = g <= 0.0 ? 0.0 : mix(lut.theta_1[below], lut.theta_1[above], fract(row));
    vec2 last = scatter_angle_in_row(below, g, theta_1, one_minus_mu).first;

    float f_beam = tau_s > 0.0 ? clamp(1.0 - tau_p / tau_s, 0.0, HG_MAX * HG_MAX) : 0.0;
    float g_beam = sqrt(f_beam), direct = exp(-tau_s);
    row = lut_row(lut.log_first, lut.log_step, lut.num_rows, g_beam);
    below = uint(row);
    above = min(below + 1u, lut.num_rows - 1u);
    scatter_angle beam = scatter_angle_in_row(below, g_beam, theta_1, one_minus_mu);
    float next_v = beam.v + float(above - below) / float(lut.num_rows), u = lut_u(tau_s, beam.scale);
    vec2 sums = mix(textureLod(lut_tex, vec2(u, beam.v), 0.0).rg,
                    textureLod(lut_tex, vec2(u, next_v), 0.0).rg, fract(row));
    // A last scattering that is broader than the earlier ones decides the angles: the beam's own spread
    // is narrow beside it.
    float spread = g_beam > 0.0 ? clamp(g / g_beam, 0.0, 1.0) : 0.0;
    float forward = exp(-tau_s * (1.0 - f_beam)) - direct;
    vec2 more = mix(last * forward, f_beam * (1.0 - direct) * exp(sums - tau_s * (1.0 - f_beam)), spread);
    return last * direct + more;
}

#endif
