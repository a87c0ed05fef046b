// nvdb_tree.c -- libFuzzer harness: damaged trees. A valid uncompressed file is patched by the input,
// a list of (kind of value, address as 3 bytes, value as 4 bytes), and read.
#include "io/nvdb.h"
#include <stdlib.h>
#include <string.h>
#include "nvdb_write.h"

static float value(int32_t i, int32_t j, int32_t k)
{
    return (float)((i + j + k) & 7) / 7.0f;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const uint32_t types[] = {NVDB_FLOAT, NVDB_HALF, NVDB_FP8, NVDB_FPN};
    nvdb_spec spec = {"density", types[size % 4], 0, 2, {1, 2, 3}, {9, 8, 7}, value, 0, {0}, 0, 1};
    size_t length, grid,
        interesting[] = {0, 672, 728, 736, 800, 832, 832 + 4128, 832 + 8256, 271232};
    tyn_volume volume;
    uint64_t clamped = 0;
    uint8_t *file = nvdb_write(&spec, &length, &grid);
    for (; size >= 8; size -= 8, data += 8) {
        size_t at =
            grid + interesting[data[0] % 9] + (data[1] | data[2] << 8 | (data[3] & 3) << 16);
        memcpy(file + at % (length - 4), data + 4, 4);
    }
    if (tyn_nvdb_parse(&volume, file, length, NULL, "fuzz.nvdb", &clamped, NULL) == TYN_OK) {
        tyn_volume_finish(&volume);
    }
    free(file);
    return 0;
}
