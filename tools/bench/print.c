// print.c -- the report for people, as a table on stdout.
#include "print.h"
#include "json.h"
#include "times.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const cJSON *list_of(const cJSON *object, const char *key)
{
    return cJSON_GetObjectItemCaseSensitive(object, key);
}

static void print_ms(double ms)
{
    if (isnan(ms)) {
        printf(" %8s", "-");
    } else {
        printf(" %8.*f", ms < 10 ? 2 : ms < 100 ? 1 : 0, ms);
    }
}

void bench_print_head(const cJSON *report)
{
    const cJSON *device = list_of(report, "device"), *c = list_of(report, "ceilings");
    printf("suite %s, tyndall %s on %s, %s\n", json_text(list_of(report, "suite"), "name"),
           json_text(report, "tyndall"), json_text(device, "name"), json_text(device, "driver"));
    const struct {
        const char *key, *unit;
    } rows[] = {{"fma_gflops", "Gflop/s"},
                {"copy_gb_s", "GB/s copied"},
                {"trilinear_gsamples_s", "G trilinear fetches/s"},
                {"exp_gops_s", "G exponentials/s"},
                {"dispatch_us", "us a dispatch"}};
    const char *between = "ceilings: ";
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        const cJSON *value = cJSON_GetObjectItemCaseSensitive(c, rows[i].key);
        if (cJSON_IsRaw(value) && strcmp(value->valuestring, "null") != 0) {
            printf("%s%.3g %s", between, strtod(value->valuestring, NULL), rows[i].unit);
            between = ", ";
        }
    }
    printf("%s", between[0] == ',' ? "\n" : "");
    fflush(stdout);
}

static void print_scene_head(const cJSON *scene)
{
    const cJSON *r = list_of(scene, "reference");
    const int block = (int)json_figure(r, "noise.0.block");
    printf("\n%s, %.0fx%.0f", json_text(scene, "name"), json_figure(scene, "size.0"),
           json_figure(scene, "size.1"));
    const double fill = json_figure(scene, "fill"), seconds = json_figure(r, "seconds");
    if (!isnan(fill)) {
        printf(", %.0f %% of it medium", 100 * fill);
    }
    if (isnan(json_figure(r, "spp"))) {
        printf(", reference from a file");
    } else {
        printf(", reference %.0f samples", json_figure(r, "spp"));
    }
    if (isnan(json_figure(r, "noise.0.n"))) {
        printf(" (its noise is not known)");
    } else {
        printf(" (its noise: %.2f %% per pixel, %.2f %% per %dx%d block)",
               100 * json_figure(r, "noise.1.n"), 100 * json_figure(r, "noise.0.n"), block, block);
    }
    if (seconds > 0) {
        printf(", %.0f s", seconds);
    }
    printf("\n%-24s %9s %9s %8s %8s %8s %8s %8s %8s %8s %8s\n", "", "error", "error", "", "first",
           "medium", "light", "camera", "same", "set-up", "memory");
    printf("%-24s %6d px %9s %8s %8s %8s %8s %8s %8s %8s %8s\n", "", block, "1 px", "FLIP", "ms",
           "ms", "ms", "ms", "ms", "ms", "MiB");
}

// "path needs for the same error 812 ms on 8 px (15.2 times)": of cold frames; nothing where noise hides the errors.
static void print_equal(const cJSON *run)
{
    const cJSON *e;
    bool any = false;
    cJSON_ArrayForEach(e, list_of(run, "equal_error"))
    {
        const double ms = json_figure(e, "baseline_ms"), block = json_figure(e, "block");
        if (strcmp(json_text(e, "frame"), bench_time_names[TIME_LIGHT]) != 0 || isnan(ms)) {
            continue;
        }
        printf(any ? ", " : "    for the same error ");
        printf("%s needs %s%.*f ms ", json_text(e, "baseline"),
               json_true(e, "measured") ? "" : "about ", ms < 10, ms);
        if (block > 0) {
            printf("on %.0f px (%.1f times)", block, json_figure(e, "speedup"));
        } else {
            printf("by FLIP (%.1f times)", json_figure(e, "speedup"));
        }
        any = true;
    }
    printf("%s", any ? "\n" : "");
}

