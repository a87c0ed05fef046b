// lattice_lamps.comp -- unscattered light in a cell: that of suns and sky, and of local lights after scaling.
#include "shaders/lattice/lattice_args.h"
#include "shaders/common/quotient.glsl"
#include "shaders/lattice/lattice_sweep.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
TYN_ARGS(lattice_lamps_args args);
TYN_READ(0, power, lattice_lamp_power power[]);
layout(binding = 1) uniform sampler3D lit;
layout(binding = 2) uniform sampler3D others;
layout(binding = 3) uniform sampler3D cells;
layout(binding = 4, rgba32f) uniform writeonly image3D source;
layout(binding = 5, rgba32f) uniform writeonly image3D vpl_light;

layout(constant_id = 0) const uint vpls = 0; // 1: the last group are VPLs

void main()
{
    ivec3 texel = ivec3(gl_GlobalInvocationID), dims = ivec3(args.dims);
    int ch = quotient(texel.z, dims.z);
    if (any(greaterThanEqual(texel.xy, dims.xy)) || ch >= int(args.channels)) {
        return;
    }
    vec4 sum = lattice_fetch_source(others, cells, texel);
    for (int group = 0; group < int(args.num_groups); group++) {
        ivec3 at = texel + ivec3(0, 0, group * int(args.channels) * dims.z);
        vec4 light = power[group * int(args.channels) + ch].scale * texelFetch(lit, at, 0);
        sum += light;
        if (vpls == 1 && group + 1 == int(args.num_groups)) {
            imageStore(vpl_light, texel, light);
        }
    }
    imageStore(source, texel, sum);
}
