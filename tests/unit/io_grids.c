// io_grids.c -- grids of a volume file: which is taken for a density, lists, colours, temperatures, one box for all of a
// medium.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "bound.h"
#include "io/grid_place.h"
#include "io/nvdb.h"
#include "io_test.h"
#include "numbers.h"
#include "nvdb_write.h"
#include "skip.h"
#ifdef TYN_HAVE_OPENVDB
#include "vdb_writer.h"
#endif

// ---- which grid is a density --------------------------------------------------------------------

static void by_name(void **state)
{
    (void)state;
    static const struct {
        const char *names[4]; // "v:" before one: of vectors
        const char *asked;
        tyn_grid_use use;
        int chosen;
        const char *error, *left_out; // words of it; NULL: none
    } cases[] = {
        {{"temperature", "smoke"}, NULL, TYN_GRID_DENSITY, 1, NULL, "\"temperature\" (heat"},
        {{"heat", "density"}, NULL, TYN_GRID_DENSITY, 1, NULL, "\"heat\""},
        {{"Temperature", "plume"}, NULL, TYN_GRID_DENSITY, 1, NULL, "\"Temperature\""},
        {{"plume"}, NULL, TYN_GRID_DENSITY, 0, NULL, NULL},
        {{""}, NULL, TYN_GRID_DENSITY, 0, NULL, NULL},
        {{"v:vel", "density", "vx"}, NULL, TYN_GRID_DENSITY, 1, NULL, "\"vel\", \"vx\" (velocity"},
        {{"density", "v:Cd"}, NULL, TYN_GRID_DENSITY, 0, NULL, "\"albedo\" of a scene's medium"},
        {{"density", "density_temp"}, NULL, TYN_GRID_DENSITY, 0, NULL, NULL},
        {{"temperature", "flames"}, NULL, TYN_GRID_DENSITY, -1, "no grid that is a density", NULL},
        {{"v:velocity"}, NULL, TYN_GRID_DENSITY, -1, "no grid of float values", NULL},
        {{"v:density"}, NULL, TYN_GRID_DENSITY, -1, "no grid of float values", NULL},
        {{"v:Cd"}, "Cd", TYN_GRID_DENSITY, -1, "holds vec3f values", NULL},
        {{"v:Cd"}, "Cd", TYN_GRID_COLOR, 0, NULL, NULL},
        {{"v:Cd"}, "Cd", TYN_GRID_VALUE, -1, "holds vec3f values", NULL},
        {{"temperature"}, "temperature", TYN_GRID_DENSITY, 0, NULL, NULL},
        {{"temperature"}, "temp", TYN_GRID_VALUE, -1, "no grid \"temp\": there are", NULL},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        tyn_grid_entry grids[4];
        uint32_t count = 0;
        for (; count < 4 && cases[i].names[count]; count++) {
            const char *name = cases[i].names[count];
            const bool vector = strncmp(name, "v:", 2) == 0;
            grids[count] = (tyn_grid_entry){name + (vector ? 2 : 0), vector ? "vec3f" : "float",
                                            !vector, vector};
        }
        io_log log;
        io_log_init(&log);
        tyn_grid_job job = {.grid = cases[i].asked, .use = cases[i].use, .log = &log.log};
        const int chosen = tyn_volume_choose(&job, grids, count, "a.vdb");
        if (chosen != cases[i].chosen) {
            print_error("case %zu: %d, must be %d: %s\n", i, chosen, cases[i].chosen, log.last);
        }
        assert_int_equal(chosen, cases[i].chosen);
        assert_int_equal(log.errors, cases[i].error ? 1 : 0);
        assert_true(!cases[i].error || strstr(log.last, cases[i].error));
        if (cases[i].left_out) {
            assert_non_null(strstr(job.left_out, cases[i].left_out));
        } else {
            assert_string_equal(job.left_out, "");
        }
    }
}

