// jpeg_write.h -- a JPEG picture in memory, by stb_image_write.
#pragma once
#include <stddef.h>
#include <stdint.h>

// RGB, row 0 at the top. Returns the bytes written, at most `room`.
size_t jpeg_write(uint8_t *out, size_t room, int width, int height, const uint8_t *rgb);
