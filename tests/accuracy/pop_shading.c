// pop_shading.c -- how `pop` shares virtual lights among neighbouring pixels: no squares where few of them are most of
// what arrives, and as much light as if every pixel took all; how blocks of pixels share one place; and what takes all.
#include "bound.h"
#include "gpu_test.h"
#include "numbers.h"
#include "picture.h"
#include "sample_scene.h"
#include "solids.h"
#include "todo.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { SIZE = 100 };

// A floor close below a strip of light, whose virtual lights each are most of what is below them, and a block that
// stands on it: edges, and sides that are seen at grazing angles.
static void render(gpu_test *t, picture *p, bool block, const char *settings)
{
    tyn_scene scene;
    tyn_view view = {0};
    tyn_scene_init(&scene);
    uint32_t grey = solids_material(&scene, (float[]){0.5f, 0.5f, 0.5f}, (float[]){0, 0, 0});
    uint32_t lamp = solids_material(&scene, (float[]){0, 0, 0}, (float[]){20, 20, 20});
    solids_quad(&scene, (float[]){-2, 0, -2}, (float[]){0, 0, 4}, (float[]){4, 0, 0}, grey);
    solids_quad(&scene, (float[]){-2, 0.3f, -0.01f}, (float[]){4, 0, 0}, (float[]){0, 0, 0.02f},
                lamp);
    if (block) {
        solids_box(&scene, (float[]){-0.2f, 0, 0.1f}, (float[]){0.1f, 0.2f, 0.3f}, 0.4f, false,
                   grey);
    }
    solids_hierarchy(&scene, 4);
    const float y = block ? -0.6f : -1, z = block ? -0.8f : 0;
    const float up[3] = {0, block ? 0.8f : 0, block ? -0.6f : -1};
    const float at[3] = {0, block ? 0.15f : 0.1f, block ? 0.16f : 0};
    view_orthographic(&view, at, 0, y, z, up, 0.5f, SIZE);
    picture_render(p, t->dev, "pop", &scene, &view, settings, 1);
    tyn_scene_finish(&scene);
}

static double value(const picture *p, int x, int y)
{
    return p->rgb[3 * (y * SIZE + x)];
}

// The second difference from one pixel of a row or column to the next but one; squares make it large at their borders.
static double bend(const picture *p, int x, int y, int dx, int dy)
{
    return value(p, x - dx, y - dy) - 2 * value(p, x, y) + value(p, x + dx, y + dy);
}

static void no_squares(void **state)
{
    static const struct {
        const char *settings; // and what the truth is rendered with
        bool block;
        // The nearest pixel of each part alone would give 130, 105, 287 %; 12.5, 7.2, 12.7 %; .49, .00, .46 %; 16, 11,
        // 17 %.
        double worst, rms, mean,
            bend; // of the mean; `bend`: how much more of it there may be, root mean square
    } cases[] = {
        {"vpl.count=128", false, 0.12, 0.015, 8e-4, 0.01},
        {"vpl.count=32", false, 0.19, 0.011, 5e-5, 0.02},
        {"vpl.count=128", true, 0.3, 0.03, 0.001, 0.02},
        // Blocks of 2 x 2 pixels with one place each, as in pictures of 384 pixels and more.
        {"vpl.count=128 shade.step=2", false, 0.3, 0.05, 0.003, 0.03},
        {"vpl.count=128 shade.step=2", true, 1.2, 0.1, 8e-4, 0.1},
    };
    bool good = true;
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        picture p, truth;
        char settings[64];
        snprintf(settings, sizeof settings, "%.13s shade.pattern=1", cases[k].settings);
        render(*state, &p, cases[k].block, cases[k].settings);
        render(*state, &truth, cases[k].block, settings);
        double worst = 0, sum = 0, off = 0, squares = 0, bends = 0, true_bends = 0;
        for (int y = 0; y < SIZE; y++) {
            for (int x = 0; x < SIZE; x++) {
                double v = value(&truth, x, y), d = value(&p, x, y) - v;
                worst = maximum(worst, fabs(d));
                sum += v;
                off += d;
                squares += d * d;
            }
        }
        for (int y = 1; y < SIZE - 1; y++) {
            for (int x = 1; x < SIZE - 1; x++) {
                for (int along = 0; along < 2; along++) {
                    double a = bend(&p, x, y, along, 1 - along);
                    double b = bend(&truth, x, y, along, 1 - along);
                    bends += (a - b) * (a - b);
                    true_bends += b * b;
                }
            }
        }
        const double mean = sum / (SIZE * SIZE), rms = sqrt(squares) / SIZE / mean;
        const double bent = sqrt(0.5 * bends) / SIZE / mean;
        print_message(
            "%s%s: a pixel %.2f %% off at most, rms %.3f %%, mean %+.4f %%; second differences "
            "%.4f %% off (they are %.4f %%)\n",
            cases[k].settings, cases[k].block ? ", block" : "", 100 * worst / mean, 100 * rms,
            100 * off / sum, 100 * bent, 100 * sqrt(0.5 * true_bends) / SIZE / mean);
        char name[64];
        snprintf(name, sizeof name, "%s%s", cases[k].settings, cases[k].block ? ", block" : "");
        good = good && sum > 0;
        good = within(worst / mean, cases[k].worst, NULL, "%s, worst", name) && good;
        good = within(rms, cases[k].rms, NULL, "%s, rms", name) && good;
        good = within(bent, cases[k].bend, NULL, "%s, bend", name) && good;
        good = within(fabs(off / sum), cases[k].mean, NULL, "%s, mean", name) && good;
        picture_free(&p);
        picture_free(&truth);
    }
    assert_true(good);
}

