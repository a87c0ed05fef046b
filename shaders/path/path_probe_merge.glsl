// path_probe_merge.glsl -- merges what the threads of a point found into the point's running statistics. The
// includer declares `partials[]` and `states[]` (path_probe_partial and path_probe_state, or those of a balance)
// and `args` (path_resolve_args).
#ifndef TYN_PATH_PROBE_MERGE_GLSL
#define TYN_PATH_PROBE_MERGE_GLSL
#ifndef PATH_SAMPLES_BEFORE
#define PATH_SAMPLES_BEFORE float(args.samples_before)
#endif

// Mean and standard error of one value, so far: Chan, Golub and LeVeque's merge, in a fixed order.
vec2 probe_merge(uint thread, uint element, uint value)
{
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

    float mean = 0.0, low = 0.0, deviation = 0.0, before = PATH_SAMPLES_BEFORE;
    if (args.samples_before > 0u) {
        mean = states[element].mean[value];
        low = states[element].low[value];
        deviation = states[element].deviation[value];
    }
    float total = max(before + added, 1.0), delta = sample_mean - mean;
    deviation += sample_deviation + delta * delta * (before * added / total);
    // Kahan: `low` keeps what single precision loses of the ever smaller steps.
    precise float step_kept = delta * (added / total) - low;
    precise float mean_next = mean + step_kept;
    precise float low_next = (mean_next - mean) - step_kept;
    states[element].mean[value] = mean_next;
    states[element].low[value] = low_next;
    states[element].deviation[value] = deviation;
    // A single sample says nothing about its spread: its size stands in.
    float error = total > 1.5 ? sqrt(max(deviation, 0.0) / (total * (total - 1.0))) : abs(mean_next);
    return vec2(mean_next, error);
}

#endif
