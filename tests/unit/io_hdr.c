// io_hdr.c -- Radiance pictures: the three encodings, and damaged ones.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "io/hdr.h"
#include "io_test.h"
#include "numbers.h"

#define HEAD "#?RADIANCE\n# a comment\nFORMAT=32-bit_rle_rgbe\n\n"

typedef struct file {
    uint8_t bytes[256];
    size_t size;
} file;

static file make(const char *head, const uint8_t *pixels, size_t count)
{
    file f = {.size = strlen(head) + count};
    memcpy(f.bytes, head, strlen(head));
    memcpy(f.bytes + strlen(head), pixels, count);
    return f;
}

static float *parse(const file *f, uint32_t size[2])
{
    float *pixels = NULL;
    io_log log;
    io_log_init(&log);
    assert_int_equal(tyn_hdr_parse(size, &pixels, f->bytes, f->size, "a.hdr", &log.log), TYN_OK);
    assert_int_equal(log.errors, 0);
    return pixels;
}

static void encodings(void **state)
{
    uint32_t size[2];
    (void)state;
    const uint8_t flat[] = {128, 64, 0, 129, 0, 0, 0, 0};
    file f = make(HEAD "-Y 1 +X 2\n", flat, sizeof flat);
    float *p = parse(&f, size);
    assert_true(size[0] == 2 && size[1] == 1);
    assert_true(p[0] == 1 && p[1] == 0.5f && p[2] == 0 && p[3] == 0); // 128/256 * 2^1
    free(p);

    const uint8_t old[] = {128, 64, 32, 128, 1, 1, 1, 3, 64, 64, 64, 128};
    f = make(HEAD "-Y 1 +X 5\n", old, sizeof old);
    p = parse(&f, size);
    assert_true(p[0] == 0.5f && p[3] == 0.5f && p[10] == 0.25f && p[12] == 0.25f);
    free(p);

    // Runs of 8 for red and exponent, literals for green, both for blue.
    const uint8_t new_style[] = {2, 2, 0, 8,   136, 128, 8, 1, 2, 3,  4,   5,
                                 6, 7, 8, 132, 16,  4,   0, 0, 0, 64, 136, 128};
    f = make("#?RGBE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=2\n\n-Y 1 +X 8\n", new_style,
             sizeof new_style);
    p = parse(&f, size);
    assert_true(p[0] == 0.25f && p[1] == 1 / 512.0f && p[22] == 8 / 512.0f);
    assert_true(p[2] == 16 / 512.0f && p[23] == 64 / 512.0f);
    free(p);
}

// Red of Rec. 2020: 1.6605 of red, and less of the others than Rec. 709 has (ITU-R BT.2087, inverted).
static void primaries(void **state)
{
    uint32_t size[2];
    (void)state;
    const uint8_t red[] = {128, 0, 0, 129};
    file f =
        make("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nPRIMARIES= 0.708 0.292 0.170 0.797 0.131 0.046 "
             "0.3127 0.3290\n\n-Y 1 +X 1\n",
             red, sizeof red);
    float *p = parse(&f, size);
    assert_near(p[0], 1.6605, 1e-3);
    assert_near(p[1], -0.1246, 1e-3);
    assert_near(p[2], -0.0182, 1e-3);
    free(p);
}

static void broken(void **state)
{
    const uint8_t pixels[32] = {2, 2, 0, 8, 136, 7};
    const uint8_t repeat_first[] = {1, 1, 1, 3, 9, 9, 9, 9};
    const uint8_t too_long[] = {9, 9, 9, 129, 1, 1, 1, 200};
    const uint8_t shifted[] = {9, 9, 9, 129, 1, 1, 1, 0, 1, 1, 1, 0,
                               1, 1, 1, 0,   1, 1, 1, 0, 1, 1, 1, 1};
    const uint8_t zero_run[] = {2, 2, 0, 8, 0, 0, 0, 0};
    const uint8_t overrun[] = {2, 2, 0, 8, 137, 1, 137, 1, 137, 1, 137, 1};
    const file files[] = {
        make("", pixels, 0),                          // empty
        make("#?RADIANCE", pixels, 0),                // nothing but the magic
        make("P6\n2 2\n255\n", pixels, 12),           // another format
        make("#?RADIANCE\n\n-Y 1 +X 2\n", pixels, 8), // no FORMAT
        make("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 2\n", pixels, 8),
        make("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n", pixels, 0), // header without end
        make("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=0\n\n-Y 1 +X 2\n", pixels, 8),
        make(HEAD "+X 2 -Y 1\n", pixels, 8),               // another orientation
        make(HEAD "-Y 0 +X 2\n", pixels, 8),               // no pixels
        make(HEAD "-Y -1 +X 2\n", pixels, 8),              // negative
        make(HEAD "-Y 60000 +X 60000\n", pixels, 8),       // absurd
        make(HEAD "-Y 99999999999 +X 2\n", pixels, 8),     // beyond int
        make(HEAD "-Y 1000 +X 2\n", pixels, 8),            // truncated
        make(HEAD "-Y 1 +X 8\n", pixels, 6),               // inside a run
        make(HEAD "-Y 1 +X 4\n", repeat_first, 8),         // repeats nothing
        make(HEAD "-Y 1 +X 4\n", too_long, 8),             // beyond the line
        make(HEAD "-Y 1 +X 4\n", shifted, sizeof shifted), // shifted out of range
        make(HEAD "-Y 1 +X 8\n", zero_run, 8),             // run of nothing
        make(HEAD "-Y 1 +X 8\n", overrun, sizeof overrun), // run beyond the line
    };
    (void)state;
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        tyn_environment env = {0};
        io_log log;
        io_log_init(&log);
        const char *path = io_put("bad.hdr", files[i].bytes, files[i].size);
        assert_int_equal(tyn_environment_load(&env, path, &log.log), TYN_ERR_PARAMS);
        assert_int_equal(log.errors, 1);
        assert_int_equal(log.newlines, 0);
        assert_non_null(strstr(log.last, path));
        assert_false(env.present);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(encodings), cmocka_unit_test(primaries),
                                       cmocka_unit_test(broken)};
    return cmocka_run_group_tests(tests, NULL, io_test_clean);
}
