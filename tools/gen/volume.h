// volume.h -- a dense grid of floats and the raw files made of it.
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct gen_grid {
    int n[3];    // voxels
    float *data; // x fastest, then y, z
} gen_grid;

gen_grid gen_grid_new(int nx, int ny, int nz); // zeros; ends the program if memory is short
void gen_grid_free(gen_grid *grid);

static inline size_t gen_index(const gen_grid *g, int x, int y, int z)
{
    return ((size_t)z * (size_t)g->n[1] + (size_t)y) * (size_t)g->n[0] + (size_t)x;
}

// Writes FOLDER/FILE, little-endian: half floats, or bytes (0..255 stand for 0..1).
bool gen_write_f16(const char *folder, const char *file, const gen_grid *grid);
bool gen_write_u8(const char *folder, const char *file, const gen_grid *grid);

// Writes an RGB float picture as Radiance HDR (flat RGBE, row 0 on top).
bool gen_write_hdr(const char *folder, const char *file, int width, int height, const float *rgb);

// Writes FOLDER/FILE: a text, then bytes. False, with one line on stderr, if it cannot be written.
bool gen_write_bytes(const char *folder, const char *file, const char *head, const void *bytes,
                     size_t size);
