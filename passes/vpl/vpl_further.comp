// vpl_further.comp -- gives the VPLs of further reflections the power of all of them. One workgroup.
//
// They come with P, what surfaces reflect of the first VPLs' light, and lie where vpl_bounce.comp takes all further reflections to
// be. If surfaces reflect q P of it they get P / (1 - q): what these VPLs send out, less what surfaces reflect of it, is P, and no
// light is lost or made.
#include "shaders/beams/radial_args.h"
#include "vpl_bounce_args.h"

const float MOST_REFLECTED = 0.95;
layout(local_size_x = TYN_RADIAL_VPLS_MAX) in;
#define WORKGROUP_SIZE TYN_RADIAL_VPLS_MAX
#define WORKGROUP_SUM vec3
#include "shaders/common/workgroup.glsl"

TYN_UPDATE(0, vpls, uint vpl_count; uint vpl_before; uvec2 vpl_pad; light_block vpls[]);
TYN_READ(1, bins, vpl_bins bins); // what surfaces reflect of these VPLs' light

void main()
{
    uint lane = gl_LocalInvocationIndex;
    bool further = lane >= vpl_before && lane < vpl_count;
    vec3 power = workgroup_total(further ? vpls[lane].color * 3.14159265 : vec3(0.0)), sum = vec3(0.0);
    for (uint bin = lane; bin < VPL_BINS; bin += TYN_RADIAL_VPLS_MAX) {
        sum += vec3(bins.list[bin].flux[0], bins.list[bin].flux[1], bins.list[bin].flux[2]);
    }
    vec3 reflected = workgroup_total(sum / VPL_BIN_UNIT) * bins.power;
    if (further) {
        vpls[lane].color /= 1.0 - min(reflected / max(power, vec3(1e-30)), vec3(MOST_REFLECTED));
    }
}
