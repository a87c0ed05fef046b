// beam_sweep.glsl -- one column of a beam's grid: the running mean of the medium along a ray.
//
// The includer defines BEAM_VALUE (float or a matrix), beam_value(vec3 p) = the medium at p with
// positions outside the box moved to its edge, beam_any(BEAM_VALUE) = is there anything, and
// beam_store(ivec3 texel, BEAM_VALUE mean).
#ifndef TYN_BEAM_SWEEP_GLSL
#define TYN_BEAM_SWEEP_GLSL

// Returns whether the ray has met anything beside the box before it enters.
bool beam_sweep(beam_block beam, uvec2 column)
{
    vec3 start = beam.origin + float(column.x) * beam.step_u + float(column.y) * beam.step_v;
    vec3 inside = start * beam.clip_scale + beam.clip_offset;
    float enter = -min(min(inside.x, inside.y), inside.z);
    bool edges = false;

    float spacing = length(beam.step_w) / float(beam.samples);
    BEAM_VALUE mean = beam_value(start);
    ivec3 texel = ivec3(column, beam.first_slice);
    beam_store(texel, mean);
    for (uint slice = 0u; slice < beam.nodes.z - 1u; slice++) {
        // Midpoints half a voxel apart at most: exact where the interpolant is linear in between.
        BEAM_VALUE sum = BEAM_VALUE(0.0);
        for (uint i = 0u; i < beam.samples; i++) {
            float s = (float(slice * beam.samples + i) + 0.5) * spacing;
            BEAM_VALUE value = beam_value(start + s * beam.direction);
            edges = edges || (s < enter && beam_any(value));
            sum += value;
        }
        mean += (sum / float(beam.samples) - mean) / float(slice + 1u);
        texel.z++;
        beam_store(texel, mean);
    }
    return edges;
}

#endif
