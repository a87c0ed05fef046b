// probe.comp -- fluence and net flux at points: the lattice's moments and what is left of the suns.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "probe_args.h"
#define MEDIUM_BLOCK 0
#define MEDIUM_DENSITY 4 // the medium itself is not read
#define BEAM_BLOCKS 3
#define BEAM_COLUMN 4
#define BEAM_TAU_A 5
#define BEAM_TAU_P 6
#include "medium.glsl"
#include "beam.glsl"
#include "lattice.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform push
{
    probe_args args;
};
layout(binding = 1, scalar) readonly buffer light_buffer
{
    light_block lights[];
};
layout(binding = 2) uniform sampler3D moments;
layout(binding = 7, scalar) readonly buffer point_buffer
{
    vec3 points[];
};
layout(binding = 8, scalar) writeonly buffer result_buffer
{
    probe_result results[];
};

// Trilinear between cell centres; in the outer half cell the same line goes on.
vec4 moments_at(lattice_box box, vec3 p, uint ch)
{
    vec3 x = clamp(lattice_from_m(box, p), vec3(0.0), vec3(box.dims)) - 0.5;
    ivec3 lo = clamp(ivec3(floor(x)), ivec3(0), max(box.dims - 2, 0)), hi = min(lo + 1, box.dims - 1);
    vec3 t = x - vec3(lo);
    vec4 sum = vec4(0.0);
    for (uint corner = 0; corner < 8; corner++) {
        bvec3 far = bvec3((corner & 1) != 0, (corner & 2) != 0, (corner & 4) != 0);
        vec3 w = mix(1.0 - t, t, far);
        ivec3 c = ivec3(far.x ? hi.x : lo.x, far.y ? hi.y : lo.y, far.z ? hi.z : lo.z);
        sum += w.x * w.y * w.z * texelFetch(moments, c + ivec3(0, 0, int(ch) * box.dims.z), 0);
    }
    return vec4(max(sum.x, 0.0), sum.yzw);
}

// Where light along `direction` that arrives at p was last in the box: p itself if that is inside.
// False: it never was.
bool last_in_box(vec3 p, vec3 direction, out vec3 last)
{
    vec3 d = mix(direction, vec3(1e-12), lessThan(abs(direction), vec3(1e-12)));
    vec3 t0 = p / d, t1 = (p - medium.extent) / d; // distances back to the faces
    vec3 lo = min(t0, t1), hi = max(t0, t1);
    float t = max(max(max(lo.x, lo.y), lo.z), 0.0);
    last = p - t * d;
    return t <= min(min(hi.x, hi.y), hi.z);
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= args.num_points) {
        return;
    }
    vec3 p = points[i];
    ivec3 dims = textureSize(moments, 0);
    dims.z /= int(args.channels);
    lattice_box box = lattice_box_of(medium.extent, dims);
    vec4 field[3];
    for (uint ch = 0; ch < 3; ch++) {
        field[ch] = args.tint[ch] * moments_at(box, p, args.channels == 1 ? 0 : ch);
    }
    for (uint sun = 0; sun < args.num_suns; sun++) {
        vec3 last;
        beam_tau tau = beam_tau(vec3(0.0), vec3(0.0), vec3(0.0));
        if (last_in_box(p, lights[sun].direction, last)) {
            tau = beam_depth(sun, last);
        }
        // The lattice counts light in the forward peak as not scattered; a probe of the scattered
        // light takes it back.
        vec3 e = exp(-(tau.a + tau.p));
        if (args.scattered_only != 0) {
            e -= exp(-(tau.a + tau.s));
        }
        for (uint ch = 0; ch < 3; ch++) {
            field[ch] += e[ch] * lights[sun].color[ch] * vec4(1.0, lights[sun].direction);
        }
    }
    for (uint ch = 0; ch < 3; ch++) {
        results[i].fluence[ch] = field[ch].x;
        results[i].fluence_se[ch] = 0.0;
        for (uint axis = 0; axis < 3; axis++) {
            results[i].flux[3 * axis + ch] = dot(args.world[axis], field[ch].yzw);
            results[i].flux_se[3 * axis + ch] = 0.0;
        }
    }
}
