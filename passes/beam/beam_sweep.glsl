// beam_sweep.glsl -- one column of a beam's grid: the medium integrated along a ray.
//
// The includer defines BEAM_VALUE (float or a matrix), beam_value(vec3 uvw) = the medium at a texture
// coordinate, clamped to the edge, beam_any(BEAM_VALUE) = is there anything, and
// beam_store(ivec3 texel, BEAM_VALUE).
#ifndef TYN_BEAM_SWEEP_GLSL
#define TYN_BEAM_SWEEP_GLSL

// Slices of a column from which points in the box can be interpolated: those between the first entry
// and the last exit of the rays up to one column away. The others are never read.
uvec2 beam_span(beam_block beam, vec3 start, float spacing)
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
bool beam_sweep(beam_block beam, uvec2 column)
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

#endif
