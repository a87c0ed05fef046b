// picture.h -- 8-bit PNG and JPEG pictures in memory.
#pragma once
#include <stddef.h>
#include <stdint.h>

// RGBA, row 0 at the top, freed with free(). NULL: `reason` says why; sides beyond 16384 are refused.
uint8_t *tyn_picture_decode(const uint8_t *bytes, size_t size, uint32_t out_size[2],
                            const char **reason);
