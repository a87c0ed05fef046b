// file_write.c -- whole files out: a regular file appears under its name only when it is complete; what is none, a
// device or a descriptor such as /dev/stdout, is written to. Links are followed and stay.
#include <tyndall/io.h>
#include "base/given.h"
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { MAX_LINKS = 40, TEMPORARY_TRIES = 1000 };

// ---- where a name leads -----------------------------------------------------------------------

// The folder of a path, with the slash: its length.
static size_t folder_length(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? (size_t)(slash - path) + 1 : 0;
}

// The descriptor that a name of one stands for, or -1.
static int descriptor_of(const char *path)
{
    static const char *const folders[] = {"/proc/self/fd/", "/dev/fd/"};
    for (size_t i = 0; i < 2; i++) {
        const size_t length = strlen(folders[i]);
        const char *number = path + length;
        if (strncmp(path, folders[i], length) == 0 && *number >= '0' && *number <= '9' &&
            strspn(number, "0123456789") == strlen(number) && strlen(number) < 9) {
            return atoi(number);
        }
    }
    return -1;
}

// What a path leads to by way of links, which need not be there yet; a new string, NULL and errno where there is none.
static char *follow(const char *path)
{
    char *at = strdup(path);
    for (int links = 0; at && descriptor_of(at) < 0; links++) {
        char next[PATH_MAX];
        const ssize_t length = readlink(at, next, sizeof next - 1);
        if (length < 0) {
            return at; // no link, or nothing yet
        }
        next[length] = '\0';
        const int folder = next[0] == '/' ? 0 : (int)folder_length(at);
        char *joined = NULL;
        if (links == MAX_LINKS || asprintf(&joined, "%.*s%s", folder, at, next) < 0) {
            free(at);
            errno = links == MAX_LINKS ? ELOOP : ENOMEM;
            return NULL;
        }
        free(at);
        at = joined;
    }
    return at;
}

// ---- writing ----------------------------------------------------------------------------------

// Gives 0 or what errno was.
static int write_all(int fd, const char *bytes, size_t size)
{
    while (size) {
        const ssize_t n = write(fd, bytes, size);
        if (n < 0 && errno != EINTR) {
            return errno;
        }
        bytes += n > 0 ? n : 0;
        size -= n > 0 ? (size_t)n : 0;
    }
    return 0;
}

// Gives 0 or what errno was.
static int close_written(int fd, int error)
{
    return close(fd) != 0 && !error ? errno : error;
}

// A name beside `file` of which nobody has the number: does not get longer with the name of the file.
static void name_temporary(char *name, size_t size, const char *file, int number)
{
    snprintf(name, size, "%.*s.tyndall-%ld-%d", (int)folder_length(file), file, (long)getpid(),
             number);
}

