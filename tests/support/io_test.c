// io_test.c -- see io_test.h.
#include "io_test.h"
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char folder[64];

static void count(void *user, tyn_log_level level, const char *message)
{
    io_log *log = user;
    log->errors += level == TYN_LOG_ERROR;
    log->warnings += level == TYN_LOG_WARN;
    log->newlines += strchr(message, '\n') != NULL;
    snprintf(log->last, sizeof log->last, "%s", message);
}

void io_log_init(io_log *log)
{
    memset(log, 0, sizeof *log);
    log->log = (tyn_log){count, log, TYN_LOG_DEBUG};
}

const char *io_path(const char *name)
{
    static char paths[16][256];
    static int next;
    if (!folder[0]) {
        strcpy(folder, "/tmp/tyndall-test-XXXXXX");
        assert_non_null(mkdtemp(folder));
    }
    char *path = paths[next++ % 16];
    snprintf(path, sizeof paths[0], "%s/%s", folder, name);
    return path;
}

const char *io_put(const char *name, const void *data, size_t size)
{
    const char *path = io_path(name);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(data, 1, size, file), size);
    fclose(file);
    return path;
}

const char *io_put_text(const char *name, const char *text)
{
    return io_put(name, text, strlen(text));
}

int io_test_clean(void **state)
{
    (void)state;
    DIR *dir = folder[0] ? opendir(folder) : NULL;
    for (struct dirent *entry; dir && (entry = readdir(dir));) {
        unlink(io_path(entry->d_name));
    }
    if (dir) {
        closedir(dir);
        rmdir(folder);
    }
    folder[0] = 0;
    return 0;
}

const char *io_shared(const char *name)
{
    static char path[512];
    const char *root = getenv("TYN_SHARED");
    snprintf(path, sizeof path, "%s/%s", root && *root ? root : TYN_SHARED_DIR, name);
    return access(path, R_OK) == 0 ? path : NULL;
}
