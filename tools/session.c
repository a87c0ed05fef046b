// session.c -- what a subcommand that computes one thing about one scene holds.
#include "session.h"
#include <stdio.h>

static void say_who_can(app *a, const char *name, tyn_output output)
{
    char able[256] = "";
    size_t used = 0;
    for (uint32_t i = 0; i < tyn_num_methods(); i++) {
        tyn_method_info info;
        tyn_method_at(i, &info);
        if (info.outputs & output && used < sizeof able) {
            used += (size_t)snprintf(able + used, sizeof able - used, "%s %s", used ? "," : "",
                                     info.name);
        }
    }
    app_error(a, "--method: '%s' cannot do that yet; these can:%s", name, able);
}

int session_open(app *a, const scene_options *scene, const method_options *how, tyn_output output,
                 session *s)
{
    *s = (session){0};
    tyn_scene_init(&s->scene);
    int code = method_open(a, how, &s->method);
    if (code == EXIT_DONE && !(s->method.info.outputs & output)) {
        say_who_can(a, s->method.info.name, output);
        code = EXIT_WRONG;
    }
    if (code == EXIT_DONE) {
        code = scene_open(a, scene, &s->scene);
    }
    return code == EXIT_DONE ? scene_prepare(a, &s->method.info, &s->scene) : code;
}

int session_start(app *a, const machine_options *options, session *s)
{
    int code = machine_open(a, options, false, &s->machine);
    if (code == EXIT_DONE) {
        code = renderer_open(a, s->machine.device, &s->method, &s->renderer);
    }
    return code;
}

void session_close(session *s)
{
    renderer_close(&s->renderer);
    machine_close(&s->machine);
    tyn_scene_finish(&s->scene);
    method_finish(&s->method);
}
