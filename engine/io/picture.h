// picture.h -- 8-bit PNG and JPEG pictures in memory.
#pragma once
#include <stddef.h>
#include <stdint.h>

// RGBA, row 0 at the top, freed with free(). NULL: `reason` says why; sides beyond 16384 are refused.
uint8_t *tyn_picture_decode(const uint8_t *bytes, size_t size, uint32_t out_size[2],
                            const char **reason);

// The PNG file of a picture in sRGB, of 3 or 4 channels; freed with free(). NULL: no memory, or 2 GiB and more.
uint8_t *tyn_picture_encode(const uint8_t *pixels, uint32_t width, uint32_t height,
                            uint32_t channels, size_t *size);
