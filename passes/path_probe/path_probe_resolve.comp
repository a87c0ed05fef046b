// path_probe_resolve.comp -- merges what the threads of each point found into the point's running statistics.
// One thread a value, in a fixed order.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/path/path_args.h"

layout(local_size_x = 64) in;

layout(set = 0, binding = 0, scalar) readonly buffer partials_buffer { path_probe_partial partials[]; };
layout(set = 0, binding = 1, scalar) buffer state_buffer { path_probe_state states[]; };
layout(set = 0, binding = 2, scalar) writeonly buffer results_buffer { path_probe_result results[]; };
layout(push_constant, scalar) uniform args_push { path_resolve_args args; };

#include "shaders/path/path_probe_merge.glsl"

void main()
{
    uint thread = gl_GlobalInvocationID.x / TYN_PATH_PROBE_VALUES;
    uint value = gl_GlobalInvocationID.x % TYN_PATH_PROBE_VALUES;
    if (thread >= args.num) {
        return;
    }
    uint element = args.first + thread;
    vec2 merged = probe_merge(thread, element, value);
    results[element].value[value] = merged.x;
    results[element].error[value] = merged.y;
}
