// io_raw.c -- raw grids: the three types, and files that are not what they should be.
#include <math.h>
#include <string.h>
#include "io/raw.h"
#include "io_test.h"

// A density by itself.
static tyn_result parse(tyn_volume *v, const void *bytes, size_t num_bytes, const int64_t size[3],
                        tyn_raw_type type, const char *file, uint64_t *clamped, const tyn_log *log)
{
    tyn_grid_job job = {.log = log};
    const tyn_result r = tyn_raw_read(&job, bytes, num_bytes, size, 1, type, file);
    *v = job.volume;
    *clamped += job.clamped;
    return r;
}

static void types(void **state)
{
    const float f32[4] = {0, 0.5f, 2, -1};
    const uint16_t f16[4] = {0x0000, 0x3800, 0x4000, 0xbc00}; // the same numbers
    const uint8_t u8[4] = {0, 51, 255, 102};
    const int64_t size[3] = {2, 1, 2};
    tyn_volume v;
    uint64_t clamped = 0;
    io_log log;
    (void)state;
    io_log_init(&log);
    assert_int_equal(parse(&v, f32, sizeof f32, size, TYN_RAW_F32, "a.raw", &clamped, &log.log),
                     TYN_OK);
    assert_true(v.data[1] == 0.5f && v.data[2] == 2 && v.data[3] == 0 && v.max_density == 2);
    assert_int_equal(clamped, 1);
    uint64_t hash = v.hash;
    tyn_volume_finish(&v);
    assert_int_equal(parse(&v, f16, sizeof f16, size, TYN_RAW_F16, "a.raw", &clamped, &log.log),
                     TYN_OK);
    assert_true(v.data[1] == 0.5f && v.data[2] == 2 && v.data[3] == 0);
    assert_int_equal(clamped, 2);
    assert_true(v.hash == hash); // of the contents, not of the file
    tyn_volume_finish(&v);
    assert_int_equal(parse(&v, u8, sizeof u8, size, TYN_RAW_U8, "a.raw", &clamped, &log.log),
                     TYN_OK);
    assert_true(v.data[1] == 0.2f && v.data[2] == 1 && v.data[3] == 0.4f);
    tyn_volume_finish(&v);
    assert_int_equal(log.errors, 0);
}

static void broken(void **state)
{
    const float bytes[8] = {1, 2, 3, 4, 5, NAN, INFINITY, 8};
    const struct {
        int64_t size[3];
        size_t bytes;
        tyn_raw_type type;
        const char *says;
    } files[] = {
        {{2, 2, 1}, 15, TYN_RAW_F32, "15 bytes"},      // truncated
        {{2, 2, 1}, 17, TYN_RAW_F32, "17 bytes"},      // too long
        {{2, 2, 1}, 0, TYN_RAW_F32, "0 bytes"},        // empty
        {{2, 2, 1}, 16, TYN_RAW_F16, "2 x 2 x 1 f16"}, // another type
        {{2, 2, 1}, 16, TYN_RAW_U8, "2 x 2 x 1 u8"},   //
        {{0, 2, 1}, 0, TYN_RAW_F32, "0 x 2 x 1"},      // no voxels
        {{-2, 2, 1}, 16, TYN_RAW_F32, "-2 x 2 x 1"},   // negative
        {{70000, 1, 1}, 16, TYN_RAW_U8, "70000"},      // absurd
        {{65536, 65536, 65536}, 16, TYN_RAW_U8, "at most"},
        {{INT64_MAX, 2, 2}, 16, TYN_RAW_F32, "65536"},
        {{6, 1, 1}, 24, TYN_RAW_F32, "voxel 5, 0, 0"}, // NaN
        {{1, 7, 1}, 28, TYN_RAW_F32, "voxel 0, 5, 0"}, // and infinity
    };
    (void)state;
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        tyn_volume v;
        uint64_t clamped = 0;
        io_log log;
        io_log_init(&log);
        assert_int_equal(parse(&v, bytes, files[i].bytes, files[i].size, files[i].type, "bad.raw",
                               &clamped, &log.log),
                         TYN_ERR_PARAMS);
        assert_int_equal(log.errors, 1);
        assert_int_equal(log.newlines, 0);
        assert_non_null(strstr(log.last, "bad.raw"));
        assert_non_null(strstr(log.last, files[i].says));
        assert_null(v.data);
    }
}

static void alone(void **state)
{
    tyn_volume v;
    tyn_scene scene;
    io_log log;
    (void)state;
    io_log_init(&log);
    assert_int_equal(tyn_volume_load(&v, "x.raw", NULL, NULL, &log.log), TYN_ERR_PARAMS);
    assert_int_equal(tyn_volume_load(&v, "x.txt", NULL, NULL, &log.log), TYN_ERR_PARAMS);
    assert_int_equal(tyn_scene_load(&scene, "x.raw", NULL, &log.log), TYN_ERR_PARAMS);
    assert_int_equal(log.errors, 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(types), cmocka_unit_test(broken),
                                       cmocka_unit_test(alone)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
