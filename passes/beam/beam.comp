// beam.comp -- the medium integrated along each sun; x, y: column, z: sun. Built twice (medium_value.glsl).
#define MEDIUM_AT 0
#include "shaders/medium/medium.glsl"
#include "shaders/medium/medium_value.glsl"
#include "shaders/beams/beam_args.h"
#include "shaders/common/counters.h"

layout(local_size_x = 8, local_size_y = 8) in;
TYN_UPDATE(5, beams, beam_block beams[]);
TYN_UPDATE(6, counters, counters_block counters);

uint non_finite = 0u; // of the thread

#ifdef TYN_DENSITY
layout(set = 0, binding = 7, r32f) writeonly uniform image3D column_image;

#define BEAM_VALUE float

float beam_value(vec3 uvw)
{
    return medium_value(uvw);
}

bool beam_any(float value)
{
    return value > 0.0;
}

void beam_store(ivec3 texel, float value)
{
    const bool broken = isnan(value) || isinf(value);
    non_finite += uint(broken);
    imageStore(column_image, texel, vec4(broken ? 0.0 : value));
}
#else
layout(set = 0, binding = 7, rgba32f) writeonly uniform image3D column_image;
layout(set = 0, binding = 8, rgba32f) writeonly uniform image3D tau_a_image;
layout(set = 0, binding = 9, rgba32f) writeonly uniform image3D tau_p_image;

#define BEAM_VALUE mat3x4 // w is the mean of the channels

vec4 with_mean(vec3 v)
{
    return vec4(v, (v.x + v.y + v.z) / 3.0);
}

mat3x4 beam_value(vec3 uvw)
{
    mat3 value = medium_value(uvw);
    return mat3x4(with_mean(value[0]), with_mean(value[1]), with_mean(value[2]));
}

vec4 finite(vec4 v)
{
    const bvec4 broken = bvec4(uvec4(isnan(v)) | uvec4(isinf(v)));
    non_finite += uint(any(broken));
    return mix(v, vec4(0.0), broken);
}

bool beam_any(mat3x4 value)
{
    return value[0].w + value[1].w > 0.0;
}

void beam_store(ivec3 texel, mat3x4 value)
{
    imageStore(column_image, texel, finite(value[0]));
    imageStore(tau_a_image, texel, finite(value[1]));
    imageStore(tau_p_image, texel, finite(value[2]));
}
#endif

// Slices of a column from which points in the box can be interpolated: those between the first entry
// and the last exit of the rays up to one column away. The others are never read.
uvec2 beam_span(const beam_block beam, vec3 start, float spacing)
{
    if (beam.even != 0u) {
        return uvec2(0u, beam.nodes.z - 1u);
    }
    vec3 scale = beam.clip_scale;
    vec3 inside = start * scale + beam.clip_offset;
    vec3 spread = abs(beam.step_u * scale) + abs(beam.step_v * scale);
    vec3 chord = mix(2.0 * beam.clip_offset, medium.extent * abs(scale), notEqual(scale, vec3(0.0)));
    vec3 first = inside + spread, last = chord - inside + spread;
    float enter = -min(min(first.x, first.y), first.z) / spacing;
    float leave = min(min(last.x, last.y), last.z) / spacing;
    float most = float(beam.nodes.z - 1u);
    return uvec2(clamp(vec2(floor(enter) - 1.0, ceil(leave) + 1.0), 0.0, most));
}

// Returns whether the ray has met anything beside the box before it enters.
bool beam_sweep(const beam_block beam, uvec2 column)
{
    vec3 start = beam.origin + float(column.x) * beam.step_u + float(column.y) * beam.step_v;
    vec3 inside = start * beam.clip_scale + beam.clip_offset;
    float enter = -min(min(inside.x, inside.y), inside.z);
    float step_length = length(beam.step_w);
    uvec2 span = beam_span(beam, start, step_length);
    vec3 uvw0 = start / medium.extent, per_slice = beam.step_w / medium.extent;
    vec3 periodic = vec3(medium.repeat);
    bool edges = false;

    // What lies before the span is left out of the integral: depths are differences along a column.
    BEAM_VALUE sum = BEAM_VALUE(0.0);
    ivec3 texel = ivec3(column, beam.first_slice + span.x);
    beam_store(texel, beam.even != 0u ? beam_value(uvw0) : sum);
    for (uint slice = span.x; slice < span.y; slice++) {
        BEAM_VALUE part = BEAM_VALUE(0.0);
        for (uint i = 0u; i < beam.samples; i++) {
            float s = float(slice) + (float(i) + 0.5) / float(beam.samples);
            vec3 uvw = uvw0 + s * per_slice;
            BEAM_VALUE value = beam_value(uvw - periodic * floor(uvw));
            edges = edges || (s * step_length < enter && beam_any(value));
            part += value;
        }
        sum += part / float(beam.samples);
        texel.z++;
        beam_store(texel, sum * (beam.even != 0u ? 1.0 / float(slice + 1u) : step_length));
    }
    return edges && beam.even == 0u;
}

void main()
{
    uvec2 column = gl_GlobalInvocationID.xy;
    uint sun = gl_WorkGroupID.z;
    if (all(lessThan(column, beams[sun].nodes.xy)) && beam_sweep(beams[sun], column)) {
        atomicOr(beams[sun].edges, 1u);
    }
    if (non_finite > 0u) {
        atomicAdd(counters.non_finite, non_finite);
    }
}
