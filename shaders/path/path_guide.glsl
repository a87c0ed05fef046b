// path_guide.glsl -- directions in which paths go on, and in which they look for the light of a map.
//
// A path has the least noise if it goes on in proportion to phase function times radiance (Herholz et al., "Volume path guiding based
// on zero-variance random walk theory", 2019). The radiance is guessed: a lobe of what has scattered, whose mean cosine is net flux
// over fluence, and two about the beams, of the mean cosines g and g^2 that one and two scatterings leave them. Directions are chosen
// among candidates, some drawn from the phase function and one from each lobe (resampled importance sampling: Talbot, Cline and
// Egbert, "Importance resampling for global illumination", 2005). Their weights with a path's own telescope: phase function
// times guess, summed up over the candidates, over the guess in the direction taken. The guess decides the noise alone, never the mean.
#ifndef TYN_PATH_GUIDE_GLSL
#define TYN_PATH_GUIDE_GLSL
#include "shaders/phase/phase_directions.glsl"
#include "shaders/random/rng.glsl"

const uint GUIDE_CANDIDATES = 4u; // of the phase function
// Caps, as the field is coarse.
const float GUIDE_NARROWEST = 0.8, GUIDE_SCATTERED_LEAST = 0.05;

struct guide_lobe {
    vec3 axis;         // where most light comes from, unit
    float mean_cosine; // about it, >= 0
    float share;       // of the fluence
    float candidates;  // the balance heuristic counts so many of it
};

struct path_guide {
    guide_lobe scattered, beams;
    float spread;   // mean cosine of the beams' second lobe
    float expected; // phase function times guess over all directions, 1/sr
};

// As much as light from a whole hemisphere: 1 - cosine of the angle between two unit vectors, which does not cancel.
float one_minus_cosine(vec3 a, vec3 b)
{
    vec3 apart = a - b;
    return 0.5 * dot(apart, apart);
}

// A lobe of vector irradiance `flux`, along which light goes, and fluence.
guide_lobe guide_lobe_of(vec4 fluence_flux, float most)
{
    vec3 size = abs(fluence_flux.yzw);
    float largest = max(max(size.x, size.y), size.z);
    if (!(largest > 0.0 && largest < 1e30 && fluence_flux.x > 0.0 && fluence_flux.x < 1e30)) {
        return guide_lobe(vec3(0.0, 0.0, 1.0), 0.0, fluence_flux.x > 0.0 && fluence_flux.x < 1e30 ? fluence_flux.x : 0.0, 0.0);
    }
    vec3 flux = fluence_flux.yzw / largest; // squares stay finite
    float along = length(flux);
    return guide_lobe(-flux / along, min(along * largest / fluence_flux.x, most), fluence_flux.x, 0.0);
}

// The concentration of a von Mises-Fisher lobe of the same mean cosine: how sharp it is.
float guide_sharpness(float mean_cosine)
{
    float square = mean_cosine * mean_cosine;
    return mean_cosine * (3.0 - square) / max(1.0 - square, 1e-4);
}

float guide_beams(const path_guide guide, vec3 d)
{
    float away = one_minus_cosine(guide.beams.axis, d);
    return 0.5 * (hg_near(guide.beams.mean_cosine, away) + hg_near(guide.spread, away));
}

float guide_scattered(const path_guide guide, vec3 d)
{
    return hg_near(guide.scattered.mean_cosine, one_minus_cosine(guide.scattered.axis, d));
}

