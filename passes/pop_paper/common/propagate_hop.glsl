// propagate_hop.glsl -- light of a cell of a grid that is aligned with it: which part goes to which of six neighbours.
//
// Elek, Ritschel, Dachsbacher, Seidel: Principal-Ordinates Propagation for Real-Time Rendering of
// Participating Media, 2014, section 4 (Eqs 1-3). No bindings.
//
// What is kept of a is its complement, the spread 1 - a: light that has hardly scattered has a next to
// 1, and the fractions that go sideways are proportional to 1 - a, which a rounded a would lose.
#ifndef TYN_PROPAGATE_HOP_GLSL
#define TYN_PROPAGATE_HOP_GLSL

const float PROPAGATE_CONE = 0.70710678; // cosine of 45 degrees, the half angle of Eq 3's cones

// A cell: L in units of the irradiance, 1 - a, and the fractions of L that go to each of the four
// neighbours beside and to the one behind; the rest goes to the one in front. The fractions are the
// distribution integrated over the cones of Eq 3, whose half angle has the cosine `edge` (45 and 135 degrees:
// PROPAGATE_CONE). With s^2 = 1 + a^2 - 2 a mu the integral of Eq 1 below mu is (1 - a) (1 + mu) / (s (s + 1 + a)), which
// has no division by a. A lobe that points backward is the mirror image.
vec4 propagate_state(float light, float spread, float edge)
{
    float narrow = min(spread, 2.0 - spread); // 1 - |a|
    float s_ahead = sqrt(narrow * narrow + 2.0 * (1.0 - narrow) * (1.0 - edge));
    float s_behind = sqrt(narrow * narrow + 2.0 * (1.0 - narrow) * (1.0 + edge));
    float outside = narrow * (1.0 + edge) / (s_ahead * (s_ahead + 2.0 - narrow)); // of the cone ahead
    float behind = narrow * (1.0 - edge) / (s_behind * (s_behind + 2.0 - narrow));
    float side = 0.25 * (outside - behind);
    return vec4(light, spread, side, spread <= 1.0 ? behind : 1.0 - outside);
}

// What of a cell's light goes `layers` steps along d.
float propagate_part(vec4 state, int layers)
{
    float part = layers == 0 ? state.z : layers < 0 ? state.w : 1.0 - 4.0 * state.z - state.w;
    return state.x * part;
}

// 1 - e^-x, x >= 0.
float propagate_loss(float x)
{
    return x < 0.05 ? x * (1.0 - x * (0.5 - x * (1.0 / 6.0 - x * (1.0 / 24.0)))) : 1.0 - exp(-x);
}

#endif
