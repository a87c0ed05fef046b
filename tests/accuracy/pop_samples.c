// pop_samples.c -- `pop` on the sample scenes with lamps and walls: against pictures of `path`.
//
// The pictures of `path` are tables in tests/data/walls: means of 12x12 blocks with their standard
// errors. They are made by this program from pictures of `path` with the layer `error`, square, of
// a multiple of 12 pixels: TYN_WALLS_MAKE=<folder of NAME-path.exr>. `tools/docs/pictures` leaves such
// pictures in out/pictures.
#include "built_in.h"
#include "bound.h"
#include "gpu_test.h"
#include "offline_frame.h"
#include "picture.h"
#include "sample_scene.h"
#include "todo.h"
#include "sky.h"
#include <tyndall/io.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BLOCKS = 12, SIZE = 96 };

static const struct wall_case {
    const char *name;
    double error, bias; // of the picture, at most
    const char *few;    // why the bias is known to be more
} cases[] = {
    {"room", 0.1, 0.009},
    {"fog-hall", 0.09, 0.03,
     "of a sun and a sky through windows walls get 5 % too little since virtual lights carry "
     "all reflections; 3 to 8 % for other numbers of them"},
    {"lantern", 0.05, 0.0043},
    {"cornell-smoke", 0.13, 0.015},
    {"vpl-cave", 0.24, 0.03},
    {"many-lights", 0.05, 0.035},
};
enum { NUM_CASES = sizeof cases / sizeof cases[0] };

static void make_table(gpu_test *t, const char *folder, const char *name)
{
    static const char *const names[6] = {"R", "G", "B", "error.R", "error.G", "error.B"};
    char path[512], comment[128];
    snprintf(path, sizeof path, "%s/%s-path.exr", folder, name);
    tyn_image_file image;
    if (tyn_exr_read(&image, path, &t->log) != TYN_OK) {
        return;
    }
    assert_true(image.width == image.height && image.width % BLOCKS == 0);
    const size_t count = 3 * (size_t)image.width * image.height;
    picture p = {image.width, image.height, malloc(count * sizeof(float)),
                 malloc(count * sizeof(float))};
    for (size_t i = 0; i < 2 * count; i++) {
        const size_t c = i / count * 3 + i % 3;
        const float *from = tyn_image_file_channel(&image, names[c]);
        assert_non_null(from);
        (c < 3 ? p.rgb : p.se)[i % count] = from[i % count / 3];
    }
    picture blocks;
    picture_blocks(&blocks, &p, image.width / BLOCKS);
    snprintf(path, sizeof path, "%s/walls/%s.csv", TYN_TEST_DATA, name);
    snprintf(comment, sizeof comment, "%s, %ux%u pixels in blocks of %u: path", name, image.width,
             image.height, image.width / BLOCKS);
    picture_write_table(&blocks, path, comment);
    picture_free(&blocks);
    picture_free(&p);
    tyn_image_file_finish(&image);
}

static void pictures(void **state)
{
    gpu_test *t = *state;
    const char *folder = getenv("TYN_WALLS_MAKE");
    bool good = true;
    for (int i = 0; folder && i < NUM_CASES; i++) {
        make_table(t, folder, cases[i].name);
    }
    for (int i = 0; i < NUM_CASES; i++) {
        const struct wall_case *k = &cases[i];
        char path[512];
        picture reference, p, blocks;
        snprintf(path, sizeof path, "%s/walls/%s.csv", TYN_TEST_DATA, k->name);
        assert_true(picture_read_table(&reference, path));
        tyn_scene *scene = malloc(sizeof *scene);
        sample_scene_load(scene, k->name, t);
        tyn_view view = {.camera = scene->cameras[0], .width = SIZE, .height = SIZE};
        picture_render(&p, t->dev, "pop", scene, &view, NULL, 0);
        picture_blocks(&blocks, &p, SIZE / BLOCKS);
        const picture_error e = picture_compare(&blocks, &reference, 1);
        print_message("%-14s error %5.2f %% (rel_l1 %5.2f, noise %4.2f), bias %+6.2f %%\n", k->name,
                      100 * e.reported, 100 * e.rel_l1, 100 * e.noise, 100 * e.bias);
        good = within(e.reported, k->error, NULL, "%s, error", k->name) && good;
        good = todo_if(k->few,
                       within(fabs(e.bias), k->bias, picture_bias_why(&e), "%s, bias", k->name),
                       k->few, "%s, bias", k->name) &&
               good;
        picture_free(&blocks);
        picture_free(&p);
        picture_free(&reference);
        tyn_scene_finish(scene);
        free(scene);
    }
    assert_true(good);
}

// The mean of the scene's picture by this method; offline_frame fails on pixels that are no numbers.
static double mean_of(gpu_test *t, const char *method, const tyn_scene *scene, const char *settings,
                      uint32_t size)
{
    tyn_offline *off = scene_open(t->dev, method, settings);
    tyn_view view = {
        .camera = scene->cameras[0], .width = size, .height = size, .outputs = TYN_OUTPUT_RADIANCE};
    offline_frame(off, scene, &view);
    const float *pixels = tyn_offline_output(off, TYN_OUTPUT_RADIANCE);
    double mean = 0;
    for (uint32_t i = 0; i < size * size; i++) {
        mean += pixels[4 * i + 1] / (size * size);
    }
    tyn_offline_destroy(&off);
    return mean;
}

// A ray that has come to its end through an empty step makes none of no length. Of so many rays a few do.
static void ends_of_rays(void **state)
{
    gpu_test *t = *state;
    tyn_scene *scene = malloc(sizeof *scene);
    sample_scene_load(scene, "lantern", t);
    assert_true(mean_of(t, "single", scene, "raymarch.sparse=0", 512) > 0);
    tyn_scene_finish(scene);
    free(scene);
}

// The published method has pictures of these scenes, too, all of numbers; of the others golden-pop-paper has them, and
// golden-single of all by `single`.
static void pop_paper(void **state)
{
    static const char *const names[] = {"room", "cornell-smoke", "vpl-cave", "many-lights"};
    gpu_test *t = *state;
    bool good = true;
    for (int i = 0; i < 4 && is_built_in("pop-paper"); i++) {
        tyn_scene *scene = malloc(sizeof *scene);
        sample_scene_load(scene, names[i], t);
        const double mean = mean_of(t, "pop-paper", scene, "propagate_radial.cells=8", 64);
        print_message("%-14s pop-paper  mean %.3g\n", names[i], mean);
        good = good && mean > 0;
        tyn_scene_finish(scene);
        free(scene);
    }
    assert_true(good);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(pictures), cmocka_unit_test(ends_of_rays),
                                       cmocka_unit_test(pop_paper)};
    setvbuf(stdout, NULL, _IOLBF, 0);
    cmocka_set_test_filter(getenv("TYN_TEST_FILTER"));
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
