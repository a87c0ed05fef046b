// lpv_reflect_deposit.comp -- a thread a texel of a light's map: into the cell in front of the surface there.
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
#include "../common/lamp_depth.glsl"
#include "../common/deposit.glsl"
#include "shaders/random/rng.glsl"
#include "shaders/lattice/lattice.glsl"
#include "shaders/lattice/lattice_sweep.glsl"
#define WALLS_AT 20
#include "shaders/walls/lattice_walls.glsl"

layout(local_size_x = LPV_REFLECT_SIDE, local_size_y = LPV_REFLECT_SIDE) in;
TYN_ARGS(lpv_reflect_args args);
layout(binding = 13) uniform sampler2D rsm_flux_tex;
layout(binding = 14) uniform sampler2D rsm_position_tex;
layout(binding = 15) uniform sampler2D rsm_normal_tex;
TYN_READ(16, partials, float partials[]);
TYN_READ(17, tiles, rsm_tile tiles[]);
TYN_UPDATE(18, reflected, float reflected_unit; uint reflected_pad[3]; int reflected[]);
TYN_UPDATE(19, counters, counters_block counters);

layout(constant_id = 1) const uint walls = 0;

#define WORKGROUP_SIZE LPV_REFLECT_LANES
#define WORKGROUP_SUM float
#include "shaders/common/workgroup.glsl"

// Of all texels, W: the same in every workgroup.
float bound_of_all()
{
    uint lane = gl_LocalInvocationIndex;
    float sum = 0.0;
    for (uint i = lane; i < args.num_blocks; i += LPV_REFLECT_LANES) {
        sum += partials[i];
    }
    return workgroup_total(sum);
}

// The cell in front of a surface: half an edge off it, or more, until its centre is on that side.
ivec3 cell_before(const lattice_box box, vec3 p, vec3 n)
{
    vec3 x = lattice_from_m(box, p);
    ivec3 c = ivec3(floor(x + 0.5 * n));
    for (int i = 0; i < 2; i++) {
        bool behind = dot(vec3(c) + 0.5 - x, n) <= 0.0;
        c = behind ? ivec3(floor(x + (0.75 + 0.25 * float(i)) * n)) : c;
    }
    return c;
}

// Is no wall between q and the centre of a cell, as far as the walls in either cell tell?
bool same_side(const lattice_box box, vec3 q, const walls_planes around, ivec3 c)
{
    vec3 centre = lattice_to_m(box, vec3(c) + 0.5);
    return walls_behind(walls_planes_of(lattice_index(box, c)), q) == 0u && walls_behind(around, q) == walls_behind(around, centre);
}

// The cell for light that starts at q, off a surface: `c`, or if a wall is between (beside an edge the cell in front of one
// wall may have its centre behind the other) the nearest around that is not cut off. Light is never dropped.
ivec3 cell_open(const lattice_box box, vec3 q, vec3 n, ivec3 c)
{
    ivec3 own = clamp(ivec3(floor(lattice_from_m(box, q))), ivec3(0), box.dims - 1), found = c;
    walls_planes around = walls_planes_of(lattice_index(box, own));
    if (same_side(box, q, around, c)) {
        return c;
    }
    vec3 x = lattice_from_m(box, q) + 0.5 * n;
    float nearest = 1e30;
    for (int k = 0; k < 27; k++) {
        ivec3 other = own + ivec3(k % 3, k / 3 % 3, k / 9) - 1;
        vec3 way = vec3(other) + 0.5 - x;
        if (all(equal(other, clamp(other, ivec3(0), box.dims - 1))) && dot(way, way) < nearest && same_side(box, q, around, other)) {
            nearest = dot(way, way);
            found = other;
        }
    }
    return found;
}

void main()
{
    float all = bound_of_all(), unit = all > 0.0 ? max(all / DEPOSIT_WHOLE, 1.2e-38) : 1.0; // denormals may be 0
    if (gl_LocalInvocationIndex == 0u && gl_WorkGroupID == uvec3(0)) {
        reflected_unit = unit; // of the same number each time
    }
    rsm_tile tile = tiles[args.first + gl_WorkGroupID.z];
    uint grid = lamp_grid_of(tile.light);
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
    if (walls == 1u) { // off its own surface, whose plane may be in the cell
        c = cell_open(box, p + 0.02 * box.dx * n, n, c);
    }
    flux *= lamp_transmittance(tile.light, grid, p);
    if (any(isnan(flux)) || any(isinf(flux))) {
        atomicAdd(counters.non_finite, 1u);
        return;
    }
    // A cosine lobe's first moment is 2/3 of its power along the normal.
    vec4 lobe = vec4(1.0, 2.0 / 3.0 * n) / unit;
    vec3 dither = vec3(rng_pcg4d(uvec4(place, args.first + gl_WorkGroupID.z, 0u)).xyz >> 8) * (1.0 / 16777216.0);
    for (uint ch = 0u; ch < args.channels; ch++) {
        uint at = 4u * (ch * args.dims.x * args.dims.y * args.dims.z + lattice_index(box, c));
        vec4 power = lattice_channel(flux, args.channels, ch, args.tint) * lobe;
        DEPOSIT_ADD(reflected, at, power, dither[ch])
    }
}
