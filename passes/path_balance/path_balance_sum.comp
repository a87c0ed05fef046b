// path_balance_sum.comp -- merges what the threads found, and writes the balance so far as doubles, with the lamps
// that are inside the media and what is missing. One thread a value.
//
// The standard error of the imbalance is that of what is given less what is taken, over what is given.
#include "shaders/common/balance_result.h"
#include "shaders/path/path_args.h"

layout(local_size_x = TYN_PATH_BALANCE_VALUES) in;

TYN_READ(0, partials, path_balance_partial partials[]);
TYN_UPDATE(1, state, path_balance_state states[]);
TYN_WRITE(2, result, path_balance_result result);
TYN_WRITE(3, balance, TYN_BALANCE_MEMBERS);
TYN_ARGS(path_resolve_args args);

#define PATH_SAMPLES_BEFORE uintBitsToFloat(args.samples_before)
#include "shaders/path/path_probe_merge.glsl"

shared float values[TYN_PATH_BALANCE_VALUES], errors[TYN_PATH_BALANCE_VALUES];

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
    if (value == 0u) { // nothing is made to agree
        for (uint k = 0u; k < TYN_BALANCE_SCALES; k++) {
            scales[k] = uvec2[2](uvec2(0u), uvec2(0u));
        }
    }
}
