// sky_eval.comp -- texels of the sky's levels, fetched as passes fetch them.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint unused = 0u;
layout(set = 0, binding = 0) uniform sampler2D sky;
layout(set = 0, binding = 1, scalar) readonly buffer points_buffer { uvec4 points[]; }; // x, y, level
layout(set = 0, binding = 2, scalar) writeonly buffer results_buffer { vec4 results[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= points.length()) {
        return;
    }
    results[i] = texelFetch(sky, ivec2(points[i].xy), int(points[i].z));
}
