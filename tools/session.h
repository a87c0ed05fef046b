// session.h -- what a subcommand that computes one thing about one scene holds.
#pragma once
#include "renderer.h"
#include "scene_setup.h"

typedef struct session {
    method method;
    tyn_scene scene;
    machine machine;
    renderer renderer;
} session;

// Finds the method, which must be able to make `output`, and loads the scene. Gives the exit code;
// session_close is due in any case, and after session_open alone the renderer is not there yet.
int session_open(app *a, const scene_options *scene, const method_options *how, tyn_output output,
                 session *s);
int session_start(app *a, const machine_options *options, session *s); // device and renderer
void session_close(session *s);