static void print_nodes(const cJSON *run, bool setup, const char *title)
{
    const cJSON *n;
    cJSON_ArrayForEach(n, list_of(run, "nodes"))
    {
        const double ms = json_figure(n, "gpu_ms"), steps = json_figure(n, "work.steps");
        const double fraction = json_figure(n, "fraction");
        if (json_true(n, "setup") != setup || !(ms > 0)) {
            continue;
        }
        printf("%s %s %.*f", title, json_text(n, "name"), ms < 10 ? 2 : 1, ms);
        title = "";
        if (steps > 0) {
            printf(" (%.1f ns a step)", 1e6 * ms / steps);
        }
        if (fraction >= 0.1) {
            printf(" (%.0f %% of %s)", 100 * fraction, json_text(n, "ceiling"));
        }
    }
}

// An error near the noise of the reference is a small difference of large numbers; below it, it is not known.
static void print_error(const cJSON *error)
{
    const double value = json_figure(error, "error"), noise = json_figure(error, "n");
    const bool hidden = value < noise;
    if (isnan(value)) {
        printf(" %9s", "-");
        return;
    }
    if (json_figure(error, "block") == 0) {
        printf(" %s%6.4f", hidden ? "<=" : "  ", hidden ? noise : value);
        return;
    }
    printf(" %s%5.2f %%",
           hidden                      ? "<="
           : json_true(error, "vague") ? " ~"
                                       : "  ",
           100 * (hidden ? noise : value));
}

static void print_run(const cJSON *run)
{
    const char *failed = json_text(run, "failed");
    if (failed[0]) {
        printf("%-24s cannot do this scene: %s\n", json_text(run, "name"), failed);
        return;
    }
    printf("%-24s", json_text(run, "name"));
    const cJSON *error;
    cJSON_ArrayForEach(error, list_of(run, "errors"))
    {
        print_error(error);
    }
    for (int i = 0; i < NUM_TIMES; i++) {
        char path[48];
        snprintf(path, sizeof path, "frame_ms.%s", bench_time_names[i]);
        print_ms(json_figure(run, path));
    }
    print_ms(json_figure(run, "setup_ms"));
    const double bytes =
        json_figure(run, "memory.persistent") + json_figure(run, "memory.transient");
    if (isnan(bytes)) {
        printf(" %8s\n", "-");
    } else {
        printf(" %8.1f\n", bytes / (1 << 20));
    }
    if (json_true(run, "sampling")) {
        return;
    }
    print_nodes(run, false, "    nodes, ms:");
    print_nodes(run, true, "; set-up:");
    printf("\n    camera moved, unchanged:");
    const cJSON *n;
    cJSON_ArrayForEach(n, list_of(run, "nodes"))
    {
        if (!json_true(n, "setup") &&
            strcmp(json_text(n, "state_after_camera_moved"), "unchanged") == 0) {
            printf(" %s", json_text(n, "name"));
        }
    }
    printf("\n    bias %+.2f %%", 100 * json_figure(run, "errors.0.bias"));
    if (!isnan(json_figure(run, "imbalance.0"))) {
        printf(", imbalance %+.2f %+.2f %+.2f %%", 100 * json_figure(run, "imbalance.0"),
               100 * json_figure(run, "imbalance.1"), 100 * json_figure(run, "imbalance.2"));
    }
    if (!isnan(json_figure(run, "flicker"))) {
        printf(", flicker %.2g %%", 100 * json_figure(run, "flicker"));
    }
    printf("\n");
    print_equal(run);
}

static void print_time(const char *name, double ms, bool measured)
{
    if (isnan(ms)) {
        printf(", %s -", name);
    } else {
        printf(", %s %s%.*f ms", name, measured ? "" : "about ", ms < 10, ms);
    }
}

// "  to 5 % on 8 px, cycles 812 ms, path 640 ms, pop 31 ms"
static void print_peer(const char *name, const cJSON *entry)
{
    const char *baseline = json_text(entry, "baseline");
    printf("  to %.0f %% on %.0f px", 100 * json_figure(entry, "error"),
           json_figure(entry, "block"));
    print_time(name, json_figure(entry, "ms"), json_true(entry, "measured"));
    print_time(baseline[0] ? baseline : "baselines", json_figure(entry, "baseline_ms"),
               json_true(entry, "baseline_measured"));
    print_time(json_text(entry, "method"), json_figure(entry, "method_ms"), true);
    printf("\n");
}

