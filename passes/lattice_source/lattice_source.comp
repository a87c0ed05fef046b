// lattice_source.comp -- the suns' unscattered light in a cell: sum of E T', and of E T' direction.
#include "shaders/common/scene_args.h"
#include "shaders/lattice/lattice_args.h"
#include "shaders/lattice/lattice_sweep.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
TYN_ARGS(lattice_source_args args);
TYN_READ(0, lights, light_block lights[]);
TYN_READ(1, power, lattice_power power[]);
layout(binding = 2) uniform sampler3D sunlit;
layout(binding = 3, rgba32f) uniform writeonly image3D source;

void main()
{
    ivec3 texel = ivec3(gl_GlobalInvocationID);
    ivec3 dims = ivec3(args.dims);
    int ch = texel.z / dims.z;
    if (any(greaterThanEqual(texel.xy, dims.xy)) || ch >= int(args.channels)) {
        return;
    }
    vec4 sum = vec4(0.0);
    for (uint sun = 0; sun < args.num_suns; sun++) {
        vec4 seen = texelFetch(sunlit, ivec3(texel.xy, texel.z % dims.z + int(sun) * dims.z), 0);
        float t = seen[ch] * seen.a;
        float e = lattice_channel(lights[sun].color, args.channels, uint(ch), args.tint);
        float scale = power[sun * args.channels + uint(ch)].scale;
        sum += e * scale * t * vec4(1.0, lights[sun].mean_cosine * lights[sun].direction);
    }
    imageStore(source, texel, sum);
}
