// shdom_moments.comp -- fluence and flux of a channel's scattered light, for probes.
//
// Unscattered light is what the sources of the lattice count as that, with f = g^2: more of it than the solver has.
#include "shdom_args.h"
#include "shaders/lattice/lattice_sweep.glsl"

layout(local_size_x = 64) in;
TYN_ARGS(shdom_args args);
layout(binding = 0) uniform sampler3D cells;
layout(binding = 1) uniform sampler3D source;
layout(binding = 2) uniform samplerBuffer unscattered_words;
layout(binding = 3) uniform samplerBuffer radiance_words;
layout(binding = 4, rgba32f) uniform writeonly image3D moments;
layout(constant_id = 0) const uint lit = 1; // is there unscattered light?

void main()
{
    int i = int(gl_GlobalInvocationID.x), all = int(args.dims.x * args.dims.y * args.dims.z);
    if (i >= all) {
        return;
    }
    ivec3 dims = ivec3(args.dims);
    ivec3 texel = ivec3(i % dims.x, i / dims.x % dims.y, i / (dims.x * dims.y) + int(args.ch) * dims.z);
    vec4 c;
    for (int k = 0; k < 4; k++) {
        c[k] = args.bands > 1u || k == 0 ? texelFetch(radiance_words, k * all + i).x : 0.0;
        if (lit != 0u) {
            c[k] += args.bands > 1u || k == 0 ? texelFetch(unscattered_words, k * all + i).x : 0.0;
        }
    }
    vec4 total = vec4(3.54490770, vec3(2.04665342)) * c.xwyz; // sqrt(4 pi), sqrt(4 pi / 3)
    imageStore(moments, texel, total - lattice_fetch_source(source, cells, texel));
}
