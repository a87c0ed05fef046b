// hg_eval.comp -- the pieces of hg.glsl and phase.glsl at given (g, 1 - mu, u).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/phase/phase.glsl"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint unused = 0u;
layout(set = 0, binding = 0, scalar) readonly buffer points_buffer { vec4 points[]; };
struct result {
    float phase, sample_one_minus_mu;
    vec3 similar_sigma_s, similar_g, fraction, cosine;
};
layout(set = 0, binding = 1, scalar) writeonly buffer results_buffer { result results[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= points.length()) {
        return;
    }
    float g = points[i].x, one_minus_mu = points[i].y, u = points[i].z;
    result r;
    r.phase = phase_near(phase_of_mean_cosine(g), 1.0, one_minus_mu);
    r.sample_one_minus_mu = phase_sample(phase_of_mean_cosine(g), u);
    r.similar_sigma_s = vec3(2.0);
    phase channels[3] = phase_of_mean_cosine(vec3(g, -g, 0.0));
    r.fraction = delta_fraction(channels);
    r.cosine = delta_cosine(channels);
    similarity_clamp(r.similar_sigma_s, channels);
    r.similar_g = phase_mean_cosine(channels);
    results[i] = r;
}
