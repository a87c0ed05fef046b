// folder.c -- folders that outputs go to.
#include "folder.h"
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

// The folders above. Gives why one could not be made, or 0.
static int make_parents(char *path)
{
    int error = 0;
    for (char *p = strchr(path + (path[0] == '/'), '/'); p; p = strchr(p + 1, '/')) {
        *p = '\0';
        if (mkdir(path, 0777) != 0 && errno != EEXIST && error == 0) {
            error = errno;
        }
        *p = '/';
    }
    return error;
}

int folder_make(app *a, const char *by, const char *path)
{
    char *copy = text_format("%s", path);
    if (!copy) {
        return app_exit_code(a, TYN_ERR_MEMORY, false);
    }
    const int above = make_parents(copy);
    free(copy);
    struct stat status;
    const bool made = mkdir(path, 0777) == 0;
    const int error = above ? above : errno;
    const bool folder = made || (stat(path, &status) == 0 && S_ISDIR(status.st_mode));
    if (folder && access(path, W_OK) == 0) {
        return EXIT_DONE;
    }
    app_error(a, "%s: the folder '%s' %s: %s", by, path,
              folder ? "is not writable" : "cannot be made", strerror(folder ? errno : error));
    return EXIT_FAILED;
}
