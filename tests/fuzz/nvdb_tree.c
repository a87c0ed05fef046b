// nvdb_tree.c -- libFuzzer harness: damaged trees. A valid uncompressed file is patched by the input,
// a list of (place, offset as 3 bytes, value as 4 bytes), and read.
#include "io/nvdb.h"
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
    const size_t places[] = {0, 672, 728, 736, 800, 832, 832 + 4128, 832 + 8256, 271232};
    static uint8_t *valid[4], file[1 << 20];
    static size_t length[4], grid;
    tyn_volume volume;
    uint64_t clamped = 0;
    for (int i = 0; i < 4 && !valid[i]; i++) {
        nvdb_spec spec = {"density", types[i], 0, 2, {1, 2, 3}, {9, 8, 7}, value, 0, {0}, 0, 1};
        valid[i] = nvdb_write(&spec, &length[i], &grid);
    }
    size_t kind = size % 4;
    memcpy(file, valid[kind], length[kind]);
    for (; size >= 8; size -= 8, data += 8) {
        size_t at = grid + places[data[0] % 9] + (data[1] | data[2] << 8 | (data[3] & 3) << 16);
        memcpy(file + at % (length[kind] - 4), data + 4, 4);
    }
    if (!tyn_nvdb_parse(&volume, file, length[kind], NULL, "fuzz.nvdb", &clamped, NULL)) {
        tyn_volume_finish(&volume);
    }
    return 0;
}
