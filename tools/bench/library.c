// library.c -- which build of the library measures.
#include "library.h"
#include "app.h"
#include <dlfcn.h>
#include <stdlib.h>
#include <tyndall/base.h>
#include <tyndall/io.h>

uint64_t library_hash(void)
{
    // Linked statically it is the program's file, which the loader does not always call by a path.
    Dl_info library = {0};
    const bool known = dladdr((void *)(uintptr_t)tyn_version_string, &library) != 0;
    void *data = NULL;
    size_t size = 0;
    const uint64_t most = UINT64_C(1) << 32;
    if (!known || !library.dli_fname ||
        tyn_file_read(library.dli_fname, most, &data, &size, NULL) != TYN_OK) {
        (void)tyn_file_read("/proc/self/exe", most, &data, &size, NULL);
    }
    const uint64_t hash = data ? text_hash(data, size, 0) : 0;
    free(data);
    return hash;
}
