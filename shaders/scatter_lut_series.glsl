// scatter_lut_series.glsl -- one step of the Legendre recurrence, kept exact near both poles. No bindings.
//
// (l+1) P_{l+1} = (2l+1) x P_l - l P_{l-1} loses all digits near x = 1 for l in the thousands, where
// dP_l/dx = l (l+1) / 2. In y = 1 - x and the differences d_l = P_l - P_{l-1} it reads
//   d_{l+1} = (l d_l - (2l+1) y P_l) / (l+1)
// and y is known to full relative precision. Behind (x < 0) use P_l(-x) = (-1)^l P_l(x).
#ifndef TYN_SCATTER_LUT_SERIES_GLSL
#define TYN_SCATTER_LUT_SERIES_GLSL

struct legendre {
    float p;    // P_l(|x|), l = 0 at the start
    float d;    // P_l - P_{l-1}
    float y;    // 1 - |x|
    float sign; // (-1)^l behind, else 1
    float flip; // -1 behind, else 1
};

legendre legendre_start(float theta)
{
    bool behind = theta > 0.5 * 3.14159265358979;
    float half_sine = behind ? cos(0.5 * theta) : sin(0.5 * theta);
    return legendre(1.0, 0.0, 2.0 * half_sine * half_sine, 1.0, behind ? -1.0 : 1.0);
}

float legendre_value(legendre s)
{
    return s.sign * s.p;
}

// From l to l + 1.
void legendre_next(inout legendre s, float l)
{
    s.d = (l * s.d - (2.0 * l + 1.0) * s.y * s.p) / (l + 1.0);
    s.p += s.d;
    s.sign *= s.flip;
}

#endif
