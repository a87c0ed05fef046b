// nvdb_tree.c -- libFuzzer harness: damaged trees. A valid uncompressed file is patched by the
// input, a list of (place, offset as 3 bytes, value as 4 bytes), and read.
#include "io/nvdb.h"
#include <string.h>
#include "nvdb_write.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const uint32_t types[4] = {NVDB_FLOAT, NVDB_HALF, NVDB_FP8, NVDB_FPN};
    const size_t places[8] = {0, 672, 736, 800, 832, 832 + 4128, 832 + 8256, 271232};
    static uint8_t *valid[4], file[1 << 20];
    static size_t length[4], grid;
    size_t kind = size % 4;
    tyn_grid_job job = {0};
    nvdb_spec spec = {"density", types[kind], 0, 2, {1, 2, 3}, {9, 8, 7}, NULL, 0, {0}, 0, 1};
    valid[kind] = valid[kind] ? valid[kind] : nvdb_write(&spec, &length[kind], &grid);
    memcpy(file, valid[kind], length[kind]);
    for (; size >= 8; size -= 8, data += 8) {
        size_t at = grid + places[data[0] % 8] + (data[1] | data[2] << 8 | (data[3] & 3) << 16);
        memcpy(file + at % (length[kind] - 4), data + 4, 4);
    }
    if (!tyn_nvdb_read(&job, file, length[kind], "fuzz.nvdb")) {
        tyn_volume_finish(&job.volume);
    }
    return 0;
}
