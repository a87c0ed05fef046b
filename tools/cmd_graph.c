// cmd_graph.c -- `tyndall graph`: the compiled render graph of a scene.
#include "session.h"
#include <stdio.h>
#include <stdlib.h>

typedef struct graph_args {
    scene_options scene;
    view_options view;
    method_options method;
    machine_options machine;
    bool dot;
} graph_args;

// Compiles without computing anything.
static int print_graph(app *a, const graph_args *args, const tyn_view *view, session *s)
{
    int code = session_start(a, &args->machine, s);
    if (code != EXIT_DONE) {
        return code;
    }
    tyn_context *context = tyn_offline_context(s->renderer.offline);
    tyn_result result = tyn_context_prepare(context, tyn_frame(.scene = &s->scene, .view = view));
    if (result != TYN_OK) {
        return app_exit_code(a, result, true);
    }
    char *text = tyn_context_graph(context, args->dot);
    if (!text) {
        return app_exit_code(a, TYN_ERR_MEMORY, false);
    }
    fputs(text, stdout);
    free(text);
    return EXIT_DONE;
}

static int run_graph(app *a, const void *arguments)
{
    const graph_args *args = arguments;
    a->quiet = args->machine.quiet;
    tyn_view view = {.outputs = TYN_OUTPUT_RADIANCE};
    method_view(&args->method, &view);
    session s;
    int code = session_open(a, &args->scene, &args->method, TYN_OUTPUT_RADIANCE, &s);
    if (code == EXIT_DONE) {
        code = view_setup(a, &args->view, &s.scene, &view);
    }
    if (code == EXIT_DONE) {
        code = print_graph(a, args, &view, &s);
    }
    session_close(&s);
    return code;
}

static const opt_positional positionals[] = {SCENE_POSITIONALS(graph_args, scene)};

#define AT(field) offsetof(graph_args, field)
static const option graph_table[] = {
    {0, "dot", OPT_FLAG, AT(dot), NULL, "for Graphviz: tyndall graph SCENE --dot | dot -Tsvg"},
};
static const opt_group groups[] = {
    {"graph", graph_table, ARRAY_SIZE(graph_table), 0},
    {"method", method_table, METHOD_TABLE_SIZE, AT(method)},
    {"view", view_table, VIEW_TABLE_SIZE, AT(view)},
    {"scene", scene_table, SCENE_TABLE_SIZE, AT(scene)},
    {"machine", machine_table, MACHINE_TABLE_SIZE, AT(machine)},
};

const command cmd_graph = {
    .name = "graph",
    .summary = "The compiled graph: nodes, resources, barriers, what is culled and why.",
    .positionals = positionals,
    .num_positionals = ARRAY_SIZE(positionals),
    .groups = groups,
    .num_groups = ARRAY_SIZE(groups),
    .args_size = sizeof(graph_args),
    .run = run_graph,
};
