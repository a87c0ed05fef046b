// vdb_check.c -- libFuzzer harness: the walk over an OpenVDB file's structure, without the library behind it.
#include "io/vdb_check.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    tyn_vdb_check(data, size, 224, "fuzz.vdb", NULL);
    return 0;
}
