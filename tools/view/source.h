// source.h -- where the scene comes from: the arguments, files that were dropped or written anew, a sequence.
#pragma once
#include <stdint.h>

typedef struct viewer viewer;
int source_open(viewer *v); // reads the scene of the arguments; gives the exit code
void source_close(viewer *v);
// A volume or scene in place of what is shown, or a map in place of the environment. What cannot be read is said, and
// what was shown stays.
void source_drop(viewer *v, const char *path);
void source_turn_to(viewer *v, uint32_t number); // a picture of a sequence
void source_step(viewer *v); // plays a sequence, reads files again that were written
