// lpv_reflect_deposit.comp -- a thread a texel of a light's map: into the cell in front of the surface there.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lpv_reflect_args.h"
#include "shaders/common/counters.h"
#include "shaders/light/rsm_args.h"
#include "shaders/light/shadow_args.h"
#define MEDIUM_AT 0
#define BEAMS_AT 5
#define RADIALS_AT 9
#define RADIALS_TEXELS
#include "shaders/medium/medium.glsl"
#include "shaders/beams/beam.glsl"
#include "shaders/beams/radial.glsl"
#include "shaders/lattice/lattice.glsl"
#include "shaders/lattice/lattice_sweep.glsl"

layout(local_size_x = LPV_REFLECT_SIDE, local_size_y = LPV_REFLECT_SIDE) in;
TYN_ARGS(lpv_reflect_args args);
layout(binding = 13) uniform sampler2D rsm_flux_tex;
layout(binding = 14) uniform sampler2D rsm_position_tex;
layout(binding = 15) uniform sampler2D rsm_normal_tex;
TYN_READ(16, partials, float partials[]);
TYN_READ(17, tiles, rsm_tile tiles[]);
TYN_UPDATE(18, reflected, float reflected_unit; uint reflected_pad[3]; int reflected[]);
TYN_UPDATE(19, counters, counters_block counters);

shared float sums[LPV_REFLECT_LANES];
shared uint grid_index;

const float WHOLE = 1073741824.0; // 2^30: roundings of a million texels on top do not fill 31 bits

// Of all texels, W: the same in every workgroup.
float bound_of_all()
{
    uint lane = gl_LocalInvocationIndex;
    float sum = 0.0;
    for (uint i = lane; i < args.num_blocks; i += LPV_REFLECT_LANES) {
        sum += partials[i];
    }
    sums[lane] = sum;
    for (uint half_n = LPV_REFLECT_LANES / 2u; half_n > 0u; half_n /= 2u) {
        barrier();
        if (lane < half_n) {
            sums[lane] += sums[lane + half_n];
        }
    }
    barrier();
    return sums[0];
}

// The grid of a lamp: they are in another order than its map. The same in all threads.
uint grid_of(uint light)
{
    uint lane = gl_LocalInvocationIndex; // as many as lamps
    uint num_lamps = texelFetch(radials_texels, 0).y;
    if (lane < num_lamps && radial_grid_of(lane).light.shadow == light) {
        grid_index = lane;
    }
    barrier();
    return grid_index;
}

// What the medium leaves of the light on its way to p; light scattered forward counts as not scattered.
vec3 transmittance(uint light, uint grid_at, vec3 p)
{
    beam_tau tau;
    if (light < TYN_SHADOW_SUNS) {
        tau = beam_depth(light, p);
    } else {
        radial_grid grid = radial_grid_of(grid_at);
        vec3 away = clamp(p, vec3(0.0), medium.extent) - grid.light.position;
        tau = radial_tau(radial_place_in(grid, away, length(away)));
    }
    return exp(-(tau.a + tau.p));
}

// The cell in front of a surface: half an edge off it, or more, until its centre is on that side.
ivec3 cell_before(lattice_box box, vec3 p, vec3 n)
{
    vec3 x = lattice_from_m(box, p);
    ivec3 c = ivec3(floor(x + 0.5 * n));
    for (int i = 0; i < 2; i++) {
        bool behind = dot(vec3(c) + 0.5 - x, n) <= 0.0;
        c = behind ? ivec3(floor(x + (0.75 + 0.25 * float(i)) * n)) : c;
    }
    return c;
}

void main()
{
    float all = bound_of_all(), unit = all > 0.0 ? all / WHOLE : 1.0;
    if (gl_LocalInvocationIndex == 0u && gl_WorkGroupID == uvec3(0)) {
        reflected_unit = unit; // of the same number each time
    }
    rsm_tile tile = tiles[args.first + gl_WorkGroupID.z];
    uint grid = tile.light < TYN_SHADOW_SUNS ? 0u : grid_of(tile.light);
    uvec2 place = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(place, uvec2(tile.texels)))) {
        return;
    }
    ivec2 texel = ivec2(tile.offset + place);
    vec3 flux = texelFetch(rsm_flux_tex, texel, 0).rgb;
    if (flux.r + flux.g + flux.b <= 0.0) {
        return;
    }
    vec3 p = texelFetch(rsm_position_tex, texel, 0).xyz, n = texelFetch(rsm_normal_tex, texel, 0).xyz;
    lattice_box box = lattice_box_of(medium.extent, ivec3(args.dims));
    ivec3 c = cell_before(box, p, n);
    if (any(lessThan(c, ivec3(0))) || any(greaterThanEqual(c, box.dims))) {
        return;
    }
    flux *= transmittance(tile.light, grid, p);
    if (any(isnan(flux)) || any(isinf(flux))) {
        atomicAdd(counters.non_finite, 1u);
        return;
    }
    // A cosine lobe's first moment is 2/3 of its power along the normal.
    vec4 lobe = vec4(1.0, 2.0 / 3.0 * n) / unit;
    for (uint ch = 0u; ch < args.channels; ch++) {
        ivec4 q = ivec4(round(lattice_channel(flux, args.channels, ch, args.tint) * lobe));
        uint at = 4u * (ch * args.dims.x * args.dims.y * args.dims.z + lattice_index(box, c));
        for (uint k = 0u; k < 4u; k++) {
            if (q[k] != 0) {
                atomicAdd(reflected[at + k], q[k]);
            }
        }
    }
}
