// watch.c -- notices that one of a list of files was written.
#include "view/watch.h"
#include "app.h"
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <tyndall/io.h>

void watch_finish(watch *w)
{
    for (uint32_t i = 0; i < w->count; i++) {
        free(w->files[i].path);
    }
    *w = (watch){0};
}

static bool look_at(watch *w, uint32_t i)
{
    struct stat status;
    const bool there = stat(w->files[i].path, &status) == 0;
    const int64_t seconds = there ? (int64_t)status.st_mtim.tv_sec : -1;
    const int64_t nanoseconds = there ? (int64_t)status.st_mtim.tv_nsec : -1;
    const int64_t size = there ? (int64_t)status.st_size : -1;
    const bool same = seconds == w->files[i].seconds && nanoseconds == w->files[i].nanoseconds &&
                      size == w->files[i].size;
    w->files[i].seconds = seconds;
    w->files[i].nanoseconds = nanoseconds;
    w->files[i].size = size;
    return !same;
}

void watch_add(watch *w, const char *path)
{
    char *copy = path && w->count < WATCH_MAX_FILES ? text_format("%s", path) : NULL;
    if (copy) {
        w->files[w->count].path = copy;
        look_at(w, w->count++);
    }
}

static void add_found(void *user, const char *path)
{
    watch_add(user, path);
}

void watch_add_scene(watch *w, const char *path, const uint32_t *frame)
{
    const tyn_log nobody = {0}; // who reads the scene says what is wrong with it
    tyn_scene_files(path, frame, add_found, w, &nobody);
}

bool watch_look(watch *w)
{
    bool changing = false;
    for (uint32_t i = 0; i < w->count; i++) {
        changing = look_at(w, i) || changing;
    }
    const bool done = w->changed && !changing;
    w->changed = changing || (w->changed && !done);
    return done;
}
