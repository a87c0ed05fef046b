// io_nvdb.c -- NanoVDB: every type and codec that is read, tiles, names, damaged files, a real one.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "io/nvdb.h"
#include "io_test.h"
#include "nvdb_write.h"
#include "skip.h"

static float ramp(int32_t i, int32_t j, int32_t k)
{
    return (float)((i * 7 + j * 5 + k * 3) & 15) / 15.0f;
}

static float with_nan(int32_t i, int32_t j, int32_t k)
{
    return i == 5 && j == 4 && k == 3 ? NAN : 1.0f;
}

static float with_negative(int32_t i, int32_t j, int32_t k)
{
    (void)j, (void)k;
    return i < 4 ? -1.0f : 2.0f;
}

// Crosses leaves, lower nodes and, with its negative corner, root tiles.
static nvdb_spec basic(uint32_t type, uint32_t codec)
{
    return (nvdb_spec){.name = "density",
                       .type = type,
                       .codec = codec,
                       .grid_class = 2,
                       .lo = {-3, 2, 1},
                       .hi = {9, 130, 6},
                       .value = ramp,
                       .voxel = 0.25};
}

// A density by itself.
static tyn_result parse_bytes(tyn_volume *v, const void *bytes, size_t size, const char *grid,
                              const char *file, uint64_t *clamped, const tyn_log *log)
{
    tyn_grid_job job = {.grid = grid, .log = log};
    const tyn_result r = tyn_nvdb_read(&job, bytes, size, file);
    *v = job.volume;
    *clamped += job.clamped;
    return r;
}

static tyn_result parse(tyn_volume *v, const nvdb_spec *spec, const char *grid, io_log *log,
                        uint64_t *clamped)
{
    size_t size;
    uint8_t *file = nvdb_write(spec, &size, NULL);
    *clamped = 0;
    io_log_init(log);
    tyn_result r = parse_bytes(v, file, size, grid, "a.nvdb", clamped, &log->log);
    free(file);
    return r;
}

static void types_and_codecs(void **state)
{
    const struct {
        uint32_t type;
        float tolerance;
    } types[] = {{NVDB_FLOAT, 0},   {NVDB_HALF, 0x1p-11f}, {NVDB_FP4, 1e-6f},
                 {NVDB_FP8, 1e-3f}, {NVDB_FP16, 1e-5f},    {NVDB_FPN, 1e-3f}};
    (void)state;
    for (int t = 0; t < 6; t++) {
        for (uint32_t codec = NVDB_PLAIN; codec <= NVDB_BLOSC; codec++) {
            tyn_volume v;
            io_log log;
            uint64_t clamped;
            nvdb_spec spec = basic(types[t].type, codec);
#ifndef TYN_HAVE_BLOSC
            if (codec == NVDB_BLOSC) {
                spec.codec = NVDB_PLAIN;
                continue;
            }
#endif
            assert_int_equal(parse(&v, &spec, NULL, &log, &clamped), TYN_OK);
            assert_int_equal(v.size[0], 13);
            assert_int_equal(v.size[1], 129);
            assert_int_equal(v.size[2], 6);
            for (int32_t k = 1; k <= 6; k++) {
                for (int32_t j = 2; j <= 130; j++) {
                    for (int32_t i = -3; i <= 9; i++) {
                        float got = v.data[((k - 1) * 129 + j - 2) * 13 + i + 3];
                        assert_true(fabsf(got - ramp(i, j, k)) <= types[t].tolerance);
                    }
                }
            }
            // The first voxel, index (-3, 2, 1), is at 0.25 times that.
            const double *m = v.index_to_world;
            assert_true(m[0] == 0.25 && m[5] == 0.25 && m[10] == 0.25 && m[15] == 1);
            assert_true(m[12] == -0.75 && m[13] == 0.5 && m[14] == 0.25);
            assert_string_equal(v.name, "a.nvdb[density]");
            assert_int_equal(log.errors, 0);
            tyn_volume_finish(&v);
        }
    }
}

static void tiles(void **state)
{
    tyn_volume v;
    io_log log;
    uint64_t clamped;
    (void)state;
    nvdb_spec spec = basic(NVDB_FLOAT, NVDB_PLAIN);
    memcpy(spec.tile, (int32_t[]){0, 8, 0}, sizeof spec.tile);
    spec.tile_value = 3;
    assert_int_equal(parse(&v, &spec, "density", &log, &clamped), TYN_OK);
    assert_true(v.data[(0 * 129 + 6) * 13 + 3] == 3);   // index (0, 8, 1)
    assert_true(v.data[(5 * 129 + 13) * 13 + 10] == 3); // index (7, 15, 6)
    assert_true(v.data[(5 * 129 + 14) * 13 + 10] == ramp(7, 16, 6));
    assert_true(v.max_density == 3);
    tyn_volume_finish(&v);
}

