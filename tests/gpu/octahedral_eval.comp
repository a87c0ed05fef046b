// octahedral_eval.comp -- the octahedral map at texels of a map of n x n.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/common/octahedral.glsl"

layout(local_size_x = 64) in;
struct point {
    int x, y, n; // texel, from -1 to n
};
struct result {
    vec3 direction; // of the texel, folded back into the map; on the octahedron
    vec2 back;      // octahedral coordinates of that
};
layout(set = 0, binding = 0, scalar) readonly buffer points_buffer { point points[]; };
layout(set = 0, binding = 1, scalar) writeonly buffer results_buffer { result results[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i < points.length()) {
        point q = points[i];
        vec3 d = octahedral_point(octahedral_texel(octahedral_fold(ivec2(q.x, q.y), q.n), q.n));
        results[i].direction = d;
        results[i].back = octahedral_of(d);
    }
}
