// photon_cache.comp -- a cell's sum over all generations that count, and what it means.
//
// I = I - H_old + H_new in whole numbers (Elek et al. 2012, Sec 4.2). A sum that has missed generations that are gone is made anew.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "photon_cache_args.h"
#include "shaders/photon/photon_args.h"
#include "shaders/common/counters.h"
#define MEDIUM_BLOCK 0
#include "shaders/medium/medium.glsl"
#include "shaders/lattice/lattice.glsl"

layout(local_size_x = 64) in;
TYN_ARGS(photon_cache_args args);
TYN_READ(1, ring, photon_ring ring; ivec4 words[]);
TYN_UPDATE(2, sum, photon_sum sum; ivec4 sums[]);
TYN_WRITE(3, light, photon_light light[]);
layout(binding = 4, rgba32f) uniform writeonly image3D moments_image;
TYN_UPDATE(5, counters, counters_block counters);

const uint QUADS = PHOTON_WORDS / 4;

bool bounded = false;

// A generation's part; bounded, so that sums cannot overflow.
ivec4 part_of(uint turn, uint quad)
{
    ivec4 value = words[turn % args.slots * args.dims.x * args.dims.y * args.dims.z * QUADS + quad];
    ivec4 most = ivec4(int(PHOTON_WHOLE) / int(args.generations));
    ivec4 kept = clamp(value, -most, most);
    bounded = bounded || any(notEqual(kept, value));
    return kept;
}

// Of a cell within the medium's box, m^3.
float volume_of(lattice_box box, ivec3 c)
{
    vec3 lo = max(lattice_to_m(box, vec3(c)), vec3(0.0)), hi = min(lattice_to_m(box, vec3(c + 1)), medium.extent);
    vec3 size = max(hi - lo, 1e-6 * box.dx);
    return size.x * size.y * size.z;
}

float mean3(vec3 v)
{
    return (v.x + v.y + v.z) * (1.0 / 3.0);
}

float over(float a, float b)
{
    return b > 0.0 ? clamp(a / b, -0.999, 0.999) : 0.0;
}

void main()
{
    uint cell = gl_GlobalInvocationID.x;
    if (cell >= args.dims.x * args.dims.y * args.dims.z) {
        return;
    }
    uint to = ring.turns, from = sum.turns, most = args.slots - args.generations;
    bool anew = from > to || to - from > most;
    uint last = min(to, args.generations);
    ivec4 s[QUADS];
    for (uint k = 0u; k < QUADS; k++) {
        uint quad = QUADS * cell + k;
        s[k] = anew ? ivec4(0) : sums[quad];
        for (uint turn = anew ? to - last : from; turn < to; turn++) {
            s[k] += part_of(turn, quad);
            if (!anew && turn >= args.generations) {
                s[k] -= part_of(turn - args.generations, quad);
            }
        }
        sums[quad] = s[k];
    }
    if (bounded) {
        atomicAdd(counters.clamped, 1u);
    }

    ivec3 dims = ivec3(args.dims);
    lattice_box box = lattice_box_of(medium.extent, dims);
    ivec3 c = ivec3(cell % args.dims.x, cell / args.dims.x % args.dims.y, cell / (args.dims.x * args.dims.y));
    float scale = args.unit / (float(max(last, 1u)) * volume_of(box, c));
    vec3 sun = max(vec3(s[0].xyz), 0.0), sky = max(vec3(s[1].xyz), 0.0), flux = vec3(s[2].xyz);
    photon_light l;
    l.cosine = over(float(s[0].w), mean3(sun));
    l.order = mean3(sun + sky) > 0.0 ? PHOTON_ORDER_UNIT * float(s[1].w) / mean3(sun + sky) : 0.0;
    float even = mean3(sky);
    l.way = even > 0.0 ? flux / even : vec3(0.0);
    l.way *= min(1.0, 0.999 / max(length(l.way), 1e-20));
    l.sun = scale * sun;
    l.sky = scale * sky;
    l.count = float(s[2].w);
    light[cell] = l;
    for (uint ch = 0u; ch < args.channels; ch++) {
        vec4 m = vec4(0.0);
        if (args.channels == 1u) {
            float a = dot(l.sun, args.tint) / dot(args.tint, args.tint), b = dot(l.sky, args.tint) / dot(args.tint, args.tint);
            m = vec4(a + b, a * l.cosine * args.sun + b * l.way);
        } else {
            m = vec4(l.sun[ch] + l.sky[ch], l.sun[ch] * l.cosine * args.sun + l.sky[ch] * l.way);
        }
        imageStore(moments_image, c + ivec3(0, 0, int(ch) * dims.z), m);
    }
}
