// pass_time.c -- one pass alone on a device of our own, for its time.
#include <tyndall/offline.h>
#include "base/clock.h"
#include "base/fault.h"
#include "frame/submission.h"
#include "graph/graph.h"
#include <math.h>

// Declares the node, with the first thing it makes as what is wanted.
static tyn_result declare(tyn_graph *g, const tyn_pass_desc *pass, const void *params)
{
    tyn_ref refs[TYN_MAX_PORTS] = {0};
    tyn_graph_begin(g);
    tyn_graph_mode(g)->recompute = true;
    TYN_TRY(tyn_graph_add(g, pass, params, refs));
    for (uint32_t i = 0; i < pass->num_ports; i++) {
        if (pass->ports[i].dir == TYN_OUT && refs[i].resource) {
            tyn_graph_output(g, pass->ports[i].name, refs[i], false);
            break;
        }
    }
    return tyn_graph_status(g);
}

static tyn_result run(tyn_submission *s, tyn_graph *g, const tyn_pass_desc *pass,
                      const void *params, double *ms)
{
    TYN_TRY(declare(g, pass, params));
    if (!tyn_graph_matches(g)) {
        TYN_TRY(tyn_graph_compile(g));
    }
    TYN_TRY(tyn_submission_begin(s));
    TYN_TRY(tyn_graph_record(g, s->cmd));
    const double start = tyn_now_ms();
    TYN_TRY(tyn_submission_run(s, "running a pass"));
    *ms = tyn_now_ms() - start;
    const tyn_node_stats *stats;
    if (tyn_graph_stats(g, &stats) && stats->gpu_ms > 0) {
        *ms = stats->gpu_ms;
    }
    return TYN_OK;
}

tyn_result tyn_offline_time_pass(tyn_device *dev, const tyn_pass_desc *pass, const void *params,
                                 uint32_t runs, double *best_ms)
{
    *best_ms = NAN;
    if (!dev || !dev->queue || !pass || runs == 0) {
        return TYN_FAULT(
            dev ? &dev->log : NULL, TYN_ERR_PARAMS,
            "tyn_offline_time_pass needs a device from tyn_device_open, a pass, and runs > 0");
    }
    tyn_graph *graph = NULL;
    tyn_submission submission = {.dev = dev};
    tyn_result result = tyn_graph_create(dev, 1, &graph);
    if (result == TYN_OK) {
        result = tyn_submission_create(dev, &submission);
    }
    for (uint32_t i = 0; i < runs && result == TYN_OK; i++) {
        double ms = 0;
        result = run(&submission, graph, pass, params, &ms);
        if (result == TYN_OK) {
            *best_ms = i == 0 ? ms : fmin(*best_ms, ms);
        }
    }
    tyn_graph_destroy(&graph);
    tyn_submission_destroy(&submission);
    return result;
}
