// given.h -- are the arguments of a public function there? Inline because file formats, a library of their own, ask as well.
#pragma once
#include <tyndall/base.h>
#include <string.h>

// False, with a line in the log, if a pointer is NULL: `names` are theirs, separated by commas.
static inline bool tyn_given(const tyn_log *log, const char *function, const char *names,
                             const void *const *pointers, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const size_t length = strcspn(names, ",");
        if (!pointers[i]) {
            tyn_log_print(log, TYN_LOG_ERROR, "%s: '%.*s' is NULL; it is required", function,
                          (int)length, names);
            return false;
        }
        names += length + strspn(names + length, ", ");
    }
    return true;
}
// False, with a line in the log, if a host's struct is older than the library: `macro` makes it.
static inline bool tyn_sized(const tyn_log *log, const char *function, size_t given, size_t size,
                             const char *macro)
{
    if (given < size) {
        tyn_log_print(log, TYN_LOG_ERROR, "%s: struct_size is %zu; use the %s() macro", function,
                      given, macro);
    }
    return given >= size;
}

// The pointers that the function around it requires: if (!TYN_GIVEN(log, path, data)) ...
#define TYN_GIVEN(log, ...)                                                                        \
    tyn_given(log, __func__, #__VA_ARGS__, (const void *const[]){__VA_ARGS__},                     \
              sizeof((const void *const[]){__VA_ARGS__}) / sizeof(void *))
