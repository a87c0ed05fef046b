// raymarch_medium.glsl -- the medium as a march takes it: its optical depth in one channel or in three.
//
// Included by raymarch.glsl. RAYMARCH_GREY: all channels are equal, so optical depths are scalars.
#ifdef RAYMARCH_GREY
#define spectrum float
#define spectrum_of(v) (v).r
float spectrum_above(float x, float least) // 1 or 0
{
    return step(least, x);
}
float spectrum_max(float x)
{
    return x;
}
float spectrum_min(float x)
{
    return x;
}
float spectrum_mean(float x)
{
    return x;
}
#else
#define spectrum vec3
#define spectrum_of(v) (v)
vec3 spectrum_above(vec3 x, float least)
{
    return step(least, x);
}
float spectrum_max(vec3 x)
{
    return max(max(x.r, x.g), x.b);
}
float spectrum_min(vec3 x)
{
    return min(min(x.r, x.g), x.b);
}
float spectrum_mean(vec3 x)
{
    return (x.r + x.g + x.b) * (1.0 / 3.0);
}
#endif

// A macro: its value is a specialization constant, and engine/gpu/specialize.c drops what is off.
#define raymarch_has(feature) ((raymarch_features & (feature)) != 0u)

// (1 - e^-x) / x with e = e^-x, x >= 0; the series where the difference would lose digits.
float mean_attenuation(float x, float e)
{
    return x > 0.03 ? (1.0 - e) / x : 1.0 - x * (0.5 - x * (1.0 / 6.0 - x * (1.0 / 24.0)));
}

vec3 mean_attenuation(vec3 x, vec3 e)
{
    return vec3(mean_attenuation(x.r, e.r), mean_attenuation(x.g, e.g), mean_attenuation(x.b, e.b));
}

// Centroid of e^-x over a step, in steps: 1/x - 1/(e^x - 1) = 1/2 - x/12 + ..., within 0.002 up to x = 3.
float step_centroid(float x)
{
    x = min(x, 3.0);
    return 0.5 - x * (1.0 / 12.0 - x * x * (1.0 / 900.0));
}

// The medium at one point, delta scaled.
struct march_medium {
    spectrum scattering;        // sigma_s
    spectrum extinction;        // sigma_t
    spectrum scaled_scattering; // sigma_s' = (1 - f) sigma_s
    spectrum scaled_extinction; // sigma_t' = sigma_t - f sigma_s
    spectrum absorption;
    spectrum hidden; // scattering into lobes too narrow to resolve: only what is behind loses it
    phase phase[3]; // of each channel; grey: the first
    vec3 emission;
};

march_medium march_medium_of(const medium_point point)
{
    march_medium m;
    vec3 sigma_s = point.sigma_s;
    m.phase = point.phase;
    bool scaled = !raymarch_has(RAYMARCH_UNSCALED);
    if (scaled) {
        similarity_clamp(sigma_s, m.phase);
    }
    m.scattering = spectrum_of(sigma_s);
    m.absorption = spectrum_of(point.sigma_a);
    m.hidden = spectrum_of(point.sigma_s) - m.scattering;
    m.extinction = m.scattering + m.absorption;
    m.scaled_scattering = m.scattering;
    if (scaled) {
        m.scaled_scattering *= 1.0 - spectrum_of(delta_fraction(m.phase));
    }
    m.scaled_extinction = m.scaled_scattering + m.absorption;
    m.emission = point.emission;
    return m;
}

march_medium march_scale(const march_medium unit, float density)
{
    return march_medium(unit.scattering * density, unit.extinction * density,
                        unit.scaled_scattering * density, unit.scaled_extinction * density,
                        unit.absorption * density, unit.hidden * density, unit.phase,
                        unit.emission * density);
}

// A vector of three numbers in [-1, 1] for a place with whole coordinates (Jarzynski and Olano, "Hash functions for GPU
// rendering", 2020: pcg3d).
vec3 march_noise_at(ivec3 place)
{
    uvec3 v = uvec3(place) * 1664525u + 1013904223u;
    v += v.yzx * v.zxy;
    v ^= v >> 16u;
    v += v.yzx * v.zxy;
    return vec3(v >> 8u) * (2.0 / 16777216.0) - 1.0;
}

// By how much the place p is moved, m: three octaves of vector noise, each of half the size and half the strength of that
// before (Elek et al. 2012, Sec 4.4), smooth between places with whole coordinates. No component is above args.noise.
vec3 march_noise(vec3 p)
{
    vec3 sum = vec3(0.0), x = p / args.noise_size;
    float strength = args.noise / 1.75;
    for (int octave = 0; octave < 3; octave++) {
        ivec3 lo = ivec3(floor(x));
        vec3 t = x - floor(x);
        t = t * t * (3.0 - 2.0 * t);
        for (int i = 0; i < 8; i++) {
            ivec3 corner = ivec3(i & 1, i >> 1 & 1, i >> 2);
            vec3 w = mix(1.0 - t, t, vec3(corner));
            sum += (strength * w.x * w.y * w.z) * march_noise_at(lo + corner);
        }
        x = 2.0 * x + 17.5;
        strength *= 0.5;
    }
    return sum;
}

// At a texture coordinate; `unit` is the medium at texture value 1 (mode DENSITY).
march_medium march_medium_at(const march_medium unit, vec3 uvw)
{
    if (raymarch_has(RAYMARCH_NOISE)) {
        uvw += march_noise(uvw * medium.extent) / medium.extent;
    }
    if (raymarch_has(RAYMARCH_REPEAT)) {
        uvw -= vec3(medium.repeat) * floor(uvw);
    }
#ifndef RAYMARCH_GREY
    if (medium_mode != TYN_MEDIUM_DENSITY) {
        vec3 emission = vec3(0.0);
        if (raymarch_has(RAYMARCH_EMISSION)) {
            emission = textureLod(emission_tex, uvw, 0.0).rgb;
        }
        return march_medium_of(medium_point(textureLod(density_tex, uvw, 0.0).rgb,
                                            textureLod(sigma_a_tex, uvw, 0.0).rgb,
                                            medium_phase(uvw), emission));
    }
#endif
    return march_scale(unit, max(textureLod(density_tex, uvw, 0.0).r, 0.0));
}

// Is there anything that absorbs, scatters or emits?
bool march_any(const march_medium m)
{
    float most = spectrum_max(m.extinction) + spectrum_max(m.hidden);
    if (raymarch_has(RAYMARCH_EMISSION)) {
        most += m.emission.r + m.emission.g + m.emission.b;
    }
    return most > 0.0;
}
