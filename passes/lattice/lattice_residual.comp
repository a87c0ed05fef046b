// lattice_residual.comp -- what a sweep and its correction give, and how to mix it with the results of earlier sweeps: Anderson
// mixing, by the shares g_i that minimise |r + sum g_i d_i|. After the last sweep also how far it is from settled.
//
// The change r = result - start of up to three sweeps is kept; with d_i = r_i - r the products are
// d1.d1, d2.d2, d1.d2, d1.r, d2.r, where flux counts three times (then the norm is that of the
// radiance whose first moments these are); of the last sweep also r.r and that of the result itself. A first sweep's r
// is the whole solution: what the diffusion correction added stands for it. Each thread adds its cells in order, each workgroup its
// threads pairwise; the workgroup that comes last adds their sums and finds the shares.
//
// The last half relaxation of the correction is done here, where it is read: nothing else needs it. Among walls corrections are
// read more than once; there it has been done.
#include "shaders/lattice/lattice_args.h"
#include "shaders/common/counters.h"
#include "shaders/common/quotient.glsl"
#include "lattice_levels.glsl"
#define LATTICE_STENCIL_LO 9
#define LATTICE_STENCIL_HI 10
#include "lattice_stencil_texels.glsl"

layout(local_size_x = LATTICE_GROUP) in;
TYN_ARGS(lattice_args args);
layout(binding = 0) uniform samplerBuffer state_texels;
layout(binding = 1) uniform samplerBuffer swept_texels;
layout(binding = 2) uniform samplerBuffer correction_words; // floats
layout(binding = 3) uniform samplerBuffer change_1_texels;
layout(binding = 4) uniform samplerBuffer change_2_texels;
TYN_WRITE(5, result_0, vec4 result[]);
TYN_WRITE(6, change_0, vec4 change[]);
layout(binding = 7, scalar) coherent buffer partials_buffer
{
    float partials[]; // [channel][workgroup][dot]
};

#define LATTICE_WALL_CELLS 8
#include "lattice_wall_state.glsl"
layout(constant_id = 0) const uint walls = 0;
layout(constant_id = 1) const uint last = 0; // 1: of the last sweep, with the two norms
layout(constant_id = 3) const uint relax_late = 0; // 1: colour 1 of the correction is still to be relaxed
layout(binding = 11) uniform samplerBuffer rhs_words;
TYN_UPDATE(12, weights, vec2 weights[LATTICE_MAX_CHANNELS]; uint num_done); // workgroups
TYN_UPDATE(13, counters, counters_block counters);
const uint num_dots = last == 1 ? LATTICE_NUM_DOTS : LATTICE_MIX_DOTS;

shared float sums[LATTICE_NUM_DOTS][LATTICE_GROUP];
shared float norms[LATTICE_MAX_CHANNELS][LATTICE_GROUP]; // of the solution
shared bool is_last;

float correction_at(uint i)
{
    return texelFetch(correction_words, int(i)).x;
}

#define LATTICE_REPEAT 2
#include "lattice_inflow.glsl"

float corrected(uint ch, uint cell)
{
    uint i = ch * args.stride + cell;
    float e = correction_at(i);
    if (relax_late == 1) {
        ivec3 c = quotient_place(cell, ivec3(args.dims));
        if ((c.x + c.y + c.z & 1) == 1) {
            lattice_stencil k = lattice_stencil_at(i);
            e = lattice_inflow(texelFetch(rhs_words, int(i)).x, lattice_level(ivec3(args.dims), 0), c, i, k) / k.diagonal;
        }
    }
    return e;
}

float norm_dot(vec4 a, vec4 b)
{
    return a.x * b.x + 3.0 * dot(a.yzw, b.yzw);
}

// Radiance counts as the fluence it would give.
float norm_dot_walls(vec4 a, vec4 b)
{
    return 157.9137 * dot(a, b);
}

// The correction e of the fluence means e / 2 = (1 + albedo) J + pi change for the flux J it has towards
// a wall, of which the wall sends back its share.
vec4 corrected_walls(uint quad, uint ch, vec4 radiance, vec4 change)
{
    for (uint k = 0u; k < 4u; k++) {
        uint cell = 4u * quad + k;
        vec4 surface = lattice_wall_surface(min(cell, lattice_all_cells() - 1u));
        if (cell < lattice_all_cells() && surface.a > 0.0) {
            float albedo = surface[ch];
            float e = corrected(ch, cell);
            radiance[k] += albedo * (e * 0.15915494 - change[k]) / (1.0 + albedo);
        }
    }
    return radiance;
}

// What is still to come, as a share of the solution in the brightest channel. Sweeps bring less and less, here by the factor
// of the last two: after what mixing leaves of the last change come its rate, rate^2, ... Of one sweep no rate is known: half
// of what the diffusion correction had to add (of 13 scenes it is 0.02 to 0.95 of that, by two thirds 0.1 to 0.6).
float unsettled(vec2 g, float p, float q)
{
    float last_change = sums[5][0], factor = 0.5, left = last_change;
    float all = max(norms[0][0], max(norms[1][0], norms[2][0]));
    if (args.history >= 1) {
        left -= g.x * p + g.y * q; // |r + sum g_i d_i|^2 at its least
        float rate = sqrt(last_change / max(sums[0][0] + 2.0 * sums[3][0] + last_change, 1e-37));
        factor = min(rate, 0.9) / (1.0 - min(rate, 0.9));
    }
    return left > 0.0 && all > 0.0 ? factor * sqrt(left / all) : 0.0;
}

