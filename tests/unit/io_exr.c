// io_exr.c -- OpenEXR images: what is written is read again; tiles; damaged files; PNG beside it.
#include <math.h>
#include <openexr.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "io/exr.h"
#include "io_test.h"
#include "numbers.h"
#include "skip.h"
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#include <stb/stb_image.h>

enum { WIDTH = 21, HEIGHT = 37 };

static float at(int channel, int i)
{
    return channel == 2 ? INFINITY : (float)(i % 53) * (channel ? -0.37f : 11.1f);
}

// Three channels, names not in alphabetical order.
static void fill(tyn_image_file *image)
{
    static const char *const names[] = {"transmittance.R", "B", "depth.Z"};
    *image = (tyn_image_file){WIDTH, HEIGHT, 3, calloc(3, sizeof(tyn_channel))};
    for (int c = 0; c < 3; c++) {
        strcpy(image->channels[c].name, names[c]);
        image->channels[c].data = malloc(WIDTH * HEIGHT * sizeof(float));
        for (int i = 0; i < WIDTH * HEIGHT; i++) {
            image->channels[c].data[i] = at(c, i);
        }
    }
}

static void round_trip(void **state)
{
    (void)state;
    for (int full = 0; full < 2; full++) {
        tyn_image_file image, read;
        io_log log;
        io_log_init(&log);
        fill(&image);
        const char *path = io_path("a.exr");
        assert_int_equal(tyn_exr_write(&image, path, full, &log.log), TYN_OK);
        assert_int_equal(tyn_exr_read(&read, path, &log.log), TYN_OK);
        assert_int_equal(log.errors + log.warnings, 0);
        assert_int_equal(read.width, WIDTH);
        assert_int_equal(read.height, HEIGHT);
        assert_int_equal(read.num_channels, 3);
        for (int c = 0; c < 3; c++) {
            const float *data = tyn_image_file_channel(&read, image.channels[c].name);
            assert_non_null(data);
            for (int i = 0; i < WIDTH * HEIGHT; i++) {
                assert_true(data[i] == at(c, i) ||
                            (!full && fabsf(data[i] - at(c, i)) <= fabsf(at(c, i)) * 0x1p-11f));
            }
        }
        assert_null(tyn_image_file_channel(&read, "R"));
        tyn_image_file_finish(&read);
        tyn_image_file_finish(&image);
    }
}

// A part of a picture: its place in the whole comes back, beside the pixels.
static void windows(void **state)
{
    (void)state;
    tyn_image_file image, read;
    io_log log;
    io_log_init(&log);
    fill(&image);
    image.x = 40;
    image.y = 7;
    image.whole_width = 40 + WIDTH;
    image.whole_height = 1000;
    assert_int_equal(tyn_exr_write(&image, io_path("part.exr"), true, &log.log), TYN_OK);
    assert_int_equal(tyn_exr_read(&read, io_path("part.exr"), &log.log), TYN_OK);
    assert_int_equal(log.errors + log.warnings, 0);
    assert_int_equal(read.x, 40);
    assert_int_equal(read.y, 7);
    assert_int_equal(read.whole_width, 40 + WIDTH);
    assert_int_equal(read.whole_height, 1000);
    for (int c = 0; c < 3; c++) {
        assert_memory_equal(tyn_image_file_channel(&read, image.channels[c].name),
                            image.channels[c].data, WIDTH * HEIGHT * sizeof(float));
    }
    tyn_image_file_finish(&read);
    tyn_image_file_finish(&image);
}