void bench_print_scene(const cJSON *scene)
{
    const cJSON *item;
    print_scene_head(scene);
    cJSON_ArrayForEach(item, list_of(scene, "runs"))
    {
        print_run(item);
    }
    cJSON_ArrayForEach(item, list_of(scene, "left_out"))
    {
        printf("%-24s left out: %s\n", json_text(item, "run"), json_text(item, "why"));
    }
    const char *between = "  ";
    cJSON_ArrayForEach(item, list_of(scene, "verdicts"))
    {
        printf("%s%s", between, item->valuestring);
        between = "; ";
    }
    printf("\n");
    const char *promise = json_text(list_of(scene, "promise"), "text");
    if (promise[0]) {
        printf("  %s\n", promise);
    }
    const cJSON *times = list_of(scene, "times");
    const cJSON *camera = list_of(times, bench_time_names[TIME_CAMERA]);
    const char *moved = json_text(list_of(camera, "promise"), "text");
    if (moved[0]) {
        printf("  in frames after the camera has moved: %s\n", moved);
    }
    cJSON_ArrayForEach(item, list_of(scene, "peers"))
    {
        const cJSON *entry;
        cJSON_ArrayForEach(entry, list_of(item, "equal_error"))
        {
            print_peer(json_text(item, "name"), entry);
        }
    }
    fflush(stdout);
}

static void print_measure(double block)
{
    if (block > 0) {
        printf("on %2.0f px", block);
    } else {
        printf("by FLIP ");
    }
}

// "about 12 times as fast as the baselines in 9 of 12 scenes"
static void print_mean(const cJSON *entry)
{
    const double times = json_figure(entry, "geometric_mean");
    const double extrapolated = json_figure(entry, "extrapolated");
    printf("%s%.*f times as fast as the baselines in %.0f of %.0f scenes",
           extrapolated > 0 ? "about " : "",
           times < 0.1 ? 3
           : times < 1 ? 2
                       : 1,
           times, json_figure(entry, "scenes"), json_figure(entry, "of"));
    printf(extrapolated > 0 ? " (%.0f of them extrapolated)\n" : "\n", extrapolated);
}

// What a user gets who sets nothing but the quality, at the error that this has.
static void print_presets(const cJSON *report)
{
    const cJSON *item;
    const char *title = "\nat the errors of the presets, geometric means over scenes:\n";
    cJSON_ArrayForEach(item, list_of(report, "presets"))
    {
        if (!(json_figure(item, "scenes") > 0)) {
            continue;
        }
        printf("%s%s, %-7s %-15s ", title, json_text(item, "method"), json_text(item, "preset"),
               json_text(item, "frame"));
        print_measure(json_figure(item, "block"));
        printf(": ");
        print_mean(item);
        title = "";
    }
}

// One line for each comparison that any scene has: the best of all runs at an error.
static void print_headlines(const cJSON *report)
{
    const cJSON *item;
    const char *title =
        "\nat equal error by the best of all settings, geometric means over scenes:\n";
    cJSON_ArrayForEach(item, list_of(report, "headline"))
    {
        const double block = json_figure(item, "block"), error = json_figure(item, "error");
        if (!(json_figure(item, "scenes") > 0)) {
            continue;
        }
        printf("%s%-10s %-15s ", title, json_text(item, "method"), json_text(item, "frame"));
        if (block > 0) {
            printf("%5.0f %% ", 100 * error);
        } else {
            printf("%7.2g ", error);
        }
        print_measure(block);
        printf(": ");
        print_mean(item);
        title = "";
    }
}

void bench_print_end(const cJSON *report)
{
    const cJSON *item;
    cJSON_ArrayForEach(item, list_of(report, "peers_left_out"))
    {
        printf("%s, %s: left out: %s\n", json_text(item, "name"), json_text(item, "scene"),
               json_text(item, "why"));
    }
    cJSON_ArrayForEach(item, list_of(report, "ratios"))
    {
        printf("\n%s, %s: %.2f times the frame in which the light changes\n",
               json_text(item, "name"), json_text(item, "run"), json_figure(item, "times"));
    }
    print_presets(report);
    print_headlines(report);
}
