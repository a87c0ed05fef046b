// scatter_lut_sum.comp -- sums the series of one depth and row for all angles.
#include "shaders/phase/scatter_lut_map.glsl"

const uint THREADS = TYN_LUT_ANGLES / 4, CHUNK = TYN_LUT_ANGLES;
layout(local_size_x = TYN_LUT_ANGLES / 4) in; // x: four angles, y: depth of a set, z: row
TYN_READ(0, lut_block, lut_block lut);
TYN_READ(1, moments, vec2 moments[]); // outside and inside the lobe
layout(set = 0, binding = 2, rg32f) writeonly uniform image2D lut_image;

const float PI = 3.14159265358979;

// Per term of a chunk: coefficient of K_tms and K_lobe, and of the recurrence to the next P_l.
shared vec4 chunk[CHUNK];

// 1 - e^-x without cancellation.
float lost(float x)
{
    return abs(x) < 0.05 ? x * (1.0 - x * (0.5 - x / 6.0 * (1.0 - 0.25 * x))) : 1.0 - exp(-x);
}

// Points: (2l+1)/(4 pi) (e^{-tau (1 - F_l)} - e^-tau) / (f (1 - e^-tau) e^{-tau (1 - f)}), F_l = moment; its
// limit at tau = 0. F_l may be negative, but no exponent here is ever large.
float coefficient(float l, float moment, float f, float tau)
{
    float x = tau * moment;
    float scattered = tau == 0.0 ? moment
                      : abs(x) < 0.05 ? exp(tau * (moment - f)) * lost(x) / lost(tau)
                                      : (exp(tau * (moment - f)) - exp(-tau * f)) / lost(tau);
    return (2.0 * l + 1.0) / (4.0 * PI * f) * scattered;
}

// Suns that are seen under an angle: (2l+1)/(4 pi) a^{l (l+1) / 2} e^{tau (F_l - f)}.
float blurred_coefficient(float l, float moment, float f, float tau, float blur)
{
    float spot = 0.5 * l * (l + 1.0) * log(1.0 - blur);
    return (2.0 * l + 1.0) / (4.0 * PI) * exp(spot + tau * (moment - f));
}

void main()
{
    uint thread = gl_LocalInvocationID.x, row = gl_WorkGroupID.z;
    phase scattering = lut.phase[row];
    float f = lut.theta_1[row] > 0.0 ? delta_fraction(scattering) : 0.0;
    float tau = lut_depth(gl_WorkGroupID.y % TYN_LUT_DEPTHS, f);
    float blur = lut.blur[gl_WorkGroupID.y / TYN_LUT_DEPTHS];
    uint terms = f > 0.0 || blur > 0.0 ? lut.terms[row] : 0u;

    // The recurrence (l+1) P_{l+1} = (2l+1) x P_l - l P_{l-1} loses all digits near x = 1 for l in the
    // thousands, where dP_l/dx = l (l+1) / 2. In y = 1 - x, which is known to full relative precision,
    // and the differences d_l = P_l - P_{l-1} it reads d_{l+1} = (l d_l - (2l+1) y P_l) / (l+1).
    // Behind (x < 0) P_l(-x) = (-1)^l P_l(x).
    vec4 y;
    bvec4 behind;
    for (uint a = 0u; a < 4u; a++) {
        float theta = lut_theta(thread + a * THREADS, scattering);
        behind[a] = theta > 0.5 * PI;
        float half_sine = behind[a] ? cos(0.5 * theta) : sin(0.5 * theta);
        y[a] = 2.0 * half_sine * half_sine;
    }
    vec4 p = vec4(1.0), d = vec4(0.0);
    vec4 rest_even = vec4(0.0), rest_odd = vec4(0.0), lobe_even = vec4(0.0), lobe_odd = vec4(0.0);
    for (uint start = 0u; start < terms; start += CHUNK) {
        barrier();
        for (uint i = thread; i < CHUNK; i += THREADS) {
            uint l = start + i;
            chunk[i] = vec4(0.0);
            if (l < terms) {
                vec2 moment = moments[lut.first_term[row] + l];
                float factor = blur > 0.0 ? blurred_coefficient(float(l), moment.y, f, tau, blur)
                                          : coefficient(float(l), moment.y, f, tau);
                factor *= phase_is_backward(scattering) && (l & 1u) != 0u ? -1.0 : 1.0; // seen from behind
                chunk[i] = vec4(moment * factor,
                                vec2(float(l), float(2u * l + 1u)) / float(l + 1u));
            }
        }
        barrier();
        uint count = min(terms - start, CHUNK);
        for (uint i = 0u; i < count; i += 2u) { // chunks have an even length
            vec4 term = chunk[i];
            rest_even += term.x * p;
            lobe_even += term.y * p;
            d = term.z * d - term.w * y * p;
            p += d;
            term = chunk[i + 1u];
            rest_odd += term.x * p;
            lobe_odd += term.y * p;
            d = term.z * d - term.w * y * p;
            p += d;
        }
    }
    vec4 rest = rest_even + mix(rest_odd, -rest_odd, behind);
    vec4 lobe = lobe_even + mix(lobe_odd, -lobe_odd, behind);
    for (uint a = 0u; a < 4u; a++) {
        // Both parts are sums of convolutions of non-negative functions; what rounding leaves below a
        // ten thousandth of the other one is not resolved.
        float total = max(rest[a] + lobe[a], 1e-9);
        vec2 stored = log(max(vec2(rest[a], lobe[a]), vec2(1e-4 * total)));
        ivec2 texel = ivec2(gl_WorkGroupID.y, thread + (a + 4u * row) * THREADS);
        imageStore(lut_image, texel, vec4(stored, 0.0, 0.0));
    }
}