static void values(void **state)
{
    tyn_volume v;
    io_log log;
    uint64_t clamped;
    (void)state;
    nvdb_spec spec = basic(NVDB_FLOAT, NVDB_ZIP);
    spec.value = with_nan;
    assert_int_equal(parse(&v, &spec, NULL, &log, &clamped), TYN_ERR_PARAMS);
    assert_int_equal(log.errors, 1);
    assert_non_null(strstr(log.last, "must be finite"));
    spec.value = with_negative;
    assert_int_equal(parse(&v, &spec, NULL, &log, &clamped), TYN_OK);
    assert_int_equal(clamped, 7 * 129 * 6);
    assert_true(v.data[0] == 0 && v.data[12] == 2);
    tyn_volume_finish(&v);
}

static void names(void **state)
{
    tyn_volume v;
    io_log log;
    uint64_t clamped;
    (void)state;
    nvdb_spec spec = basic(NVDB_FLOAT, NVDB_PLAIN);
    spec.name = "soot";
    assert_int_equal(parse(&v, &spec, NULL, &log, &clamped), TYN_OK); // the first one
    tyn_volume_finish(&v);
    assert_int_equal(parse(&v, &spec, "fire", &log, &clamped), TYN_ERR_PARAMS);
    assert_non_null(strstr(log.last, "no grid \"fire\""));
    assert_non_null(strstr(log.last, "\"soot\" (float)"));
    spec.grid_class = 1;
    assert_int_equal(parse(&v, &spec, NULL, &log, &clamped), TYN_ERR_PARAMS);
    assert_non_null(strstr(log.last, "level set"));
    spec.grid_class = 2;
    spec.type = 4; // int32, of the same layout as float
    assert_int_equal(parse(&v, &spec, "soot", &log, &clamped), TYN_ERR_PARAMS);
    assert_non_null(strstr(log.last, "int32"));
    assert_int_equal(log.errors, 1);
}

// Two files one after another are one file of two segments.
static void segments(void **state)
{
    nvdb_spec a = basic(NVDB_FLOAT, NVDB_ZIP), b = basic(NVDB_HALF, NVDB_PLAIN);
    size_t size_a, size_b;
    tyn_volume v;
    io_log log;
    uint64_t clamped = 0;
    (void)state;
    io_log_init(&log);
    a.name = "heat";
    uint8_t *one = nvdb_write(&a, &size_a, NULL), *two = nvdb_write(&b, &size_b, NULL);
    one = realloc(one, size_a + size_b);
    memcpy(one + size_a, two, size_b);
    assert_int_equal(parse_bytes(&v, one, size_a + size_b, NULL, "a.nvdb", &clamped, &log.log),
                     TYN_OK);
    assert_string_equal(v.name, "a.nvdb[density]");
    tyn_volume_finish(&v);
    free(one);
    free(two);
}

// Where damage goes: in the file, or in the unpacked grid behind `grid`.
typedef struct damage {
    const char *what;
    bool in_grid;
    size_t at;
    int bytes;
    uint64_t value;
    const char *says;
} damage;

