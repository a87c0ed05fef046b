// pipeline_blob.c -- compiled kernels as bytes that a host keeps: there and back, damaged, of others.
#include <math.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "small_frame.h"

enum { HEADER = 56 };

// ---- the blob -----------------------------------------------------------------------------------

static size_t get_blob(tyn_device *dev, char *blob, size_t room)
{
    size_t size = 0;
    assert_int_equal(tyn_device_pipeline_cache(dev, NULL, &size), TYN_OK);
    assert_true(size > HEADER && size <= room);
    size_t written = room;
    assert_int_equal(tyn_device_pipeline_cache(dev, blob, &written), TYN_OK);
    assert_int_equal(written, size);
    return size;
}

// Prepares a frame on a new device with these bytes.
static tyn_pipeline_stats run_with(fixture *f, const char *blob, size_t size)
{
    tyn_device *dev = new_device(f, (device_choice){.blob = blob, .blob_size = size});
    tyn_context *ctx = new_context(dev);
    assert_int_equal(prepare(f, ctx, false), TYN_OK);
    assert_int_equal(record(f, ctx, false), TYN_OK);
    expect_picture(f, 0);
    tyn_pipeline_stats stats;
    tyn_device_pipelines(dev, &stats);
    print_message("%u kernels, %u from the cache, %.4f s\n", stats.compiled, stats.from_cache,
                  stats.seconds);
    tyn_context_destroy(&ctx);
    tyn_device_destroy(&dev);
    return stats;
}

// What the driver of this machine gives, it takes back without a word. Some keep nothing in it.
static void blob_of_the_driver(void **state)
{
    fixture *f = *state;
    static char blob[16 << 20], again[16 << 20];
    tyn_device *dev = new_device(f, (device_choice){0});
    const size_t size = get_blob(dev, blob, sizeof blob);
    tyn_device_destroy(&dev);
    print_message("%zu bytes\n", size);
    dev = new_device(f, (device_choice){.blob = blob, .blob_size = size});
    assert_int_equal(driver.given_size, size - HEADER);
    assert_true(get_blob(dev, again, sizeof again) >= size);
    tyn_device_destroy(&dev);
}

static void blob_round_trip(void **state)
{
    fixture *f = *state;
    char blob[HEADER + KEPT_BYTES + 8];
    driver.keeps = true;
    tyn_device *dev = new_device(f, (device_choice){0});
    assert_int_equal(driver.given_size, 0);
    const size_t size = get_blob(dev, blob, sizeof blob);
    assert_int_equal(size, HEADER + KEPT_BYTES);
    // Room for a part: what the driver puts there is whole in itself.
    char part[HEADER + 11];
    size_t written = sizeof part;
    assert_int_equal(tyn_device_pipeline_cache(dev, part, &written), TYN_OK);
    assert_int_equal(written, HEADER + 8);
    // No room.
    written = HEADER - 1;
    assert_int_equal(tyn_device_pipeline_cache(dev, part, &written), TYN_ERR_PARAMS);
    assert_int_equal(written, 0);
    assert_int_equal(tyn_device_pipeline_cache(dev, part, NULL), TYN_ERR_PARAMS);
    assert_int_equal(f->errors, 2);
    f->errors = 0;
    tyn_device_destroy(&dev);

    dev = new_device(f, (device_choice){.blob = part, .blob_size = HEADER + 8});
    assert_int_equal(driver.given_size, 8);
    tyn_device_destroy(&dev);
    memset(driver.given, 0, sizeof driver.given);
    dev = new_device(f, (device_choice){.blob = blob, .blob_size = size});
    assert_int_equal(driver.given_size, KEPT_BYTES);
    assert_memory_equal(driver.given, driver.kept, KEPT_BYTES);
    tyn_device_destroy(&dev);
    driver.ms = 50;
    const tyn_pipeline_stats cold = run_with(f, NULL, 0), warm = run_with(f, blob, size);
    assert_true(cold.compiled > 0 && warm.compiled == cold.compiled);
    assert_int_equal(cold.from_cache, 0);
    assert_int_equal(warm.from_cache, warm.compiled);
    assert_true(cold.seconds >= 0.05 * cold.compiled && warm.seconds < 0.5 * cold.seconds);
    // A driver that does not want what was its own.
    driver.refuses = true;
    dev = new_device(f, (device_choice){.blob = blob, .blob_size = size});
    assert_int_equal(f->warnings, 1);
    f->warnings = 0;
    tyn_device_destroy(&dev);
}

static void expect_ignored(fixture *f, const char *what, const char *blob, size_t size)
{
    print_message("%s\n", what);
    f->warnings = 0;
    driver.given_size = 99;
    tyn_device *dev = new_device(f, (device_choice){.blob = blob, .blob_size = size});
    assert_int_equal(driver.given_size, 0); // the driver does not see it
    assert_int_equal(f->warnings, 1);
    tyn_device_destroy(&dev);
    f->warnings = 0;
}

static void damaged_blobs_are_ignored(void **state)
{
    fixture *f = *state;
    enum { SIZE = HEADER + KEPT_BYTES };
    char blob[SIZE + 8] = {0}, bad[SIZE + 8];
    driver.keeps = true;
    tyn_device *dev = new_device(f, (device_choice){0});
    assert_int_equal(get_blob(dev, blob, sizeof blob), SIZE);
    tyn_device_destroy(&dev);
    const size_t lengths[] = {1, 7, HEADER - 1, HEADER, HEADER + 1, SIZE - 1, SIZE + 1};
    for (size_t i = 0; i < sizeof lengths / sizeof *lengths; i++) {
        char *cut = malloc(lengths[i]); // so that what reads on is found
        memcpy(cut, blob, lengths[i]);
        char what[32];
        snprintf(what, sizeof what, "%zu of %d bytes", lengths[i], SIZE);
        expect_ignored(f, what, cut, lengths[i]);
        free(cut);
    }
    for (size_t i = 0; i < SIZE;
         i++) { // magic, version, ids, driver, uuid, size, checksum, content
        memcpy(bad, blob, SIZE);
        bad[i] ^= (char)(1 << i % 8);
        char what[32];
        snprintf(what, sizeof what, "byte %zu", i);
        expect_ignored(f, what, bad, SIZE);
    }
    memset(bad, 0, SIZE);
    expect_ignored(f, "zeros", bad, SIZE);
    dev = new_device(f, (device_choice){.blob = NULL, .blob_size = 100}); // none was given
    tyn_device_destroy(&dev);
    dev = new_device(f, (device_choice){.blob = blob, .blob_size = 0});
    tyn_device_destroy(&dev);
    assert_int_equal(f->warnings, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(blob_of_the_driver),
        TEST(blob_round_trip),
        TEST(damaged_blobs_are_ignored),
    };
    return cmocka_run_group_tests_name("pipeline_blob", tests, frame_set_up, frame_tear_down);
}
