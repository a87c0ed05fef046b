// print.c -- results of the bench for people and for programs.
#include "bench.h"
#include "stats.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

// ---- for people -------------------------------------------------------------------------------

static void print_ms(double ms)
{
    if (isnan(ms)) {
        printf(" %8s", "-");
    } else {
        printf(" %8.*f", ms < 10 ? 2 : ms < 100 ? 1 : 0, ms);
    }
}

void bench_print_scene(const bench_case *c)
{
    const bench_reference *r = &c->reference;
    printf("\n%s, %ux%u", c->spec->name, c->view.width, c->view.height);
    if (!isnan(c->fill)) {
        printf(", %.0f %% of it medium", 100 * c->fill);
    }
    printf(", reference %u samples (its noise: %.2f %% per pixel, %.2f %% per %ux%u block)",
           c->spec->reference_spp, 100 * r->noise[1], 100 * r->noise[0], c->blocks[0],
           c->blocks[0]);
    if (r->seconds > 0) {
        printf(", %.0f s", r->seconds);
    }
    printf("\n%-20s %8s %8s %8s %8s %8s %8s %8s\n", "", "error", "error", "cold", "camera", "same",
           "set-up", "memory");
    printf("%-20s %5u px %8s %8s %8s %8s %8s %8s\n", "", c->blocks[0], "1 px", "ms", "ms", "ms",
           "ms", "MiB");
}

// "path 812 ms, 15.2 times as long": one line per baseline.
static void print_equal(const bench_case *c, const bench_result *result)
{
    for (uint32_t i = 0; i < c->suite->num_baselines; i++) {
        printf("    %-20s needs for the same error", c->suite->baselines[i].name);
        for (int k = 0; k < BENCH_BLOCKS; k++) {
            const bench_equal *e = &result->equal[i][k];
            if (e->ms > 0) {
                printf("%s %s%.*f ms on %u px (%.1f times)", k ? "," : "",
                       e->measured ? "" : "about ", e->ms < 10, e->ms, c->blocks[k],
                       e->ms / result->cold_ms);
            }
        }
        printf("\n");
    }
}

static void print_nodes(const bench_result *result, bool setup, const char *title)
{
    for (uint32_t i = 0; i < result->num_nodes; i++) {
        const bench_node *n = &result->nodes[i];
        if (n->setup != setup || !(n->gpu_ms > 0)) {
            continue;
        }
        printf("%s %s %.*f", title, n->name, n->gpu_ms < 10 ? 2 : 1, n->gpu_ms);
        title = "";
        if (n->steps > 0) {
            printf(" (%.1f ns a step)", 1e6 * n->gpu_ms / n->steps);
        }
    }
}

void bench_print_result(const bench_case *c, const bench_run *run, const bench_result *result)
{
    if (result->failed) {
        printf("%-20s cannot do this scene\n", run->name);
        return;
    }
    printf("%-20s", run->name);
    for (int k = 0; k < BENCH_BLOCKS; k++) {
        // An error near the noise of the reference is a small difference of large numbers.
        bool vague = result->error[k].error < 2 * c->reference.noise[k];
        printf(" %s%5.2f %%", vague ? "~" : " ", 100 * result->error[k].error);
    }
    print_ms(result->cold_ms);
    print_ms(result->camera_ms);
    print_ms(result->unchanged_ms);
    print_ms(result->setup_ms);
    printf(" %8.1f\n", (double)(result->persistent + result->transient) / (1 << 20));
    print_nodes(result, false, "    nodes, ms:");
    print_nodes(result, true, "; set-up:");
    printf("\n    camera moved, unchanged:");
    for (uint32_t i = 0; i < result->num_nodes; i++) {
        if (!result->nodes[i].setup && strcmp(result->nodes[i].state, "unchanged") == 0) {
            printf(" %s", result->nodes[i].name);
        }
    }
    printf("\n");
    print_equal(c, result);
    fflush(stdout);
}

// ---- for programs -----------------------------------------------------------------------------