// A Gram determinant below this share of the product of its diagonal is rounding: d1, d2 are
// parallel.
const float PARALLEL = 1e-5;

void weigh(uint ch)
{
    uint me = gl_LocalInvocationIndex, groups = gl_NumWorkGroups.x;
    barrier();
    for (uint k = 0; k < num_dots; k++) {
        float sum = 0.0;
        for (uint i = me; i < groups; i += LATTICE_GROUP) {
            sum += partials[(ch * groups + i) * LATTICE_NUM_DOTS + k];
        }
        sums[k][me] = sum;
    }
    for (uint c = 0; c < LATTICE_MAX_CHANNELS && last == 1; c++) {
        float sum = 0.0;
        for (uint i = me; c < args.channels && i < groups; i += LATTICE_GROUP) {
            sum += partials[(c * groups + i) * LATTICE_NUM_DOTS + 6];
        }
        norms[c][me] = sum;
    }
    for (uint half_n = LATTICE_GROUP / 2; half_n > 0; half_n /= 2) {
        barrier();
        if (me < half_n) {
            for (uint k = 0; k < num_dots; k++) {
                sums[k][me] += sums[k][me + half_n];
            }
            for (uint c = 0; c < LATTICE_MAX_CHANNELS && last == 1; c++) {
                norms[c][me] += norms[c][me + half_n];
            }
        }
    }
    barrier();
    if (me == 0) {
        float a = sums[0][0] * (1.0 + 1e-6), b = sums[1][0] * (1.0 + 1e-6), c = sums[2][0];
        float p = -sums[3][0], q = -sums[4][0];
        // Scaled by the diagonal, so that nothing under- or overflows.
        float cosine = a > 0.0 && b > 0.0 ? c / (sqrt(a) * sqrt(b)) : 1.0;
        float det = 1.0 - cosine * cosine;
        vec2 g = vec2(0.0);
        if (args.history >= 2 && det > PARALLEL) {
            float x = p / sqrt(a), y = q / sqrt(b);
            g = vec2((x - cosine * y) / sqrt(a), (y - cosine * x) / sqrt(b)) / det;
        } else if (args.history >= 1 && a > 0.0) {
            g = vec2(p / a, 0.0);
        }
        g = args.anderson == 0 || any(isnan(g)) || any(isinf(g)) ? vec2(0.0) : g;
        weights[ch] = g;
        if (last == 1) {
            counters.unsettled[ch] = unsettled(g, p, q);
        }
    }
}

void main()
{
    uint me = gl_LocalInvocationIndex, ch = gl_GlobalInvocationID.y;
    uint cells = args.dims.x * args.dims.y * args.dims.z;
    uint begin = gl_WorkGroupID.x * LATTICE_GROUP_CELLS;
    uint end = min(begin + LATTICE_GROUP_CELLS, args.elements);
    float dots[LATTICE_NUM_DOTS] = float[](0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    for (uint c = begin + me; c < end; c += LATTICE_GROUP) {
        bool wall = walls == 1 && c >= cells;
        uint i = wall ? args.channels * cells + ch * (args.elements - cells) + c - cells : ch * cells + c;
        const vec4 plain = texelFetch(swept_texels, int(i));
        vec4 m = plain;
        vec4 old = texelFetch(state_texels, int(i));
        if (!wall) {
            m.x += corrected(ch, c);
        }
        if (wall && args.corrected == 1) {
            m = corrected_walls(c - cells, ch, m, m - old);
        }
        vec4 r = m - old;
        result[i] = m;
        change[i] = r;
        if (last == 1) {
            const vec4 left = args.history == 0 && args.corrected == 1 ? m - plain : r;
            dots[5] += wall ? norm_dot_walls(left, left) : norm_dot(left, left);
            dots[6] += wall ? norm_dot_walls(m, m) : norm_dot(m, m);
        }
        if (args.history >= 1) {
            vec4 d1 = texelFetch(change_1_texels, int(i)) - r;
            vec4 d2 = args.history >= 2 ? texelFetch(change_2_texels, int(i)) - r : vec4(0.0);
            dots[0] += wall ? norm_dot_walls(d1, d1) : norm_dot(d1, d1);
            dots[3] += wall ? norm_dot_walls(d1, r) : norm_dot(d1, r);
            dots[1] += wall ? norm_dot_walls(d2, d2) : norm_dot(d2, d2);
            dots[2] += wall ? norm_dot_walls(d1, d2) : norm_dot(d1, d2);
            dots[4] += wall ? norm_dot_walls(d2, r) : norm_dot(d2, r);
        }
    }
    for (uint k = 0; k < num_dots; k++) {
        sums[k][me] = dots[k];
    }
    for (uint half_n = LATTICE_GROUP / 2; half_n > 0; half_n /= 2) {
        barrier();
        if (me < half_n) {
            for (uint k = 0; k < num_dots; k++) {
                sums[k][me] += sums[k][me + half_n];
            }
        }
    }
    barrier();
    if (me < num_dots) {
        partials[(ch * gl_NumWorkGroups.x + gl_WorkGroupID.x) * LATTICE_NUM_DOTS + me] = sums[me][0];
    }
    memoryBarrierBuffer();
    barrier();
    if (me == 0) {
        is_last = atomicAdd(num_done, 1u) + 1u == gl_NumWorkGroups.x * gl_NumWorkGroups.y;
    }
    barrier();
    memoryBarrierBuffer();
    if (is_last) {
        for (uint c = 0; c < args.channels; c++) {
            weigh(c);
        }
        num_done = 0u; // of the next sweep
    }
}
