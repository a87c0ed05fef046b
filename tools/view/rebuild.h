// rebuild.h -- shaders that are edited while they are looked at: the build is run, and the viewer starts again.
//
// Kernels are part of the library, so a new kernel is a new library: the viewer hands its state to a new process image.
#pragma once
#include <stdbool.h>
#include <stdint.h>
#include <sys/types.h>

typedef struct viewer viewer;
typedef struct rebuild {
    char *source;   // folder of the sources; NULL: it was not asked for
    uint64_t stamp; // of the shaders as they were built last
    pid_t ninja;    // 0: it does not run
    double last_look;
    bool restart; // it succeeded: the loop ends
} rebuild;

int rebuild_open(viewer *v); // gives the exit code
void rebuild_close(viewer *v);
void rebuild_step(viewer *v);
// Starts the program again where the viewer stands; returns only if that fails.
void rebuild_restart(char *const *arguments);
// The arguments for it: a new NULL-terminated list of new strings; NULL: out of memory.
char **rebuild_arguments(const viewer *v);
