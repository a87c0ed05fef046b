// tms.glsl -- what a medium scatters out of the light of an ordinate.
//
// An ordinate stands for a cone of directions. Of irradiance that has come through the scattering depth
// tau_s the medium scatters, per sigma_s' and with all light that is still going forward,
//   e^-tau' k,  k(mu) = sum_l (2l+1)/(4 pi) P_l(mu) c_l (p_l - F_l) / (1 - f) e^{-tau_s (f - F_l)},
// which is K_tms of scatter_lut.glsl averaged over the cone; e^-tau' is the delta-scaled transmittance.
// c_l are the Legendre moments of a uniform cone with half angle gamma, c = cos gamma:
//   c_l = (P_{l-1}(c) - P_{l+1}(c)) / ((2l+1) (1 - c)),  c_1 = 1 - solid angle / (4 pi).
// k is a phase function: its integral over all directions is 1.
//
// The table "tms" has k over ln(1 + tau_s / 4), sin(theta / 2)^(1/2) and the size of the cone. Cones of
// other sizes are mixed from two so that the mean cosine is exact.
//
// Define TMS and SCATTER_LUT_BLOCK, the bindings of the table (sampler3D) and of the lut_block (uniform
// buffer), before including.
#include "shaders/phase/scatter_lut_map.glsl"

layout(set = 0, binding = TMS) uniform sampler3D tms_tex;
TYN_UNIFORM(SCATTER_LUT_BLOCK, lut_block, lut_block lut);

// A row of the table.
struct tms_row {
    float w;     // texture coordinate of the smallest cone
    float scale; // texture u per ln(1 + tau / 4)
    float side;  // -1 of backward scattering: angles are counted from behind
};

tms_row tms_row_of(uint row)
{
    phase p = lut.phase[row];
    return tms_row((float(row * TYN_TMS_CONES) + 0.5) / float(lut.num_rows * TYN_TMS_CONES),
                   tms_depth_scale(delta_fraction(p)), phase_is_backward(p) ? -1.0 : 1.0);
}

// Mode DENSITY.
tms_row tms_row_of_channel(uint channel)
{
    return tms_row_of(lut.channel_row[channel]);
}

// k, 1/sr. `mu`: cosine between the light's travel and the way to the eye; `level`: tms_level of the
// ordinate's solid angle / (4 pi). One fetch.
float tms_kernel(const tms_row row, float mu, float tau_s, float level)
{
    vec3 at = vec3(tms_u(tau_s, row.scale), tms_v(1.0 - row.side * mu),
                   row.w + level / float(lut.num_rows * TYN_TMS_CONES));
    return textureLod(tms_tex, at, 0.0).r;
}

// ---- mode COEFFICIENTS, where the mean cosine g varies ------------------------------------------------

// f - F_1: how fast the mean cosine of light that is still going forward falls with tau_s. A fit to the
// moments of the lobe, within 1.5 %.
float tms_spread(float g)
{
    float f = delta_fraction(g);
    return f * f * (1.0 - g) / (0.871 + g * (1.35 + 2.47 * g));
}

// The last scattering; constant in a cell.
struct tms_last {
    tms_row below, above; // around its g
    float between;
    float depth; // of a beam of its g that has a spread of 1
    phase phase;
};

tms_last tms_last_of(const phase last)
{
    float g = phase_mean_cosine(last);
    float row = lut_row(lut.log_first, lut.log_step, lut.num_rows, min(g, HG_MAX));
    uint below = uint(row), above = min(below + 1u, lut.num_rows - 1u);
    return tms_last(tms_row_of(below), tms_row_of(above), fract(row),
                    1.0 / tms_spread(clamp(g, phase_mean_cosine(lut.phase[0]), HG_MAX)), last);
}

// The mean of (1 - f) on the way was tau_p / tau_s. A beam of the last scattering's g that is as wide as
// that one has another depth.
float tms_kernel_mixed(const tms_last last, float mu, float tau_s, float tau_p, float level,
                       float mean_cosine)
{
    float f = tau_s > 0.0 ? clamp(1.0 - tau_p / tau_s, 0.0, delta_fraction(HG_MAX)) : 0.0;
    float depth = tau_s * tms_spread(delta_lobe(f)) * last.depth;
    float forward = mix(tms_kernel(last.below, mu, depth, level),
                        tms_kernel(last.above, mu, depth, level), last.between);
    // Without a lobe the light is as narrow as it came.
    return phase_forward_cosine(last.phase) > 0.0 ? forward : phase_near(last.phase, mean_cosine, 1.0 - mu);
}