static void broken(void **state)
{
    enum { TREE = 672, ROOT = 736, TILE = 800, UPPER = 832, LOWER = UPPER + 270400 };
    const damage list[] = {
        {"magic", false, 0, 8, 0x21212121, "must start with"},
        {"version", false, 8, 4, 29u << 21, "version 29"},
        {"no grids", false, 12, 2, 0, "damaged behind a segment"},
        {"more grids than there are", false, 12, 2, 500, "metadata"},
        {"name without end", false, 16 + 136, 4, 3, "metadata"},
        {"name size absurd", false, 16 + 136, 4, 0xffffffff, "metadata"},
        {"no name", false, 16 + 136, 4, 0, "metadata"},
        {"codec", false, 16 + 168, 2, 77, "codec 77"},
        {"file size absurd", false, 16 + 8, 8, 1ull << 60, "cut short"},
        {"grid size absurd", false, 16, 8, 1ull << 50, "cannot be"},
        {"grid size 0", false, 16, 8, 0, "cannot be"},
        {"grid magic", true, 0, 8, 0, "header"},
        {"grid version", true, 16, 4, 31u << 21, "header"},
        {"grid type", true, 636, 4, 9, "header"},
        {"root before the tree", true, TREE + 24, 8, (uint64_t)-64, "header"},
        {"root beyond the grid", true, TREE + 24, 8, 1 << 30, "header"},
        {"root at an odd place", true, TREE + 24, 8, 65, "header"},
        {"box turned round", true, ROOT, 4, 1000, "no active voxels"},
        {"box absurd", true, ROOT + 12, 4, 0x7fffffff, "65536"},
        {"box of too many voxels", true, ROOT + 20, 4, 60000, NULL},
        {"tile count absurd", true, ROOT + 24, 4, 0xffffffff, "nodes"},
        {"upper node before the grid", true, TILE + 8, 8, (uint64_t)-4096, "nodes"},
        {"upper node is the root", true, TILE + 8, 8, (uint64_t)-64, "nodes"},
        {"upper node beyond the grid", true, TILE + 8, 8, 1ull << 40, "nodes"},
        {"lower node beyond the grid", true, UPPER + 8256, 8, 1ull << 40, "nodes"},
        {"lower node at an odd place", true, UPPER + 8256, 8, 3, "nodes"},
        {"leaf beyond the grid", true, LOWER + 1088, 8, 1ull << 40, "nodes"},
        {"leaf at the end", true, LOWER + 1088, 8, LOWER, "nodes"},
    };
    nvdb_spec spec = {.name = "density",
                      .type = NVDB_FLOAT,
                      .grid_class = 2,
                      .hi = {9, 9, 9},
                      .value = ramp,
                      .voxel = 1};
    size_t size, grid;
    uint8_t *whole = nvdb_write(&spec, &size, &grid), *file = malloc(size);
    (void)state;
    for (size_t i = 0; i < sizeof list / sizeof list[0]; i++) {
        tyn_volume v;
        io_log log;
        io_log_init(&log);
        memcpy(file, whole, size);
        for (int b = 0; b < list[i].bytes; b++) {
            file[(list[i].in_grid ? grid : 0) + list[i].at + (size_t)b] =
                (uint8_t)(list[i].value >> (8 * b));
        }
        const char *path = io_put("bad.nvdb", file, size);
        tyn_result r = tyn_volume_load(&v, path, NULL, NULL, &log.log);
        if (!list[i].says) { // a big box around few leaves is legal
            assert_int_equal(r, TYN_OK);
            tyn_volume_finish(&v);
            continue;
        }
        if (r != TYN_ERR_PARAMS || log.errors != 1 || !strstr(log.last, list[i].says)) {
            print_error("%s: %d, %d errors: %s\n", list[i].what, r, log.errors, log.last);
        }
        assert_int_equal(r, TYN_ERR_PARAMS);
        assert_int_equal(log.errors, 1);
        assert_int_equal(log.newlines, 0);
        assert_non_null(strstr(log.last, path));
        assert_non_null(strstr(log.last, list[i].says));
        assert_null(v.data);
    }
    for (size_t cut = 0; cut < size; cut += cut < 300 ? 1 : 9973) { // truncated anywhere
        tyn_volume v;
        io_log log;
        uint64_t clamped = 0;
        io_log_init(&log);
        memcpy(file, whole, cut);
        assert_int_equal(parse_bytes(&v, file, cut, NULL, "cut.nvdb", &clamped, &log.log),
                         TYN_ERR_PARAMS);
        assert_int_equal(log.errors, 1);
    }
    free(whole);
    free(file);
}

static void packed_damage(void **state)
{
    (void)state;
    for (uint32_t codec = NVDB_ZIP; codec <= NVDB_BLOSC; codec++) {
        nvdb_spec spec = basic(NVDB_FLOAT, codec);
        size_t size, grid;
        uint8_t *file = nvdb_write(&spec, &size, &grid);
        tyn_volume v;
        io_log log;
        uint64_t clamped = 0;
        io_log_init(&log);
        file[grid] ^= 0xff; // packed size
        tyn_result r = parse_bytes(&v, file, size, NULL, "a.nvdb", &clamped, &log.log);
        assert_true(r == TYN_ERR_PARAMS || r == TYN_ERR_UNSUPPORTED); // no BLOSC in this build
        file[grid] ^= 0xff;
        memset(file + grid + 8, 0x55, 64);
        r = parse_bytes(&v, file, size, NULL, "a.nvdb", &clamped, &log.log);
        assert_true(r == TYN_ERR_PARAMS || r == TYN_ERR_UNSUPPORTED);
        assert_int_equal(log.errors, 2);
        free(file);
    }
}

