// nvdb.c -- libFuzzer harness: NanoVDB files.
#include "io/nvdb.h"
#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    tyn_grid_job density = {0};
    if (tyn_nvdb_read(&density, data, size, "fuzz.nvdb") == TYN_OK) {
        tyn_volume_finish(&density.volume);
    }
    tyn_grid_job color = {.grid = "density", .use = TYN_GRID_COLOR};
    if (tyn_nvdb_read(&color, data, size, "fuzz.nvdb") == TYN_OK) {
        tyn_volume_finish(&color.volume);
    }
    tyn_grid_job list = {.use = TYN_GRID_LIST};
    if (tyn_nvdb_read(&list, data, size, "fuzz.nvdb") == TYN_OK) {
        free(list.list);
    }
    return 0;
}