static const char since_triangles[] =
    "held while the G-buffer stored distances and facets: 1.0e-3 with triangles alone, 5.5e-4 "
    "since a block's place is of one triangle";

// Light of virtual lights and of the lattice once for 2 x 2 pixels against once for every pixel, where every place
// takes all virtual lights.
static void blocks_of_pixels(void **state)
{
    static const struct {
        const char *scene;
        double off; // a third above what is observed, where blocks have one place for smooth light
        double mean;
    } cases[] = {
        {"vpl-cave", 0.035, 0.002},
        {"cornell-smoke", 0.014, 1.2e-4},
        {"lantern", 0.006, 3.5e-4},
    };
    bool good = true;
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        tyn_scene scene;
        sample_scene_load(&scene, cases[k].scene, *state);
        const tyn_view view = {.camera = scene.cameras[0], .width = 101, .height = 99};
        const char *common = "lattice.cells=16 shade.pattern=1 vpl.count=32";
        char set[2][96];
        picture p[2];
        for (int i = 0; i < 2; i++) {
            snprintf(set[i], sizeof set[i], "%s shade.step=%d", common, i + 1);
            picture_render(&p[i], ((gpu_test *)*state)->dev, "pop", &scene, &view, set[i], 1);
        }
        double sum = 0, off = 0, all = 0;
        for (int i = 0; i < 3 * 101 * 99; i++) {
            const double d = (double)p[1].rgb[i] - (double)p[0].rgb[i];
            sum += (double)p[0].rgb[i];
            off += fabs(d);
            all += d;
        }
        print_message("%s: %.3f %% off, mean %+.4f %%\n", cases[k].scene, 100 * off / sum,
                      100 * all / sum);
        good = good && sum > 0;
        good = within(off / sum, cases[k].off, NULL, "blocks, %s, off", cases[k].scene) && good;
        const bool bars = strcmp(cases[k].scene, "lantern") == 0;
        const double mean = fabs(all) / sum;
        if (bars) {
            good = todo_if(true, mean < cases[k].mean, since_triangles,
                           "blocks, lantern, mean: %.2e of %.2e", mean, cases[k].mean) &&
                   good;
        }
        good =
            within(mean, bars ? 6e-4 : cases[k].mean, NULL, "blocks, %s, mean", cases[k].scene) &&
            good;
        picture_free(&p[0]);
        picture_free(&p[1]);
        tyn_scene_finish(&scene);
    }
    assert_true(good);
}

// A small lamp that stands on a floor, in front of a wall, as six faces of which some are a few pixels.
static void make_lamp(tyn_scene *scene, tyn_view *view)
{
    tyn_scene_init(scene);
    uint32_t grey = solids_material(scene, (float[]){0.5f, 0.5f, 0.5f}, (float[]){0, 0, 0});
    uint32_t lamp = solids_material(scene, (float[]){0, 0, 0}, (float[]){40, 40, 40});
    solids_quad(scene, (float[]){-2, 0, -2}, (float[]){0, 0, 4}, (float[]){4, 0, 0}, grey);
    solids_quad(scene, (float[]){-2, 0, -0.3f}, (float[]){4, 0, 0}, (float[]){0, 3, 0}, grey);
    solids_box(scene, (float[]){-0.03f, 0.02f, -0.03f}, (float[]){0.03f, 0.1f, 0.03f}, 0.5f, false,
               lamp);
    solids_hierarchy(scene, 4);
    view_orthographic(view, (float[]){0, 0.1f, 0}, 0, -0.6f, -0.8f, (float[]){0, 0.8f, -0.6f}, 0.7f,
                      SIZE);
}