// Of a path that goes along `way` and scatters with the mean cosine `g`; fluence (x) and net flux of both parts of the light.
path_guide guide_of(vec4 scattered, vec4 beams, vec3 way, float g)
{
    path_guide guide;
    float forward = max(g, 0.0);
    guide.scattered = guide_lobe_of(scattered, GUIDE_NARROWEST);
    guide.beams = guide_lobe_of(beams, 1.0);
    guide.beams.mean_cosine *= forward;
    guide.spread = guide.beams.mean_cosine * forward;
    float total = max(guide.scattered.share + guide.beams.share, 1e-30);
    guide.beams.share /= total;
    guide.scattered.share = max(guide.scattered.share / total, GUIDE_SCATTERED_LEAST);
    // A lobe seen through the phase function is one of the product of the mean cosines.
    float away = one_minus_cosine(way, guide.beams.axis);
    float of_beams = guide.beams.share * 0.5 *
                     (hg_near(g * guide.beams.mean_cosine, away) + hg_near(g * guide.spread, away));
    float of_scattered = guide.scattered.share * hg_near(g * guide.scattered.mean_cosine,
                                                         one_minus_cosine(way, guide.scattered.axis));
    guide.expected = of_scattered + of_beams;
    // A lobe as wide as the phase function needs no candidates of its own.
    float sharpness = guide.expected * max(guide_sharpness(abs(g)), 1e-2);
    guide.scattered.candidates = of_scattered * guide_sharpness(guide.scattered.mean_cosine) / sharpness;
    guide.beams.candidates = of_beams * guide_sharpness(guide.beams.mean_cosine) / sharpness;
    return guide;
}

// Without a field: light of one direction, `toward` it, and of all. Narrow lobes multiply the weight at every scattering, so their
// share falls with depth.
path_guide guide_towards(vec3 toward, uint depth, vec3 way, float g)
{
    float beams = 0.4 * exp2(-0.2 * float(depth)) + 0.05;
    return guide_of(vec4(1.0 - beams, 0.0, 0.0, 0.0), beams * vec4(1.0, -toward), way, g);
}

// The guess, of a fluence of 1; 1/sr.
float guide_radiance(const path_guide guide, vec3 d)
{
    return guide.scattered.share * guide_scattered(guide, d) + guide.beams.share * guide_beams(guide, d);
}

// About the pdf of the directions that guide_direction takes, for heuristics; `forward`: the phase function.
float guide_pdf(const path_guide guide, vec3 d, float forward)
{
    return forward * guide_radiance(guide, d) / guide.expected;
}

// Takes one thing of a stream by its weight: Chao's reservoir, whose random number is stretched again after each use.
bool guide_takes(float weight, inout float total, inout float u)
{
    total += weight;
    float share = weight / max(total, 1e-37);
    bool takes = u < share;
    u = takes ? u / max(share, 1e-12) : (u - share) / max(1.0 - share, 1e-12);
    return takes;
}

// The next direction. `weight`: the phase function `p` over its pdf.
vec3 guide_direction(const path_guide guide, const phase p, vec3 way, inout rng_state rng, out float weight)
{
    vec3 taken = way;
    float total = 0.0, there = 0.0, u = rng_float(rng_next(rng).x);
    [[unroll]] for (uint i = 0u; i < GUIDE_CANDIDATES + 2u; i++) {
        uvec4 bits = rng_next(rng);
        phase from = p;
        vec3 about = way;
        float count = 1.0;
        if (i == GUIDE_CANDIDATES) {
            from = phase_of_mean_cosine(guide.scattered.mean_cosine);
            about = guide.scattered.axis;
            count = guide.scattered.candidates;
        } else if (i > GUIDE_CANDIDATES) {
            from = phase_of_mean_cosine((bits.z & 256u) == 0u ? guide.beams.mean_cosine : guide.spread);
            about = guide.beams.axis;
            count = guide.beams.candidates;
        }
        vec3 d = phase_direction(from, about, rng_vec2(bits.xy));
        float forward = phase_near(p, 1.0, one_minus_cosine(way, d));
        float scattered = guide_scattered(guide, d), beams = guide_beams(guide, d);
        float guess = guide.scattered.share * scattered + guide.beams.share * beams;
        float drawn = float(GUIDE_CANDIDATES) * forward + guide.scattered.candidates * scattered +
                      guide.beams.candidates * beams;
        if (guide_takes(count * forward * guess / max(drawn, 1e-37), total, u)) {
            taken = d;
            there = guess;
        }
    }
    weight = total / max(there, 1e-37);
    return taken;
}

#endif
