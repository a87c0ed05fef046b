// lpv_start.comp -- the light that starts in a cell: reflected by surfaces, scattered for the first time, emitted.
//
// Light that has scattered once is not added to the sum (but for the setting `own`): the march draws what lights it. That which
// surfaces have reflected is.
#include "lpv_links.glsl"
#include "shaders/common/quotient.glsl"
#include "shaders/common/counters.h"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
TYN_ARGS(lpv_args args);
layout(binding = 0) uniform sampler3D cells;
layout(binding = 1) uniform sampler3D source;
TYN_READ(2, reflected, float reflected_unit; uint reflected_pad[3]; ivec4 reflected[]);
TYN_READ(3, scattered, float scattered_unit; uint scattered_pad[3]; ivec4 scattered[]);
TYN_WRITE(4, sent_0, vec4 sent[]);
TYN_WRITE(5, sum, vec4 sum[]);
TYN_UPDATE(6, counters, counters_block counters);
layout(constant_id = 0) const uint extinction = 0;
layout(constant_id = 1) const uint reflects = 0;
layout(constant_id = 2) const uint scatters = 0; // in place of `source`

void main()
{
    uvec3 texel = gl_GlobalInvocationID; // channels stacked along z
    uint ch = uint(quotient(int(texel.z), int(args.dims.z)));
    if (any(greaterThanEqual(texel.xy, args.dims.xy)) || ch >= args.channels) {
        return;
    }
    uint i = (texel.z * args.dims.y + texel.y) * args.dims.x + texel.x;
    uint stride = args.dims.x * args.dims.y * args.dims.z * args.channels;
    float volume = args.dx * args.dx * args.dx;
    vec4 cell = texelFetch(cells, ivec3(texel), 0), light = lattice_fetch_source(source, cells, ivec3(texel));
    vec4 once = volume * (cell.x * vec4(light.x, cell.z * light.yzw) + vec4(LATTICE_4PI * cell.w, 0.0, 0.0, 0.0));
    once += scatters == 1u ? scattered_unit * vec4(scattered[i]) : vec4(0.0);
    vec4 mirrored = reflects == 1u ? reflected_unit * vec4(reflected[i]) : vec4(0.0);
    if (any(isnan(once)) || any(isinf(once))) {
        once = vec4(0.0);
        atomicAdd(counters.non_finite, 1u);
    }
    lpv_medium m = lpv_medium_of(cell, args.dx, extinction);
    if (m.bounded) {
        atomicAdd(counters.clamped, 1u);
    }
    sum[i] = mirrored + args.own * once;
    for (uint shell = 0u; shell < (extinction == LPV_EXTINCTION_PAPER ? 1u : LPV_SHELLS); shell++) {
        sent[shell * stride + i] = lpv_sent(once + mirrored, m, cell.z, shell);
    }
}
