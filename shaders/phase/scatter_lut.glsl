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
// A sun that is seen under an angle is taken for a soft round spot with its mean cosine a, the heat
// kernel on the sphere, whose moments are a^{l (l + 1) / 2}: all terms are multiplied with them. There is
// no closed form for the first terms then, but no peak either: the table has everything,
//   ln( K / e^{-tau (1 - f)} ).
// These tables lie beside the one for points.
//
// Define SCATTER_LUT (sampler2D) and SCATTER_LUT_BLOCK (uniform buffer) before including, and SCATTER_LUT_SOFT
// as an expression that is false if there are no tables of suns (some devices run both sides of a branch).
#ifndef TYN_SCATTER_LUT_GLSL
#define TYN_SCATTER_LUT_GLSL
#include "scatter_lut_map.glsl"

layout(set = 0, binding = SCATTER_LUT) uniform sampler2D lut_tex;
TYN_UNIFORM(SCATTER_LUT_BLOCK, lut_block, lut_block lut);

// What the kernels need to know about the scattering angle; constant along a ray and a sun.
struct scatter_angle {
    vec2 first;   // p (1 - h), p h; in the table where the sun is no point
    vec2 uv;      // texture coordinates of the angle and depth 0
    float scale;  // texture u per ln(1 + tau / 4)
    float last;   // texture u of the greatest depth after that of 0
    float loss;   // 1 - f
    vec2 weight;  // of the table: x - y e^-tau
};

scatter_angle scatter_angle_in_row(uint row, float one_minus_mu)
{
    phase last = lut.phase[row];
    float theta = 2.0 * asin(sqrt(clamp(0.5 * one_minus_mu, 0.0, 1.0)));
    float p = phase_near(last, 1.0, one_minus_mu), f = delta_fraction(last);
    float h = lut_window(theta, lut.theta_1[row]), sets = float(lut.num_sets);
    scatter_angle a;
    a.first = vec2(p * (1.0 - h), p * h);
    a.uv = vec2(lut_u(0.0, 0.0) / sets, (float(row) + lut_v(theta, last)) / float(lut.num_rows));
    a.scale = lut_depth_scale(f) / sets;
    a.last = LUT_DEPTH_RANGE / sets;
    a.loss = 1.0 - f;
    a.weight = vec2(f);
    return a;
}

// Mode DENSITY. For a view v (direction in which the light goes to the eye) and a beam of direction d,
// unit vectors, 1 - mu is |v - d|^2 / 2 without cancellation.
scatter_angle scatter_angle_of(uint sun, uint channel, float one_minus_mu)
{
    uint row = lut.channel_row[channel], set = lut.sun_set[sun];
    scatter_angle a = scatter_angle_in_row(row, one_minus_mu);
    if (set > 0u) {
        a.first = vec2(0.0);
        a.uv.x += float(set) / float(lut.num_sets);
        a.weight = vec2(1.0, 0.0);
    }
    return a;
}

// A light that is a point, as seen from anywhere.
scatter_angle scatter_angle_of_point(uint channel, float one_minus_mu)
{
    return scatter_angle_in_row(lut.channel_row[channel], one_minus_mu);
}

// K_tms and K_lobe, 1/sr, behind the scattering depth tau_s. One fetch.
vec2 scatter_kernels(const scatter_angle a, float tau_s)
{
    float direct = exp(-tau_s), u = min(lut_depth_log(tau_s) * a.scale, a.last);
    vec2 table = textureLod(lut_tex, vec2(a.uv.x + u, a.uv.y), 0.0).rg;
    return a.first * direct + (a.weight.x - a.weight.y * direct) * exp(table - tau_s * a.loss);
}

// ---- mode COEFFICIENTS, where the mean cosine g varies ------------------------------------------------

// The rows around a g, as texture v and how far it is between them. Lobes between rows are as wide as those
// of their own g: the angle is taken by its width.
struct scatter_rows {
    float v, next_v, between;
};

scatter_rows scatter_rows_of(float g, float theta)
{
    float row = lut_row(lut.log_first, lut.log_step, lut.num_rows, g);
    float at = lut_v(theta, phase_of_mean_cosine(g));
    float above = min(floor(row) + 1.0, float(lut.num_rows - 1u));
    return scatter_rows((floor(row) + at) / float(lut.num_rows), (above + at) / float(lut.num_rows),
                        fract(row));
}

vec2 scatter_table(const scatter_rows rows, float u)
{
    return mix(textureLod(lut_tex, vec2(u, rows.v), 0.0).rg,
               textureLod(lut_tex, vec2(u, rows.next_v), 0.0).rg, rows.between);
}

// `last` is the last scattering; the earlier ones on the way had the mean 1 - f = tau_p / tau_s, which
// keeps the light that is still in the beam exact. `set` of tables: lut.sun_set of a sun, 0 of a point; `a`:
// mean cosine of the sun.
vec2 scatter_kernels_mixed(uint set_index, float a, float one_minus_mu, const phase last, float tau_s, float tau_p)
{
    float theta = 2.0 * asin(sqrt(clamp(0.5 * one_minus_mu, 0.0, 1.0)));
    float g = min(phase_mean_cosine(last), HG_MAX);
    float f = tau_s > 0.0 ? clamp(1.0 - tau_p / tau_s, 0.0, delta_fraction(HG_MAX)) : 0.0;
    float g_beam = sqrt(f), direct = exp(-tau_s), forward = exp(-tau_s * (1.0 - f)) - direct;
    scatter_rows beam = scatter_rows_of(g_beam, theta);
    float sets = float(lut.num_sets), u = lut_u(tau_s, lut_depth_scale(f));

    // Once scattered, and all orders after that in a medium of the beam's g.
    float row = lut_row(lut.log_first, lut.log_step, lut.num_rows, g);
    uint below = uint(row), above = min(below + 1u, lut.num_rows - 1u);
    float theta_1 = g <= 0.0 ? 0.0 : mix(lut.theta_1[below], lut.theta_1[above], fract(row));
    float h = lut_window(theta, theta_1);
    vec2 once = hg_near(g * a, one_minus_mu) * vec2(1.0 - h, h);
    vec2 more = f * (1.0 - direct) * exp(scatter_table(beam, u / sets) - tau_s * (1.0 - f));
    if (SCATTER_LUT_SOFT) {
        float set = float(set_index), u0 = lut_u(0.0, 0.0);
        vec2 all = exp(scatter_table(beam, (set + u) / sets) - tau_s * (1.0 - f));
        vec2 beam_once = exp(scatter_table(beam, (set + u0) / sets));
        vec2 once_here = exp(scatter_table(scatter_rows_of(g, theta), (set + u0) / sets));
        more = set > 0.0 ? max(all - beam_once * direct, vec2(0.0)) : more;
        once = set > 0.0 && g > 0.0 ? once_here : once;
    }
    // A last scattering that is broader than the earlier ones decides the angles: the beam's own spread
    // is narrow beside it.
    float spread = g_beam > 0.0 ? clamp(g / g_beam, 0.0, 1.0) : 0.0;
    return once * direct + mix(once * forward, more, spread);
}

#endif
