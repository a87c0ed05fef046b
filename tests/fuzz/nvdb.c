// nvdb.c -- libFuzzer harness: NanoVDB files.
#include "io/nvdb.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    tyn_volume volume;
    uint64_t clamped = 0;
    if (tyn_nvdb_parse(&volume, data, size, NULL, "fuzz.nvdb", &clamped, NULL) == TYN_OK) {
        tyn_volume_finish(&volume);
    }
    return 0;
}
