// merge_ordinates.comp -- adds what a cell scatters towards the eye of the ordinates' unscattered light.
#define MEDIUM_BLOCK 0
#include "shaders/medium/medium.glsl"
#define COLUMNS_AT 4
#include "shaders/beams/columns.glsl"
#define TMS 6
#define SCATTER_LUT_BLOCK 7
#include "tms.glsl"
#include "merge_args.h"
#define SKY_SEEN_AT 8
#include "shaders/light/sky_seen.glsl"
#include "shaders/light/ordinate_args.h"
#include "shaders/lattice/lattice.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
layout(constant_id = 1) const bool grey = false; // all channels of the medium are equal
layout(constant_id = 2) const uint channels = 3;
layout(constant_id = 3) const uint seen = 0; // 1: surfaces hide some of the light
TYN_ARGS(merge_args args);
TYN_UNIFORM(1, camera, camera_block camera);
layout(binding = 2) uniform sampler3D cells;
TYN_UPDATE(3, field, float field[]);
#include "merge.glsl"
#include "merge_read.glsl"

// k e^-tau' of an ordinate, per channel.
vec3 grey_share(uint n, uvec3 cell, const beam_tau unit, const tms_row row, float mu, float level)
{
    float column = columns_density(n, cell, args.dims);
    return vec3(exp(-(unit.a.r + unit.p.r) * column) * tms_kernel(row, mu, unit.s.r * column, level));
}

vec3 coloured_share(uint n, uvec3 cell, const beam_tau unit, tms_row row[3], float mu, float level)
{
    vec3 tau_s, tau; // tau': without what is scattered straight on
    if (medium_mode == TYN_MEDIUM_DENSITY) {
        float column = columns_density(n, cell, args.dims);
        tau_s = unit.s * column;
        tau = (unit.a + unit.p) * column;
    } else {
        beam_tau depth = columns_tau(n, cell, args.dims);
        tau_s = depth.s;
        tau = depth.a + depth.p;
    }
    vec3 k = exp(-tau);
    for (int ch = 0; ch < 3; ch++) {
        k[ch] *= tms_kernel(row[ch], mu, tau_s[ch], level);
    }
    return k;
}

vec3 mixed_share(uint n, uvec3 cell, tms_last last[3], float mu, float level,
                 float mean_cosine)
{
    beam_tau tau = columns_tau(n, cell, args.dims);
    vec3 k = exp(-(tau.a + tau.p));
    for (int ch = 0; ch < 3; ch++) {
        k[ch] *= tms_kernel_mixed(last[ch], mu, tau.s[ch], tau.p[ch], level, mean_cosine);
    }
    return k;
}

void main()
{
    ivec3 c = ivec3(gl_GlobalInvocationID), dims = ivec3(args.dims);
    if (any(greaterThanEqual(c, dims))) {
        return;
    }
    vec3 v = merge_towards_eye(camera, lattice_box_of(medium.extent, dims), c);
    beam_tau unit = beam_of_column(1.0);
    tms_row row[3];
    for (uint ch = 0u; ch < 3u; ch++) {
        row[ch] = tms_row_of_channel(ch);
    }
    tms_last last[3]; // of the cell
    if (medium_mode == TYN_MEDIUM_COEFFICIENTS) {
        for (int ch = 0; ch < 3; ch++) {
            float scaled = texelFetch(cells, c + ivec3(0, 0, min(ch, int(channels) - 1) * dims.z), 0).z;
            last[ch] = tms_last_of(phase_of_delta_cosine(scaled));
        }
    }
    vec3 sum = vec3(0.0);
    uint count = merge_is_read(c, dims, channels) ? min(ordinates.count, uint(TYN_ORDINATES_MAX)) : 0u;
    float open = seen == 1u ? sky_seen_share(0u, uvec3(c), args.dims) : 1.0;
    for (uint n = 0u; n < count; n++) {
        ordinate o = ordinates.list[n];
        float mu = dot(o.direction, v), level = tms_level(1.0 - o.mean_cosine);
        vec3 share;
        if (medium_mode == TYN_MEDIUM_COEFFICIENTS) {
            share = mixed_share(n, uvec3(c), last, mu, level, o.mean_cosine);
        } else if (grey) {
            share = grey_share(n, uvec3(c), unit, row[0], mu, level);
        } else {
            share = coloured_share(n, uvec3(c), unit, row, mu, level);
        }
        if (seen == 1u) {
            sum += sky_seen_irradiance(o, sky_seen_share(n + 1u, uvec3(c), args.dims), open) * share;
        } else {
            sum += o.irradiance * share;
        }
    }
    if (channels == 1u) {
        field[merge_index(c, 0u)] += dot(sum, args.tint) / dot(args.tint, args.tint);
    } else {
        for (uint ch = 0u; ch < 3u; ch++) {
            field[merge_index(c, ch)] += sum[ch];
        }
    }
}