// Two root tiles of one key: an hour's work for a small file, if it were believed.
static void overlap(void **state)
{
    enum { SECOND_TILE = 672 + 64 + 64 + 32 };
    nvdb_spec spec = {.name = "density",
                      .type = NVDB_FLOAT,
                      .grid_class = 2,
                      .lo = {-16, 0, 0},
                      .hi = {1, 9, 9},
                      .value = ramp,
                      .voxel = 1};
    size_t size, grid;
    uint8_t *file = nvdb_write(&spec, &size, &grid);
    tyn_volume v;
    io_log log;
    uint64_t clamped = 0;
    (void)state;
    io_log_init(&log);
    memcpy(file + grid + SECOND_TILE, file + grid + SECOND_TILE - 32, 8);
    assert_int_equal(parse_bytes(&v, file, size, NULL, "a.nvdb", &clamped, &log.log),
                     TYN_ERR_PARAMS);
    assert_int_equal(log.errors, 1);
    assert_non_null(strstr(log.last, "overlap"));
    free(file);
}

// A volume alone becomes a scene: a camera, a sun, a sky.
static void alone(void **state)
{
    nvdb_spec spec = basic(NVDB_FLOAT, NVDB_ZIP);
    size_t size;
    tyn_scene scene;
    io_log log;
    (void)state;
    io_log_init(&log);
    uint8_t *file = nvdb_write(&spec, &size, NULL);
    const char *path = io_put("cloud.nvdb", file, size);
    assert_int_equal(tyn_scene_load(&scene, path, NULL, &log.log), TYN_OK);
    assert_int_equal(scene.num_cameras, 1);
    assert_int_equal(scene.num_lights, 1);
    assert_int_equal(scene.num_shapes, 1);
    assert_true(scene.environment.present && scene.environment.data);
    // The box spans the voxels' outer corners: 13 x 129 x 6 voxels of 0.25 m.
    float lo[3], hi[3];
    tyn_scene_bounds(&scene, lo, hi);
    assert_true(fabsf(lo[0] + 3.5f * 0.25f) < 1e-5f && fabsf(hi[0] - 9.5f * 0.25f) < 1e-5f);
    assert_true(fabsf(lo[1] - 1.5f * 0.25f) < 1e-5f && fabsf(hi[1] - 130.5f * 0.25f) < 1e-4f);
    tyn_scene_finish(&scene);
    const uint8_t hdr[] = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n\x80\x80\x80\x81";
    const char *map = io_put("sky.hdr", hdr, sizeof hdr - 1);
    assert_int_equal(tyn_scene_load(&scene, path, map, &log.log), TYN_OK);
    assert_int_equal(scene.num_lights, 0); // the map lights it
    assert_true(scene.environment.size[0] == 65 && scene.environment.data[0] == 1);
    tyn_scene_finish(&scene);
    assert_int_equal(tyn_scene_load(&scene, path, io_path("none.hdr"), &log.log), TYN_ERR_IO);
    assert_int_equal(log.errors, 1);
    free(file);
}

static void real_file(void **state)
{
    tyn_volume v;
    io_log log;
    (void)state;
    io_log_init(&log);
    const char *path = io_shared("data/teapot_cloud.nvdb");
    if (!path) {
        skip_without("data/teapot_cloud.nvdb");
    }
    assert_int_equal(tyn_volume_load(&v, path, NULL, NULL, &log.log), TYN_OK);
    uint64_t dense = 0;
    for (size_t i = 0; i < (size_t)v.size[0] * v.size[1] * v.size[2]; i++) {
        dense += v.data[i] > 0;
    }
    print_message("%s: %u x %u x %u, max %g, %llu voxels > 0\n", v.name, v.size[0], v.size[1],
                  v.size[2], v.max_density, (unsigned long long)dense);
    assert_int_equal(v.size[0], 267);
    assert_int_equal(v.size[1], 134);
    assert_int_equal(v.size[2], 178);
    assert_true(v.max_density == 50);
    assert_int_equal(dense, 1963736);
    assert_true(fabs(v.index_to_world[0] - 0.00767147) < 1e-7);
    tyn_volume_finish(&v);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(types_and_codecs),
                                       cmocka_unit_test(tiles),
                                       cmocka_unit_test(values),
                                       cmocka_unit_test(names),
                                       cmocka_unit_test(segments),
                                       cmocka_unit_test(broken),
                                       cmocka_unit_test(packed_damage),
                                       cmocka_unit_test(overlap),
                                       cmocka_unit_test(alone),
                                       cmocka_unit_test(real_file)};
    return run_cases(tests, NULL, io_test_clean);
}
