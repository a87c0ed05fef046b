// file.c -- whole files in and out; a written file appears under its name only when it is complete.
#include <tyndall/io.h>
#include "base/given.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

tyn_result tyn_file_read(const char *path, uint64_t limit, void **data, size_t *size,
                         const tyn_log *log)
{
    struct stat info;
    if (!TYN_GIVEN(log, path, data, size)) {
        return TYN_ERR_PARAMS;
    }
    *data = NULL;
    *size = 0;
    FILE *file = fopen(path, "rb");
    if (!file || fstat(fileno(file), &info) != 0) {
        tyn_log_print(log, TYN_LOG_ERROR, "%s: cannot be opened: %s", path, strerror(errno));
        if (file) {
            fclose(file);
        }
        return TYN_ERR_IO;
    }
    if (!S_ISREG(info.st_mode)) {
        tyn_log_print(log, TYN_LOG_ERROR, "%s: is not a regular file", path);
        fclose(file);
        return TYN_ERR_IO;
    }
    uint64_t length = (uint64_t)info.st_size;
    if (length > limit) {
        tyn_log_print(log, TYN_LOG_ERROR, "%s: has %llu bytes, at most %llu are read", path,
                      (unsigned long long)length, (unsigned long long)limit);
        fclose(file);
        return TYN_ERR_PARAMS;
    }
    char *bytes = malloc((size_t)length + 1);
    if (!bytes) {
        tyn_log_print(log, TYN_LOG_ERROR, "%s: no memory for its %llu bytes", path,
                      (unsigned long long)length);
        fclose(file);
        return TYN_ERR_MEMORY;
    }
    size_t got = fread(bytes, 1, (size_t)length, file);
    fclose(file);
    if (got != length) {
        tyn_log_print(log, TYN_LOG_ERROR, "%s: only %zu of %llu bytes could be read", path, got,
                      (unsigned long long)length);
        free(bytes);
        return TYN_ERR_IO;
    }
    bytes[length] = 0; // text may be read as a string
    *data = bytes;
    *size = got;
    return TYN_OK;
}

tyn_result tyn_file_write(const char *path, const void *data, size_t size, const tyn_log *log)
{
    if (!TYN_GIVEN(log, path) || (size && !TYN_GIVEN(log, data))) {
        return TYN_ERR_PARAMS;
    }
    size_t length = strlen(path);
    char *temporary = malloc(length + 8);
    if (!temporary) {
        tyn_log_print(log, TYN_LOG_ERROR, "%s: no memory to write it", path);
        return TYN_ERR_MEMORY;
    }
    memcpy(temporary, path, length);
    memcpy(temporary + length, ".XXXXXX", 8);
    int fd = mkstemp(temporary);
    FILE *file = fd < 0 ? NULL : fdopen(fd, "wb");
    bool ok = file && fwrite(data, 1, size, file) == size;
    int error = errno;
    if (file) {
        mode_t mask = umask(0); // what open() would have given; mkstemp is private
        umask(mask);
        ok = fchmod(fd, 0666 & ~mask) == 0 && ok;
        if (fclose(file) != 0) {
            error = errno;
            ok = false;
        }
    } else if (fd >= 0) {
        close(fd);
    }
    if (ok && rename(temporary, path) != 0) {
        error = errno;
        ok = false;
    }
    if (!ok) {
        tyn_log_print(log, TYN_LOG_ERROR, "%s: cannot be written: %s", path, strerror(error));
        if (fd >= 0) {
            unlink(temporary);
        }
    }
    free(temporary);
    return ok ? TYN_OK : TYN_ERR_IO;
}
