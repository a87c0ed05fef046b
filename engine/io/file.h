// file.h -- files that are looked at where they lie.
#pragma once
#include <tyndall/io.h>

// The bytes of a file, not copied; until tyn_file_unmap. Refuses what tyn_file_read refuses.
tyn_result tyn_file_map(const char *path, uint64_t limit, const void **bytes, size_t *size,
                        const tyn_log *log);
void tyn_file_unmap(const void *bytes, size_t size);
