// core.c -- the passes and methods of the library itself, as a module (tyndall/extend/plugin.h); and what comes before any
// method.
#define TYN_BUILT_IN tyn_built_in_core
#include <tyndall/extend/plugin.h>
#include "passes/passes.h"

#define ROW(name) &tyn_pass_##name,
static const tyn_pass_desc *const passes[] = {TYN_PASSES(ROW) NULL};

// The march ends at a depth of its own size.
static void halve_depth(tyn_graph *g, tyn_scene_refs *refs)
{
    const tyn_halve_depth_params params = {0};
    tyn_ref ports[HALVE_DEPTH_NUM_PORTS] = {[HALVE_DEPTH_PORT_FULL_DEPTH] = refs->depth};
    tyn_graph_add(g, &tyn_pass_halve_depth, &params, ports);
    refs->full_depth = refs->depth;
    refs->depth = ports[HALVE_DEPTH_PORT_HALF_DEPTH];
}

static void prepare(tyn_graph *g, tyn_job *job)
{
    if (job->refs.depth.resource && job->half_view) {
        halve_depth(g, &job->refs);
    }
    tyn_limits_warn(job, 0);
}

// The default first.
extern const tyn_method tyn_method_pop, tyn_method_single, tyn_method_path;
static const tyn_method *const methods[] = {&tyn_method_pop, &tyn_method_single, &tyn_method_path,
                                            NULL};

static const tyn_picture_hook core = {.name = "core", .prepare = prepare};
static const tyn_picture_hook *const hooks[] = {&core, NULL};

TYN_PLUGIN("core", "the library's own", passes, methods, hooks)
