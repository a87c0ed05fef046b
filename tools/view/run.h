// run.h -- the viewer, or what says that there is none.
#pragma once
#include "view/view_args.h"

int viewer_run(app *a, const view_args *args); // gives the exit code
