// path_balance_sum.comp -- merges what the threads found, and writes the balance so far as doubles, with the lamps
// that are inside the media and what is missing. One thread a value.
//
// The standard error of the imbalance is that of what is given less what is taken, over what is given.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/path/path_args.h"

layout(local_size_x = TYN_PATH_BALANCE_VALUES) in;

TYN_READ(0, partials, path_balance_partial partials[]);
TYN_UPDATE(1, state, path_balance_state states[]);
TYN_WRITE(2, result, path_balance_result result);
// tyn_balance: seven triples of doubles, each as two words; a device need not know doubles.
TYN_WRITE(3, balance, uvec2 balance[7][3]);
TYN_ARGS(path_resolve_args args);

#include "shaders/path/path_probe_merge.glsl"

shared float values[TYN_PATH_BALANCE_VALUES], errors[TYN_PATH_BALANCE_VALUES];

uvec2 double_bits(float x)
{
    uint bits = floatBitsToUint(x), exponent = (bits >> 23) & 0xffu;
    if (exponent == 0u) {
        return uvec2(0u); // zero; single denormals are as good as zero
    }
    return uvec2(bits << 29, (bits & 0x80000000u) | ((exponent + 896u) << 20) | ((bits & 0x7fffffu) >> 3));
}

void main()
{
    uint value = gl_LocalInvocationIndex;
    vec2 merged = probe_merge(0u, 0u, value);
    values[value] = merged.x;
    errors[value] = merged.y;
    result.value[value] = merged.x;
    result.error[value] = merged.y;
    barrier();
    if (value >= 3u) {
        return;
    }
    float entering = values[value], emitted = values[3u + value] + args.lamps[value];
    float absorbed = values[6u + value], escaped = values[9u + value], on_walls = values[12u + value];
    float given = entering + emitted, taken = absorbed + on_walls + escaped;
    balance[0][value] = double_bits(entering);
    balance[1][value] = double_bits(emitted);
    balance[2][value] = double_bits(absorbed);
    balance[3][value] = double_bits(on_walls);
    balance[4][value] = double_bits(escaped);
    balance[5][value] = double_bits(given > 0.0 ? 1.0 - taken / given : 0.0);
    balance[6][value] = double_bits(given > 0.0 ? errors[15u + value] / given : 0.0);
}
