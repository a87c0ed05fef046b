// hdr.h -- Radiance pictures (.hdr).
#pragma once
#include <tyndall/io.h>

// Reads RGB triples, row 0 at the top. `*pixels` is freed with free(). Faults name `file`.
tyn_result tyn_hdr_parse(uint32_t size[2], float **pixels, const void *bytes, size_t num_bytes,
                         const char *file, const tyn_log *log);
