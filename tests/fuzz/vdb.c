// vdb.c -- libFuzzer harness: OpenVDB files, checked and read through the library.
#include "io/vdb.h"
#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    tyn_grid_job job = {0};
    char path[64];
    const int fd = memfd_create("fuzz.vdb", 0);
    snprintf(path, sizeof path, "/proc/self/fd/%d", fd);
    if (fd >= 0 && write(fd, data, size) == (ssize_t)size &&
        tyn_vdb_read_file(&job, path) == TYN_OK) {
        tyn_volume_finish(&job.volume);
        tyn_grid_job list = {.use = TYN_GRID_LIST};
        if (tyn_vdb_read_file(&list, path) == TYN_OK) {
            free(list.list);
        }
    }
    close(fd);
    return 0;
}