// Bars thinner than a pixel, lit from one side, before a bright wall that does not light their fronts.
static void make_fence(tyn_scene *scene, tyn_view *view)
{
    tyn_scene_init(scene);
    uint32_t grey = solids_material(scene, (float[]){0.5f, 0.5f, 0.5f}, (float[]){0, 0, 0});
    uint32_t lamp = solids_material(scene, (float[]){0, 0, 0}, (float[]){4, 4, 4});
    solids_quad(scene, (float[]){-2, 0, -1}, (float[]){4, 0, 0}, (float[]){0, 2, 0}, grey);
    solids_quad(scene, (float[]){-2, 2, -0.5f}, (float[]){4, 0, 0}, (float[]){0, 0, 0.3f}, lamp);
    for (int k = 0; k < 12; k++) {
        const float x = -0.55f + 0.1f * (float)k;
        solids_box(scene, (float[]){x, 0, 0}, (float[]){x + 0.004f, 2, 0.004f}, 0.6f, false, grey);
    }
    solids_hierarchy(scene, 4);
    view_orthographic(view, (float[]){0, 1, 0}, 0.1f, -0.3f, -0.95f, (float[]){0, 1, 0}, 0.5f,
                      SIZE);
}

// What neighbours do not tell of: light that falls off within a few pixels, beside what gives it, and bars that
// fill no pixel. Against pictures whose every piece of surface takes all virtual lights.
static void small_things(void **state)
{
    static const struct {
        void (*make)(tyn_scene *, tyn_view *);
        const char *name, *settings;
        int half;         // pixels of the crop around the middle
        double off, mean; // of all light in it
        const char *few;  // why the mean is known to be more
    } cases[] = {
        // Taken from neighbours: 32 % off, mean -23 %; 46, +30; .86, -.49. Between places 2 pixels apart that are as near to
        // the lamp, its light is linear.
        {make_lamp, "lamp", "vpl.count=128 shade.step=1", 12, 0.04, 0.007},
        {make_lamp, "lamp", "vpl.count=192 shade.step=1", 12, 0.045, 0.007,
         "next to a lamp the mean hangs on where its lights lie: .6 to 3.6 % for 128 to 240"},
        {make_lamp, "lamp", "vpl.count=128 shade.step=2", 12, 0.12, 0.015},
        {make_fence, "fence", "vpl.count=128 shade.step=2", SIZE / 2, 0.005, 0.001},
    };
    bool good = true;
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        tyn_scene scene;
        tyn_view view = {0};
        picture p, truth;
        cases[k].make(&scene, &view);
        tyn_device *dev = ((gpu_test *)*state)->dev;
        picture_render(&p, dev, "pop", &scene, &view, cases[k].settings, 1);
        char each[64];
        snprintf(each, sizeof each, "%.13s shade.pattern=1 shade.step=1", cases[k].settings);
        picture_render(&truth, dev, "pop", &scene, &view, each, 1);
        double sum = 0, off = 0, all = 0;
        int far = 0;
        for (int y = SIZE / 2 - cases[k].half; y < SIZE / 2 + cases[k].half; y++) {
            for (int x = SIZE / 2 - cases[k].half; x < SIZE / 2 + cases[k].half; x++) {
                // What the lamp shows of itself is the same in both.
                const double v = value(&truth, x, y), d = value(&p, x, y) - v;
                const bool itself = v > 10;
                sum += itself ? 0 : v;
                off += itself ? 0 : fabs(d);
                all += itself ? 0 : d;
                far += !(fabs(d) <= 0.3 * v);
            }
        }
        print_message("%s, %s: %.2f %% off, mean %+.3f %%, %d pixels more than 30 %% off\n",
                      cases[k].name, cases[k].settings, 100 * off / sum, 100 * all / sum, far);
        good = good && sum > 0;
        good = within(off / sum, cases[k].off, NULL, "%s, %s, off", cases[k].name,
                      cases[k].settings) &&
               good;
        good = todo_if(cases[k].few,
                       within(fabs(all) / sum, cases[k].mean, NULL, "%s, %s, mean", cases[k].name,
                              cases[k].settings),
                       cases[k].few, "%s, %s, mean", cases[k].name, cases[k].settings) &&
               good;
        picture_free(&p);
        picture_free(&truth);
        tyn_scene_finish(&scene);
    }
    assert_true(good);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(no_squares),
                                       cmocka_unit_test(blocks_of_pixels),
                                       cmocka_unit_test(small_things)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
