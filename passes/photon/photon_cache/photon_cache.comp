// photon_cache.comp -- a cell's sum over all generations that count, and what it means.
//
// I = I - H_old + H_new in whole numbers (Elek et al. 2012, Sec 4.2). A sum that has missed generations that are gone is made anew.
#include "photon_cache_args.h"
#include "../common/photon_args.h"
#include "shaders/common/counters.h"
#define MEDIUM_BLOCK 0
#include "shaders/medium/medium.glsl"
#include "shaders/lattice/lattice.glsl"

layout(local_size_x = 64) in;
TYN_ARGS(photon_cache_args args);
TYN_READ(1, ring, photon_ring ring; ivec4 words[]);
TYN_UPDATE(2, sum, photon_sum sum; ivec4 sums[]);
TYN_READ(7, flux, ivec4 flux_words[]);
TYN_WRITE(3, light, photon_light light[]);
layout(binding = 4, rgba32f) uniform writeonly image3D moments_image;
TYN_UPDATE(5, counters, counters_block counters);
layout(binding = 6) uniform sampler3D cells;
#include "../common/photon_cells.glsl"

bool bounded = false;

// A generation's part; bounded, so that sums cannot overflow.
ivec4 part_of(bool light_is, uint turn, uint quad)
{
    uint at = turn % args.slots * args.lobes * args.dims.x * args.dims.y * args.dims.z + quad;
    ivec4 value = light_is ? words[at] : flux_words[at];
    ivec4 most = ivec4(int(PHOTON_WHOLE) / int(args.generations));
    ivec4 kept = clamp(value, -most, most);
    bounded = bounded || any(notEqual(kept, value));
    return kept;
}

// Of a cell within the medium's box, m^3.
float volume_of(const lattice_box box, ivec3 c)
{
    vec3 lo = max(lattice_to_m(box, vec3(c)), vec3(0.0)), hi = min(lattice_to_m(box, vec3(c + 1)), medium.extent);
    vec3 size = max(hi - lo, 1e-6 * box.dx);
    return size.x * size.y * size.z;
}

void main()
{
    uint cell = gl_GlobalInvocationID.x, cells_all = args.dims.x * args.dims.y * args.dims.z;
    if (cell >= cells_all) {
        return;
    }
    uint to = ring.turns, from = sum.turns, most = args.slots - args.generations;
    bool anew = from > to || to - from > most;
    uint last = min(to, args.generations);
    ivec3 dims = ivec3(args.dims);
    lattice_box box = lattice_box_of(medium.extent, dims);
    ivec3 c = ivec3(cell % args.dims.x, cell / args.dims.x % args.dims.y, cell / (args.dims.x * args.dims.y));
    // Of the volume, or of as much of the densest medium as the cell has.
    float measure = volume_of(box, c);
    if (args.majorant > 0.0) {
        float extinction = photon_extinction(c, args.dims.z, args.cell_channels, args.scaled == 1u);
        measure = extinction > 1e-6 * args.majorant ? box.dx * box.dx * box.dx * extinction / args.majorant : 1e37;
    }
    float scale = args.unit / (float(max(last, 1u)) * measure);
    vec3 fluence = vec3(0.0), flux[3] = vec3[3](vec3(0.0), vec3(0.0), vec3(0.0)); // by channel
    for (uint lobe = 0u; lobe < args.lobes; lobe++) {
        ivec4 s[2];
        for (uint k = 0u; k < 2u; k++) {
            uint quad = lobe * cells_all + cell, at = k * args.lobes * cells_all + quad;
            s[k] = anew ? ivec4(0) : sums[at];
            for (uint turn = anew ? to - last : from; turn < to; turn++) {
                s[k] += part_of(k == 0u, turn, quad);
                if (!anew && turn >= args.generations) {
                    s[k] -= part_of(k == 0u, turn - args.generations, quad);
                }
            }
            sums[at] = s[k];
        }
        vec3 sum_of = max(vec3(s[0].xyz), 0.0);
        float mean = mean3(sum_of);
        photon_light l;
        l.order = mean > 0.0 ? PHOTON_ORDER_UNIT * float(s[0].w) / mean : 0.0;
        l.way = mean > 0.0 ? vec3(s[1].xyz) / mean : vec3(0.0);
        l.way *= min(1.0, 0.999 / max(length(l.way), 1e-20));
        l.fluence = scale * sum_of;
        l.count = float(s[1].w);
        light[lobe * cells_all + cell] = l;
        fluence += l.fluence;
        for (uint ch = 0u; ch < 3u; ch++) {
            flux[ch] += l.fluence[ch] * l.way;
        }
    }
    if (bounded) {
        atomicAdd(counters.clamped, 1u);
    }
    vec3 tint = args.tint / dot(args.tint, args.tint);
    for (uint ch = 0u; ch < args.channels; ch++) {
        vec4 m = vec4(fluence[ch], flux[ch]);
        if (args.channels == 1u) {
            m = vec4(dot(fluence, tint), tint.x * flux[0] + tint.y * flux[1] + tint.z * flux[2]);
        }
        imageStore(moments_image, c + ivec3(0, 0, int(ch) * dims.z), m);
    }
}
