// path_probe_resolve.comp -- merges what the threads of each point found into the point's running statistics.
// One thread a value, in a fixed order.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "path_args.h"

layout(local_size_x = 64) in;

struct probe_state {
    float mean[TYN_PATH_PROBE_VALUES], low[TYN_PATH_PROBE_VALUES], deviation[TYN_PATH_PROBE_VALUES];
};

layout(set = 0, binding = 0, scalar) readonly buffer partial_buffer { path_probe_partial partials[]; };
layout(set = 0, binding = 1, scalar) buffer state_buffer { probe_state states[]; };
layout(set = 0, binding = 2, scalar) writeonly buffer result_buffer { path_probe_result results[]; };
layout(push_constant, scalar) uniform args_push { path_resolve_args args; };

void main()
{
    uint thread = gl_GlobalInvocationID.x / TYN_PATH_PROBE_VALUES;
    uint value = gl_GlobalInvocationID.x % TYN_PATH_PROBE_VALUES;
    if (thread >= args.num) {
        return;
    }
    uint element = args.first + thread;

    float sample_mean = 0.0, sample_deviation = 0.0, added = 0.0;
    for (uint i = thread * args.slots; i < (thread + 1u) * args.slots; i++) {
        float n = float(partials[i].count);
        if (n > 0.0) {
            float share = n / (added + n), delta = partials[i].mean[value] - sample_mean;
            sample_mean += delta * share;
            sample_deviation += partials[i].deviation[value] + delta * delta * (added * share);
            added += n;
        }
    }

    float mean = 0.0, low = 0.0, deviation = 0.0, before = float(args.samples_before);
    if (args.samples_before > 0u) {
        mean = states[element].mean[value];
        low = states[element].low[value];
        deviation = states[element].deviation[value];
    }
    float total = max(before + added, 1.0), delta = sample_mean - mean;
    deviation += sample_deviation + delta * delta * (before * added / total);
    precise float step_kept = delta * (added / total) - low;
    precise float mean_next = mean + step_kept;
    precise float low_next = (mean_next - mean) - step_kept;
    states[element].mean[value] = mean_next;
    states[element].low[value] = low_next;
    states[element].deviation[value] = deviation;
    results[element].value[value] = mean_next;
    results[element].error[value] =
        total > 1.5 ? sqrt(max(deviation, 0.0) / (total * (total - 1.0))) : abs(mean_next);
}
