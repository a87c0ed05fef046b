// scatter_lut_tms.comp -- sums the series of four depths of one row and cone for all angles.
#include "shaders/phase/scatter_lut_map.glsl"
#include "shaders/common/counters.h"

const uint THREADS = TYN_TMS_ANGLES / 4, CHUNK = 2u * THREADS;
layout(local_size_x = TYN_TMS_ANGLES / 4) in; // x: four angles, y: four depths, z: cone of a row
TYN_READ(0, lut_block, lut_block lut);
TYN_READ(1, moments, vec2 moments[]); // outside and inside the lobe
TYN_READ(2, cones, float cones[]); // c_l, TYN_TMS_MAX_TERMS per cone
layout(set = 0, binding = 3, r32f) writeonly uniform image3D tms_image;
TYN_UPDATE(4, counters, counters_block counters);

const float PI = 3.14159265358979;

shared vec4 chunk[CHUNK]; // per term: its coefficient at the four depths

void main()
{
    uint thread = gl_LocalInvocationID.x, depth = 4u * gl_WorkGroupID.y;
    uint row = gl_WorkGroupID.z / TYN_TMS_CONES, cone = gl_WorkGroupID.z % TYN_TMS_CONES;
    float f = lut.theta_1[row] > 0.0 ? delta_fraction(lut.phase[row]) : 0.0;
    vec4 tau;
    for (uint i = 0u; i < 4u; i++) {
        tau[i] = tms_depth(depth + i, f);
    }
    // P_l by its differences in y = 1 - x: exact near y = 0, see scatter_lut_sum.comp.
    vec4 y = vec4(tms_away(thread), tms_away(thread + THREADS), tms_away(thread + 2u * THREADS),
                  tms_away(thread + 3u * THREADS));
    vec4 p = vec4(1.0), d = vec4(0.0);
    mat4 sums = mat4(0.0); // [depth][angle]
    uint terms = lut.tms_terms[row];
    for (uint start = 0u; start < terms; start += CHUNK) {
        barrier();
        for (uint i = thread; i < CHUNK; i += THREADS) {
            uint l = start + i;
            chunk[i] = vec4(0.0);
            if (l < terms) {
                vec2 moment = moments[lut.first_term[row] + l];
                float scale = float(2u * l + 1u) / (4.0 * PI * (1.0 - f));
                chunk[i] = scale * cones[cone * TYN_TMS_MAX_TERMS + l] * moment.x *
                           exp(tau * (moment.y - f));
            }
        }
        barrier();
        uint count = min(terms - start, CHUNK);
        for (uint i = 0u; i < count; i++) {
            vec4 term = chunk[i];
            for (uint k = 0u; k < 4u; k++) {
                sums[k] += term[k] * p;
            }
            float r = 1.0 / float(start + i + 1u);
            d = (1.0 - r) * d - (2.0 - r) * y * p;
            p += d;
        }
    }
    float below = 0.0, above = 0.0;
    uint clamped = 0u;
    for (uint k = 0u; k < 4u; k++) {
        for (uint a = 0u; a < 4u; a++) {
            float solid_angle = tms_away(thread + a * THREADS + 1u) - tms_away(thread + a * THREADS);
            below += solid_angle * max(-sums[k][a], 0.0);
            above += solid_angle * max(sums[k][a], 0.0);
            clamped += sums[k][a] < 0.0 ? 1u : 0u;
            // An average of a phase function: below 0 only by rounding.
            imageStore(tms_image, ivec3(depth + k, thread + a * THREADS, gl_WorkGroupID.z),
                       vec4(max(sums[k][a], 0.0)));
        }
    }
    TYN_LIGHT_CLAMP_ADD(counters.clamp_0, below, above)
    if (clamped > 0u) {
        atomicAdd(counters.clamped, clamped);
    }
}
