// raw.c -- reads .raw grids.
#include "io/raw.h"
#include "base/fault.h"
#include <string.h>
#include "base/bytes.h"
#include "base/half.h"
#include "io/volume.h"

tyn_result tyn_raw_read(tyn_grid_job *job, const void *bytes, size_t num_bytes,
                        const int64_t size[3], uint32_t channels, tyn_raw_type type,
                        const char *file)
{
    static const char *const names[] = {"f32", "f16", "u8"};
    static const uint8_t widths[] = {4, 2, 1};
    const uint8_t *p = bytes;
    tyn_volume *volume = &job->volume;
    TYN_TRY(tyn_volume_alloc(volume, size, channels, file, job->log));
    job->channels = channels;
    uint64_t values = (uint64_t)size[0] * (uint64_t)size[1] * (uint64_t)size[2] * channels;
    if (num_bytes != values * widths[type]) {
        tyn_volume_finish(volume);
        return TYN_FAULT(job->log, TYN_ERR_PARAMS,
                         "%s: has %zu bytes, a grid of %lld x %lld x %lld %s%s values has %llu",
                         file, num_bytes, (long long)size[0], (long long)size[1],
                         (long long)size[2], channels == 3 ? "triples of " : "", names[type],
                         (unsigned long long)(values * widths[type]));
    }
    for (uint64_t i = 0; i < values; i++, p += widths[type]) {
        uint32_t word;
        switch (type) {
        case TYN_RAW_F32:
            word = (uint32_t)tyn_load(p, 4);
            memcpy(&volume->data[i], &word, 4);
            break;
        case TYN_RAW_F16:
            volume->data[i] = tyn_half_to_float((uint16_t)tyn_load(p, 2));
            break;
        case TYN_RAW_U8:
            volume->data[i] = (float)p[0] / 255.0f;
            break;
        }
    }
    return tyn_grid_seal(job, file, NULL);
}