// What a file says beside its pixels comes back; channels that are to be exact are, whatever the others are.
static void attributes(void **state)
{
    (void)state;
    tyn_image_file image, read;
    io_log log;
    io_log_init(&log);
    fill(&image);
    image.channels[1].exact = true;
    image.screen_width = 1.25f;
    double matrix[16], primaries[8] = {0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329};
    for (int i = 0; i < 16; i++) {
        matrix[i] = 0.5 * i - 3;
    }
    const double samples = 16777217; // no float is
    assert_true(tyn_image_file_set_text(&image, "comments", "first"));
    assert_true(tyn_image_file_set_text(&image, "tyndall:settings", "{\"a\": \"\xc3\xa4\"}"));
    assert_true(tyn_image_file_set_text(&image, "comments", "then this"));
    assert_true(tyn_image_file_set_numbers(&image, "samples", TYN_ATTRIBUTE_INTEGER, &samples));
    assert_true(tyn_image_file_set_numbers(&image, "gain", TYN_ATTRIBUTE_NUMBER, &matrix[1]));
    assert_true(tyn_image_file_set_numbers(&image, "worldToCamera", TYN_ATTRIBUTE_MATRIX, matrix));
    assert_true(tyn_image_file_set_numbers(&image, "chromaticities", TYN_ATTRIBUTE_CHROMATICITIES,
                                           primaries));
    char name[100] = "";
    memset(name, 'n', sizeof name - 1);
    assert_false(tyn_image_file_set_text(&image, name, "too long a name"));
    assert_int_equal(image.num_attributes, 6);
    const char *path = io_path("told.exr");
    assert_int_equal(tyn_exr_write(&image, path, false, &log.log), TYN_OK);
    assert_int_equal(tyn_exr_read(&read, path, &log.log), TYN_OK);
    assert_int_equal(log.errors + log.warnings, 0);
    assert_int_equal(read.num_attributes, 6);
    assert_true(read.screen_width == 1.25f);
    assert_string_equal(tyn_image_file_text(&read, "comments"), "then this");
    assert_string_equal(tyn_image_file_text(&read, "tyndall:settings"), "{\"a\": \"\xc3\xa4\"}");
    assert_true(tyn_image_file_attribute(&read, "samples")->values[0] == samples);
    assert_true(tyn_image_file_attribute(&read, "gain")->values[0] == -2.5);
    const tyn_attribute *m = tyn_image_file_attribute(&read, "worldToCamera");
    const tyn_attribute *c = tyn_image_file_attribute(&read, "chromaticities");
    assert_true(m && m->kind == TYN_ATTRIBUTE_MATRIX);
    assert_true(c && c->kind == TYN_ATTRIBUTE_CHROMATICITIES);
    for (int i = 0; i < 16; i++) {
        assert_true(m->values[i] == matrix[i]);
        assert_true(i >= 8 || fabs(c->values[i] - primaries[i]) < 1e-7);
    }
    assert_null(tyn_image_file_attribute(&read, "owner"));
    assert_null(tyn_image_file_text(&read, "samples"));
    uint32_t rounded = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        assert_true(tyn_image_file_channel(&read, "B")[i] == at(1, i));
        rounded += tyn_image_file_channel(&read, "transmittance.R")[i] != at(0, i);
    }
    assert_true(rounded > 0);
    tyn_image_file_finish(&read);
    tyn_image_file_finish(&image);
}

// Noise with more and more zeros: among these are rows that compress to exactly their own size, which OpenEXR 3.1.5
// takes for rows that are not compressed.
static void incompressible(void **state)
{
    enum { COUNT = 16 * 16 };
    float values[COUNT];
    tyn_channel channel = {"Y", values};
    tyn_image_file image = {16, 16, 1, &channel}, read;
    io_log log;
    (void)state;
    io_log_init(&log);
    const char *path = io_path("noise.exr");
    uint32_t random = 1;
    for (int zeros = 0; zeros < COUNT; zeros++) {
        for (int i = 0; i < COUNT; i++) {
            random = random * 1664525u + 1013904223u;
            const uint32_t bits = random >> 9 | (random << 7 & 0x80000000u) | 0x3f000000u;
            memcpy(&values[i], &bits, sizeof bits);
            values[i] = i < zeros / 4 ? 0.0f : values[i];
        }
        assert_int_equal(tyn_exr_write(&image, path, true, &log.log), TYN_OK);
        assert_int_equal(tyn_exr_read(&read, path, &log.log), TYN_OK);
        assert_memory_equal(tyn_image_file_channel(&read, "Y"), values, sizeof values);
        tyn_image_file_finish(&read);
    }
}

