// hdr.c -- libFuzzer harness: Radiance pictures.
#include "io/hdr.h"
#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    uint32_t extent[2];
    float *pixels = NULL;
    if (tyn_hdr_parse(extent, &pixels, data, size, "fuzz.hdr", NULL) == TYN_OK) {
        free(pixels);
    }
    return 0;
}
