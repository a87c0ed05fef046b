// raw.c -- libFuzzer harness: raw grids. The first seven bytes say type and size.
#include "io/raw.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    tyn_grid_job job = {0};
    if (size < 7) {
        return 0;
    }
    const int64_t voxels[3] = {data[1] | data[2] << 8, data[3] | data[4] << 8,
                               data[5] | data[6] << 8};
    tyn_raw_type type = (tyn_raw_type)(data[0] % 3);
    if (!tyn_raw_read(&job, data + 7, size - 7, voxels, 1, type, "fuzz.raw")) {
        tyn_volume_finish(&job.volume);
    }
    return 0;
}
