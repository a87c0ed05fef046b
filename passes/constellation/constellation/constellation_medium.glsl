// constellation_medium.glsl -- the medium at a sample, from the texture that has the distance map beside it.
//
// Include after medium.glsl. What is summed along shadow rays is density (mode DENSITY) or sigma_t of each channel.
#ifdef TYN_DENSITY
#define MATTER float

MATTER matter_of(vec4 v)
{
    return max(v.r, 0.0);
}

float away_of(vec4 v)
{
    return v.g;
}

vec3 extinction_of(MATTER m)
{
    return (medium.sigma_s + medium.sigma_a) * m;
}

float most_of(MATTER m)
{
    return m;
}
#else
#define MATTER vec3

MATTER matter_of(vec4 v)
{
    return max(v.rgb, vec3(0.0));
}

float away_of(vec4 v)
{
    return v.a;
}

vec3 extinction_of(MATTER m)
{
    return m;
}

float most_of(MATTER m)
{
    return max(max(m.r, m.g), m.b);
}
#endif

struct sample_point {
    vec3 extinction, scattering; // 1/m
    vec3 emission;               // W/(m^3 sr)
    phase phase[3];
};

// Where the medium is `m` at the texture coordinate `uvw`.
sample_point sample_point_of(MATTER m, vec3 uvw)
{
    sample_point s;
    s.extinction = extinction_of(m);
#ifdef TYN_DENSITY
    s.scattering = medium.sigma_s * m;
    s.phase = medium.phase;
    s.emission = medium.emission * m;
#else
    s.scattering = max(textureLod(density_tex, uvw, 0.0).rgb, 0.0);
    s.phase = medium_phase(uvw);
    s.emission = vec3(0.0);
    if (constellation_has(CONSTELLATION_EMISSION)) {
        s.emission = textureLod(emission_tex, uvw, 0.0).rgb;
    }
#endif
    return s;
}

// Is there nothing at a sample? Media may emit alone where coefficients differ between them.
bool is_empty(MATTER m, vec3 uvw)
{
    float most = most_of(m);
#ifndef TYN_DENSITY
    if (constellation_has(CONSTELLATION_EMISSION)) {
        const vec3 e = textureLod(emission_tex, uvw, 0.0).rgb;
        most = max(most, max(max(e.r, e.g), e.b));
    }
#endif
    return !(most > 0.0);
}
