// textures.c -- the textures of the sample scenes, which repeat, and their PNG files.
//
// The pictures are stored, not compressed: what a compressor makes of them would be its version's.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "noise.h"
#include "textures.h"
#include "volume.h"

enum { SIZE = 256 };

// ---- PNG ----------------------------------------------------------------------------------------

static uint8_t *put_u32(uint8_t *out, uint32_t v)
{
    for (int i = 0; i < 4; i++) {
        out[i] = (uint8_t)(v >> (24 - 8 * i));
    }
    return out + 4;
}

// The checksum of PNG, bit by bit.
static uint32_t crc32(const uint8_t *data, size_t size)
{
    uint32_t crc = 0xffffffffu;
    for (size_t i = 0; i < size; i++) {
        crc ^= data[i];
        for (int bit = 0; bit < 8; bit++) {
            crc = (crc >> 1) ^ (crc & 1 ? 0xedb88320u : 0);
        }
    }
    return ~crc;
}

// Wraps what stands at out + 8 as a chunk.
static uint8_t *end_chunk(uint8_t *out, const char *type, size_t size)
{
    put_u32(out, (uint32_t)size);
    memcpy(out + 4, type, 4);
    return put_u32(out + 8 + size, crc32(out + 4, size + 4));
}

static bool write_png(const char *folder, const char *file, const uint8_t *rgb)
{
    enum { ROW = 1 + 3 * SIZE, ROWS = 64, BLOCKS = SIZE / ROWS }; // a deflate block holds < 64 KiB
    uint8_t *png = malloc(1024 + SIZE * ROW), *out = png;
    if (!png) {
        return false;
    }
    memcpy(out, "\x89PNG\r\n\x1a\n", 8);
    out += 8;
    put_u32(put_u32(out + 8, SIZE), SIZE);
    memcpy(out + 16, "\x08\x02\0\0\0", 5); // 8 bits, RGB
    out = end_chunk(out, "IHDR", 13);
    uint8_t *data = out + 8;
    uint32_t a = 1, b = 0; // Adler-32 of the rows
    memcpy(data, "\x78\x01", 2);
    data += 2;
    for (int block = 0; block < BLOCKS; block++) {
        const uint32_t length = ROWS * ROW;
        *data++ = block == BLOCKS - 1; // stored; the last one
        *data++ = length & 255;
        *data++ = length >> 8;
        *data++ = ~length & 255;
        *data++ = (uint8_t)(~length >> 8);
        for (int y = 0; y < ROWS; y++) {
            *data = 0; // not filtered
            memcpy(data + 1, rgb + (size_t)(block * ROWS + y) * 3 * SIZE, 3 * SIZE);
            for (int i = 0; i < ROW; i++) {
                a = (a + data[i]) % 65521;
                b = (b + a) % 65521;
            }
            data += ROW;
        }
    }
    data = put_u32(data, b << 16 | a);
    out = end_chunk(out, "IDAT", (size_t)(data - out) - 8);
    out = end_chunk(out, "IEND", 0);
    const bool ok = gen_write_bytes(folder, file, "", png, (size_t)(out - png));
    free(png);
    return ok;
}

// ---- stone --------------------------------------------------------------------------------------

// Value noise that repeats after `period` cells, about [-1, 1].
static float noise(float x, float y, int period, uint32_t seed)
{
    const int ix = (int)floorf(x), iy = (int)floorf(y);
    const float fx = x - (float)ix, fy = y - (float)iy;
    const float u = fx * fx * (3 - 2 * fx), v = fy * fy * (3 - 2 * fy);
    float corner[4];
    for (int i = 0; i < 4; i++) {
        const uint32_t cx = (uint32_t)((ix + (i & 1)) % period);
        const uint32_t cy = (uint32_t)((iy + (i >> 1)) % period);
        corner[i] = gen_random(cy * 4096 + cx, seed);
    }
    const float top = corner[0] + (corner[1] - corner[0]) * u;
    const float bottom = corner[2] + (corner[3] - corner[2]) * u;
    return 2 * (top + (bottom - top) * v) - 1;
}

// Grain of many sizes at a texel, x and y in [0, 1).
static float grain(float x, float y, uint32_t seed)
{
    float sum = 0, weight = 0.5f;
    for (int period = 8; period <= 128; period *= 2) {
        sum += weight * noise(x * (float)period, y * (float)period, period, seed);
        seed++;
        weight *= 0.75f;
    }
    return sum;
}

// How far a place is from the nearest joint, in units of half a joint's width, up to 1.
static float joint(float place, float spacing, float half)
{
    const float at = place / spacing, from = fabsf(at - floorf(at + 0.5f)) * spacing / half;
    return from < 1 ? from : 1;
}

static void paint(uint8_t *out, const float color[3], float tone)
{
    for (int k = 0; k < 3; k++) {
        const float v = color[k] * tone;
        out[k] = (uint8_t)(v < 0 ? 0 : v > 255 ? 255 : v + 0.5f);
    }
}

// Courses of cut stone: 2 m of a wall, four courses high, two blocks long.
static void ashlar(uint8_t *rgb)
{
    static const float sand[3] = {205, 190, 166}; // sRGB
    for (int i = 0; i < SIZE * SIZE; i++) {
        const float x = ((float)(i % SIZE) + 0.5f) / SIZE, y = ((float)(i / SIZE) + 0.5f) / SIZE;
        const int course = (int)(4 * y);
        const float along = 2 * x + 0.5f * (float)(course % 2);
        const int block = (int)along % 2;
        const float gap = fminf(joint(y, 0.25f, 0.006f), joint(along, 1.0f, 0.012f));
        const float tone = 0.93f + 0.1f * gen_random((uint32_t)(2 * course + block), 41);
        paint(rgb + 3 * i, sand, tone * (1 + 0.13f * grain(x, y, 50)) * (0.72f + 0.28f * gap));
    }
}

// 2 m of a floor of slabs of half a metre, light and dark.
static void slabs(uint8_t *rgb)
{
    static const float light[3] = {188, 176, 158}, dark[3] = {122, 112, 104};
    for (int i = 0; i < SIZE * SIZE; i++) {
        const float x = ((float)(i % SIZE) + 0.5f) / SIZE, y = ((float)(i / SIZE) + 0.5f) / SIZE;
        const int column = (int)(4 * x), row = (int)(4 * y);
        const float gap = fminf(joint(x, 0.25f, 0.006f), joint(y, 0.25f, 0.006f));
        const float tone = 0.9f + 0.16f * gen_random((uint32_t)(4 * row + column), 43);
        paint(rgb + 3 * i, (column + row) % 2 ? dark : light,
              tone * (1 + 0.12f * grain(x, y, 70)) * (0.7f + 0.3f * gap));
    }
}

bool gen_write_textures(const char *folder)
{
    static uint8_t rgb[3 * SIZE * SIZE];
    ashlar(rgb);
    bool ok = write_png(folder, "stone.png", rgb);
    slabs(rgb);
    return write_png(folder, "slabs.png", rgb) && ok;
}
