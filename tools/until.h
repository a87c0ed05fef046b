// until.h -- --until: samples are added until a picture's own estimate of its error is small enough.
#pragma once
#include "app.h"
#include "method_setup.h"
#include "renderer.h"

// "1%" or "0.01" into *error. False: said.
bool until_parse(app *a, const char *text, float *error);

// The method that is meant where none is said, and what it takes to reach the error. Before method_open.
void until_method(float error, method_options *how);
// The method tells its error, and more samples make it smaller.
bool until_tells(const tyn_method_info *info);
// False: it does not; said.
bool until_check(app *a, const tyn_method_info *info, const char *text);

// Renders at most view->num_samples samples. *samples: how many; *ms: of all of them. Gives the exit code; a line says
// what was reached.
int until_render(app *a, renderer *r, const tyn_scene *scene, const tyn_view *view, float error,
                 const char *label, uint32_t *samples);
