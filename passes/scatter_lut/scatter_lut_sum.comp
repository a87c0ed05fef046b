// scatter_lut_sum.comp -- sums the series of one depth and row for all angles.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "scatter_lut_map.glsl"
#include "scatter_lut_series.glsl"

layout(local_size_x = TYN_LUT_ANGLES) in; // x: angle, y: depth, z: row
layout(set = 0, binding = 0, scalar) readonly buffer lut_buffer
{
    lut_block lut;
};
layout(set = 0, binding = 1, scalar) readonly buffer moments_buffer
{
    vec2 moments[]; // g^l - F_l, F_l
};
layout(set = 0, binding = 2, rg32f) writeonly uniform image3D lut_image;

const float PI = 3.14159265358979;

shared vec2 coefficients[TYN_LUT_ANGLES];

// (2l+1)/(4 pi) (e^{-tau (1 - F_l)} - e^-tau) / (f (1 - e^-tau) e^{-tau (1 - f)}); its limit at tau = 0.
float coefficient(float l, float moment, float f, float tau)
{
    float order = (2.0 * l + 1.0) / (4.0 * PI * f);
    if (tau == 0.0) {
        return order * moment;
    }
    float x = tau * moment;
    float scattered = abs(x) < 0.05 ? exp(tau * (moment - f)) * x * (1.0 - x * (0.5 - x / 6.0 * (1.0 - 0.25 * x)))
                                    : exp(tau * (moment - f)) - exp(-tau * f);
    float any = tau < 0.05 ? tau * (1.0 - tau * (0.5 - tau / 6.0 * (1.0 - 0.25 * tau))) : 1.0 - exp(-tau);
    return order * scattered / any;
}

void main()
{
    ivec3 texel = ivec3(gl_GlobalInvocationID);
    uint row = gl_WorkGroupID.z;
    float g = lut.g[row];
    float f = lut.theta_1[row] > 0.0 ? g * g : 0.0;
    float tau = lut_depth(gl_WorkGroupID.y, f);
    uint terms = f > 0.0 ? lut.terms[row] : 0u;

    legendre series = legendre_start(lut_theta(gl_LocalInvocationID.x, g));
    vec2 sums = vec2(0.0);
    for (uint start = 0u; start < terms; start += TYN_LUT_ANGLES) {
        uint l = start + gl_LocalInvocationID.x;
        barrier();
        if (l < terms) {
            vec2 moment = moments[lut.first_term[row] + l];
            coefficients[gl_LocalInvocationID.x] = moment * coefficient(float(l), moment.y, f, tau);
        }
        barrier();
        uint count = min(terms - start, TYN_LUT_ANGLES);
        for (uint i = 0u; i < count; i++) {
            sums += coefficients[i] * legendre_value(series);
            legendre_next(series, float(start + i));
        }
    }
    // Both parts are sums of convolutions of non-negative functions; what rounding leaves below a ten
    // thousandth of the other one is not resolved.
    float total = max(sums.x + sums.y, 1e-9);
    vec2 stored = log(max(sums, vec2(1e-4 * total)));
    imageStore(lut_image, texel.yxz, vec4(stored, 0.0, 0.0));
}