static void saturation(void **state)
{
    float values[4] = {1e6f, -1e9f, 65504, INFINITY};
    tyn_channel channel = {"Y", values};
    tyn_image_file image = {4, 1, 1, &channel}, read;
    io_log log;
    (void)state;
    io_log_init(&log);
    const char *path = io_path("big.exr");
    assert_int_equal(tyn_exr_write(&image, path, false, &log.log), TYN_OK);
    assert_int_equal(log.warnings, 1);
    assert_non_null(strstr(log.last, "2 values"));
    assert_int_equal(tyn_exr_read(&read, path, &log.log), TYN_OK);
    const float *y = tyn_image_file_channel(&read, "Y");
    assert_true(y[0] == 65504 && y[1] == -65504 && y[2] == 65504 && isinf(y[3]));
    tyn_image_file_finish(&read);
    // Infinity is refused as radiance.
    tyn_environment env = {0};
    assert_int_equal(tyn_environment_load(&env, path, &log.log), TYN_ERR_PARAMS);
    assert_non_null(strstr(log.last, "pixel 3, 0"));
    // A folder that is not there; nothing is left behind.
    io_log_init(&log);
    assert_int_equal(tyn_exr_write(&image, io_path("none/a.exr"), false, &log.log), TYN_ERR_IO);
    assert_int_equal(log.errors, 1);
    image.width = 0;
    assert_int_equal(tyn_exr_write(&image, path, false, &log.log), TYN_ERR_PARAMS);
}

// What the library refuses to write is an error in one line; it holds a lock while it says so.
static void refused_channels(void **state)
{
    (void)state;
    float value = 1;
    tyn_channel channels[2] = {{"R", &value}, {"R", &value}};
    io_log log;
    io_log_init(&log);
    assert_true(tyn_exr_write(&(tyn_image_file){1, 1, 2, channels}, io_path("twice.exr"), true,
                              &log.log) < 0);
    assert_int_equal(log.errors, 1);
}

// A map with a luminance channel alone, and one that lacks blue.
static void environments(void **state)
{
    float values[2] = {0.5f, -0.25f};
    tyn_channel channels[2] = {{"Y", values}, {"G", values}};
    tyn_image_file image = {2, 1, 1, channels};
    tyn_environment env = {0};
    io_log log;
    (void)state;
    io_log_init(&log);
    const char *path = io_path("env.exr");
    assert_int_equal(tyn_exr_write(&image, path, true, &log.log), TYN_OK);
    assert_int_equal(tyn_environment_load(&env, path, &log.log), TYN_OK);
    // Refined 33 times, as small maps are: look at the centres of the old texels.
    assert_true(env.present && env.size[0] == 66 && env.size[1] == 33);
    const float *first = env.data + 3 * 16, *second = env.data + 3 * 49;
    assert_true(first[0] == 0.5f && first[2] == 0.5f && second[0] == 0); // clamped
    image.channels = channels + 1;
    assert_int_equal(tyn_exr_write(&image, path, true, &log.log), TYN_OK);
    assert_int_equal(tyn_environment_load(&env, path, &log.log), TYN_ERR_PARAMS);
    assert_int_equal(log.errors, 1);
    assert_true(env.data[3 * 16] == 0.5f); // what was there stays
    free(env.data);
}

