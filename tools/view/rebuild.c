// rebuild.c -- shaders that are edited while they are looked at: the build is run, and the viewer starts again.
#include "view/rebuild.h"
#include "view/viewer.h"
#include <cjson/cJSON.h>
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <tyndall/io.h>
#include <unistd.h>

static const double look_every = 0.7; // seconds
enum { MAX_ARGUMENTS = 256, MAX_DEPTH = 8 };

// ---- what is watched ----------------------------------------------------------------------------

static bool is_shader(const char *name)
{
    static const char *const ends[] = {".comp", ".vert", ".frag", ".glsl", ".h"};
    bool found = false;
    for (size_t i = 0; i < ARRAY_SIZE(ends); i++) {
        found = found || text_ends_with(name, ends[i]);
    }
    return found;
}

// Of names and times of the shaders in a folder, in whatever order they are listed.
static uint64_t stamp_of(const char *path, int depth)
{
    DIR *folder = depth < MAX_DEPTH ? opendir(path) : NULL;
    uint64_t stamp = 0;
    for (const struct dirent *e = folder ? readdir(folder) : NULL; e; e = readdir(folder)) {
        struct stat status;
        char *entry = e->d_name[0] == '.' ? NULL : text_format("%s/%s", path, e->d_name);
        if (entry && stat(entry, &status) == 0) {
            if (S_ISDIR(status.st_mode)) {
                stamp += stamp_of(entry, depth + 1);
            } else if (is_shader(entry)) {
                stamp += text_hash(&status.st_mtim, sizeof status.st_mtim,
                                   text_hash(entry, strlen(entry), 0));
            }
        }
        free(entry);
    }
    if (folder) {
        closedir(folder);
    }
    return stamp;
}

static uint64_t shaders_stamp(const viewer *v)
{
    uint64_t stamp = 0;
    static const char *const folders[] = {"passes", "shaders"};
    for (size_t i = 0; i < ARRAY_SIZE(folders); i++) {
        char *path = text_format("%s/%s", v->rebuild.source, folders[i]);
        stamp += path ? stamp_of(path, 0) : 0;
        free(path);
    }
    return stamp;
}

// Where the sources of a build folder are, as meson says.
static char *source_of(const char *build)
{
    char *path = text_format("%s/meson-info/meson-info.json", build);
    void *text = NULL;
    size_t size = 0;
    char *source = NULL;
    if (path && tyn_file_read(path, 1 << 20, &text, &size, NULL) == TYN_OK) {
        cJSON *json = cJSON_ParseWithLength(text, size);
        const cJSON *folders = cJSON_GetObjectItem(json, "directories");
        const char *named = cJSON_GetStringValue(cJSON_GetObjectItem(folders, "source"));
        source = named ? text_format("%s", named) : NULL;
        cJSON_Delete(json);
    }
    free(text);
    free(path);
    return source;
}

int rebuild_open(viewer *v)
{
    if (!v->args->rebuild) {
        return EXIT_DONE;
    }
    v->rebuild.source = source_of(v->args->rebuild);
    if (!v->rebuild.source) {
        app_error(v->app, "--rebuild: '%s' is no build folder of meson", v->args->rebuild);
        return EXIT_WRONG;
    }
    v->rebuild.stamp = shaders_stamp(v);
    return EXIT_DONE;
}

void rebuild_close(viewer *v)
{
    if (v->rebuild.ninja > 0) {
        waitpid(v->rebuild.ninja, NULL, 0);
    }
    free(v->rebuild.source);
}

// ---- building -----------------------------------------------------------------------------------

static void start_ninja(viewer *v)
{
    const pid_t child = fork();
    if (child == 0) {
        dup2(STDERR_FILENO, STDOUT_FILENO);
        execlp("ninja", "ninja", "-C", v->args->rebuild, "tools/tyndall", (char *)NULL);
        _exit(127);
    }
    v->rebuild.ninja = child > 0 ? child : 0;
    viewer_note(v, "a shader was written: building");
}

static void end_ninja(viewer *v)
{
    int status;
    if (waitpid(v->rebuild.ninja, &status, WNOHANG) != v->rebuild.ninja) {
        return;
    }
    v->rebuild.ninja = 0;
    v->rebuild.restart = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    if (!v->rebuild.restart) {
        viewer_note(v, "the shaders cannot be built; the terminal says why");
    }
}

void rebuild_step(viewer *v)
{
    rebuild *b = &v->rebuild;
    if (!b->source) {
        return;
    }
    if (b->ninja) {
        end_ninja(v);
    } else if (app_seconds() - b->last_look > look_every) {
        b->last_look = app_seconds();
        const uint64_t stamp = shaders_stamp(v);
        if (stamp != b->stamp) {
            b->stamp = stamp;
            start_ninja(v);
        }
    }
}

// ---- starting again -----------------------------------------------------------------------------

// What rebuild_arguments adds, so that it does not pile up.
static bool is_state(const char *argument)
{
    static const char *const names[] = {"--method=", "--quality=",   "--exposure=", "--size=",
                                        "--fov=",    "--look-from=", "--look-at="};
    bool found = false;
    for (size_t i = 0; i < ARRAY_SIZE(names); i++) {
        found = found || strncmp(argument, names[i], strlen(names[i])) == 0;
    }
    return found;
}

// The process's own arguments, the program first; gives their number.
static size_t own_arguments(char **list, size_t most)
{
    FILE *file = fopen("/proc/self/cmdline", "rb");
    size_t count = 0, size = 0;
    char *line = NULL;
    while (file && count < most && getdelim(&line, &size, '\0', file) > 0) {
        list[count] = is_state(line) ? NULL : text_format("%s", line);
        count += list[count] != NULL;
    }
    free(line);
    if (file) {
        fclose(file);
    }
    return count;
}

char **rebuild_arguments(const viewer *v)
{
    char **list = calloc(MAX_ARGUMENTS + 16, sizeof *list);
    if (!list) {
        return NULL;
    }
    size_t count = own_arguments(list, MAX_ARGUMENTS);
    const float *p = v->camera.camera.position, *t = v->camera.target;
    // Later options hold: these are where the viewer stands.
    list[count++] = text_format("--method=%s", v->method.info.name);
    list[count++] = text_format("--quality=%s", viewer_qualities[v->quality]);
    list[count++] = text_format("--exposure=%.9g", v->exposure);
    list[count++] = text_format("--size=%ux%u", v->view.width, v->view.height);
    list[count++] = text_format("--look-from=%.9g,%.9g,%.9g", p[0], p[1], p[2]);
    list[count++] = text_format("--look-at=%.9g,%.9g,%.9g", t[0], t[1], t[2]);
    if (v->camera.camera.projection == TYN_PERSPECTIVE) {
        list[count++] =
            text_format("--fov=%.9g", v->camera.camera.yfov * 180 / 3.14159265358979323846);
    }
    free(list[0]);
    list[0] = text_format("%s/tools/tyndall", v->args->rebuild);
    for (size_t i = 0; i < count; i++) {
        if (!list[i]) {
            return NULL;
        }
    }
    return list;
}

void rebuild_restart(char *const *arguments)
{
    execv(arguments[0], arguments);
}
