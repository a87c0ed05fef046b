// vpl_power.comp -- the power of all VPLs: what bins count in.
#include "shaders/beams/radial_args.h"
#include "vpl_bounce_args.h"

layout(local_size_x = TYN_RADIAL_VPLS_MAX) in;
#define WORKGROUP_SIZE TYN_RADIAL_VPLS_MAX
#define WORKGROUP_SUM vec3
#include "shaders/common/workgroup.glsl"

TYN_READ(0, vpls, uint vpl_count; uvec3 vpl_pad; light_block vpls[]);
TYN_WRITE(1, bins, vpl_bins bins);

void main()
{
    uint lane = gl_LocalInvocationIndex;
    vec3 power = workgroup_total(lane < vpl_count ? vpls[lane].color * 3.14159265 : vec3(0.0));
    if (lane == 0u) {
        bins.power = power;
    }
}
