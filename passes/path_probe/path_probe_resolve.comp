// path_probe_resolve.comp -- merges what the threads of each point found into the point's running statistics.
// One thread a value, in a fixed order.
#include "shaders/path/path_args.h"

layout(local_size_x = 64) in;

TYN_READ(0, partials, path_probe_partial partials[]);
TYN_UPDATE(1, state, path_probe_state states[]);
TYN_WRITE(2, results, path_probe_result results[]);
TYN_ARGS(path_resolve_args args);

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