// ---- colours of NanoVDB files -------------------------------------------------------------------

static float slope(int32_t i, int32_t j, int32_t k)
{
    return 1.0f + 0.25f * (float)i + 0.5f * (float)j - 0.125f * (float)k;
}

static nvdb_spec spec_of(const char *name, uint32_t type)
{
    return (nvdb_spec){.name = name,
                       .type = type,
                       .grid_class = type == NVDB_VEC3F ? 3 : 2,
                       .lo = {-2, 1, 0},
                       .hi = {9, 12, 6},
                       .value = slope,
                       .voxel = 0.25};
}

// Several grids, a segment each.
static const char *put_nvdb(const char *name, const nvdb_spec *specs, int count)
{
    uint8_t *all = NULL;
    size_t size = 0;
    for (int i = 0; i < count; i++) {
        size_t bytes;
        uint8_t *one = nvdb_write(&specs[i], &bytes, NULL);
        all = realloc(all, size + bytes);
        memcpy(all + size, one, bytes);
        size += bytes;
        free(one);
    }
    const char *path = io_put(name, all, size);
    free(all);
    return path;
}

static void colors_of_nvdb(void **state)
{
    (void)state;
    io_log log;
    io_log_init(&log);
    const nvdb_spec specs[] = {spec_of("Cd", NVDB_VEC3F), spec_of("flame", NVDB_FLOAT),
                               spec_of("density", NVDB_HALF)};
    const char *path = put_nvdb("colors.nvdb", specs, 3);
    for (int g = 0; g < 2; g++) {
        tyn_color_grid c;
        double m[16];
        uint64_t clamped = 0;
        assert_int_equal(tyn_color_grid_load(&c, path, specs[g].name, m, &clamped, &log.log),
                         TYN_OK);
        assert_int_equal(c.channels, g ? 1 : 3);
        assert_true(c.size[0] == 12 && c.size[1] == 12 && c.size[2] == 7);
        assert_true(m[0] == 0.25 && m[12] == -0.5 && m[13] == 0.25);
        size_t at = 0, below = 0;
        float most = 0;
        for (int k = 0; k < 7; k++) {
            for (int j = 0; j < 12; j++) {
                for (int i = 0; i < 12; i++) {
                    const float v = slope(i - 2, j + 1, k);
                    for (uint32_t n = 0; n < c.channels; n++) {
                        const float right = v < 0 ? 0 : v / (float)(1 << n);
                        if (c.data[at] != right) {
                            print_error("%s at %d %d %d: %g, must be %g\n", specs[g].name, i, j, k,
                                        c.data[at], right);
                        }
                        assert_true(c.data[at++] == right);
                        most = right > most ? right : most;
                        below += v < 0;
                    }
                }
            }
        }
        assert_true(c.max == most && clamped == below);
        tyn_color_grid_finish(&c);
    }
    assert_int_equal(log.errors, 0);

    tyn_volume_grid *list;
    uint32_t count;
    assert_int_equal(tyn_volume_list(path, &list, &count, &log.log), TYN_OK);
    assert_int_equal(count, 3);
    assert_string_equal(list[0].name, "Cd");
    assert_string_equal(list[0].type, "vec3f");
    assert_string_equal(list[0].grid_class, "staggered");
    assert_string_equal(list[1].type, "float");
    assert_string_equal(list[2].type, "half");
    for (uint32_t i = 0; i < count; i++) {
        const tyn_volume_grid *g = &list[i];
        assert_int_equal(g->active_voxels, 12 * 12 * 7);
        assert_true(g->lo[0] == -2 && g->hi[1] == 12 && g->hi[2] == 6);
        assert_true(g->has_range && g->most == 9.25 && g->least == (i == 0 ? 0.0625 : 0.25));
        assert_true(g->affine && g->voxel[0] == 0.25 && g->voxel[2] == 0.25);
        assert_true(g->world_lo[0] == -0.625 && g->world_hi[0] == 2.375 && g->world_hi[2] == 1.625);
    }
    free(list);

    // Cut short and changed: one line each, and no colours.
    void *bytes;
    size_t size;
    assert_int_equal(tyn_file_read(path, 1 << 26, &bytes, &size, &log.log), TYN_OK);
    for (size_t cut = 0; cut < size; cut += size / 23) {
        tyn_color_grid c;
        io_log_init(&log);
        const char *bad = io_put("cut.nvdb", bytes, cut);
        assert_int_equal(tyn_color_grid_load(&c, bad, "Cd", NULL, NULL, &log.log), TYN_ERR_PARAMS);
        assert_true(log.errors == 1 && log.newlines == 0 && !c.data);
        assert_int_equal(tyn_volume_list(bad, &list, &count, &log.log), TYN_ERR_PARAMS);
        assert_true(log.errors == 2 && !list && count == 0);
    }
    free(bytes);
}

