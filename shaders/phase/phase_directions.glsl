// phase_directions.glsl -- directions that are distributed as the phase function, or as lobes about a light.
#ifndef TYN_PHASE_DIRECTIONS_GLSL
#define TYN_PHASE_DIRECTIONS_GLSL
#include "phase.glsl"

// Phase function of each channel, 1/sr, between two unit directions of travel.
vec3 phase_between(phase p[3], vec3 before, vec3 after)
{
    vec3 apart = before - after;
    float one_minus_mu = 0.5 * dot(apart, apart); // does not cancel in the narrow peak
    return vec3(phase_near(p[0], 1.0, one_minus_mu), phase_near(p[1], 1.0, one_minus_mu),
                phase_near(p[2], 1.0, one_minus_mu));
}

// Unit vector about `axis`, distributed as the phase function, from two uniform numbers.
vec3 phase_direction(const phase p, vec3 axis, vec2 u)
{
    float one_minus_mu = phase_sample(p, u.x);
    float across = sqrt(max(one_minus_mu * (2.0 - one_minus_mu), 0.0)), azimuth = 2.0 * HG_PI * u.y;
    // Duff et al., "Building an orthonormal basis, revisited" (JCGT 6(1), 2017).
    float sign_z = axis.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (sign_z + axis.z), b = axis.x * axis.y * a;
    vec3 t = vec3(1.0 + sign_z * axis.x * axis.x * a, sign_z * b, -sign_z * axis.x);
    vec3 s = vec3(b, sign_z + axis.y * axis.y * a, -axis.y);
    vec3 d = (1.0 - one_minus_mu) * axis + across * (cos(azimuth) * t + sin(azimuth) * s);
    return d * (1.5 - 0.5 * dot(d, d)); // rounding alone is to be undone: one Newton step
}

// ---- lobes about a light ------------------------------------------------------------------------

// Where light that has scattered once (of the forward lobe) and twice comes from, half and half. For backward
// scattering the lobes are uniform.
phase phase_about_light(const phase p, bool once)
{
    float g = phase_forward_cosine(p);
    return phase_of_mean_cosine(once ? g : g * g);
}

// pdf of `d` about `light`, unit vectors.
vec3 light_lobes_pdf(phase p[3], vec3 light, vec3 d)
{
    phase once[3], twice[3];
    for (int c = 0; c < 3; c++) {
        once[c] = phase_about_light(p[c], true);
        twice[c] = phase_about_light(p[c], false);
    }
    return 0.5 * (phase_between(once, light, d) + phase_between(twice, light, d));
}

#endif
