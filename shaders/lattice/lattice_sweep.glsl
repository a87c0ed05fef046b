// lattice_sweep.glsl -- light along the 14 lattice lines of a cell. No bindings.
//
// Directions: 6 along the axes, 8 along the body diagonals; a line goes from cell centre to cell
// centre, so nothing is interpolated and the tubes around the lines fill space: what leaves a cell
// enters the next one. The weights sum to 1 and give sum w O O^T = 1/3 for any share of the axes;
// 0.30 matches the mean escape from a cube within 0.7 % for optical depths 1 to 50 (Lebedev's 0.40:
// 2.6 %).
#ifndef TYN_LATTICE_SWEEP_GLSL
#define TYN_LATTICE_SWEEP_GLSL

const float LATTICE_4PI = 12.56637061;
const float LATTICE_WEIGHT_AXIS = 0.30 / 6.0;
const float LATTICE_WEIGHT_DIAGONAL = 0.70 / 8.0;

float lattice_weight(uint direction)
{
    return direction < 6 ? LATTICE_WEIGHT_AXIS : LATTICE_WEIGHT_DIAGONAL;
}

// Of a cell's face, in its areas: what a direction takes of a wall across an axis that it is along or oblique to.
float lattice_share(uint direction)
{
    return lattice_weight(direction) * (direction < 6u ? 1.0 : inversesqrt(3.0));
}

// Steps of direction 0..13; 0..5 are the axes.
ivec3 lattice_step(uint direction)
{
    if (direction < 6) {
        ivec3 o = ivec3(0);
        o[direction / 2] = direction % 2 == 0 ? 1 : -1;
        return o;
    }
    uint corner = direction - 6;
    return ivec3((corner & 1) == 0 ? 1 : -1, (corner & 2) == 0 ? 1 : -1, (corner & 4) == 0 ? 1 : -1);
}

// What is solved of a colour: its channel, or its share of the tint (see tyn_lattice_tint).
float lattice_channel(vec3 color, uint channels, uint ch, vec3 tint)
{
    return channels == 1 ? dot(color, tint) / dot(tint, tint) : color[ch];
}

// The source of scattered radiance per sigma_s' is linear in direction: s(O) = e.x + dot(O, e.yzw),
// from the fluence and flux of all light. It may be negative against strong light; that is not
// clipped, as clipping adds energy (1.7 % at g = 0.9).
vec4 lattice_emitted(vec4 total, float g)
{
    return vec4(total.x, 3.0 * g * total.yzw) / LATTICE_4PI;
}

// Without suns the source's port has one texel of zeros.
vec4 lattice_fetch_source(sampler3D source, sampler3D cells, ivec3 texel)
{
    return textureSize(source, 0) == textureSize(cells, 0) ? texelFetch(source, texel, 0) : vec4(0.0);
}

// A segment of optical depth tau with a source that is linear along it (value s in the middle,
// slope per segment): psi_out = psi_in e + Q (s a0 + slope w1), mean psi = psi_in a0 + Q (s a1 +
// slope b1), Q = length sigma_s'. The slope has no mean: tau psi_mean = psi_in - psi_out + Q s
// exactly, so energy is conserved; without it thick media diffuse too fast by sigma length / 2.
struct lattice_weights {
    float e, a0, a1, w1, b1;
};

lattice_weights lattice_weights_of(float tau)
{
    lattice_weights w;
    if (tau < 0.5) {
        // Power series where the closed forms cancel; a0 and e from a1, so that tau a1 = 1 - a0 and
        // tau a0 = 1 - e hold to the last digit: that is what conserves energy.
        w.a1 = 1.0 / 40320.0;
        w.a1 = 1.0 / 5040.0 - tau * w.a1;
        w.a1 = 1.0 / 720.0 - tau * w.a1;
        w.a1 = 1.0 / 120.0 - tau * w.a1;
        w.a1 = 1.0 / 24.0 - tau * w.a1;
        w.a1 = 1.0 / 6.0 - tau * w.a1;
        w.a1 = 0.5 - tau * w.a1;
        w.a0 = 1.0 - tau * w.a1;
        w.e = 1.0 - tau * w.a0;
        w.b1 = 1.0 / 360.0 - tau * (1.0 / 2016.0 - tau / 13440.0);
        w.b1 = -(1.0 / 12.0 - tau * (1.0 / 24.0 - tau * (1.0 / 80.0 - tau * w.b1)));
        w.w1 = -tau * w.b1;
    } else {
        w.e = exp(-tau);
        w.a0 = (1.0 - w.e) / tau;
        w.a1 = (1.0 - w.a0) / tau;
        w.w1 = w.a1 - 0.5 * w.a0;
        w.b1 = -w.w1 / tau;
    }
    return w;
}

#endif