// The lower right quarter of a map is one of the whole sphere: the others are black. A map of a cube's faces is refused.
static void partial_maps(void **state)
{
    float values[64 * 32];
    tyn_channel channels[1] = {{"Y", values}};
    tyn_image_file image = {64, 32, 1, channels, .x = 64, .y = 32};
    const double latitude = 0, cube = 1;
    tyn_environment env = {0};
    io_log log;
    (void)state;
    io_log_init(&log);
    image.whole_width = 128;
    image.whole_height = 64;
    for (int i = 0; i < 64 * 32; i++) {
        values[i] = (float)(i + 1);
    }
    const char *path = io_path("part.exr");
    assert_true(tyn_image_file_set_numbers(&image, "envmap", TYN_ATTRIBUTE_INTEGER, &latitude));
    assert_int_equal(tyn_exr_write(&image, path, true, &log.log), TYN_OK);
    assert_int_equal(tyn_environment_load(&env, path, &log.log), TYN_OK);
    assert_non_null(strstr(log.last, "has 25 % of its 128 x 64 pixels"));
    assert_true(env.size[0] == 128 && env.size[1] == 64);
    for (int y = 0; y < 64; y++) {
        for (int x = 0; x < 128; x++) {
            const float right = x < 64 || y < 32 ? 0 : values[64 * (y - 32) + x - 64];
            assert_true(env.data[3 * (128 * y + x)] == right);
        }
    }
    image.x = -32; // beyond the sphere on one side
    image.y = 40;
    assert_int_equal(tyn_exr_write(&image, path, true, &log.log), TYN_OK);
    assert_int_equal(tyn_environment_load(&env, path, &log.log), TYN_OK);
    assert_true(env.data[3 * 128 * 40] == values[32] &&
                env.data[3 * (128 * 63 + 31)] == values[64 * 23 + 63]);
    io_log_init(&log);
    assert_true(tyn_image_file_set_numbers(&image, "envmap", TYN_ATTRIBUTE_INTEGER, &cube));
    assert_int_equal(tyn_exr_write(&image, path, true, &log.log), TYN_OK);
    assert_int_equal(tyn_environment_load(&env, path, &log.log), TYN_ERR_PARAMS);
    assert_non_null(strstr(log.last, "a cube's faces"));
    free(env.data);
    free(image.attributes);
}

// A map in the primaries of ACEScg: white stays white, and colours are those of the matrix that ACES publishes, by Bradford's
// adaptation.
static void primaries(void **state)
{
    static const double acescg[8] = {0.713, 0.293, 0.165, 0.830, 0.128, 0.044, 0.32168, 0.33767};
    static const double none[8] = {0.3, 0.3, 0.3, 0.3, 0.3, 0.3, 0.3, 0.3};
    float values[3][2] = {{1, 0.5f}, {1, 0.25f}, {1, 0.25f}};
    tyn_channel channels[3] = {{"R", values[0]}, {"G", values[1]}, {"B", values[2]}};
    tyn_image_file image = {2, 1, 3, channels};
    tyn_environment env = {0};
    io_log log;
    (void)state;
    io_log_init(&log);
    for (int k = 0; k < 2; k++) {
        assert_true(tyn_image_file_set_numbers(&image, "chromaticities",
                                               TYN_ATTRIBUTE_CHROMATICITIES, k ? none : acescg));
        assert_int_equal(tyn_exr_write(&image, io_path("aces.exr"), true, &log.log), TYN_OK);
        assert_int_equal(tyn_environment_load(&env, io_path("aces.exr"), &log.log), TYN_OK);
        const float *first = env.data + 3 * 16, *second = env.data + 3 * 49;
        for (int c = 0; c < 3; c++) {
            static const double row[3][3] = {{1.70505, -0.62179, -0.08326},
                                             {-0.13026, 1.14080, -0.01055},
                                             {-0.02400, -0.12897, 1.15297}};
            const double right = 0.5 * row[c][0] + 0.25 * (row[c][1] + row[c][2]);
            assert_near(first[c], 1, 1e-5);
            assert_near(second[c], k ? values[c][1] : right, 1e-4);
        }
    }
    free(env.data);
    free(image.attributes);
}

