// watch.h -- notices that one of a list of files was written.
#pragma once
#include <stdbool.h>
#include <stdint.h>

enum { WATCH_MAX_FILES = 64 };
typedef struct watch {
    struct {
        char *path;
        int64_t seconds, nanoseconds, size; // when it was written last; -1: it is not there
    } files[WATCH_MAX_FILES];
    uint32_t count;
    bool changed; // at the last look: it is told when a look finds no further change
} watch;

void watch_finish(watch *w);
void watch_add(watch *w, const char *path); // NULL: nothing
// A scene and the files that it names; `frame`: the picture of a sequence, NULL: none.
void watch_add_scene(watch *w, const char *path, const uint32_t *frame);
// True once after files have changed and are no longer being written.
bool watch_look(watch *w);
