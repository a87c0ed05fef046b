// io_vdb.c -- OpenVDB files, or the line that says how to get them.
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "io_test.h"
#include "skip.h"
#include "vdb_files.h"

static void real_file(void **state)
{
    tyn_volume v;
    io_log log;
    (void)state;
    io_log_init(&log);
    const char *path = io_shared("data/smoke.vdb");
    if (!path) {
        skip_without("data/smoke.vdb");
    }
    tyn_result r = tyn_volume_load(&v, path, NULL, NULL, &log.log);
    if (r == TYN_ERR_UNSUPPORTED) {
        assert_int_equal(log.errors, 1);
        assert_non_null(strstr(log.last, "-Dopenvdb=enabled"));
        skip_case("built without OpenVDB");
    }
    assert_int_equal(r, TYN_OK);
    uint64_t active = 0;
    for (size_t i = 0; i < (size_t)v.size[0] * v.size[1] * v.size[2]; i++) {
        active += v.data[i] > 0;
    }
    print_message("%s: %u x %u x %u, max %g\n", v.name, v.size[0], v.size[1], v.size[2],
                  v.max_density);
    assert_int_equal(active, 1049275); // its count of active voxels
    assert_true(v.max_density > 5 && v.max_density < 6);
    assert_true(fabs(v.index_to_world[0] - 1 / 2.1) < 1e-6);
    tyn_volume_finish(&v);
    assert_int_equal(tyn_volume_load(&v, path, "fire", NULL, &log.log), TYN_ERR_PARAMS);
    assert_non_null(strstr(log.last, "\"density\" (float)"));
    assert_int_equal(log.errors, 1);
}

static void broken(void **state)
{
    (void)state;
    const char *path = io_shared("data/smoke.vdb");
    void *whole = NULL;
    size_t size = 64;
    io_log log;
    io_log_init(&log);
    if (path) {
        assert_int_equal(tyn_file_read(path, 1 << 24, &whole, &size, &log.log), TYN_OK);
    }
    const size_t cuts[] = {0, 1, 7, 20, 40, 100, 200, 400, 1000, 100000, size - 1};
    for (size_t i = 0; i < sizeof cuts / sizeof cuts[0]; i++) {
        tyn_volume v;
        uint8_t text[64] = "this is no volume";
        io_log_init(&log);
        const char *bad = io_put("bad.vdb", whole ? whole : text, cuts[i] < size ? cuts[i] : size);
        tyn_result r = tyn_volume_load(&v, bad, NULL, NULL, &log.log);
        assert_true(r == TYN_ERR_PARAMS || r == TYN_ERR_UNSUPPORTED);
        assert_int_equal(log.errors, 1);
        assert_int_equal(log.newlines, 0);
        assert_null(v.data);
    }
    free(whole);
    if (!path) { // and a text alone was no volume
        skip_without("data/smoke.vdb");
    }
}

#ifdef HAVE_VDB_FILES

// Every way of storing values gives the densities that were stored.
static void stored_values(void **state)
{
    (void)state;
    for (int i = 0; i < VDB_FILES; i++) {
        tyn_volume v;
        io_log log;
        io_log_init(&log);
        const char *path = io_path("stored.vdb");
        assert_true(vdb_file_write(i, path));
        print_message("%d: ", i);
        assert_int_equal(tyn_volume_load(&v, path, NULL, NULL, &log.log), TYN_OK);
        assert_int_equal(v.size[0], VDB_NX);
        assert_int_equal(v.size[1], VDB_NY);
        assert_int_equal(v.size[2], VDB_NZ);
        size_t at = 0;
        for (int z = 0; z < VDB_NZ; z++) {
            for (int y = 0; y < VDB_NY; y++) {
                for (int x = 0; x < VDB_NX; x++) { // sixteenths are half floats to the bit
                    assert_true(v.data[at++] == vdb_file_density(x, y, z));
                }
            }
        }
        print_message("%zu densities\n", at);
        tyn_volume_finish(&v);
    }
}

// A blank among the digits of the UUID, which the library leaves out: all that follows is a byte farther then.
static void uuids(void **state)
{
    (void)state;
    void *whole = NULL;
    size_t size = 0;
    io_log log;
    io_log_init(&log);
    assert_true(vdb_file_write(0, io_path("whole.vdb")));
    assert_int_equal(tyn_file_read(io_path("whole.vdb"), 1 << 24, &whole, &size, &log.log), TYN_OK);
    ((uint8_t *)whole)[21 + 24] = '\r';
    tyn_volume v;
    assert_int_equal(tyn_volume_load(&v, io_put("blank.vdb", whole, size), NULL, NULL, &log.log),
                     TYN_ERR_PARAMS);
    assert_non_null(strstr(log.last, "its UUID is not"));
    free(whole);
}

// A byte is changed, at places all over the file: it is read, or there is one line. What is not freed then is told by
// the address sanitizer alone.
static void damaged(void **state)
{
    (void)state;
    uint32_t refused = 0, unpacked = 0, tried = 0;
    for (int i = 0; i < VDB_FILES; i++) {
        void *whole = NULL;
        size_t size = 0;
        io_log log;
        io_log_init(&log);
        assert_true(vdb_file_write(i, io_path("whole.vdb")));
        assert_int_equal(tyn_file_read(io_path("whole.vdb"), 1 << 24, &whole, &size, &log.log),
                         TYN_OK);
        for (size_t at = 13; at < size; at += 1 + size / 199) {
            tyn_volume v;
            ((uint8_t *)whole)[at] ^= 0x5a;
            io_log_init(&log);
            const char *bad = io_put("bad.vdb", whole, size);
            const tyn_result r = tyn_volume_load(&v, bad, NULL, NULL, &log.log);
            assert_int_equal(log.errors, r ? 1 : 0);
            assert_int_equal(log.newlines, 0);
            unpacked += r && strstr(log.last, "cannot be unpacked");
            refused += r != TYN_OK;
            tried++;
            tyn_volume_finish(&v);
            ((uint8_t *)whole)[at] ^= 0x5a;
        }
        free(whole);
    }
    print_message("%u of %u refused, %u of them as they were unpacked\n", refused, tried, unpacked);
    // 572 and 47; other versions of zlib and Blosc compress to a few other bytes.
    assert_in_range(refused, 550, 600);
    assert_in_range(unpacked, 40, 55);
}

#endif

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(real_file), cmocka_unit_test(broken),
#ifdef HAVE_VDB_FILES
                                       cmocka_unit_test(stored_values), cmocka_unit_test(uuids),
                                       cmocka_unit_test(damaged)
#endif
    };
    return run_cases(tests, NULL, io_test_clean);
}
