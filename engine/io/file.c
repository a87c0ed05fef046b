// file.c -- whole files in. Only regular files are opened: others would be waited for, or never end.
#include "io/file.h"
#include "base/given.h"
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

static const char *kind_of(mode_t mode)
{
    return S_ISDIR(mode)    ? "a folder"
           : S_ISFIFO(mode) ? "a FIFO"
           : S_ISSOCK(mode) ? "a socket"
                            : "a device";
}

// Gives a descriptor and the size in bytes, or -1 after a line.
static int open_regular(const char *path, uint64_t limit, uint64_t *size, tyn_result *result,
                        const tyn_log *log)
{
    struct stat info;
    *result = TYN_ERR_IO;
    // Looked at before it is opened, as opening alone waits for a FIFO and changes some devices; and after, as it may be
    // another by then.
    bool there = stat(path, &info) == 0;
    int fd = there && S_ISREG(info.st_mode) ? open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC) : -1;
    if (fd >= 0 ? fstat(fd, &info) != 0 : !there || S_ISREG(info.st_mode)) {
        tyn_log_print(log, TYN_LOG_ERROR, "%s: cannot be opened: %s", path, strerror(errno));
        if (fd >= 0) {
            close(fd);
        }
        return -1;
    }
    *size = (uint64_t)info.st_size;
    if (!S_ISREG(info.st_mode)) {
        tyn_log_print(log, TYN_LOG_ERROR, "%s: is %s: must be a regular file", path,
                      kind_of(info.st_mode));
    } else if (*size > limit) {
        *result = TYN_FAULT(log, TYN_ERR_PARAMS, "%s: has %llu bytes, at most %llu are read", path,
                            (unsigned long long)*size, (unsigned long long)limit);
    } else {
        *result = TYN_OK;
        return fd;
    }
    if (fd >= 0) {
        close(fd);
    }
    return -1;
}

// Gives how many bytes there were.
static size_t read_all(int fd, char *bytes, size_t size)
{
    size_t got = 0;
    while (got < size) {
        const ssize_t n = read(fd, bytes + got, size - got);
        if (n == 0 || (n < 0 && errno != EINTR)) {
            break;
        }
        got += n > 0 ? (size_t)n : 0;
    }
    return got;
}

tyn_result tyn_file_read(const char *path, uint64_t limit, void **data, size_t *size,
                         const tyn_log *log)
{
    tyn_result r;
    uint64_t length;
    if (!TYN_GIVEN(log, path, data, size)) {
        return TYN_ERR_PARAMS;
    }
    *data = NULL;
    *size = 0;
    int fd = open_regular(path, limit, &length, &r, log);
    if (fd < 0) {
        return r;
    }
    char *bytes = malloc((size_t)length + 1);
    if (!bytes) {
        close(fd);
        return TYN_FAULT(log, TYN_ERR_MEMORY, "%s: no memory for its %llu bytes", path,
                         (unsigned long long)length);
    }
    size_t got = read_all(fd, bytes, (size_t)length);
    close(fd);
    if (got != length) {
        free(bytes);
        return TYN_FAULT(log, TYN_ERR_IO, "%s: only %zu of %llu bytes could be read", path, got,
                         (unsigned long long)length);
    }
    bytes[length] = 0; // text may be read as a string
    *data = bytes;
    *size = got;
    return TYN_OK;
}

tyn_result tyn_file_map(const char *path, uint64_t limit, const void **bytes, size_t *size,
                        const tyn_log *log)
{
    tyn_result r;
    uint64_t length;
    int fd = open_regular(path, limit, &length, &r, log);
    if (fd < 0) {
        return r;
    }
    *size = (size_t)length;
    *bytes = NULL; // of no bytes there is no mapping
    void *mapping = length ? mmap(NULL, (size_t)length, PROT_READ, MAP_PRIVATE, fd, 0) : NULL;
    int error = errno;
    close(fd);
    if (mapping == MAP_FAILED) {
        return TYN_FAULT(log, TYN_ERR_IO, "%s: cannot be read: %s", path, strerror(error));
    }
    *bytes = mapping;
    return TYN_OK;
}

void tyn_file_unmap(const void *bytes, size_t size)
{
    if (size) {
        munmap((void *)(uintptr_t)bytes, size);
    }
}
