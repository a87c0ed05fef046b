// raw_to_vdb.c -- a density in a .raw file (docs/scene-format.md) as an OpenVDB grid that fills the unit box.
//
// usage: tyndall-raw-to-vdb IN.raw NX NY NZ f32|f16|u8 OUT.vdb
//
// The grid "density" holds a float at the centre of every voxel, (i + 0.5) / n - 0.5 on each axis, between which
// OpenVDB's readers interpolate as the library does. Voxels that are 0 stay inactive. In the outer half voxel a reader
// goes over to the 0 outside where the library keeps the value of the edge: the voxels at the faces must be 0, and a
// file of which this does not hold is refused.
#include "vdb_writer.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// The file, which the writer asks for voxels.
static struct {
    unsigned char *bytes;
    size_t size, width; // width: bytes a voxel
    int32_t n[3];
} raw;

static float half_value(uint16_t bits)
{
    const int exponent = bits >> 10 & 31, mantissa = bits & 1023;
    const float size = exponent == 31 ? (mantissa ? NAN : INFINITY)
                       : exponent     ? ldexpf((float)(1024 + mantissa), exponent - 25)
                                      : ldexpf((float)mantissa, -24);
    return bits >> 15 ? -size : size;
}

static float value_at(int32_t x, int32_t y, int32_t z, int c)
{
    (void)c;
    const size_t i = ((size_t)z * (size_t)raw.n[1] + (size_t)y) * (size_t)raw.n[0] + (size_t)x;
    const unsigned char *at = raw.bytes + i * raw.width;
    float value;
    uint16_t bits;
    switch (raw.width) {
    case 4:
        memcpy(&value, at, sizeof value);
        return value;
    case 2:
        memcpy(&bits, at, sizeof bits);
        return half_value(bits);
    default:
        return (float)*at / 255;
    }
}

static bool read_file(const char *path)
{
    FILE *file = fopen(path, "rb");
    if (!file) {
        return false;
    }
    fseek(file, 0, SEEK_END);
    const long size = ftell(file);
    rewind(file);
    raw.size = size > 0 ? (size_t)size : 0;
    raw.bytes = malloc(raw.size + 1);
    const bool whole = raw.bytes && fread(raw.bytes, 1, raw.size, file) == raw.size;
    fclose(file);
    return whole;
}

static bool is_face(int32_t x, int32_t y, int32_t z)
{
    return x == 0 || y == 0 || z == 0 || x == raw.n[0] - 1 || y == raw.n[1] - 1 ||
           z == raw.n[2] - 1;
}

static bool faces_are_empty(void)
{
    for (int32_t z = 0; z < raw.n[2]; z++) {
        for (int32_t y = 0; y < raw.n[1]; y++) {
            for (int32_t x = 0; x < raw.n[0]; x++) {
                if (is_face(x, y, z) && value_at(x, y, z, 0) != 0) {
                    return false;
                }
            }
        }
    }
    return true;
}

static int wrong(const char *path, const char *what)
{
    fprintf(stderr, "tyndall-raw-to-vdb: %s%s%s\n", path, *path ? ": " : "", what);
    return 2;
}

static int convert(const char *in, const char *type, const char *out)
{
    const struct {
        const char *name;
        size_t width;
    } types[] = {{"f32", 4}, {"f16", 2}, {"u8", 1}};
    for (int i = 0; i < 3; i++) {
        raw.width = strcmp(type, types[i].name) ? raw.width : types[i].width;
    }
    if (!raw.width) {
        return wrong("", "the type must be f32, f16 or u8");
    }
    if (raw.n[0] < 1 || raw.n[1] < 1 || raw.n[2] < 1) {
        return wrong("", "NX, NY and NZ must be above 0");
    }
    if (!read_file(in)) {
        return wrong(in, "cannot be read");
    }
    char what[128];
    const size_t due = (size_t)raw.n[0] * (size_t)raw.n[1] * (size_t)raw.n[2] * raw.width;
    if (raw.size != due) {
        snprintf(what, sizeof what, "has %zu bytes, not %zu", raw.size, due);
        return wrong(in, what);
    }
    if (!faces_are_empty()) {
        return wrong(in, "its voxels at the faces of the box are not all 0");
    }
    vdb_spec grid = {.name = "density", .values = VDB_FLOATS, .value = value_at, .sparse = true};
    for (int a = 0; a < 3; a++) {
        grid.hi[a] = raw.n[a] - 1;
        grid.voxel[a] = 1.0 / raw.n[a];
        grid.origin[a] = 0.5 / raw.n[a] - 0.5;
    }
    const char *failure = vdb_write(out, &grid, 1, VDB_BLOSC | VDB_ACTIVE_MASK);
    return failure ? (wrong("", failure), 1) : 0;
}

int main(int argc, char **argv)
{
    if (argc != 7) {
        fprintf(stderr, "usage: tyndall-raw-to-vdb IN.raw NX NY NZ f32|f16|u8 OUT.vdb\n");
        return 2;
    }
    for (int a = 0; a < 3; a++) {
        raw.n[a] = atoi(argv[2 + a]);
    }
    const int code = convert(argv[1], argv[5], argv[6]);
    free(raw.bytes);
    return code;
}