// Writes an image of 12 x 12 with the library itself: lines or 8 x 8 tiles that count from 0.
static const char *write_kind(exr_storage_t storage, int parts, exr_pixel_type_t type)
{
    const char *path = io_path("kind.exr");
    exr_context_t context;
    float count[64];
    const int32_t no_samples[12] = {0};
    for (int i = 0; i < 64; i++) {
        count[i] = (float)i;
    }
    assert_int_equal(exr_start_write(&context, path, EXR_WRITE_FILE_DIRECTLY, NULL), 0);
    for (int p = 0; p < parts; p++) {
        int index;
        exr_add_part(context, p ? "two" : "one", storage, &index);
        exr_initialize_required_attr_simple(context, p, 12, 12, EXR_COMPRESSION_NONE);
        if (storage == EXR_STORAGE_TILED) {
            exr_set_tile_descriptor(context, p, 8, 8, EXR_TILE_ONE_LEVEL, EXR_TILE_ROUND_DOWN);
        }
        exr_add_channel(context, p, "Y", type, EXR_PERCEPTUALLY_LINEAR, 1, 1);
        exr_set_version(context, p, 1);
    }
    assert_int_equal(exr_write_header(context), 0);
    for (int t = 0; storage == EXR_STORAGE_TILED && t < 4; t++) {
        size_t side_x = t & 1 ? 4 : 8, side_y = t & 2 ? 4 : 8;
        exr_write_tile_chunk(context, 0, t & 1, t >> 1, 0, 0, count, side_x * side_y * 4);
    }
    for (int y = 0; y < 12 * parts; y++) {
        if (storage == EXR_STORAGE_SCANLINE) {
            exr_write_scanline_chunk(context, y / 12, y % 12, count, 48);
        } else if (storage == EXR_STORAGE_DEEP_SCANLINE) {
            exr_write_deep_scanline_chunk(context, 0, y, count, 0, 0, no_samples, 48);
        }
    }
    assert_int_equal(exr_finish(&context), 0);
    return path;
}

static void refuse(const char *path, const char *says)
{
    tyn_image_file image;
    io_log log;
    io_log_init(&log);
    assert_int_equal(tyn_exr_read(&image, path, &log.log), TYN_ERR_PARAMS);
    assert_int_equal(log.errors, 1);
    assert_int_equal(log.newlines, 0);
    if (!strstr(log.last, says)) {
        print_error("%s\n", log.last);
    }
    assert_non_null(strstr(log.last, says));
}

// Damaged data of this compression, which the library calls a lack of memory: no bits are set in its bitmap, and its
// code of so many bytes is none.
static void damaged_piz(void **state)
{
    exr_context_t context;
    uint8_t data[200] = {1, 0, 0, 0, 190};
    uint32_t random = 1;
    int part;
    (void)state;
    for (int i = 0; i < 64; i++) {
        const char *path = io_path("piz.exr");
        for (size_t k = 8; k < sizeof data; k++) {
            random = random * 1664525u + 1013904223u;
            data[k] = (uint8_t)(random >> 24);
        }
        memset(data + 8, 0, 8); // codes from 0 to 0
        data[12] = (uint8_t)(i * 4);
        assert_int_equal(exr_start_write(&context, path, EXR_WRITE_FILE_DIRECTLY, NULL), 0);
        exr_add_part(context, "one", EXR_STORAGE_SCANLINE, &part);
        exr_initialize_required_attr_simple(context, 0, 12, 12, EXR_COMPRESSION_PIZ);
        exr_add_channel(context, 0, "Y", EXR_PIXEL_FLOAT, EXR_PERCEPTUALLY_LINEAR, 1, 1);
        assert_int_equal(exr_write_header(context), 0);
        exr_write_scanline_chunk(context, 0, 0, data, sizeof data);
        assert_int_equal(exr_finish(&context), 0);
        refuse(path, "piz.exr");
    }
}

