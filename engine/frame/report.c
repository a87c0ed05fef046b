// report.c -- what happened in the last frame: times, work, counters, warnings, the graph.
#include "frame/context.h"
#include "registry/registry.h"
#include "gpu/device.h"
#include "shaders/common/light_sum.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const state_names[] = {"ran", "unchanged", "culled", "empty"};

static void add_work(tyn_node_report *node, const char *name, double amount)
{
    if (node->num_work < sizeof node->work / sizeof node->work[0]) {
        node->work[node->num_work].name = name;
        node->work[node->num_work++].amount = amount;
    }
}

// In percent to one digit: no more is known, and frames of a film say the same line.
static double percent_of(double share)
{
    const double percent = 100 * fmin(share, 1), unit = pow(10, floor(log10(percent)));
    return unit * round(percent / unit);
}

static double sum_of(const struct light_clamp *clamp, uint32_t first)
{
    double all = 0;
    for (int k = 0; k < TYN_LIGHT_SUM_BINS; k++) {
        all += ldexp(clamp->bins[first + (uint32_t)k], k - 135);
    }
    return all;
}

// Light that a clamp at 0 hid, of what it let through.
static double hidden_share(const struct light_clamp *clamp)
{
    const double hidden = sum_of(clamp, TYN_LIGHT_HIDDEN), shown = sum_of(clamp, TYN_LIGHT_SHOWN);
    return shown > 0 ? hidden / shown : hidden > 0 ? 1 : 0;
}

// NaN if one of them is, which fmax would drop.
static double larger(double a, double b)
{
    return isnan(a) || a > b ? a : b;
}

// What the node itself counted, by the table of its pass.
static void add_counters(tyn_node_report *node, tyn_context *ctx)
{
    const tyn_pass_desc *pass = tyn_pass_find(node->name);
    const uint8_t *data = tyn_graph_map(ctx->graph, node->name, NULL, NULL);
    for (const tyn_counter *c = pass && data ? pass->counters : NULL; c && c->name; c++) {
        double most = 0;
        for (uint32_t i = 0; i < (c->count ? c->count : 1); i++) {
            const void *at = data + c->offset + 4 * i;
            most = larger(most, c->clamp  ? hidden_share(at)
                                : c->real ? (double)*(const float *)at
                                          : *(const uint32_t *)at);
        }
        add_work(node, c->name, most);
        if (c->warning && isnan(most)) {
            char line[256];
            snprintf(line, sizeof line, "%s: '%s' is not a number", node->name, c->name);
            tyn_context_warn(ctx, line);
        } else if (c->warning && most > c->limit) {
            char line[256];
            snprintf(line, sizeof line, c->warning, percent_of(most));
            tyn_context_warn(ctx, line);
        }
    }
}

void tyn_context_report(tyn_context *ctx, tyn_report *report)
{
    if (report) {
        *report = (tyn_report){0};
    }
    if (!ctx || !report) {
        return;
    }
    const tyn_node_stats *stats;
    uint32_t count = tyn_graph_stats(ctx->graph, &stats);
    tyn_node_report *nodes = realloc(ctx->nodes, (count ? count : 1) * sizeof *nodes);
    if (!nodes) {
        return;
    }
    ctx->nodes = nodes;
    for (uint32_t i = 0; i < count; i++) {
        const tyn_node_stats *s = &stats[i];
        nodes[i] = (tyn_node_report){.name = s->name,
                                     .state = state_names[s->state],
                                     .gpu_ms = s->gpu_ms,
                                     .cpu_ms = s->cpu_ms,
                                     .dispatches = s->dispatches,
                                     .barriers = s->barriers,
                                     .bytes = s->bytes,
                                     .shared_bytes = s->shared_bytes,
                                     .media_only = s->media_only};
        for (uint32_t w = 0; w < s->num_work; w++) {
            if (!strcmp(s->work[w].name, "flops")) {
                nodes[i].flops = s->work[w].amount;
            } else {
                add_work(&nodes[i], s->work[w].name, s->work[w].amount);
            }
        }
        if (s->state != TYN_NODE_CULLED && !s->aid) {
            add_counters(&nodes[i], ctx);
        }
    }
    report->nodes = nodes;
    report->num_nodes = count;
    report->warnings = (const char *const *)ctx->warnings;
    report->num_warnings = ctx->num_warnings;
    tyn_graph_memory(ctx->graph, &report->persistent_bytes, &report->transient_bytes);
}

void tyn_context_inspect(tyn_context *ctx, const char *pass)
{
    if (ctx) {
        ctx->inspect = pass;
    }
}

bool tyn_context_inspection(tyn_context *ctx, tyn_inspection *inspection)
{
    if (inspection) {
        *inspection = (tyn_inspection){0};
    }
    if (!ctx || !inspection) {
        return false;
    }
    const tyn_pass_desc *pass = ctx->inspect ? tyn_pass_find(ctx->inspect) : NULL;
    tyn_extent extent = {0};
    const void *texels = tyn_graph_map(ctx->graph, "inspect", &extent, &inspection->format);
    if (!pass || !texels) {
        return false;
    }
    inspection->port = pass->ports[pass->debug_port].name;
    inspection->meaning = pass->debug_meaning;
    inspection->size[0] = extent.x;
    inspection->size[1] = extent.y;
    inspection->size[2] = extent.z ? extent.z : 1;
    inspection->texels = texels;
    return true;
}

char *tyn_context_graph(tyn_context *ctx, bool dot)
{
    return ctx ? tyn_graph_dump(ctx->graph, dot, ctx->method->info.passes) : NULL;
}
