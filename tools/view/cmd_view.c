// cmd_view.c -- `tyndall view`: a window on a scene.
#include "view/run.h"

static int run_view(app *a, const void *arguments)
{
    const view_args *args = arguments;
    a->quiet = args->machine.quiet;
    return viewer_run(a, args);
}

static const opt_positional positionals[] = {SCENE_POSITIONALS(view_args, scene)};

#define AT(field) offsetof(view_args, field)
static const option window_table[] = {
    {0, "exposure", OPT_NUMBER, AT(exposure), "EV", "of the picture", 0, -64, 64},
    {0, "target-ms", OPT_NUMBER, AT(target_ms), "MS",
     "what a picture may take while something moves; it is made smaller to fit", 60, 1, 10000},
    {0, "orbit", OPT_FLAG, AT(orbit), NULL, "the camera turns about the scene, as by key O"},
    {0, "no-panel", OPT_FLAG, AT(no_panel), NULL, "start without the panel, as by key H"},
    {0, "busy", OPT_FLAG, AT(busy), NULL,
     "draw the window also where nothing changes, to measure what that takes"},
    {0, "frames", OPT_TEXT, AT(frames), "A-B",
     "a sequence that is played, %04d or #### in names; space, comma and full stop step it"},
    {0, "fps", OPT_NUMBER, AT(fps), "N", "pictures of the sequence a second", 24, 0.01, 1000},
    {'o', "output", OPT_TEXT, AT(output), "STEM",
     "where key S saves: STEM-1.exr, STEM-1.gltf, and so on; else the scene's name"},
    {0, "rebuild", OPT_TEXT, AT(rebuild), "BUILD",
     "when a shader of this build folder is written, run ninja there and start again in place"},
    {0, "seconds", OPT_NUMBER, AT(seconds), "S", "close the window after that time; 0 = stay", 0, 0,
     1e6},
    {0, "stats", OPT_TEXT, AT(stats), "FILE.json",
     "at the end: pictures a second while moving and at rest", .file = OPT_WRITES},
    {0, "validate", OPT_FLAG, AT(validate), NULL,
     "with Vulkan's validation and synchronization validation; exit 1 if a message came"},
};
static const opt_group groups[] = {
    {"window", window_table, ARRAY_SIZE(window_table), 0},
    {"method", method_table, METHOD_TABLE_SIZE, AT(method)},
    {"view", view_table, VIEW_TABLE_SIZE, AT(view)},
    {"scene", scene_table, SCENE_TABLE_SIZE, AT(scene)},
    {"machine", machine_table, MACHINE_TABLE_SIZE, AT(machine)},
};

const command cmd_view = {
    .name = "view",
    .summary = "Look at a scene in a window: move, light and compare it live.",
    .details =
        "Mouse: drag orbits, with shift or the middle button pans, with control or the wheel "
        "dollies; the\n"
        "right button looks around, and W A S D fly meanwhile. docs/viewer.md lists the keys.",
    .positionals = positionals,
    .num_positionals = ARRAY_SIZE(positionals),
    .groups = groups,
    .num_groups = ARRAY_SIZE(groups),
    .args_size = sizeof(view_args),
    .run = run_view,
};
