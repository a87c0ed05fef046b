// lattice_keep.comp -- puts a solution away for the next frame.
#include "shaders/lattice/lattice_args.h"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
TYN_ARGS(lattice_recall_args args);
layout(binding = 0) uniform sampler3D moments_tex;
TYN_READ(1, power, float power[3]);
TYN_WRITE(2, memory, lattice_memory_block memory; vec4 moments[]);

void main()
{
    uvec3 texel = gl_GlobalInvocationID; // channels stacked along z
    if (any(greaterThanEqual(texel, uvec3(args.dims.xy, args.dims.z * args.channels)))) {
        return;
    }
    uint i = (texel.z * args.dims.y + texel.y) * args.dims.x + texel.x;
    moments[i] = texelFetch(moments_tex, ivec3(texel), 0);
    if (i == 0) {
        memory = lattice_memory_block(args.world, args.extent, args.dims, args.channels, args.tint,
                                      vec3(power[0], power[1], power[2]));
    }
}
