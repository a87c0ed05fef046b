// lpv_step.comp -- one iteration: what arrives in a cell from its 26 neighbours, and what it sends on.
//
// A gather: each thread reads what the neighbours have sent, and nothing is added up by several.
#include "lpv_links.glsl"
#include "shaders/common/quotient.glsl"
#include "shaders/common/scene_args.h"
#include "shaders/common/counters.h"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
TYN_ARGS(lpv_args args);
layout(binding = 0) uniform sampler3D cells;
layout(binding = 1) uniform samplerBuffer sent_0_texels; // of the iteration before
TYN_WRITE(2, sent_1, vec4 sent[]);
TYN_UPDATE(3, sum, vec4 sum[]);
layout(binding = 4) uniform usamplerBuffer wall_links_words;
layout(binding = 5) uniform usamplerBuffer blocking_words; // of lpv_blockers: 26 bytes a cell
layout(binding = 6, rgba32f) uniform writeonly image3D moments;
TYN_UPDATE(7, leaks, float leaks[]);
TYN_UPDATE(8, wall_power, vec2 wall_power[]);
TYN_UPDATE(9, counters, counters_block counters);
TYN_UNIFORM(10, environment, env_block environment);
layout(constant_id = 0) const uint extinction = 0;
layout(constant_id = 1) const uint blockers = 0;
layout(constant_id = 2) const uint ledger = 0;      // 1: leaks are summed; 2: and what walls absorb
layout(constant_id = 3) const uint surroundings = 0; // 1: light of the environment enters in this iteration
layout(constant_id = 4) const uint last = 0;
layout(constant_id = 5) const uint reflects = 0; // 1: walls that cut links send light back
layout(binding = 11) uniform samplerBuffer wall_cells_texels; // four to a struct wall_cell; the last is the albedo

void main()
{
    uvec3 texel = gl_GlobalInvocationID;
    uint ch = uint(quotient(int(texel.z), int(args.dims.z)));
    if (any(greaterThanEqual(texel.xy, args.dims.xy)) || ch >= args.channels) {
        return;
    }
    ivec3 dims = ivec3(args.dims), c = ivec3(texel.xy, texel.z - ch * args.dims.z);
    int n = dims.x * dims.y * dims.z, stride = n * int(args.channels), first = int(ch) * n;
    int here = (c.z * dims.y + c.y) * dims.x + c.x;
    uint links = blockers == LPV_BLOCKERS_EXACT ? texelFetch(wall_links_words, here).x : 0u;
    // From all around comes so much power that, travelling on, it makes the environment's radiance.
    float outside = 0.0;
    if (surroundings == 1u) {
        float radiance = lattice_channel(environment.sky, args.channels, ch, args.tint);
        // The mean length of links, as their light counts each.
        float way = extinction == LPV_EXTINCTION_PAPER ? LPV_DISTANCE : dot(LPV_COUNT * LPV_GAMMA, LPV_LENGTH);
        outside = LATTICE_4PI * args.dx * args.dx * radiance / way;
    }
    bool mirrors = reflects == 1u && blockers == LPV_BLOCKERS_EXACT;
    float albedo = mirrors && links != 0u ? texelFetch(wall_cells_texels, 4 * here + 3)[ch] : 0.0;
    vec4 arrived = vec4(0.0);
    float left = 0.0, absorbed = 0.0;
    [[unroll]] for (uint link = 0u; link < LPV_LINKS; link++) {
        // Light comes along `step` from the cell on the other side.
        ivec3 step = walls_step(link), q = c - step;
        uint towards = walls_reverse(link); // q as seen from here
        bool within = all(equal(q, clamp(q, ivec3(0), dims - 1)));
        int shell = extinction == LPV_EXTINCTION_PAPER ? 0 : int(lpv_shell(link)) * stride;
        int there = (q.z * dims.y + q.y) * dims.x + q.x;
        vec4 sent = texelFetch(sent_0_texels, shell + first + (within ? there : here));
        float power = lpv_along(within ? sent : vec4(outside, 0.0, 0.0, 0.0), link, vec3(step)), open = 1.0;
        if (blockers == LPV_BLOCKERS_EXACT) {
            open = (links >> towards & 1u) != 0u ? 0.0 : 1.0;
        }
        if (blockers == LPV_BLOCKERS_FUZZY) {
            uint word = texelFetch(blocking_words, 7 * here + int(link / 4u)).x;
            open = 1.0 - float(word >> 8u * (link % 4u) & 255u) / 255.0;
        }
        arrived += lpv_deposit(open * power, link, vec3(step));
        if (mirrors && open == 0.0) { // what goes that way comes back, with a cosine lobe
            vec4 own = texelFetch(sent_0_texels, shell + first + here);
            float back = albedo * lpv_along(own, towards, -vec3(step));
            arrived += back * vec4(1.0, 2.0 / 3.0 * normalize(vec3(step)));
            absorbed -= back;
        }
        if (ledger > 0u) {
            absorbed += (1.0 - open) * power;
            if (!within) { // the same link the other way
                float away = lpv_along(sent, towards, -vec3(step));
                left += open * (away - power);
                absorbed += (1.0 - open) * (away - power);
            }
        }
    }
    if (any(isnan(arrived)) || any(isinf(arrived))) {
        arrived = vec4(0.0);
        atomicAdd(counters.non_finite, 1u);
    }
    int i = first + here;
    if (ledger > 0u) {
        leaks[i] += left;
    }
    if (ledger == 2u) {
        wall_power[i].x += absorbed;
    }
    vec4 cell = texelFetch(cells, ivec3(texel), 0), total = sum[i] + arrived;
    lpv_medium m = lpv_medium_of(cell, args.dx, extinction);
    if (last == 1u) {
        imageStore(moments, ivec3(texel), total * (vec2(m.way, m.forward) / (args.dx * args.dx * args.dx)).xyyy);
    } else {
        sum[i] = total;
        for (uint k = 0u; k < (extinction == LPV_EXTINCTION_PAPER ? 1u : LPV_SHELLS); k++) {
            sent[k * uint(stride) + uint(i)] = lpv_sent(arrived, m, cell.z, k);
        }
    }
}
