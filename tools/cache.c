// cache.c -- where the tool keeps what it can make again.
#include "cache.h"
#include "app.h"
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

char *cache_path(const char *name)
{
    const char *base = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
    char *path = NULL;
    if (base && base[0] == '/') { // the XDG specification: relative paths are invalid
        path = text_format("%s/tyndall/%s", base, name);
    } else if (home && home[0] == '/') {
        path = text_format("%s/.cache/tyndall/%s", home, name);
    }
    for (char *p = path ? strchr(path + 1, '/') : NULL; p; p = strchr(p + 1, '/')) {
        *p = '\0';
        mkdir(path, 0700);
        *p = '/';
    }
    return path;
}
