// shdom_next.comp -- the source function of a cell, per metre: what scatters of all light, and emission. y: coefficients.
#include "shdom_args.h"
#include "../common/delta_bands.glsl"
#include "shaders/common/counters.h"

layout(local_size_x = 64) in;
TYN_ARGS(shdom_args args);
layout(binding = 0) uniform sampler3D cells;
layout(binding = 1) uniform samplerBuffer unscattered_words; // [coefficient][cell]
layout(binding = 2) uniform samplerBuffer radiance_words;
TYN_WRITE(3, sent_0, float sent[]);
TYN_WRITE(4, extinction, float extinction[]);
TYN_UPDATE(5, counters, counters_block counters);
layout(constant_id = 0) const uint lit = 1;       // is there unscattered light?
layout(constant_id = 1) const uint scattered = 1; // 0: of the first iteration

void main()
{
    uint i = gl_GlobalInvocationID.x, k = gl_GlobalInvocationID.y, all = args.dims.x * args.dims.y * args.dims.z;
    if (i >= all || k >= args.coefficients) {
        return;
    }
    ivec3 texel = ivec3(i % args.dims.x, i / args.dims.x % args.dims.y, i / (args.dims.x * args.dims.y) + args.ch * args.dims.z);
    vec4 cell = texelFetch(cells, texel, 0);
    bands_medium m = bands_medium_of(cell, args.bands);
    int l = int(sqrt(float(k) + 0.5)), at = int(k * all + i);
    float light = lit != 0u ? texelFetch(unscattered_words, at).x : 0.0;
    light += scattered != 0u ? texelFetch(radiance_words, at).x : 0.0;
    float next = l < int(args.bands) ? bands_scattering(m, l) * light : 0.0;
    next += k == 0u ? 3.54490770 * cell.w : 0.0; // sqrt(4 pi)
    if (isnan(next) || isinf(next)) {
        next = 0.0;
        atomicAdd(counters.non_finite, 1u);
    }
    sent[at] = next;
    if (k == 0u) {
        extinction[i] = m.extinction;
    }
}
