// cmd_view.c -- `tyndall view`: the interactive viewer has not come yet, and says so.
#include "app.h"

typedef struct view_args {
    const char *scene;
} view_args;

static int run_view(app *a, const void *arguments)
{
    (void)arguments;
    app_error(a,
              "the interactive viewer comes with a later version; 'tyndall render' makes pictures");
    return EXIT_WRONG;
}

static const opt_positional positionals[] = {
    {"SCENE", "a .gltf or .glb scene, or a volume", false, offsetof(view_args, scene)},
};

const command cmd_view = {
    .name = "view",
    .summary = "The interactive viewer (comes with a later version).",
    .positionals = positionals,
    .num_positionals = ARRAY_SIZE(positionals),
    .args_size = sizeof(view_args),
    .run = run_view,
};