// ---- black bodies -------------------------------------------------------------------------------

static double luminance(const float rgb[3])
{
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

static void black_bodies(void **state)
{
    (void)state;
    float rgb[3];
    // Platinum at its point of freezing, 2042 K, was the candela's standard: 60 of them per square centimetre.
    tyn_blackbody(2042, rgb);
    assert_true(within(fabs(luminance(rgb) * 683 / 6e5 - 1), 4e-4, NULL, "luminance at 2042 K"));
    // Illuminant A: x 0.4476, y 0.4074.
    tyn_blackbody(2856, rgb);
    static const double to_xyz[3][3] = {{0.4124564, 0.3575761, 0.1804375},
                                        {0.2126729, 0.7151522, 0.0721750},
                                        {0.0193339, 0.1191920, 0.9503041}};
    double xyz[3];
    for (int r = 0; r < 3; r++) {
        xyz[r] = to_xyz[r][0] * rgb[0] + to_xyz[r][1] * rgb[1] + to_xyz[r][2] * rgb[2];
    }
    const double sum = xyz[0] + xyz[1] + xyz[2];
    assert_true(within(fabs(xyz[0] / sum - 0.44757), 0.0015, NULL, "x of illuminant A"));
    assert_true(within(fabs(xyz[1] / sum - 0.40745), 0.0015, NULL, "y of illuminant A"));
    // 6504 K is nearly white, what is cold is black, and nothing is NaN.
    tyn_blackbody(6504, rgb);
    assert_true(within(fabs(rgb[0] / rgb[1] - 1), 0.06, NULL, "red over green at 6504 K"));
    const double cold[] = {0, 1, 77, 293, -5, NAN, INFINITY};
    for (int i = 0; i < 7; i++) {
        tyn_blackbody(cold[i], rgb);
        assert_true(rgb[0] >= 0 && rgb[0] < 1e-9f && rgb[1] <= rgb[0] && rgb[2] <= rgb[0]);
    }
    float before = 0;
    for (double kelvins = 300; kelvins < 1e5; kelvins *= 1.05) {
        tyn_blackbody(kelvins, rgb);
        assert_true(rgb[0] > before && isfinite(rgb[0]));
        before = rgb[0];
    }
}

static void temperatures(void **state)
{
    (void)state;
    io_log log;
    io_log_init(&log);
    const float values[4] = {0, 0.5f, 1, -3};
    const uint32_t size[3] = {4, 1, 1};
    tyn_temperature how = {.scale = 1500, .offset = 400, .strength = 2};
    tyn_color_grid c;
    double worst = 0;
    assert_int_equal(tyn_color_grid_of_temperatures(&c, size, values, &how, &log.log), TYN_OK);
    for (int i = 0; i < 4; i++) {
        float rgb[3];
        tyn_blackbody(fmax(400 + 1500 * values[i], 0), rgb);
        for (int ch = 0; ch < 3; ch++) {
            worst =
                maximum(worst, fabs(c.data[3 * i + ch] - 2.0 * rgb[ch]) / (2.0 * rgb[0] + 1e-12));
        }
    }
    assert_true(within(worst, 1e-6, NULL, "radiance of a grid of temperatures"));
    // One voxel that is far hotter leaves the others as they are; NaN is refused also where nothing else is wrong.
    const float outlier[4] = {0.4f, 0.6f, 1, 666}, missing[4] = {0, NAN, 0, 0};
    tyn_color_grid hot;
    worst = 0;
    assert_int_equal(tyn_color_grid_of_temperatures(&hot, size, outlier, &how, &log.log), TYN_OK);
    for (int i = 0; i < 4; i++) {
        float rgb[3];
        tyn_blackbody(400 + 1500 * (double)outlier[i], rgb);
        worst = maximum(worst, fabs(hot.data[3 * i] / (2.0 * rgb[0]) - 1));
    }
    tyn_color_grid_finish(&hot);
    assert_true(within(worst, 3e-6, NULL, "radiance beside an outlier"));
    assert_int_equal(tyn_color_grid_of_temperatures(&hot, size, missing, &how, &log.log),
                     TYN_ERR_PARAMS);
    io_log_init(&log);
    assert_true(c.max == c.data[6] && c.channels == 3 && c.data[9] == 0);
    tyn_color_grid_finish(&c);
    how.luminance = 7;
    assert_int_equal(tyn_color_grid_of_temperatures(&c, size, values, &how, &log.log), TYN_OK);
    assert_true(c.data[0] == 0 && c.data[9] == 0); // 400 K
    for (int i = 1; i < 3; i++) {
        assert_true(fabs(luminance(c.data + 3 * i) - 14) < 1e-3);
    }
    tyn_color_grid_finish(&c);
    how.strength = -1;
    assert_int_equal(tyn_color_grid_of_temperatures(&c, size, values, &how, &log.log),
                     TYN_ERR_PARAMS);
    assert_non_null(strstr(log.last, "strength = -1: must be finite and >= 0"));
    how = (tyn_temperature){0};
    assert_int_equal(
        tyn_color_grid_of_temperatures(&c, size, (float[4]){0, NAN, 0, INFINITY}, &how, &log.log),
        TYN_ERR_PARAMS);
    assert_int_equal(log.errors, 2);
}

// ---- one box ------------------------------------------------------------------------------------

static void set_box(tyn_placed_grid *g, const uint32_t size[3], double voxel, double x, float base)
{
    const size_t count = (size_t)size[0] * size[1] * size[2];
    *g = (tyn_placed_grid){.size = {size[0], size[1], size[2]}, .channels = 1};
    g->data = malloc(count * sizeof *g->data);
    for (size_t i = 0; i < count; i++) {
        g->data[i] = base + (float)(i % size[0]);
    }
    for (int a = 0; a < 3; a++) {
        g->index_to_world[5 * a] = voxel;
    }
    g->index_to_world[12] = x;
    g->index_to_world[15] = 1;
}

static void one_box(void **state)
{
    (void)state;
    const char *why = NULL;
    tyn_placed_grid g[3];
    set_box(&g[0], (uint32_t[]){4, 1, 1}, 0.5, 10, 1);
    set_box(&g[1], (uint32_t[]){3, 1, 1}, 0.5, 9, 5);   // begins two voxels before
    set_box(&g[2], (uint32_t[]){3, 1, 1}, 1, 10.25, 2); // voxels of two
    g[2].edge = true;
    g[2].index_to_world[13] = g[2].index_to_world[14] = 0;
    assert_int_equal(tyn_grids_align(g, 2, 1000, &why), TYN_OK);
    const float first[6] = {0, 0, 1, 2, 3, 4}, second[6] = {5, 6, 7, 0, 0, 0};
    for (int i = 0; i < 2; i++) {
        assert_true(g[i].size[0] == 6 && g[i].size[1] == 1 && g[i].index_to_world[12] == 9);
        assert_memory_equal(g[i].data, i ? second : first, sizeof first);
    }
    // Of voxels of two: in x from 9.75 to 12.75, in y and z from -0.5 to 0.5, which are two voxels of the first, half off.
    assert_int_equal(tyn_grids_align((tyn_placed_grid[]){g[0], g[2]}, 2, 4, &why), TYN_ERR_PARAMS);
    assert_non_null(strstr(why, "too many voxels"));
    tyn_placed_grid two[2] = {g[0], g[2]};
    assert_int_equal(tyn_grids_align(two, 2, 1000, &why), TYN_OK);
    assert_true(two[0].size[0] == 8 && two[0].size[1] == 3);
    // Its voxel centres 10.25, 11.25, 12.25; those of the first 9, 9.5, ...: linear between, constant beyond.
    const float third[8] = {2, 2, 2, 2.25f, 2.75f, 3.25f, 3.75f, 4};
    for (int i = 0; i < 8; i++) {
        assert_true(fabsf(two[1].data[8 * 4 + i] - third[i]) < 1e-6f);
        assert_true(two[0].data[8 * 4 + i] == (i < 6 ? first[i] : 0));
    }
    two[1].index_to_world[1] = 0.2;
    assert_int_equal(tyn_grids_align(two, 2, 1000, &why), TYN_ERR_PARAMS);
    assert_non_null(strstr(why, "axes"));
    free(two[0].data);
    free(two[1].data);
    free(g[1].data);
}

// ---- OpenVDB, and a scene of it -----------------------------------------------------------------

#ifdef TYN_HAVE_OPENVDB
static float fire(int32_t i, int32_t j, int32_t k, int c)
{
    return (float)(c + 1) * 0.125f * (float)(1 + (i + 20) % 3 + (j + 20) % 2 + (k + 20) % 2);
}

static float kelvins(int32_t i, int32_t j, int32_t k, int c)
{
    (void)c;
    return 900.0f + 50.0f * (float)(i + j + k);
}

static const vdb_spec fire_grids[] = {
    {"temperature", VDB_FLOATS, {-1, 0, 0}, {3, 9, 3}, {0.5, 0.5, 0.5}, 0.3, {1, 2, 3}, kelvins},
    {"vel", VDB_VECTORS, {0, 0, 0}, {3, 3, 3}, {0.5, 0.5, 0.5}, 0.3, {1, 2, 3}, fire},
    {"density", VDB_FLOATS, {0, 2, 0}, {3, 9, 3}, {0.5, 0.5, 0.5}, 0.3, {1, 2, 3}, fire},
    {"Cd", VDB_VECTORS, {0, 2, 0}, {3, 9, 3}, {0.5, 0.5, 0.5}, 0.3, {1, 2, 3}, fire},
    {"flames", VDB_FLOATS, {0, 0, 0}, {1, 1, 1}, {0.5, 0.5, 0.5}, -0.3, {1, 2, 3}, fire}};

#define SCENE(medium)                                                                              \
    "{\"asset\": {\"version\": \"2.0\"}, \"scenes\": [{\"nodes\": [0]}], \"extensionsUsed\": "     \
    "[\"TYN_participating_media\"], \"nodes\": [{\"extensions\": {\"TYN_participating_media\": "   \
    "{\"medium\": 0, \"shape\": \"grid\"}}}], \"extensions\": {\"TYN_participating_media\": "      \
    "{\"media\": [{\"scattering\": 1, \"absorption\": 1, " medium "}]}}}"
#endif

static void openvdb(void **state)
{
    (void)state;
#ifndef TYN_HAVE_OPENVDB
    skip_case("built without OpenVDB");
#else
    io_log log;
    io_log_init(&log);
    const char *path = io_path("fire.vdb");
    assert_null(vdb_write(path, fire_grids, 5, VDB_BLOSC | VDB_ACTIVE_MASK));
    tyn_volume_grid *list;
    uint32_t count;
    assert_int_equal(tyn_volume_list(path, &list, &count, &log.log), TYN_OK);
    assert_int_equal(count, 5);
    for (uint32_t i = 0; i < count; i++) {
        const tyn_volume_grid *g = &list[i];
        const vdb_spec *s = NULL;
        for (int k = 0; k < 5; k++) {
            s = strcmp(fire_grids[k].name, g->name) == 0 ? &fire_grids[k] : s;
        }
        assert_non_null(s);
        uint64_t voxels = 1;
        for (int a = 0; a < 3; a++) {
            assert_true(g->lo[a] == s->lo[a] && g->hi[a] == s->hi[a]);
            assert_true(fabs(g->voxel[a] - 0.5) < 1e-9);
            voxels *= (uint64_t)(s->hi[a] - s->lo[a] + 1);
        }
        assert_int_equal(g->active_voxels, voxels);
        assert_string_equal(g->type, s->values == VDB_VECTORS ? "vec3s" : "float");
        assert_string_equal(g->grid_class, s->values == VDB_VECTORS ? "staggered" : "fog volume");
        const bool hot = s->value == kelvins;
        assert_true(g->has_range && fabs(g->least - (hot ? 850 : 0.125)) < 1e-6);
        assert_true(s->values == VDB_VECTORS ||
                    fabs(g->most - (hot ? 1650 : 0.125 * (s == &fire_grids[4] ? 5 : 5))) < 1e-6);
    }
    free(list);

    // Alone, the density is taken, and one line tells of the others.
    tyn_scene s;
    assert_int_equal(tyn_scene_load(&s, path, NULL, &log.log), TYN_OK);
    assert_int_equal(s.num_warnings, 1);
    const char *const words[] = {"\"temperature\"", "\"flames\"", "heat",
                                 "\"Cd\"",          "\"vel\"",    "velocity"};
    for (int i = 0; i < 6; i++) {
        assert_non_null(strstr(s.warnings[0], words[i]));
    }
    tyn_scene_finish(&s);

    // The medium's box holds the temperature too, which reaches farther; each voxel stays where it was.
    path = io_put_text(
        "fire.gltf", SCENE("\"density\": {\"uri\": \"fire.vdb\"}, \"temperature\": {\"uri\": "
                           "\"fire.vdb\", \"strength\": 3}, \"albedo\": {\"uri\": \"fire.vdb\"}"));
    assert_int_equal(tyn_scene_load(&s, path, NULL, &log.log), TYN_OK);
    assert_int_equal(log.errors, 0);
    assert_int_equal(s.num_warnings, 2); // velocity; an albedo above 1
    assert_non_null(strstr(s.warnings[0], "\"vel\""));
    assert_null(strstr(s.warnings[0], "\"temperature\""));
    assert_non_null(strstr(s.warnings[1], "above 1"));
    const tyn_medium *m = &s.media[0];
    assert_true(m->volume == 0 && m->radiance_grid == 1 && m->albedo_grid == 2 &&
                !m->emission_grid);
    const uint32_t *n = s.volumes[0].size;
    assert_true(n[0] == 5 && n[1] == 10 && n[2] == 4);
    for (int k = 0; k < 4; k++) {
        for (int j = 0; j < 10; j++) {
            for (int i = 0; i < 5; i++) {
                const size_t at = ((size_t)k * 10 + (size_t)j) * 5 + (size_t)i;
                const bool dense = i >= 1 && j >= 2;
                assert_true(s.volumes[0].data[at] == (dense ? fire(i - 1, j, k, 0) : 0));
                float rgb[3];
                tyn_blackbody((double)kelvins(i - 1, j, k, 0), rgb);
                assert_true(fabsf(s.color_grids[0].data[3 * at] - 3 * rgb[0]) < 2e-4f * rgb[0]);
                const float albedo = fire(i < 1 ? 0 : i - 1, j < 2 ? 2 : j, k, 1);
                assert_true(s.color_grids[1].data[3 * at + 1] == fminf(albedo, 1));
            }
        }
    }
    // Its middle: voxel 1, 4.5, 1.5, in the world.
    const float *world = s.shapes[0].to_world;
    const double x = 0.5, y = 2.25, c = cos(0.3), sn = sin(0.3);
    const double right[2] = {1 + c * x - sn * y, 2 + sn * x + c * y};
    for (int a = 0; a < 2; a++) {
        assert_true(fabs((double)world[12 + a] - right[a]) < 1e-5);
    }
    assert_true(fabs((double)world[14] - 3.75) < 1e-6);
    tyn_scene_finish(&s);

    static const struct {
        const char *medium, *error;
    } wrong[] = {
        {"\"density\": {\"uri\": \"fire.vdb\"}, \"temperature\": {\"uri\": \"fire.vdb\", \"grid\": "
         "\"flames\"}",
         "media[0].temperature = an object: its axes are not along"},
        {"\"temperature\": {\"uri\": \"fire.vdb\", \"grid\": \"vel\"}", "holds vec3s values"},
        {"\"temperature\": {\"uri\": \"fire.vdb\", \"scale\": 0}", "must not be 0"},
        {"\"temperature\": {\"uri\": \"fire.vdb\", \"luminance\": -1}", ">= 0, in W/(m^2 sr)"},
        {"\"emission_density\": {\"uri\": \"fire.vdb\"}", "no grid \"emission\": there are"},
        {"\"albedo\": {\"grid\": \"Cd\"}", "uri is missing"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        char text[2048];
        snprintf(text, sizeof text, SCENE("%s"), wrong[i].medium);
        io_log_init(&log);
        path = io_put_text("wrong.gltf", text);
        assert_int_equal(tyn_scene_load(&s, path, NULL, &log.log), TYN_ERR_PARAMS);
        if (log.errors != 1 || !strstr(log.last, wrong[i].error)) {
            print_error("case %zu: %s\n", i, log.last);
        }
        assert_true(log.errors == 1 && strstr(log.last, wrong[i].error));
    }
    // A temperature that is named as one's density is said to be.
    path = io_put_text("asked.gltf", SCENE("\"density\": {\"uri\": \"fire.vdb\", \"grid\": "
                                           "\"temperature\"}"));
    assert_int_equal(tyn_scene_load(&s, path, NULL, &log.log), TYN_OK);
    assert_non_null(strstr(s.warnings[0], "is taken for a density, as \"grid\" says"));
    tyn_scene_finish(&s);
    // Without a density at all: refused, or a temperature with sigma_a alone.
    assert_null(vdb_write(io_path("hot.vdb"), fire_grids, 2, VDB_BLOSC | VDB_ACTIVE_MASK));
    io_log_init(&log);
    assert_int_equal(tyn_scene_load(&s, io_path("hot.vdb"), NULL, &log.log), TYN_ERR_PARAMS);
    assert_non_null(strstr(log.last, "no grid that is a density by its name: there are"));
    path = io_put_text("hot.gltf", SCENE("\"temperature\": {\"uri\": \"hot.vdb\"}"));
    assert_int_equal(tyn_scene_load(&s, path, NULL, &log.log), TYN_OK);
    assert_true(s.media[0].volume == -1 && s.media[0].radiance_grid == 1);
    tyn_scene_finish(&s);
#endif
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(by_name),      cmocka_unit_test(colors_of_nvdb),
        cmocka_unit_test(black_bodies), cmocka_unit_test(temperatures),
        cmocka_unit_test(one_box),      cmocka_unit_test(openvdb),
    };
    const int failed = run_cases(tests, NULL, io_test_clean);
    return bounds_near(true) ? failed : 1;
}
