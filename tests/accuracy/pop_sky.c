// pop_sky.c -- `pop` under environment maps: against the reference images under a sky, and against
// pictures of `path` of the sample scenes and of volumes under a measured map.
//
// rel_l1 on blocks of 8x8 pixels less what the references' noise explains; with the background, and without:
// both pictures less what is seen of the environment with no scattering, which is computed here along the
// pixels' rays. Each case by the number of ordinates and by the cells of the lattice.
//
// The pictures of `path` are tables in tests/data/sky: block means with their standard errors. They are made by this
// program with TYN_SKY_MAKE=<folder of the tables> (TYN_SKY_ONLY=<case>: one of them); without that
// a short run of `path` is held against them. TYN_LONG=1: all numbers of ordinates and all lattices,
// and the tables are checked with more samples.
#include "bound.h"
#include "gpu_test.h"
#include "npy.h"
#include "picture.h"
#include "sample_scene.h"
#include "skip.h"
#include "sky.h"
#include "todo.h"
#include <tyndall/io.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { BLOCK = 8 };

static const float zero3[3] = {0, 0, 0};

// The references' blobs, dense (g 0.9) or thin (g 0.5).
static bool make_blobs(tyn_scene *scene, tyn_view *view, bool thin)
{
    char path[512];
    if (!shared_path(path, sizeof path, "reference/images/blobs64.f32")) {
        return false;
    }
    float *grid = malloc(64 * 64 * 64 * sizeof *grid);
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    assert_int_equal(fread(grid, sizeof *grid, 64 * 64 * 64, file), 64 * 64 * 64);
    fclose(file);
    tyn_medium dense = {.sigma_s = {2.9f, 3.6f, 4.2f},
                        .sigma_a = {3.4f, 3.35f, 3.4f},
                        .phase = {{.g = 0.9f}, {.g = 0.9f}, {.g = 0.9f}}};
    tyn_medium light = {.sigma_s = {0.29f, 0.36f, 0.42f},
                        .sigma_a = {0.034f, 0.0335f, 0.034f},
                        .phase = {{.g = 0.5f}, {.g = 0.5f}, {.g = 0.5f}}};
    tyn_medium medium = thin ? light : dense;
    medium.density_scale = 1;
    scene_add_box(scene, &medium, (float[]){-5, -5, -5}, (float[]){5, 5, 5},
                  (uint32_t[]){64, 64, 64}, grid);
    sky_reference_map(&scene->environment, SKY_WHOLE);
    view_orthographic(view, zero3, 0, 0, 1, (float[]){0, 1, 0}, 5, 32);
    free(grid);
    return true;
}

typedef enum origin { BLOBS, THIN_BLOBS, SAMPLE, VOLUME } origin;

typedef struct sky_case {
    const char *name;
    origin from;
    const char *file, *map; // VOLUME: below the shared data
    uint32_t spp, check;    // samples of the stored table (or of the picture), and of the check
    uint32_t runs;          // of so many samples, with seeds of their own, make the table; 0: one
    uint32_t size;          // of the picture, 0: 96
    double with, without;   // bounds of the error with the background, and without
    const char *flat;       // why 64 ordinates are no better than 16
} sky_case;

// More ordinates bring light of the map from directions nearer to its own; where they bring no less error it is of something else.
static const char *const lobe =
    "the error is of forward lobes that do not spread sideways, not of the ordinates";
static const char *const cells_thick = "the error is of cells that are thick, not of the ordinates";

static const sky_case cases[] = {
    {.name = "blobs_sky_front",
     .from = BLOBS,
     .check = 512,
     .with = 0.006,
     .without = 0.065,
     .flat = lobe},
    {.name = "blobsthin_sky_front",
     .from = THIN_BLOBS,
     .check = 512,
     .with = 8e-4,
     .without = 0.012},
    {.name = "smoke-sky",
     .from = SAMPLE,
     .spp = 1024,
     .check = 16,
     .with = 0.025,
     .without = 0.055,
     .flat = lobe},
    {.name = "cloud-sunset",
     .from = SAMPLE,
     .spp = 2048,
     .check = 16,
     .with = 0.02,
     .without = 0.06},
    {.name = "milk",
     .from = SAMPLE,
     .spp = 3200,
     .check = 16,
     .runs = 2,
     .size = 48,
     .with = 0.035,
     .without = 0.07,
     .flat = cells_thick},
    {.name = "plume-contrast",
     .from = SAMPLE,
     .spp = 2048,
     .check = 16,
     .with = 0.01,
     .without = 0.12,
     .flat = lobe},
    {.name = "teapot-museum",
     .from = VOLUME,
     .file = "data/teapot_cloud.nvdb",
     .map = "data/museum.exr",
     .spp = 64,
     .with = 0.02,
     .without = 0.05},
    {.name = "smoke-museum",
     .from = VOLUME,
     .file = "data/smoke.vdb",
     .map = "data/museum.exr",
     .spp = 64,
     .with = 0.01,
     .without = 0.04,
     .flat = lobe},
};
enum { NUM_CASES = sizeof cases / sizeof cases[0] };