// Three channels of half floats and one of integers, which is left out, wherever it lies among them.
static void left_out(void **state)
{
    (void)state;
    static const char *names[4] = {"A", "B", "G", "R"};
    static const uint16_t halves[4] = {0x3c00, 0x4000, 0x4200, 0x4400}; // 1 to 4
    for (int left = 0; left < 4; left++) {
        const char *path = io_path("left.exr");
        exr_context_t context;
        int part;
        assert_int_equal(exr_start_write(&context, path, EXR_WRITE_FILE_DIRECTLY, NULL), 0);
        exr_add_part(context, "one", EXR_STORAGE_SCANLINE, &part);
        exr_initialize_required_attr_simple(context, 0, 12, 12, EXR_COMPRESSION_NONE);
        for (int c = 0; c < 4; c++) {
            exr_add_channel(context, 0, names[c], c == left ? EXR_PIXEL_UINT : EXR_PIXEL_HALF,
                            EXR_PERCEPTUALLY_LINEAR, 1, 1);
        }
        assert_int_equal(exr_write_header(context), 0);
        for (int y = 0; y < 12; y++) {
            uint8_t line[12 * (3 * 2 + 4)];
            size_t at = 0;
            for (int c = 0; c < 4; c++) {
                for (int x = 0; x < 12; x++) {
                    const uint32_t value = c == left ? 0xdeadbeef : halves[c];
                    const size_t size = c == left ? 4 : 2;
                    memcpy(line + at, &value, size); // of little endian
                    at += size;
                }
            }
            exr_write_scanline_chunk(context, 0, y, line, at);
        }
        assert_int_equal(exr_finish(&context), 0);
        tyn_image_file image;
        io_log log;
        io_log_init(&log);
        assert_int_equal(tyn_exr_read(&image, path, &log.log), TYN_OK);
        assert_int_equal(image.num_channels, 3);
        for (int c = 0; c < 4; c++) {
            const float *data = tyn_image_file_channel(&image, names[c]);
            assert_true((data == NULL) == (c == left));
            for (int i = 0; data && i < 144; i++) {
                assert_true(data[i] == (float)(c + 1));
            }
        }
        tyn_image_file_finish(&image);
    }
}

