// cmd_graph.c -- `tyndall graph`: the compiled render graph of a scene.
#include "output.h"
#include "session.h"
#include "slice.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct graph_args {
    scene_options scene;
    view_options view;
    method_options method;
    machine_options machine;
    const char *node, *output;
    bool dot;
} graph_args;

static bool has_pass(app *a, const tyn_method_info *info, const char *name)
{
    char known[512] = "";
    size_t used = 0;
    for (const tyn_pass_desc *const *pass = info->passes; *pass; pass++) {
        if (strcmp((*pass)->name, name) == 0) {
            return true;
        }
        if (used < sizeof known) {
            used += (size_t)snprintf(known + used, sizeof known - used, "%s %s", used ? "," : "",
                                     (*pass)->name);
        }
    }
    app_error(a, "--view: method '%s' has no pass '%s'; it has:%s", info->name, name, known);
    return false;
}

// --view: computes a frame and draws what one pass made.
static int view_pass(app *a, const graph_args *args, const tyn_view *view, session *s)
{
    tyn_view drawn = *view;
    // Outputs that need the pass, as far as the method makes them.
    drawn.outputs |= s->method.info.outputs & (TYN_OUTPUT_DISPLAY | TYN_OUTPUT_ERROR);
    tyn_context *context = tyn_offline_context(s->renderer.offline);
    tyn_context_inspect(context, args->node);
    int code = renderer_frame(a, &s->renderer, &s->scene, &drawn, false, s->method.info.name);
    if (code != EXIT_DONE) {
        return code;
    }
    tyn_inspection inspection;
    if (!tyn_context_inspection(context, &inspection)) {
        app_error(a, "--view: pass '%s' makes no image for this scene", args->node);
        return EXIT_WRONG;
    }
    return slice_write(a, &inspection, args->output);
}

// Compiles without computing anything.
static int print_graph(app *a, const graph_args *args, const tyn_view *view, session *s)
{
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
    if ((args->node != NULL) != (args->output != NULL) ||
        (args->output && !text_ends_with(args->output, ".png"))) {
        app_error(a, "--view PASS and -o FILE.png go together");
        return EXIT_WRONG;
    }
    tyn_view view = {.outputs = TYN_OUTPUT_RADIANCE};
    method_view(&args->method, &view);
    session s;
    int code = session_open(a, &args->scene, &args->method, TYN_OUTPUT_RADIANCE, &s);
    if (code == EXIT_DONE) {
        code = view_setup(a, &args->view, &s.scene, &view);
    }
    if (code == EXIT_DONE && args->node && !has_pass(a, &s.method.info, args->node)) {
        code = EXIT_WRONG;
    }
    if (code == EXIT_DONE && args->output && !output_folder_is_writable(a, args->output)) {
        code = EXIT_FAILED;
    }
    if (code == EXIT_DONE) {
        code = session_start(a, &args->machine, &s);
    }
    if (code == EXIT_DONE) {
        code = args->node ? view_pass(a, args, &view, &s) : print_graph(a, args, &view, &s);
    }
    session_close(&s);
    return code;
}

static const opt_positional positionals[] = {SCENE_POSITIONALS(graph_args, scene)};

#define AT(field) offsetof(graph_args, field)
static const option graph_table[] = {
    {0, "dot", OPT_FLAG, AT(dot), NULL, "for Graphviz: tyndall graph SCENE --dot | dot -Tsvg"},
    {0, "view", OPT_TEXT, AT(node), "PASS",
     "draw the middle slice of what a pass made (its debug view in 'tyndall info --passes')"},
    {'o', "output", OPT_TEXT, AT(output), "FILE.png", "where --view is drawn", .file = OPT_WRITES},
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