// Under a temporary name, then renamed. Gives 0 or what errno was.
static int replace_named(const char *file, char *temporary, size_t room, const void *data,
                         size_t size)
{
    int fd = -1;
    for (int i = 0; fd < 0 && i < TEMPORARY_TRIES; i++) {
        name_temporary(temporary, room, file, i);
        fd = open(temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (fd < 0 && errno != EEXIST) {
            break;
        }
    }
    if (fd < 0) {
        return errno;
    }
    int error = close_written(fd, write_all(fd, data, size));
    if (!error && rename(temporary, file) != 0) {
        error = errno;
    }
    if (error) {
        unlink(temporary);
    }
    return error;
}

// Without a name while it is written, where the file system can do that: then nothing is left of it whatever ends the
// process. False: it cannot. Else `error` is 0 or what errno was.
static bool replace_unnamed(const char *file, char *temporary, size_t room, const void *data,
                            size_t size, int *error)
{
    char by_descriptor[64];
    const size_t folder = folder_length(file);
    snprintf(temporary, room, "%.*s.", (int)folder, file);
    int fd = open(temporary, O_WRONLY | O_TMPFILE | O_CLOEXEC, 0666);
    if (fd < 0) {
        return false;
    }
    *error = write_all(fd, data, size);
    bool linked = false;
    snprintf(by_descriptor, sizeof by_descriptor, "/proc/self/fd/%d", fd);
    for (int i = 0; !*error && !linked && i < TEMPORARY_TRIES; i++) {
        name_temporary(temporary, room, file, i);
        linked = linkat(AT_FDCWD, by_descriptor, AT_FDCWD, temporary, AT_SYMLINK_FOLLOW) == 0;
        if (!linked && errno != EEXIST) {
            break;
        }
    }
    *error = close_written(fd, *error);
    if (linked && (*error || rename(temporary, file) != 0)) {
        *error = *error ? *error : errno;
        unlink(temporary);
    }
    return linked || *error;
}

// Gives 0 or what errno was.
static int replace(const char *file, const void *data, size_t size)
{
    int error = 0;
    const size_t room = folder_length(file) + 64;
    char *temporary = malloc(room);
    if (!temporary) {
        return ENOMEM;
    }
    if (!replace_unnamed(file, temporary, room, data, size, &error)) {
        error = replace_named(file, temporary, room, data, size);
    }
    free(temporary);
    return error;
}

// Gives 0 or what errno was.
static int put(const char *file, const void *data, size_t size)
{
    struct stat info;
    int fd = descriptor_of(file);
    if (fd >= 0) {
        fflush(stdout); // what was printed before comes first
        return write_all(fd, data, size);
    }
    if (stat(file, &info) != 0 || S_ISREG(info.st_mode)) {
        return replace(file, data, size);
    }
    fd = open(file, O_WRONLY | O_NOCTTY | O_CLOEXEC);
    return fd < 0 ? errno : close_written(fd, write_all(fd, data, size));
}

tyn_result tyn_file_write(const char *path, const void *data, size_t size, const tyn_log *log)
{
    if (!TYN_GIVEN(log, path) || (size && !TYN_GIVEN(log, data))) {
        return TYN_ERR_PARAMS;
    }
    char *file = follow(path);
    const int error = file ? put(file, data, size) : errno;
    free(file);
    return error ? TYN_FAULT(log, TYN_ERR_IO, "%s: cannot be written: %s", path, strerror(error))
                 : TYN_OK;
}

// ---- before the work --------------------------------------------------------------------------

// Why no file can be put there, or NULL; `reason` is room for it.
static const char *why_not(const char *file, char *reason, size_t room)
{
    struct stat info;
    const int length = (int)folder_length(file);
    const int fd = descriptor_of(file);
    if (fd >= 0) {
        const int flags = fcntl(fd, F_GETFL);
        return flags < 0 || (flags & O_ACCMODE) == O_RDONLY ? "nothing can be written to it" : NULL;
    }
    if (stat(file, &info) == 0 && S_ISDIR(info.st_mode)) {
        return "it is a folder; give the name of a file";
    }
    if (strlen(file + length) > NAME_MAX) {
        snprintf(reason, room, "its name has %zu bytes, must have at most %d",
                 strlen(file + length), NAME_MAX);
        return reason;
    }
    if (stat(file, &info) == 0 && !S_ISREG(info.st_mode)) {
        return access(file, W_OK) == 0 ? NULL : "it is not writable";
    }
    char *folder = NULL;
    const int shown = length > 1 ? length - 1 : length;
    if (asprintf(&folder, "%.*s", shown ? shown : 1, shown ? file : ".") < 0) {
        return "no memory";
    }
    const bool there = stat(folder, &info) == 0 && S_ISDIR(info.st_mode);
    const bool writable = there && access(folder, W_OK | X_OK) == 0;
    snprintf(reason, room, "the folder '%s' %s", folder,
             there ? "is not writable" : "is not there");
    free(folder);
    return writable ? NULL : reason;
}

tyn_result tyn_file_writable(const char *path, const tyn_log *log)
{
    if (!TYN_GIVEN(log, path)) {
        return TYN_ERR_PARAMS;
    }
    char reason[PATH_MAX];
    char *file = follow(path);
    const char *why = file ? why_not(file, reason, sizeof reason) : strerror(errno);
    if (why) {
        tyn_log_print(log, TYN_LOG_ERROR, "%s: cannot be written: %s", path, why);
    }
    free(file);
    return why ? TYN_ERR_IO : TYN_OK;
}
