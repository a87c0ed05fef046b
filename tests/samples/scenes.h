// scenes.h -- what the tests of the sample scenes share.
#pragma once
#include <tyndall/scene.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

// Prints warnings and errors.
extern const tyn_log scenes_log;

// Takes the folder of the scenes from the command line, "PROGRAM FOLDER"; false: that is not what it is.
bool scenes_folder(int argc, char **argv);

// NAME.gltf of that folder, valid and without warnings; else the test fails.
tyn_scene scenes_load(const char *name);
