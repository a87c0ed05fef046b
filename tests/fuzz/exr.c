// exr.c -- libFuzzer harness: OpenEXR images.
#include "io/exr.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    tyn_image_file image;
    if (tyn_exr_parse(&image, data, size, "fuzz.exr", NULL) == TYN_OK) {
        tyn_image_file_finish(&image);
    }
    return 0;
}
