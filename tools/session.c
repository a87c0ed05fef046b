// session.c -- what a subcommand that computes one thing about one scene holds.
#include "session.h"

int session_open(app *a, const scene_options *scene, const method_options *how, tyn_output output,
                 session *s)
{
    *s = (session){0};
    tyn_scene_init(&s->scene);
    int code = method_open(a, how, &s->method);
    if (code == EXIT_DONE && !(s->method.info.outputs & output)) {
        app_error(a, "--method: '%s' cannot do that", s->method.info.name);
        code = EXIT_WRONG;
    }
    return code == EXIT_DONE ? scene_open(a, scene, &s->scene) : code;
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
