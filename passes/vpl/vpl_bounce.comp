// vpl_bounce.comp -- bins as a map of what reflects light again, for the next VPLs. One workgroup.
//
// First of what the first VPLs light, P in all: VPLs of that, whose own light surfaces reflect, R in all. Then of all further
// reflections: what R lights is taken to be lit by all that comes after it, too. If a share q = R / P is reflected each time,
// P + R + q R + q^2 R + ... is P + R / (1 - q); the map is (1 - q) times that, whose sum is P, as vpl_further.comp has it.
#include "shaders/beams/radial_args.h"
#include "shaders/surfaces/surface_args.h"
#include "vpl_bounce_args.h"
#include "shaders/light/vpl_visibility.glsl"
#include "shaders/light/hilbert.glsl"

const uint GROUP = 256u;
layout(local_size_x = GROUP) in;
#define WORKGROUP_SIZE GROUP
#define WORKGROUP_SUM vec3
#include "shaders/common/workgroup.glsl"

TYN_READ(0, vpls, uint vpl_count; uvec3 vpl_pad; light_block vpls[]);
TYN_READ(1, bins, vpl_bins bins);
layout(binding = 2) uniform sampler2D vpl_distances_tex;
layout(binding = 3) uniform sampler2D vpl_planes_tex;
TYN_UNIFORM(4, surfaces, surface_block surfaces);
layout(binding = 5, rgba32f) uniform image2D bin_flux_image; // as rsm_args.h has them
layout(binding = 6, rgba32f) uniform writeonly image2D bin_position_image;
layout(binding = 7, rgba32f) uniform writeonly image2D bin_normal_image;
TYN_ARGS(vpl_bounce_args args);

vec3 flux_of(uint bin)
{
    vpl_bin b = bins.list[bin];
    return vec3(b.flux[0], b.flux[1], b.flux[2]) / VPL_BIN_UNIT * bins.power;
}

void main()
{
    uint lane = gl_LocalInvocationIndex;
    vec3 cell = (surfaces.hi - surfaces.lo) / float(VPL_BIN_CELLS);
    float area = pow(max(cell.x * cell.y * cell.z, 1e-30), 2.0 / 3.0);
    int width = textureSize(vpl_distances_tex, 0).x, side = width / VPL_MAPS_IN_A_ROW;
    vec3 before_share = vec3(0.0), share = vec3(1.0);
    if (args.later != 0u) {
        vec3 before = vec3(0.0), now = vec3(0.0);
        for (uint bin = lane; bin < VPL_BINS; bin += GROUP) {
            before += imageLoad(bin_flux_image, ivec2(hilbert_texel(VPL_BIN_SIDE, bin))).rgb;
            now += flux_of(bin);
        }
        before = workgroup_total(before);
        now = workgroup_total(now);
        before_share = 1.0 - min(now / max(before, vec3(1e-30)), vec3(1.0));
        share = min(before / max(now, vec3(1e-30)), vec3(1.0));
    }
    for (uint bin = lane; bin < VPL_BINS; bin += GROUP) {
        ivec2 to = ivec2(hilbert_texel(VPL_BIN_SIDE, bin));
        vec3 flux = share * flux_of(bin), before = vec3(0.0);
        if (args.later != 0u) {
            before = before_share * imageLoad(bin_flux_image, to).rgb;
        }
        vec4 position = vec4(0.0), normal = vec4(0.0);
        if (flux.r + flux.g + flux.b > 0.0) {
            int best = int(bins.list[bin].best & 0xfffffu);
            ivec2 texel = ivec2(best % width, best / width);
            light_block light =
                vpls[texel.y / side * VPL_MAPS_IN_A_ROW + texel.x / side];
            vec3 d = vpl_frame(light.direction) *
                     normalize(vpl_map_direction(vec2(texel % side) / float(side - 1)));
            float away = texelFetch(vpl_distances_tex, texel, 0).r;
            vec3 at = vpl_map_origin(light.position, light.direction, light.radius) + away * d;
            // Where a bin is much larger than what is lit, a VPL lights about as much as it is away.
            position = vec4(at, min(area, 3.14159265 * away * away));
            normal = vec4(texelFetch(vpl_planes_tex, texel, 0).xyz, 0.0);
        }
        imageStore(bin_flux_image, to, vec4(before + flux, 0.0));
        // Where more was before, it was brightest there.
        if (args.later == 0u || dot(flux, vec3(1.0)) > dot(before, vec3(1.0))) {
            imageStore(bin_position_image, to, position);
            imageStore(bin_normal_image, to, normal);
        }
    }
}
