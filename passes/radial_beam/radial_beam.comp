// radial_beam.comp -- the mean of the medium around local lights; a thread per direction. Built twice
// (medium_value.glsl).
#define MEDIUM_AT 0
#include "shaders/medium/medium.glsl"
#include "shaders/medium/medium_value.glsl"
#include "shaders/common/octahedral.glsl"
#include "shaders/beams/radial_args.h"
#include "shaders/common/counters.h"
#include "radial_beam_args.h"

layout(local_size_x = RADIAL_GROUP * RADIAL_GROUP) in;
TYN_ARGS(radial_beam_args args);
TYN_READ(5, grids, uint radial_count; uint radial_num_lamps; uvec2 radial_pad; radial_grid radials[]);
TYN_UPDATE(6, counters, counters_block counters);

uint non_finite = 0u; // of the thread

#ifdef TYN_DENSITY
layout(set = 0, binding = 7, r32f) writeonly uniform image3D radial_column_image;

void radial_store(ivec3 texel, float value)
{
    const bool broken = isnan(value) || isinf(value);
    non_finite += uint(broken);
    imageStore(radial_column_image, texel, vec4(broken ? 0.0 : value));
}
#else
layout(set = 0, binding = 7, rgba32f) writeonly uniform image3D radial_column_image;
layout(set = 0, binding = 8, rgba32f) writeonly uniform image3D radial_tau_a_image;
layout(set = 0, binding = 9, rgba32f) writeonly uniform image3D radial_tau_p_image;

vec4 finite(vec3 v)
{
    const bvec3 broken = bvec3(uvec3(isnan(v)) | uvec3(isinf(v)));
    non_finite += uint(any(broken));
    return vec4(mix(v, vec3(0.0), broken), 0.0);
}

void radial_store(ivec3 texel, mat3 value)
{
    imageStore(radial_column_image, texel, finite(value[0]));
    imageStore(radial_tau_a_image, texel, finite(value[1]));
    imageStore(radial_tau_p_image, texel, finite(value[2]));
}
#endif

// One direction of a light's grid: means of the medium along a ray.
void radial_sweep(uint n, ivec2 texel)
{
    int cells = int(radials[n].cells);
    uint shells = radials[n].shells;
    vec3 m = octahedral_point(octahedral_texel(octahedral_fold(texel - 1, cells), cells));
    // The inverse of rows that are orthogonal: each over its squared length.
    vec3 r0 = radials[n].to_map[0], r1 = radials[n].to_map[1], r2 = radials[n].to_map[2];
    vec3 d = normalize(r0 * (m.x / dot(r0, r0)) + r1 * (m.y / dot(r1, r1)) + r2 * (m.z / dot(r2, r2)));
    vec3 origin = radials[n].light.position;
    ivec3 at = ivec3(radials[n].first) + ivec3(texel, 0);

    vec3 inverse = 1.0 / mix(d, vec3(1e-20), lessThan(abs(d), vec3(1e-20)));
    vec3 t0 = -origin * inverse, t1 = (medium.extent - origin) * inverse;
    vec3 lo = min(t0, t1), hi = max(t0, t1);
    float enter = max(max(max(lo.x, lo.y), lo.z), 0.0), leave = min(min(hi.x, hi.y), hi.z);
    bool outside = radials[n].inside == 0u;
    // So far beside the box a ray may still be mixed with rays in it, per distance from the light.
    float spread = 6.0 / float(cells);
    if (outside && enter >= leave) {
        float margin = spread * length(0.5 * medium.extent - origin);
        vec3 near_lo = min(t0 - margin * inverse, t1 + margin * inverse);
        vec3 near_hi = max(t0 - margin * inverse, t1 + margin * inverse);
        enter = max(max(max(near_lo.x, near_lo.y), near_lo.z), 0.0);
        leave = min(min(near_hi.x, near_hi.y), near_hi.z);
    }
    if (outside && enter >= leave) {
        // Beside the box: what its neighbours mix with their own.
        float closest = clamp(dot(0.5 * medium.extent - origin, d), 0.0, 1e20);
        MEDIUM_VALUE value = medium_value((origin + closest * d) / medium.extent);
        for (uint k = 0u; k <= shells; k++) {
            radial_store(at + ivec3(0, 0, int(k)), value);
        }
        return;
    }
    enter = outside ? enter : 0.0;
    float near = 1.0 / radials[n].inverse_near, begin = radials[n].begin;
    float voxel = min(min(medium.voxel.x, medium.voxel.y), medium.voxel.z);
    MEDIUM_VALUE sum = MEDIUM_VALUE(0.0), mean = medium_value((origin + enter * d) / medium.extent);
    float done = enter, growth = exp(radials[n].per_shell), power = 1.0;
    for (uint k = 0u; k <= shells; k++) {
        float r = begin + near * (power - 1.0);
        power *= growth;
        // Beyond the box the medium goes on as at its face, as far as it is mixed with what is inside.
        vec3 p = origin + done * d;
        float beside = length(max(max(-p, p - medium.extent), vec3(0.0)));
        if (r > done && (done < leave || beside <= spread * done)) {
            uint samples = uint(clamp(ceil((r - done) / voxel - 0.01), 1.0, 4096.0));
            float ds = (r - done) / float(samples);
            MEDIUM_VALUE part = MEDIUM_VALUE(0.0);
            for (uint i = 0u; i < samples; i++) {
                part += medium_value((origin + (done + (float(i) + 0.5) * ds) * d) / medium.extent);
            }
            sum += ds * part;
            done = r;
            mean = sum / (done - enter);
        }
        radial_store(at + ivec3(0, 0, int(k)), mean);
    }
}

// Light and texel of a thread of the dispatch: workgroups go through the classes one by one.
bool radial_thread(out uint n, out ivec2 texel)
{
    uint group = gl_WorkGroupID.x, c = 0u, per_light = 0u;
    for (; c < RADIAL_CLASSES; c++) {
        per_light = args.classes[c].patches * args.classes[c].patches;
        uint groups = per_light * args.classes[c].count;
        if (group < groups) {
            break;
        }
        group -= groups;
    }
    if (c == RADIAL_CLASSES) {
        return false;
    }
    radial_class own = args.classes[c];
    n = own.first_light + group / per_light;
    uint patch_index = group % per_light, i = gl_LocalInvocationIndex;
    texel = ivec2(RADIAL_GROUP * uvec2(patch_index % own.patches, patch_index / own.patches) +
                  uvec2(i % RADIAL_GROUP, i / RADIAL_GROUP));
    return n < radial_count && all(lessThan(texel, ivec2(own.cells + 2u)));
}

void main()
{
    uint n;
    ivec2 texel;
    if (radial_thread(n, texel)) {
        radial_sweep(n, texel);
    }
    if (non_finite > 0u) {
        atomicAdd(counters.non_finite, non_finite);
    }
}
