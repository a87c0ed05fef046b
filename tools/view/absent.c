// absent.c -- stands for the viewer where it is not built.
#include "app.h"
#include "view/view_args.h"
#include "view/run.h"

int viewer_run(app *a, const view_args *args)
{
    (void)args;
    app_error(a, "this build has no viewer: it was made without GLFW 3 and Dear ImGui (Debian's "
                 "libglfw3-dev and "
                 "libimgui-dev; meson option 'viewer')");
    return EXIT_WRONG;
}