// False: what it needs is not there.
static bool load(gpu_test *t, const sky_case *k, tyn_scene *scene, tyn_view *view)
{
    tyn_scene_init(scene);
    *view = (tyn_view){0};
    view->width = view->height = k->size ? k->size : 96;
    char path[512], map[512];
    switch (k->from) {
    case BLOBS:
    case THIN_BLOBS:
        return make_blobs(scene, view, k->from == THIN_BLOBS);
    case SAMPLE:
        sample_scene_load(scene, k->name, t);
        break;
    case VOLUME:
        if (!shared_path(path, sizeof path, k->file) || !shared_path(map, sizeof map, k->map)) {
            return false;
        }
        t->quiet = true; // without OpenVDB there is no reading .vdb
        tyn_result result = tyn_scene_load(scene, path, map, &t->log);
        t->quiet = false;
        if (result == TYN_ERR_UNSUPPORTED) {
            skip_case("built without OpenVDB");
        }
        assert_int_equal(result, TYN_OK);
        break;
    }
    if (scene->num_cameras) {
        view->camera = scene->cameras[0];
    } else {
        tyn_camera_frame_scene(&view->camera, scene);
    }
    return true;
}

// ---- references -------------------------------------------------------------------------------

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double relative_se(const picture *p)
{
    double se = 0, sum = 0;
    for (uint32_t i = 0; i < p->width * p->height * 3; i++) {
        se += p->se[i];
        sum += fabs(p->rgb[i]);
    }
    return se / sum;
}

static void table_path(char *path, size_t size, const char *folder, const sky_case *k)
{
    snprintf(path, size, "%s/%s.csv", folder, k->name);
}

static void path_blocks(gpu_test *t, const sky_case *k, const tyn_scene *scene,
                        const tyn_view *view, uint32_t seed, uint32_t spp, picture *blocks)
{
    picture p;
    double start = seconds();
    tyn_view seeded = *view;
    seeded.seed = seed;
    picture_render(&p, t->dev, "path", scene, &seeded, NULL, spp);
    picture_blocks(blocks, &p, BLOCK);
    print_message("%-20s path, %u samples: standard error of a block %.2f %%, %.0f s\n", k->name,
                  spp, 100 * relative_se(blocks), seconds() - start);
    picture_free(&p);
}

// Bias and z of a picture of few samples against the reference.
static void check_reference(gpu_test *t, const sky_case *k, const tyn_scene *scene,
                            const tyn_view *view, const picture *reference)
{
    picture p;
    path_blocks(t, k, scene, view, 1000, k->check * (getenv("TYN_LONG") ? 16 : 1), &p);
    double off = 0, variance = 0, sum = 0, z2 = 0;
    uint32_t count = 0;
    for (uint32_t i = 0; i < p.width * p.height * 3; i++) {
        double d = (double)p.rgb[i] - reference->rgb[i];
        double v = (double)p.se[i] * p.se[i] + (double)reference->se[i] * reference->se[i];
        off += d;
        variance += v;
        sum += reference->rgb[i];
        if (v > 1e-10 * reference->rgb[i] * reference->rgb[i]) {
            z2 += d * d / v;
            count++;
        }
    }
    double bias_z = off / sqrt(variance), z = sqrt(z2 / count);
    print_message("%-20s path against the reference: bias %+.2f %% (z %+.2f), z_rms of blocks "
                  "%.2f\n",
                  k->name, 100 * off / sum, bias_z, z);
    assert_true(fabs(bias_z) <= 4);
    // The noise of few samples of a rare bright event does not know itself.
    assert_true(z <= 1.5 || relative_se(&p) > 0.1);
    picture_free(&p);
}

static bool reference_of(gpu_test *t, const sky_case *k, const tyn_scene *scene,
                         const tyn_view *view, picture *reference)
{
    if (k->from == BLOBS || k->from == THIN_BLOBS) {
        picture p;
        if (!picture_reference(&p, k->name)) {
            return false;
        }
        picture_blocks(reference, &p, BLOCK);
        picture_free(&p);
        return true;
    }
    if (k->from == VOLUME) { // nothing of others is kept here
        path_blocks(t, k, scene, view, 0, k->spp * (getenv("TYN_LONG") ? 16 : 1), reference);
        return true;
    }
    char path[512];
    table_path(path, sizeof path, TYN_TEST_DATA "/sky", k);
    assert_true(picture_read_table(reference, path));
    return true;
}

// ---- comparison -------------------------------------------------------------------------------

typedef struct sky_error {
    picture_error with, without;
} sky_error;

static sky_error compare(gpu_test *t, const tyn_scene *scene, const tyn_view *view,
                         const char *settings, const picture *reference, const picture *unscattered)
{
    picture p, blocks, rest;
    picture_render(&p, t->dev, "pop", scene, view, settings, 0);
    picture_blocks(&blocks, &p, BLOCK);
    sky_error e = {.with = picture_compare(&blocks, reference, 1)};
    rest = (picture){.width = reference->width, .height = reference->height, .se = reference->se};
    size_t bytes = (size_t)rest.width * rest.height * 3 * sizeof *rest.rgb;
    rest.rgb = malloc(bytes);
    memcpy(rest.rgb, reference->rgb, bytes);
    picture_subtract(&rest, unscattered);
    picture_subtract(&blocks, unscattered);
    e.without = picture_compare(&blocks, &rest, 1);
    free(rest.rgb);
    picture_free(&blocks);
    picture_free(&p);
    return e;
}

