// vpl_power.comp -- the power of all VPLs: what bins count in.
#include "shaders/beams/radial_args.h"
#include "vpl_bounce_args.h"

layout(local_size_x = TYN_RADIAL_VPLS_MAX) in;

TYN_READ(0, vpls, uint vpl_count; uvec3 vpl_pad; light_block vpls[]);
TYN_WRITE(1, bins, vpl_bins bins);

shared vec3 sums[TYN_RADIAL_VPLS_MAX];

void main()
{
    uint lane = gl_LocalInvocationIndex;
    sums[lane] = lane < vpl_count ? vpls[lane].color * 3.14159265 : vec3(0.0);
    for (uint half_size = TYN_RADIAL_VPLS_MAX / 2u; half_size > 0u; half_size /= 2u) {
        barrier();
        if (lane < half_size) {
            sums[lane] += sums[lane + half_size];
        }
    }
    if (lane == 0u) {
        bins.power = sums[0];
    }
}
