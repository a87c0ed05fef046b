// hdr.c -- Radiance RGBE pictures, flat or run-length encoded, old and new style.
#include "io/hdr.h"
#include "base/fault.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "io/image.h"
#include "io/primaries.h"

typedef struct reader {
    const uint8_t *at, *end;
    const char *file;
    const tyn_log *log;
} reader;

static tyn_result fault(const reader *r, const char *what)
{
    return TYN_FAULT(r->log, TYN_ERR_PARAMS, "%s: not a Radiance picture that can be read: %s",
                     r->file, what);
}

// The next line of the header without its newline; false at the end of the file.
static bool next_line(reader *r, char *line, size_t room)
{
    size_t n = 0;
    for (; r->at < r->end && *r->at != '\n'; r->at++) {
        if (n + 1 < room) {
            line[n++] = (char)*r->at;
        }
    }
    line[n] = 0;
    return r->at < r->end && r->at++;
}

// What the header says of the pixels.
typedef struct coding {
    double exposure;
    double primaries[8]; // x and y of red, green, blue, white
    bool has_primaries;
} coding;

static tyn_result read_primaries(reader *r, const char *text, coding *c)
{
    for (int i = 0; i < 8; i++) {
        char *end;
        c->primaries[i] = strtod(text, &end);
        if (end == text || !isfinite(c->primaries[i])) {
            return fault(r, "PRIMARIES must be eight numbers");
        }
        text = end;
    }
    c->has_primaries = true;
    return TYN_OK;
}

static tyn_result read_header(reader *r, uint32_t size[2], coding *c)
{
    char line[256];
    bool format = false;
    int width = 0, height = 0;
    if (!next_line(r, line, sizeof line) ||
        (strncmp(line, "#?RADIANCE", 10) != 0 && strncmp(line, "#?RGBE", 6) != 0)) {
        return fault(r, "must start with #?RADIANCE or #?RGBE");
    }
    *c = (coding){.exposure = 1};
    for (;;) {
        if (!next_line(r, line, sizeof line)) {
            return fault(r, "the header does not end");
        }
        if (!line[0]) {
            break;
        }
        if (strncmp(line, "FORMAT=", 7) == 0) {
            format = strncmp(line + 7, "32-bit_rle_rgbe", 15) == 0;
            if (!format) {
                return fault(r, "FORMAT must be 32-bit_rle_rgbe");
            }
        } else if (strncmp(line, "EXPOSURE=", 9) == 0) {
            c->exposure *= strtod(line + 9, NULL);
        } else if (strncmp(line, "PRIMARIES=", 10) == 0) {
            TYN_TRY(read_primaries(r, line + 10, c));
        }
    }
    if (!format) {
        return fault(r, "FORMAT=32-bit_rle_rgbe is missing");
    }
    if (!(c->exposure > 1e-30 && c->exposure < 1e30)) {
        return fault(r, "EXPOSURE must be > 0");
    }
    if (!next_line(r, line, sizeof line) || sscanf(line, "-Y %d +X %d", &height, &width) != 2) {
        return fault(r, "its size must be given as -Y height +X width");
    }
    if (width < 1 || height < 1 || width > TYN_MAX_IMAGE_SIDE || height > TYN_MAX_IMAGE_SIDE ||
        (uint64_t)width * (uint64_t)height > TYN_MAX_PIXELS) {
        return fault(r, "width or height is 0 or too large");
    }
    if (r->end - r->at < 4 * (int64_t)height) { // the shortest run-length encoding
        return fault(r, "the file is cut short");
    }
    size[0] = (uint32_t)width;
    size[1] = (uint32_t)height;
    return TYN_OK;
}

// New style: the four components of a line one after another, each in runs.
static bool read_line_new(reader *r, uint8_t *rgbe, uint32_t width)
{
    for (int c = 0; c < 4; c++) {
        for (uint32_t x = 0; x < width;) {
            if (r->end - r->at < 2) {
                return false;
            }
            uint32_t code = *r->at++;
            bool run = code > 128;
            uint32_t count = run ? code - 128 : code;
            if (count == 0 || count > width - x || (!run && count > (uint64_t)(r->end - r->at))) {
                return false;
            }
            for (uint32_t i = 0; i < count; i++, x++) {
                rgbe[4 * x + (uint32_t)c] = run ? *r->at : r->at[i];
            }
            r->at += run ? 1 : count;
        }
    }
    return true;
}

// Old style: pixels, where 1, 1, 1, n repeats the last one n times, more by 2^8 for each further
// one.
static bool read_line_old(reader *r, uint8_t *rgbe, uint32_t width)
{
    uint32_t shift = 0;
    for (uint32_t x = 0; x < width;) {
        if (r->end - r->at < 4) {
            return false;
        }
        const uint8_t *p = r->at;
        r->at += 4;
        if (p[0] == 1 && p[1] == 1 && p[2] == 1) {
            uint64_t count = shift < 32 ? (uint64_t)p[3] << shift : UINT64_MAX;
            if (x == 0 || count > width - x) {
                return false;
            }
            for (uint64_t i = 0; i < count; i++, x++) {
                memcpy(rgbe + 4 * x, rgbe + 4 * (x - 1), 4);
            }
            shift += 8;
        } else {
            memcpy(rgbe + 4 * x++, p, 4);
            shift = 0;
        }
    }
    return true;
}

static bool read_line(reader *r, uint8_t *rgbe, uint32_t width)
{
    const uint8_t *p = r->at;
    if (width >= 8 && width < 32768 && r->end - p >= 4 && p[0] == 2 && p[1] == 2 &&
        ((uint32_t)p[2] << 8 | p[3]) == width) {
        r->at += 4;
        return read_line_new(r, rgbe, width);
    }
    return read_line_old(r, rgbe, width);
}

tyn_result tyn_hdr_parse(uint32_t size[2], float **pixels, const void *bytes, size_t num_bytes,
                         const char *file, const tyn_log *log)
{
    reader r = {bytes, (const uint8_t *)bytes + num_bytes, file, log};
    coding c;
    *pixels = NULL;
    tyn_result result = read_header(&r, size, &c);
    if (result) {
        return result;
    }
    float *out = malloc((size_t)size[0] * size[1] * 3 * sizeof *out);
    uint8_t *line = malloc((size_t)size[0] * 4);
    if (!out || !line) {
        result = TYN_FAULT(log, TYN_ERR_MEMORY, "%s: no memory for %u x %u pixels", file, size[0],
                           size[1]);
    }
    for (uint32_t y = 0; !result && y < size[1]; y++) {
        if (!read_line(&r, line, size[0])) {
            result = fault(&r, "its pixels are cut short or damaged");
            break;
        }
        for (uint32_t x = 0; x < size[0]; x++) {
            const uint8_t *p = line + 4 * x;
            float *rgb = out + 3 * ((size_t)y * size[0] + x);
            double scale = p[3] ? ldexp(1.0 / c.exposure, p[3] - 136) : 0.0;
            for (int k = 0; k < 3; k++) {
                rgb[k] = (float)(p[k] * scale);
            }
        }
    }
    free(line);
    if (result) {
        free(out);
        return result;
    }
    if (c.has_primaries) {
        tyn_pixels_to_rec709(out, (size_t)size[0] * size[1], c.primaries);
    }
    *pixels = out;
    return TYN_OK;
}
