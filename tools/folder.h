// folder.h -- folders that outputs go to.
#pragma once
#include "app.h"

// Makes a folder and those above it; one that is there and can be written to stays as it is. `by` is what named
// it, for the message. Gives the exit code.
int folder_make(app *a, const char *by, const char *path);
