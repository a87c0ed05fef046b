// lpv_links.glsl -- the 26 links of light propagation volumes, and what a cell sends along them. No bindings.
//
// Billeter et al. 2012, Eq 3, with the numbers of lpv_args.h: along link j goes
//   (1 - b) gamma_j [(1 - lambda) (P + 3 m_j.F) + lambda_s (P + 3 g' m_j.F)]
// of the power in a cell; g' (beyond the paper, where it is 0) is the mean cosine that delta scaling leaves. So a cell
// needs to write only (P, F) weighted with these factors, once for each length of links.
#include "lpv_args.h"
#include "shaders/lattice/lattice_sweep.glsl"
#include "shaders/walls/walls_links.glsl"

const vec3 LPV_GAMMA = vec3(LPV_GAMMA_FACE, LPV_GAMMA_CORNER, LPV_GAMMA_EDGE);
const vec3 LPV_COSINE = vec3(LPV_COSINE_FACE, LPV_COSINE_CORNER, LPV_COSINE_EDGE);
const vec3 LPV_COUNT = vec3(6.0, 8.0, 12.0);
const vec3 LPV_LENGTH = vec3(1.0, 1.73205081, 1.41421356); // edges of a cell

uint lpv_shell(uint link)
{
    return link < 6u ? 0u : link < 14u ? 1u : 2u;
}

// What a cell does to light that starts in it: `keep` is the share that arrives along a link of each shell, `scatter` that
// scattered on the way, along all links together.
struct lpv_medium {
    vec3 keep;
    float scatter;
    float way;     // of the light in the cell and its half links, on average, m: fluence = way P / volume
    float forward; // the same of what goes on, for the net flux
    bool bounded;  // sigma_t d > 1, which Eq 3 cannot do
};

// (1 - e^-x) / x
float lpv_mean(float x)
{
    return x < 0.01 ? 1.0 - 0.5 * x : (1.0 - exp(-x)) / x;
}

// `cell`: sigma_s', sigma_a (1/m), g', emission, of lattice_cells.
lpv_medium lpv_medium_of(vec4 cell, float dx, uint extinction)
{
    float sigma_t = cell.x + cell.y, albedo = sigma_t > 0.0 ? cell.x / sigma_t : 0.0;
    vec3 share = LPV_COUNT * LPV_GAMMA;
    lpv_medium m;
    if (extinction == LPV_EXTINCTION_PAPER) {
        float lambda = sigma_t * LPV_DISTANCE * dx;
        m.bounded = lambda > 1.0;
        lambda = min(lambda, 1.0);
        m.keep = vec3(1.0 - lambda);
        m.scatter = albedo * lambda;
        m.way = m.bounded ? 1.0 / sigma_t : LPV_DISTANCE * dx;
        m.forward = m.way * dot(share, LPV_COSINE * LPV_LENGTH) / dot(share, LPV_LENGTH);
    } else {
        vec3 tau = sigma_t * dx * LPV_LENGTH, way = dx * LPV_LENGTH;
        m.bounded = false;
        m.keep = exp(-tau);
        way *= vec3(lpv_mean(tau.x), lpv_mean(tau.y), lpv_mean(tau.z));
        m.way = dot(share, way);
        m.scatter = cell.x * m.way; // albedo (1 - keep) on average, without its cancellation
        m.forward = dot(share, LPV_COSINE * way);
    }
    return m;
}

// (P, F) of a cell -> what goes along links of a shell: gamma (x + 3 m.yzw).
vec4 lpv_sent(vec4 light, const lpv_medium m, float g, uint shell)
{
    return light * vec2(m.keep[shell] + m.scatter, m.keep[shell] + m.scatter * g).xyyy;
}

// Power along a link, W.
float lpv_along(vec4 sent, uint link, vec3 step)
{
    uint shell = lpv_shell(link);
    return LPV_GAMMA[shell] * (sent.x + 3.0 * LPV_COSINE[shell] / LPV_LENGTH[shell] * dot(step, sent.yzw));
}

// What arrives there with it, by direction.
vec4 lpv_deposit(float power, uint link, vec3 step)
{
    uint shell = lpv_shell(link);
    return power * vec4(1.0, LPV_COSINE[shell] / LPV_LENGTH[shell] * step);
}
