// scatter_lut_map.glsl -- where in the table a depth, an angle and a g are. No bindings.
#ifndef TYN_SCATTER_LUT_MAP_GLSL
#define TYN_SCATTER_LUT_MAP_GLSL
#include "phase.glsl"
#include "scatter_lut_args.h"

// Largest depth in the table: the beam is e^-20 of itself there. Beyond it the sums go as
// e^{-tau (1 - f)}, which is not in the table.
float lut_depth_max(float f)
{
    return 20.0 / (1.0 - f);
}

// Depth around which the texels go from even to geometric spacing; found by trial.
const float LUT_DEPTH = 4.0;

// Texture u per ln(1 + tau / LUT_DEPTH), texel centres at both ends.
float lut_depth_scale(float f)
{
    return float(TYN_LUT_DEPTHS - 1) / (float(TYN_LUT_DEPTHS) * log(1.0 + lut_depth_max(f) / LUT_DEPTH));
}

// From the first to the last depth, in texture u.
const float LUT_DEPTH_RANGE = float(TYN_LUT_DEPTHS - 1) / float(TYN_LUT_DEPTHS);

float lut_depth_log(float tau)
{
    return log(1.0 + max(tau, 0.0) / LUT_DEPTH);
}

float lut_u(float tau, float scale)
{
    return 0.5 / float(TYN_LUT_DEPTHS) + min(lut_depth_log(tau) * scale, LUT_DEPTH_RANGE);
}

float lut_depth(uint texel, float f)
{
    float t = float(texel) / float(TYN_LUT_DEPTHS - 1);
    return LUT_DEPTH * (exp(t * log(1.0 + lut_depth_max(f) / LUT_DEPTH)) - 1.0);
}

// Angle around which the texels go from even to geometric spacing, radians: a few times the width of
// the twice scattered light, p * p = Henyey-Greenstein of g^2.
float lut_width(const phase p)
{
    return 8.0 * (1.0 - phase_forward_cosine(p));
}

float lut_v(float theta, const phase p)
{
    float width = lut_width(p);
    float t = log(1.0 + theta / width) / log(1.0 + 3.14159265358979 / width);
    return (0.5 + t * float(TYN_LUT_ANGLES - 1)) / float(TYN_LUT_ANGLES);
}

float lut_theta(uint texel, const phase p)
{
    float width = lut_width(p);
    float t = float(texel) / float(TYN_LUT_ANGLES - 1);
    return width * (exp(t * log(1.0 + 3.14159265358979 / width)) - 1.0);
}

// ---- the table "tms" ----------------------------------------------------------------------------

// Texture u per ln(1 + tau / LUT_DEPTH), texel centres at both ends.
float tms_depth_scale(float f)
{
    return float(TYN_TMS_DEPTHS - 1) / (float(TYN_TMS_DEPTHS) * log(1.0 + lut_depth_max(f) / LUT_DEPTH));
}

float tms_u(float tau, float scale)
{
    return 0.5 / float(TYN_TMS_DEPTHS) +
           min(lut_depth_log(tau) * scale, float(TYN_TMS_DEPTHS - 1) / float(TYN_TMS_DEPTHS));
}

float tms_depth(uint texel, float f)
{
    float t = float(texel) / float(TYN_TMS_DEPTHS - 1);
    return LUT_DEPTH * (exp(t * log(1.0 + lut_depth_max(f) / LUT_DEPTH)) - 1.0);
}

// Over the square root of sin(theta / 2): no arc cosine, and texels are closer where lobes are.
// `away` = 1 - mu, or 1 + mu of backward scattering.
float tms_v(float away)
{
    const float n = float(TYN_TMS_ANGLES);
    return 0.5 / n + sqrt(sqrt(clamp(0.5 * away, 0.0, 1.0))) * ((n - 1.0) / n);
}

float tms_away(uint texel)
{
    float root = float(texel) / float(TYN_TMS_ANGLES - 1);
    return 2.0 * root * root * root * root;
}

// Fractional cone for a part of the sphere: the mix of the two cones around it that has its mean
// cosine, 1 - part. Cones are at even steps of sin(half their half angle).
float tms_level(float part)
{
    const float n = float(TYN_TMS_CONES - 1);
    part = clamp(part, 0.0, 1.0);
    float k = min(floor(n * sqrt(part)), n - 1.0);
    return k + clamp((n * n * part - k * k) / (2.0 * k + 1.0), 0.0, 1.0);
}

// ---- rows ---------------------------------------------------------------------------------------

// Fractional row of a spread table.
float lut_row(float log_first, float log_step, uint num_rows, float g)
{
    g = clamp(g, 1e-6, 1.0 - 1e-6);
    float row = (log(g / (1.0 - g)) - log_first) / log_step;
    return clamp(row, 0.0, float(num_rows - 1u));
}

// h: 1 inside theta_1 / 2, 0 outside 3 theta_1 / 2, smooth between.
float lut_window(float theta, float theta_1)
{
    if (theta_1 <= 0.0) {
        return 0.0;
    }
    float x = clamp(theta / theta_1 - 0.5, 0.0, 1.0);
    return 1.0 - x * x * (3.0 - 2.0 * x);
}

#endif
