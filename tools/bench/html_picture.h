// html_picture.h -- a picture as text for the page: linear half floats, packed.
#pragma once
#include "app.h"

// R, G, B one after the other, each: halves of value * 2^exponent, row by row, as differences (16 bits,
// wrapping) to the pixel on the left, that of the first column to the pixel above; then all high bytes
// and all low bytes, zlib, base64. page/pictures.js undoes it.
typedef struct html_picture {
    uint32_t width, height;
    int exponent; // the largest value is below 2^15 with it; 0 where all are 0 or not finite
    char *base64;
} html_picture;

// Reads an EXR with channels R, G, B. False with one warning where it cannot.
bool html_picture_read(app *a, const char *path, html_picture *picture);
void html_picture_finish(html_picture *picture);

// Nearest half, ties to even; what is too large for one is infinite. NaN stays NaN.
uint16_t html_half(float value);
