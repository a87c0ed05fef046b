// legendre.glsl -- associated Legendre functions with int_-1^1 P_lm^2 dmu = 1. No bindings.
//
// For l < 64 in single precision. Towards the poles P_mm ~ sin^m theta underflows for large m, but only
// where P_lm is below 1e-9 for every l < 64 too: it grows from P_mm by less than e^24 before it starts to
// oscillate.
// P_mm / sin^m theta.

float legendre_norm(uint m)
{
    float norm = 0.70710678;
    for (uint i = 1u; i <= m; i++) {
        norm *= sqrt(1.0 + 0.5 / float(i));
    }
    return norm;
}

// P_lm = alpha (cos_theta P_{l-1,m} - beta P_{l-2,m}) for l > m, P_{m-1,m} = 0.
vec2 legendre_recurrence(uint l, uint m)
{
    float ll = float(l * l), mm = float(m * m), before = float((l - 1u) * (l - 1u));
    return vec2(sqrt((4.0 * ll - 1.0) / (ll - mm)), sqrt(max(before - mm, 0.0) / abs(4.0 * before - 1.0)));
}
