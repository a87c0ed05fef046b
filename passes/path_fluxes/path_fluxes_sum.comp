// path_fluxes_sum.comp -- merges the means that threads found into the running statistics. One workgroup a value.
//
// A thread's mean over n paths has n times less variance than a path, so threads are weighed by n, whatever each
// dispatch's n was (Chan, Golub and LeVeque, 1983); of K threads in all sum n (mean_i - mean)^2 / (K - 1) is a
// path's variance. Fixed order: every lane its own threads, then pairwise.
#include "shaders/path/path_args.h"

layout(local_size_x = TYN_PATH_FLUX_LANES) in;

TYN_READ(0, partials, float partials[]);
TYN_UPDATE(1, state, path_fluxes_state state);
TYN_WRITE(2, fluxes, path_fluxes_result result);
TYN_ARGS(path_fluxes_sum_args args);

shared vec2 lanes[TYN_PATH_FLUX_LANES]; // mean, sum of squared deviations of means

void main()
{
    uint value = gl_WorkGroupID.x, lane = gl_LocalInvocationIndex, each = args.threads / TYN_PATH_FLUX_LANES;
    vec2 own = vec2(0.0);
    for (uint i = 0u; i < each; i++) {
        float delta = partials[value * args.threads + i * TYN_PATH_FLUX_LANES + lane] - own.x;
        own.x += delta / float(i + 1u);
        own.y += delta * delta * (float(i) / float(i + 1u));
    }
    lanes[lane] = own;
    float count = float(each);
    for (uint half_n = TYN_PATH_FLUX_LANES / 2u; half_n > 0u; half_n /= 2u) {
        barrier();
        if (lane < half_n) {
            vec2 a = lanes[lane], b = lanes[lane + half_n];
            float delta = b.x - a.x;
            lanes[lane] = vec2(a.x + 0.5 * delta, a.y + b.y + delta * delta * (0.5 * count));
        }
        count *= 2.0;
    }
    barrier();
    if (lane > 0u) {
        return;
    }
    vec2 found = lanes[0];
    float mean = 0.0, low = 0.0, deviation = 0.0;
    float threads = float(args.threads), before = threads * float(args.paths_before), added = threads * float(args.paths);
    if (args.paths_before > 0u) {
        mean = state.mean[value];
        low = state.low[value];
        deviation = state.deviation[value];
        threads += state.threads[value];
    }
    float total = before + added, delta = found.x - mean;
    deviation += found.y * float(args.paths) + delta * delta * (before * (added / total));
    // Kahan: `low` keeps what single precision loses of the ever smaller steps.
    precise float step_kept = delta * (added / total) - low;
    precise float mean_next = mean + step_kept;
    precise float low_next = (mean_next - mean) - step_kept;
    state.mean[value] = mean_next;
    state.low[value] = low_next;
    state.deviation[value] = deviation;
    state.threads[value] = threads;
    result.value[value] = mean_next;
    result.error[value] = sqrt(max(deviation, 0.0) / (threads - 1.0) / total);
}
