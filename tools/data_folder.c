// data_folder.c -- see data_folder.h.
#include "data_folder.h"
#include "app.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

char *data_folder_scenes(void)
{
    static const char *const places[] = {"../samples/scenes", "../share/tyndall/scenes"};
    char program[4096];
    const ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    char *slash = NULL, *path = NULL;
    if (length > 0) {
        program[length] = '\0';
        slash = strrchr(program, '/');
    }
    for (size_t i = 0; i < ARRAY_SIZE(places); i++) {
        struct stat info;
        free(path);
        path = text_format("%.*s/%s", slash ? (int)(slash - program) : 1, slash ? program : ".",
                           places[i]);
        if (path && stat(path, &info) == 0 && S_ISDIR(info.st_mode)) {
            return path;
        }
    }
    return path;
}
