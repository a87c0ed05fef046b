// lattice_recall.comp -- the last frame's solution at the places of this frame's cells.
#include "shaders/lattice/lattice_args.h"
#include "shaders/lattice/lattice.glsl"
#define LATTICE_ENVIRONMENT 1
#include "shaders/lattice/lattice_unhindered.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
TYN_ARGS(lattice_recall_args args);
TYN_READ(0, memory, lattice_memory_block memory; vec4 moments[]);
TYN_READ(2, power, float power[3]);
TYN_WRITE(3, guess, vec4 guess[]);

const float OTHER_LIGHT = 16.0; // a greater change of power is another light: the solve starts anew

// By what an earlier solution is scaled. Media that move or grow change the power as well, and by that
// the solution less than proportionally: a small change is left to the sweeps.
float growth(uint ch)
{
    float ratio = power[ch] / memory.power[ch];
    return ratio > 0.67 && ratio < 1.5 ? 1.0 : ratio;
}

// Trilinear between cell centres, clamped to the outermost.
vec4 remembered(vec3 cell, uint ch)
{
    ivec3 dims = ivec3(memory.dims);
    vec3 at = clamp(cell - 0.5, vec3(0.0), vec3(dims - 1));
    ivec3 lo = min(ivec3(at), dims - 1);
    vec3 f = at - vec3(lo);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 8; i++) {
        ivec3 o = ivec3(i & 1, i >> 1 & 1, i >> 2), c = min(lo + o, dims - 1);
        vec3 w = mix(1.0 - f, f, vec3(o));
        sum += w.x * w.y * w.z *
               moments[((int(ch) * dims.z + c.z) * dims.y + c.y) * dims.x + c.x];
    }
    return sum;
}

void main()
{
    uvec3 texel = gl_GlobalInvocationID; // channels stacked along z
    uint ch = texel.z / args.dims.z;
    if (any(greaterThanEqual(texel.xy, args.dims.xy)) || ch >= args.channels) {
        return;
    }
    uint i = (texel.z * args.dims.y + texel.y) * args.dims.x + texel.x;
    vec4 m = lattice_unhindered(args.channels, ch, args.tint);
    if (memory.channels == args.channels && memory.tint == args.tint &&
        memory.power[ch] < OTHER_LIGHT * power[ch] && power[ch] < OTHER_LIGHT * memory.power[ch]) {
        vec3 p = lattice_to_m(lattice_box_of(args.extent, ivec3(args.dims)),
                              vec3(texel.xy, texel.z - ch * args.dims.z) + 0.5);
        vec3 p_world = vec3(dot(args.world[0].xyz, p), dot(args.world[1].xyz, p),
                            dot(args.world[2].xyz, p)) +
                       vec3(args.world[0].w, args.world[1].w, args.world[2].w);
        // The matrices are rigid: their transposes turn back.
        mat3 to_world = transpose(mat3(args.world[0].xyz, args.world[1].xyz, args.world[2].xyz));
        mat3 from_world = mat3(memory.world[0].xyz, memory.world[1].xyz, memory.world[2].xyz);
        vec3 then = from_world * (p_world - vec3(memory.world[0].w, memory.world[1].w,
                                                 memory.world[2].w));
        vec3 cell = lattice_from_m(lattice_box_of(memory.extent, ivec3(memory.dims)), then);
        if (all(greaterThan(cell, vec3(0.0))) && all(lessThan(cell, vec3(memory.dims)))) {
            vec4 old = growth(ch) * remembered(cell, ch);
            old.yzw = transpose(to_world) * (transpose(from_world) * old.yzw);
            // A solution that failed is not handed on.
            m = any(isnan(old)) || any(isinf(old)) ? m : old;
        }
    }
    guess[i] = m;
}
