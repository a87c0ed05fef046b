// beam_sweep.glsl -- one column of a beam's grid: the running mean of the medium along a ray.
//
// The includer defines BEAM_VALUE (float or a matrix), beam_value(vec3 p) = the medium at p with
// positions outside the box moved to its edge, and beam_store(ivec3 texel, BEAM_VALUE mean).
#ifndef TYN_BEAM_SWEEP_GLSL
#define TYN_BEAM_SWEEP_GLSL

void beam_sweep(beam_block beam, uvec2 column)
{
    vec3 start = beam.origin + float(column.x) * beam.step_u + float(column.y) * beam.step_v;
    // Distances are counted from slice 0. Beside and behind the box the ray goes on in its edge values,
    // so that the mean continues smoothly to the nodes that points near a face are interpolated from.
    vec3 inside = start * beam.clip_scale + beam.clip_offset;
    float enter = max(-min(min(inside.x, inside.y), inside.z), 0.0);
    BEAM_VALUE mean = beam_value(start + enter * beam.direction);
    float step_length = length(beam.step_w);

    ivec3 texel = ivec3(column, beam.first_slice);
    beam_store(texel, mean);
    for (uint slice = 1u; slice < beam.nodes.z; slice++) {
        float from = max(float(slice - 1u) * step_length, enter), to = float(slice) * step_length;
        if (to > from) {
            // Midpoints half a voxel apart at most: exact where the interpolant is linear in between.
            BEAM_VALUE sum = BEAM_VALUE(0.0);
            float spacing = (to - from) / float(beam.samples);
            for (uint i = 0u; i < beam.samples; i++) {
                sum += beam_value(start + (from + (float(i) + 0.5) * spacing) * beam.direction);
            }
            mean += (sum / float(beam.samples) - mean) * ((to - from) / (to - enter));
        }
        texel.z++;
        beam_store(texel, mean);
    }
}

#endif
