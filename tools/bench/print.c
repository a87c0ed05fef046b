// print.c -- the report for people, as a table on stdout.
#include "print.h"
#include "json.h"
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
    printf("\n%-24s %9s %9s %8s %8s %8s %8s %8s\n", "", "error", "error", "cold", "camera", "same",
           "set-up", "memory");
    printf("%-24s %6d px %9s %8s %8s %8s %8s %8s\n", "", block, "1 px", "ms", "ms", "ms", "ms",
           "MiB");
}

// "plain path needs for the same error 812 ms on 8 px (15.2 times)": one line per baseline; none where noise hides the
// errors.
static void print_equal(const cJSON *run)
{
    const cJSON *first, *e, *list = list_of(run, "equal_error");
    cJSON_ArrayForEach(first, list)
    {
        const char *baseline = json_text(first, "baseline");
        if (json_figure(first, "block") != json_figure(list, "0.block")) {
            continue;
        }
        bool any = false;
        cJSON_ArrayForEach(e, list)
        {
            const double ms = json_figure(e, "ms");
            if (strcmp(json_text(e, "baseline"), baseline) == 0 && !isnan(ms)) {
                if (!any) {
                    printf("    %-24s needs for the same error", baseline);
                }
                printf("%s %s%.*f ms on %.0f px (%.1f times)", any ? "," : "",
                       json_true(e, "measured") ? "" : "about ", ms < 10, ms,
                       json_figure(e, "block"), json_figure(e, "speedup"));
                any = true;
            }
        }
        printf("%s", any ? "\n" : "");
    }
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
    print_ms(json_figure(run, "frame_ms.cold"));
    print_ms(json_figure(run, "frame_ms.camera_moved"));
    print_ms(json_figure(run, "frame_ms.unchanged"));
    print_ms(json_figure(run, "setup_ms"));
    printf(" %8.1f\n",
           (json_figure(run, "memory.persistent") + json_figure(run, "memory.transient")) /
               (1 << 20));
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
    if (!isnan(json_figure(run, "flip"))) {
        printf(", flip %.4f", json_figure(run, "flip"));
    }
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
    const char *moved = json_text(list_of(list_of(scene, "moved"), "promise"), "text");
    if (moved[0]) {
        printf("  in frames after the camera has moved: %s\n", moved);
    }
    fflush(stdout);
}

// One line for each comparison that any scene has.
static void print_headlines(const cJSON *report, const char *name, const char *title)
{
    const cJSON *item;
    cJSON_ArrayForEach(item, list_of(report, name))
    {
        const double scenes = json_figure(item, "scenes");
        const double extrapolated = json_figure(item, "extrapolated");
        const cJSON *mean = list_of(item, "geometric_mean");
        if (!(scenes > 0) || !cJSON_IsRaw(mean)) {
            continue;
        }
        const double times = strtod(mean->valuestring, NULL);
        printf("%s%-16s %3.0f %% of %2.0f px: %s%.*f times as fast as %s (%.0f scenes", title,
               json_text(item, "method"), 100 * json_figure(item, "error"),
               json_figure(item, "block"), extrapolated > 0 ? "about " : "",
               times < 0.1 ? 3
               : times < 1 ? 2
                           : 1,
               times, json_text(item, "baseline"), scenes);
        printf(extrapolated > 0 ? ", %.0f of them extrapolated)\n" : ")\n", extrapolated);
        title = "";
    }
}

void bench_print_end(const cJSON *report)
{
    const cJSON *item;
    cJSON_ArrayForEach(item, list_of(report, "ratios"))
    {
        printf("\n%s, %s: %.2f times the cold frame\n", json_text(item, "name"),
               json_text(item, "run"), json_figure(item, "times"));
    }
    print_headlines(report, "headline", "\nat equal error, geometric means over scenes:\n");
    print_headlines(report, "headline_moved",
                    "\nthe same, with the times of frames after the camera has moved:\n");
}