// Of `runs` pictures one more.
static void average(picture *p, const picture *more, uint32_t runs)
{
    for (uint32_t i = 0; i < p->width * p->height * 3; i++) {
        float a = (float)runs, se = p->se[i] * a;
        p->rgb[i] = (a * p->rgb[i] + more->rgb[i]) / (a + 1);
        p->se[i] = sqrtf(se * se + more->se[i] * more->se[i]) / (a + 1);
    }
}

static void run_case(gpu_test *t, const sky_case *k)
{
    static const int counts[] = {64, 16, 256}, cells[] = {32, 16, 24, 48};
    const char *only = getenv("TYN_SKY_ONLY"), *folder = getenv("TYN_SKY_MAKE");
    const bool thorough = getenv("TYN_LONG") != NULL;
    if (only && strcmp(only, k->name) != 0) {
        return;
    }
    tyn_scene *scene = malloc(sizeof *scene);
    tyn_view view = {0};
    picture reference, whole, unscattered;
    bool there = load(t, k, scene, &view);
    if (there && folder && k->from == SAMPLE) {
        char path[512], comment[128];
        uint32_t runs = k->runs ? k->runs : 1;
        for (uint32_t run = 0; run < runs; run++) {
            picture more;
            path_blocks(t, k, scene, &view, run, k->spp, &more);
            if (run == 0) {
                reference = more;
            } else {
                average(&reference, &more, run);
                picture_free(&more);
            }
        }
        table_path(path, sizeof path, folder, k);
        snprintf(comment, sizeof comment,
                 "%s, %ux%u pixels in blocks of %u: path, %u x %u samples a pixel", k->name,
                 view.width, view.height, BLOCK, runs, k->spp);
        picture_write_table(&reference, path, comment);
        picture_free(&reference);
    }
    if (!there || !reference_of(t, k, scene, &view, &reference)) {
        tyn_scene_finish(scene);
        free(scene);
        skip_without(k->file ? k->file : k->name);
    }
    bool blobs = k->from == BLOBS || k->from == THIN_BLOBS;
    picture_unscattered(&whole, scene, &view, blobs ? sky_of_references : NULL);
    picture_blocks(&unscattered, &whole, BLOCK);
    if (k->check) {
        check_reference(t, k, scene, &view, &reference);
    }
    double usual = 0;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 4; j++) {
            bool wanted = thorough || j == 0 || (i == 0 && j == 1);
            if (!wanted) {
                continue;
            }
            char settings[80];
            snprintf(settings, sizeof settings, "lattice.cells=%d ordinates.count=%d", cells[j],
                     counts[i]);
            sky_error e = compare(t, scene, &view, settings, &reference, &unscattered);
            print_message("%-20s %3d ordinates, %2d cells: with background %5.2f %%, without %5.2f "
                          "%% (rel_l1 %5.2f, noise %4.2f, bias %+6.2f)\n",
                          k->name, counts[i], cells[j], 100 * e.with.reported,
                          100 * e.without.reported, 100 * e.without.rel_l1, 100 * e.without.noise,
                          100 * e.without.bias);
            if (i == 0 && j == 0) {
                usual = e.without.reported;
                assert_true(within(e.with.reported, k->with, NULL, "%s, with background", k->name));
                assert_true(within(e.without.reported, k->without, NULL, "%s, without", k->name));
            } else if (j == 0) { // the more the better
                const bool fewer = counts[i] < counts[0];
                const double gain = fewer ? e.without.reported - usual : usual - e.without.reported;
                assert_true(todo_if(fewer && k->flat, gain >= 0, k->flat,
                                    "%s, %d ordinates beside %d", k->name, counts[i], counts[0]));
            }
        }
    }
    picture_free(&whole);
    picture_free(&unscattered);
    picture_free(&reference);
    tyn_scene_finish(scene);
    free(scene);
}

static void references(void **state)
{
    run_case(*state, &cases[0]);
    run_case(*state, &cases[1]);
}

static void samples(void **state)
{
    for (int i = 2; i < NUM_CASES; i++) {
        if (cases[i].from == SAMPLE) {
            run_case(*state, &cases[i]);
        }
    }
}

static void volumes(void **state)
{
    for (int i = 2; i < NUM_CASES; i++) {
        if (cases[i].from == VOLUME) {
            run_case(*state, &cases[i]);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(references), cmocka_unit_test(samples),
                                       cmocka_unit_test(volumes)};
    setvbuf(stdout, NULL, _IOLBF, 0);
    cmocka_set_test_filter(getenv("TYN_TEST_FILTER"));
    return run_cases(tests, gpu_setup, gpu_teardown);
}