cJSON *bench_json_scene(const bench_case *c)
{
    cJSON *scene = cJSON_CreateObject();
    const int size[2] = {(int)c->view.width, (int)c->view.height};
    cJSON_AddStringToObject(scene, "name", c->spec->name);
    cJSON_AddItemToObject(scene, "size", cJSON_CreateIntArray(size, 2));
    json_add_float(scene, "fill", c->fill);
    cJSON *reference = cJSON_AddObjectToObject(scene, "reference");
    cJSON_AddNumberToObject(reference, "spp", c->spec->reference_spp);
    json_add_float(reference, "seconds", c->reference.seconds > 0 ? c->reference.seconds : NAN);
    json_add_float(reference, "n_block", c->reference.noise[0]);
    json_add_float(reference, "n_pixel", c->reference.noise[1]);
    return scene;
}

static cJSON *json_errors(uint32_t block, const metrics *m)
{
    cJSON *error = cJSON_CreateObject();
    cJSON_AddNumberToObject(error, "block", block);
    json_add_float(error, "error", m->error);
    json_add_float(error, "rel_l1", m->rel_l1);
    json_add_float(error, "n", m->n);
    json_add_float(error, "rel_rmse", m->rel_rmse);
    json_add_float(error, "rel_mse", m->rel_mse);
    json_add_float(error, "bias", m->bias);
    json_add_float(error, "p95", m->p95);
    cJSON_AddNumberToObject(error, "nan", (double)m->nan);
    return error;
}

static cJSON *json_nodes(const bench_result *result)
{
    cJSON *nodes = cJSON_CreateArray();
    for (uint32_t i = 0; i < result->num_nodes; i++) {
        const bench_node *n = &result->nodes[i];
        cJSON *node = cJSON_CreateObject();
        cJSON_AddStringToObject(node, "name", n->name);
        json_add_float(node, "gpu_ms", n->gpu_ms);
        cJSON_AddBoolToObject(node, "setup", n->setup);
        cJSON_AddNumberToObject(node, "bytes", (double)n->bytes);
        if (n->steps > 0) {
            cJSON_AddNumberToObject(node, "steps", n->steps);
            json_add_float(node, "ns_per_step", 1e6 * n->gpu_ms / n->steps);
        }
        cJSON_AddStringToObject(node, "state_after_camera_moved", n->state);
        cJSON_AddItemToArray(nodes, node);
    }
    return nodes;
}

static cJSON *json_equal(const bench_case *c, const bench_result *result)
{
    cJSON *list = cJSON_CreateArray();
    for (uint32_t i = 0; i < c->suite->num_baselines; i++) {
        for (int k = 0; k < BENCH_BLOCKS; k++) {
            const bench_equal *e = &result->equal[i][k];
            cJSON *equal = cJSON_CreateObject();
            cJSON_AddStringToObject(equal, "baseline", c->suite->baselines[i].name);
            cJSON_AddNumberToObject(equal, "block", c->blocks[k]);
            json_add_float(equal, "spp", e->spp);
            json_add_float(equal, "ms", e->ms);
            json_add_float(equal, "times_cold", e->ms / result->cold_ms);
            cJSON_AddBoolToObject(equal, "measured", e->measured);
            cJSON_AddItemToArray(list, equal);
        }
    }
    return list;
}

cJSON *bench_json_result(const bench_case *c, const bench_run *run, const bench_result *result)
{
    cJSON *json = cJSON_CreateObject();
    cJSON_AddStringToObject(json, "name", run->name);
    cJSON_AddItemToObject(json, "spec", cJSON_Duplicate(run->json, true));
    cJSON_AddBoolToObject(json, "failed", result->failed);
    if (result->failed) {
        return json;
    }
    cJSON *errors = cJSON_AddArrayToObject(json, "errors");
    for (int i = 0; i < BENCH_BLOCKS; i++) {
        cJSON_AddItemToArray(errors, json_errors(c->blocks[i], &result->error[i]));
    }
    json_add_float(json, "setup_ms", result->setup_ms);
    cJSON *frame = cJSON_AddObjectToObject(json, "frame_ms");
    json_add_float(frame, "cold", result->cold_ms);
    json_add_float(frame, "camera_moved", result->camera_ms);
    json_add_float(frame, "unchanged", result->unchanged_ms);
    cJSON *memory = cJSON_AddObjectToObject(json, "memory");
    cJSON_AddNumberToObject(memory, "persistent", (double)result->persistent);
    cJSON_AddNumberToObject(memory, "transient", (double)result->transient);
    cJSON_AddItemToObject(json, "nodes", json_nodes(result));
    cJSON_AddItemToObject(json, "equal_error", json_equal(c, result));
    return json;
}