static void kinds(void **state)
{
    tyn_image_file image;
    io_log log;
    (void)state;
    io_log_init(&log);
    const char *path = write_kind(EXR_STORAGE_TILED, 1, EXR_PIXEL_FLOAT);
    assert_int_equal(tyn_exr_read(&image, path, &log.log), TYN_OK);
    assert_int_equal(image.width, 12);
    const float *y = image.channels[0].data;
    assert_true(y[0] == 0 && y[12] == 8 && y[8] == 0 && y[12 + 8] == 4 && y[8 * 12 + 8] == 0 &&
                y[11 * 12 + 11] == 15);
    tyn_image_file_finish(&image);
    refuse(write_kind(EXR_STORAGE_SCANLINE, 2, EXR_PIXEL_FLOAT), "2 parts");
    refuse(write_kind(EXR_STORAGE_SCANLINE, 1, EXR_PIXEL_UINT), "no half or float");
    refuse(write_kind(EXR_STORAGE_DEEP_SCANLINE, 1, EXR_PIXEL_FLOAT), "deep");
    void *file;
    size_t size;
    path = write_kind(EXR_STORAGE_SCANLINE, 1, EXR_PIXEL_FLOAT);
    assert_int_equal(tyn_file_read(path, 1 << 20, &file, &size, &log.log), TYN_OK);
    const char entry[] = {'Y', 0, 2, 0, 0, 0, 0, 0,
                          0,   0, 1, 0, 0, 0, 1}; // name, type, ..., sampling
    char *found = memmem(file, size, entry, sizeof entry);
    if (!found) { // perceptually linear is a byte before the reserved ones
        const char linear[] = {'Y', 0, 2, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
        found = memmem(file, size, linear, sizeof linear);
    }
    assert_non_null(found);
    found[10] = found[14] = 2;
    refuse(io_put("sub.exr", file, size), "subsampled");
    free(file);
}

static void broken(void **state)
{
    tyn_image_file image, read;
    io_log log;
    void *whole;
    size_t size;
    (void)state;
    io_log_init(&log);
    fill(&image);
    const char *path = io_path("whole.exr");
    assert_int_equal(tyn_exr_write(&image, path, false, &log.log), TYN_OK);
    assert_int_equal(tyn_file_read(path, 1 << 20, &whole, &size, &log.log), TYN_OK);
    tyn_image_file_finish(&image);
    for (size_t cut = 0; cut < size - 1; cut += 7) { // truncated anywhere
        uint8_t *file = malloc(cut + 1);
        memcpy(file, whole, cut);
        io_log_init(&log);
        assert_int_equal(tyn_exr_parse(&read, file, cut, "cut.exr", &log.log), TYN_ERR_PARAMS);
        assert_int_equal(log.errors, 1);
        assert_int_equal(log.newlines, 0);
        assert_non_null(strstr(log.last, "cut.exr"));
        free(file);
    }
    // Attributes: the value of `name` (behind name, type and size) is overwritten.
    const struct {
        const char *name, *type;
        size_t at;
        int32_t value;
    } attributes[] = {{"dataWindow", "box2i", 8, 0x7ffffff0}, {"dataWindow", "box2i", 8, -100},
                      {"dataWindow", "box2i", 12, 60000},     {"dataWindow", "box2i", 0, 22},
                      {"compression", "compression", 0, 99},  {"channels", "chlist", 2, 77},
                      {"lineOrder", "lineOrder", 0, 88}};
    for (size_t i = 0; i < sizeof attributes / sizeof attributes[0]; i++) {
        uint8_t *file = malloc(size);
        memcpy(file, whole, size);
        char key[64];
        int length = snprintf(key, sizeof key, "%s%c%s", attributes[i].name, 0, attributes[i].type);
        uint8_t *found = memmem(file, size, key, (size_t)length + 1);
        assert_non_null(found);
        uint8_t *value = found + length + 1 + 4 + attributes[i].at;
        memcpy(value, &attributes[i].value, strcmp(attributes[i].type, "box2i") ? 1 : 4);
        io_log_init(&log);
        tyn_result r = tyn_exr_parse(&read, file, size, "bad.exr", &log.log);
        if (r != TYN_ERR_PARAMS) {
            print_error("attribute %zu: %d\n", i, r);
        }
        assert_int_equal(r, TYN_ERR_PARAMS);
        assert_int_equal(log.errors, 1);
        free(file);
    }
    const struct {
        const char *name, *bytes;
    } others[] = {
        {"empty.exr", ""}, {"text.exr", "not an image at all"}, {"magic.exr", "v/1\1\2\0\0\0"}};
    for (int i = 0; i < 3; i++) {
        io_log_init(&log);
        path = io_put_text(others[i].name, others[i].bytes);
        assert_int_equal(tyn_exr_read(&read, path, &log.log), TYN_ERR_PARAMS);
        assert_int_equal(log.errors, 1);
    }
    io_log_init(&log);
    assert_int_equal(tyn_exr_read(&read, io_path("none.exr"), &log.log), TYN_ERR_IO);
    assert_int_equal(log.errors, 1);
    free(whole);
}

static void png(void **state)
{
    (void)state;
    for (uint32_t channels = 3; channels <= 4; channels++) {
        uint8_t pixels[31 * 17 * 4];
        io_log log;
        io_log_init(&log);
        for (uint32_t i = 0; i < sizeof pixels; i++) {
            pixels[i] = (uint8_t)(i < 600 ? i / 3 : i * i * 2654435761u >> 24);
        }
        const char *path = io_path("a.png");
        assert_int_equal(tyn_png_write(path, 31, 17, channels, pixels, &log.log), TYN_OK);
        int w, h, n;
        uint8_t *read = stbi_load(path, &w, &h, &n, 0);
        assert_non_null(read);
        assert_true(w == 31 && h == 17 && n == (int)channels);
        assert_memory_equal(read, pixels, 31 * 17 * channels);
        stbi_image_free(read);
        uint32_t width, height;
        uint8_t *rgba;
        assert_int_equal(tyn_png_read(path, &width, &height, &rgba, &log.log), TYN_OK);
        assert_true(width == 31 && height == 17);
        for (uint32_t i = 0; i < 31 * 17; i++) {
            assert_memory_equal(&rgba[4 * i], &pixels[channels * i], channels);
            assert_true(channels == 4 || rgba[4 * i + 3] == 255);
        }
        free(rgba);
        assert_int_equal(tyn_png_write(path, 0, 17, 3, pixels, &log.log), TYN_ERR_PARAMS);
        assert_int_equal(tyn_png_write(path, 3, 17, 2, pixels, &log.log), TYN_ERR_PARAMS);
        assert_int_equal(tyn_png_write(io_path("no/a.png"), 3, 3, 3, pixels, &log.log), TYN_ERR_IO);
        assert_int_equal(log.errors, 3);
    }
}

static void png_refusals(void **state)
{
    // Pictures that are no PNG, a PNG that is cut, and none at all.
    static const uint8_t cut[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n', 0, 0};
    static const uint8_t jpeg[] = {0xff, 0xd8, 0xff, 0xe0, 0, 16, 'J', 'F', 'I', 'F', 0};
    const char *const paths[] = {io_put("cut.png", cut, sizeof cut),
                                 io_put("jpeg.png", jpeg, sizeof jpeg), io_path("nothere.png")};
    (void)state;
    for (int i = 0; i < 3; i++) {
        io_log log;
        io_log_init(&log);
        uint32_t width, height;
        uint8_t *rgba;
        assert_int_equal(tyn_png_read(paths[i], &width, &height, &rgba, &log.log),
                         i < 2 ? TYN_ERR_PARAMS : TYN_ERR_IO);
        assert_null(rgba);
        assert_int_equal(log.errors, 1);
        assert_non_null(strstr(log.last, paths[i]));
    }
}

static void real_file(void **state)
{
    tyn_environment env = {0};
    io_log log;
    (void)state;
    io_log_init(&log);
    const char *path = io_shared("data/museum.exr");
    if (!path) {
        skip_without("data/museum.exr");
    }
    assert_int_equal(tyn_environment_load(&env, path, &log.log), TYN_OK);
    double sum = 0;
    for (size_t i = 0; i < 3 * (size_t)env.size[0] * env.size[1]; i++) {
        sum += env.data[i];
    }
    print_message("museum.exr: %u x %u, mean %g\n", env.size[0], env.size[1],
                  sum / (3.0 * env.size[0] * env.size[1]));
    assert_int_equal(env.size[0], 2 * env.size[1]);
    assert_true(sum > 0 && isfinite(sum));
    free(env.data);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(round_trip),       cmocka_unit_test(windows),
        cmocka_unit_test(attributes),       cmocka_unit_test(incompressible),
        cmocka_unit_test(refused_channels), cmocka_unit_test(saturation),
        cmocka_unit_test(environments),     cmocka_unit_test(primaries),
        cmocka_unit_test(partial_maps),     cmocka_unit_test(kinds),
        cmocka_unit_test(broken),           cmocka_unit_test(damaged_piz),
        cmocka_unit_test(left_out),         cmocka_unit_test(png),
        cmocka_unit_test(png_refusals),     cmocka_unit_test(real_file)};
    return run_cases(tests, NULL, io_test_clean);
}
