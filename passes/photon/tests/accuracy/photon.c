// photon.c -- `photon` against `path` in a cloud, its noise, a sun that turns, and which nodes run when something changes.
#include "bound.h"
#include "gpu_test.h"
#include "numbers.h"
#include "offline_frame.h"
#include "path_run.h"
#include "picture.h"
#include "sample_scene.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- the cloud's fluence ------------------------------------------------------------------------

// Cells of a cache of 8 x 6 x 8, of 75 m.
enum { COUNT = 8, PLACES = 64, POINTS = COUNT * PLACES };
static const int picked[COUNT][3] = {{2, 2, 3}, {3, 2, 2}, {3, 2, 4}, {3, 3, 3},
                                     {4, 2, 3}, {4, 3, 4}, {5, 2, 3}, {5, 2, 5}};
static float centres[COUNT][3], points[POINTS][3];

static void place_points(void)
{
    for (int i = 0; i < COUNT; i++) {
        for (int a = 0; a < 3; a++) {
            const float lo = (a == 1 ? 610 - 225 : -300) + 75 * (float)picked[i][a];
            centres[i][a] = lo + 37.5f;
            for (int k = 0; k < PLACES; k++) { // one in each of 4^3 parts
                const int part = k >> (2 * a) & 3;
                points[i * PLACES + k][a] =
                    lo + 18.75f * ((float)part + (float)rand() / (float)RAND_MAX);
            }
        }
    }
}

typedef struct cell_means {
    double mean[COUNT], se[COUNT];
} cell_means;

static cell_means of_path(tyn_device *dev, const tyn_scene *scene)
{
    cell_means m;
    path_run path;
    path_run_open(&path, dev);
    const tyn_probe_result *p =
        path_run_probe(&path, scene, (const float(*)[3])points, POINTS, false, path_effort(96));
    for (int i = 0; i < COUNT; i++) {
        double square = 0;
        m.mean[i] = 0;
        for (int k = 0; k < PLACES; k++) {
            const double value = (double)p[i * PLACES + k].fluence[1];
            m.mean[i] += value / PLACES;
            square += value * value / PLACES;
        }
        m.se[i] = sqrt((square - m.mean[i] * m.mean[i]) / PLACES);
    }
    path_run_close(&path);
    return m;
}

static cell_means of_photons(tyn_device *dev, const tyn_scene *scene, const char *similarity)
{
    cell_means m = {{0}, {0}};
    char settings[128];
    snprintf(settings, sizeof settings,
             "photon_trace.cells=8 photon_trace.first=cache photon_trace.similarity=%s",
             similarity);
    tyn_offline *off = scene_open(dev, "photon", settings);
    const tyn_probe_result *p = scene_probes(dev, off, scene, (const float(*)[3])centres, COUNT);
    for (int i = 0; i < COUNT; i++) {
        m.mean[i] = (double)p[i].fluence[1];
    }
    tyn_offline_destroy(&off);
    return m;
}

typedef struct apart {
    double worst, mean; // of a cell beyond 3 standard errors of the reference; of all
} apart;

static apart compare(const cell_means *a, const cell_means *reference, const char *what)
{
    apart r = {0, 0};
    double sum = 0, se = 0;
    for (int i = 0; i < COUNT; i++) {
        const double off = a->mean[i] - reference->mean[i];
        r.worst = maximum(r.worst, (fabs(off) - 3 * reference->se[i]) / reference->mean[i]);
        r.mean += off;
        sum += reference->mean[i];
        se = maximum(se, reference->se[i] / reference->mean[i]);
    }
    r.mean /= sum;
    printf("%-40s all cells %+.2f %%, one at most %.2f %% beyond noise (%.1f %%)\n", what,
           100 * r.mean, 100 * r.worst, 100 * se);
    return r;
}

// Cells against `path`, and similarity against none. (Paths from inside are no reference at g 0.96: they hardly ever find
// the way to the sun. passes/photon/tests/gpu/photon_trace.c has what the medium absorbs instead.)
static void fluence(void **state)
{
    gpu_test *t = *state;
    tyn_scene scene;
    sample_scene_load(&scene, "cloud", t);
    srand(1);
    place_points();
    const cell_means path = of_path(t->dev, &scene);
    const cell_means off = of_photons(t->dev, &scene, "off");
    const cell_means usual = of_photons(t->dev, &scene, "usual");
    const cell_means printed = of_photons(t->dev, &scene, "printed");
    const apart none = compare(&off, &path, "g 0.85 against path"),
                alike = compare(&usual, &path, "g 0.85, usual similarity, against path"),
                similar = compare(&usual, &off, "g 0.85, usual similarity against none"),
                wrong = compare(&printed, &off, "g 0.85, printed similarity against none");
    for (int c = 0; c < 3; c++) {
        scene.media[0].phase[c].g = 0.96f;
    }
    const cell_means narrow = of_photons(t->dev, &scene, "off"),
                     narrow_usual = of_photons(t->dev, &scene, "usual");
    const apart peak = compare(&narrow_usual, &narrow, "g 0.96, usual similarity against none");
    tyn_scene_finish(&scene);
    assert_within(none.worst, 0.05, BOUND_NOISE);
    assert_within(fabs(none.mean), 0.03, BOUND_NOISE);
    assert_within(alike.worst, 0.05, BOUND_NOISE);
    assert_within(similar.worst, 0.05, BOUND_NOISE);
    assert_within(peak.worst, 0.05, BOUND_NOISE);
    assert_true(wrong.mean > 0.1); // it scatters too often, and light stays
}

// ---- noise, and what is obsolete ------------------------------------------------------------------

static void turn_sun(tyn_scene *scene, double degrees)
{
    const double a = 0.7 + degrees * M_PI / 180;
    scene->lights[0].direction[0] = (float)(0.6 * cos(a));
    scene->lights[0].direction[1] = -0.8f;
    scene->lights[0].direction[2] = (float)(0.6 * sin(a));
}

// A cube as deep as a small cloud.
static void make_cube(tyn_scene *scene)
{
    tyn_medium medium = grey_medium(20, 0, 0.85f);
    tyn_scene_init(scene);
    scene_add_box(scene, &medium, (float[]){0, 0, 0}, (float[]){1, 1, 1}, NULL, NULL);
    scene_add_sun(scene, 0, -1, 0, 1, 1, 1);
    turn_sun(scene, 0);
}

static double spread(tyn_device *dev, const tyn_scene *scene, const char *settings)
{
    enum { SEEDS = 4, CELLS = 64 };
    static float places[CELLS][3];
    static double values[CELLS][SEEDS];
    for (int i = 0; i < CELLS; i++) {
        const int at[3] = {i % 4, i / 4 % 4, i / 16};
        for (int a = 0; a < 3; a++) {
            places[i][a] = ((float)at[a] + 0.5f) / 4;
        }
    }
    for (uint32_t seed = 0; seed < SEEDS; seed++) {
        tyn_offline *off = scene_open(dev, "photon", settings);
        tyn_view view = {.width = 1,
                         .height = 1,
                         .outputs = TYN_OUTPUT_PROBE,
                         .points = (const float(*)[3])places,
                         .num_points = CELLS,
                         .seed = seed};
        tyn_camera_frame_scene(&view.camera, scene);
        offline_frame(off, scene, &view);
        const tyn_probe_result *p = tyn_offline_output(off, TYN_OUTPUT_PROBE);
        for (int i = 0; i < CELLS; i++) {
            values[i][seed] = (double)p[i].fluence[1];
        }
        tyn_offline_destroy(&off);
    }
    double square = 0;
    for (int i = 0; i < CELLS; i++) {
        double mean = 0, sum = 0;
        for (int k = 0; k < SEEDS; k++) {
            mean += values[i][k] / SEEDS;
        }
        for (int k = 0; k < SEEDS; k++) {
            sum += (values[i][k] / mean - 1) * (values[i][k] / mean - 1);
        }
        square += sum / (SEEDS - 1) / CELLS;
    }
    return sqrt(square);
}

// Of cells of 5 mean free paths.
static void noise(void **state)
{
    gpu_test *t = *state;
    tyn_scene scene;
    make_cube(&scene);
    const double found =
        spread(t->dev, &scene,
               "photon_trace.cells=4 photon_trace.generations=20 photon_trace.photons=8192 "
               "photon_trace.first=cache");
    printf("noise of a cell: %.2f %%\n", 100 * found);
    assert_within(found, 0.02, NULL);
    tyn_scene_finish(&scene);
}

// The sun turns by 1 degree while all generations are renewed: the picture at its end against one that starts there.
static void obsolescence(void **state)
{
    enum { FRAMES = 20 };
    static const char settings[] =
        "photon_trace.cells=8 photon_trace.generations=20 photon_trace.photons=8192";
    gpu_test *t = *state;
    tyn_scene scene;
    tyn_view view = {.outputs = TYN_OUTPUT_RADIANCE};
    make_cube(&scene);
    view_perspective(&view, (float[]){2, 1.4f, 2.5f}, (float[]){0.5f, 0.5f, 0.5f}, 0.3f, 24);
    tyn_offline *off = scene_open(t->dev, "photon", settings);
    for (int frame = 0; frame <= FRAMES; frame++) {
        turn_sun(&scene, (double)frame / FRAMES);
        offline_frame(off, &scene, &view);
    }
    const float *moving = tyn_offline_output(off, TYN_OUTPUT_RADIANCE);
    tyn_offline *fresh = scene_open(t->dev, "photon", settings);
    offline_frame(fresh, &scene, &view);
    const float *still = tyn_offline_output(fresh, TYN_OUTPUT_RADIANCE);
    view.seed = 1;
    tyn_offline *other = scene_open(t->dev, "photon", settings);
    offline_frame(other, &scene, &view);
    const float *again = tyn_offline_output(other, TYN_OUTPUT_RADIANCE);
    double off_by = 0, noise_of_it = 0, sum = 0;
    for (int i = 0; i < 24 * 24; i++) {
        off_by += fabs((double)moving[4 * i + 1] - (double)still[4 * i + 1]);
        noise_of_it += fabs((double)again[4 * i + 1] - (double)still[4 * i + 1]);
        sum += (double)still[4 * i + 1];
    }
    off_by /= sum;
    noise_of_it /= sum;
    printf("a sun that turns by 1 degree in %d frames: picture off by %.2f %%, two seeds by %.2f "
           "%%\n",
           FRAMES, 100 * off_by, 100 * noise_of_it);
    tyn_offline_destroy(&other);
    tyn_offline_destroy(&fresh);
    tyn_offline_destroy(&off);
    tyn_scene_finish(&scene);
    assert_within(sqrt(maximum(off_by * off_by - noise_of_it * noise_of_it, 0)), 0.015,
                  BOUND_NOISE);
}

// ---- what runs ------------------------------------------------------------------------------------

static void nodes_that_ran(tyn_offline *off, char *text, size_t size)
{
    tyn_report report;
    tyn_offline_report(off, &report);
    text[0] = 0;
    for (uint32_t i = 0; i < report.num_nodes; i++) {
        if (!strcmp(report.nodes[i].state, "ran")) {
            const size_t used = strlen(text);
            snprintf(text + used, size - used, "%s%s", used ? " " : "", report.nodes[i].name);
        }
    }
}

#define FIRST "beam photon_trace photon_cache photon_upsample photon_view raymarch"
#define RENEWED "photon_trace photon_cache photon_upsample photon_view raymarch"

// Beside those of the set-up. Four generations: what was changed is followed for four frames.
static void skips(void **state)
{
    static const struct {
        const char *what, *ran;
    } frames[] = {
        {"first frame", FIRST},
        {"nothing changed", ""},
        {"camera moved", "photon_view raymarch"},
        {"sun turned", FIRST},
        {"1 frame later", RENEWED},
        {"2 frames later", RENEWED},
        {"3 frames later", RENEWED},
        {"4 frames later", ""},
        {"5 frames later", ""},
        {"sun turned", FIRST},
        {"sun turned", FIRST},
        {"1 frame later", RENEWED},
        {"2 frames later", RENEWED},
        {"3 frames later", RENEWED},
        {"4 frames later", ""},
        {"cut", RENEWED},
        {"nothing changed", ""},
        {"unlit", "raymarch"},
        {"empty", "raymarch"},
    };
    gpu_test *t = *state;
    tyn_scene scene;
    tyn_view view = {.outputs = TYN_OUTPUT_RADIANCE};
    make_cube(&scene);
    view_perspective(&view, (float[]){2, 1.4f, 2.5f}, (float[]){0.5f, 0.5f, 0.5f}, 0.3f, 16);
    tyn_offline *off =
        scene_open(t->dev, "photon",
                   "photon_trace.cells=4 photon_trace.generations=4 photon_trace.photons=256");
    bool right = true;
    double degrees = 0;
    for (size_t k = 0; k < sizeof frames / sizeof frames[0]; k++) {
        char ran[1024];
        const char *what = frames[k].what;
        if (!strcmp(what, "camera moved")) {
            view_perspective(&view, (float[]){2.1f, 1.4f, 2.5f}, (float[]){0.5f, 0.5f, 0.5f}, 0.3f,
                             16);
        } else if (!strcmp(what, "sun turned")) {
            turn_sun(&scene, degrees += 1);
        } else if (!strcmp(what, "cut")) {
            view.cut++;
        } else if (!strcmp(what, "unlit")) {
            scene.num_lights = 0;
        } else if (!strcmp(what, "empty")) {
            scene.num_shapes = 0;
        }
        offline_frame(off, &scene, &view);
        nodes_that_ran(off, ran, sizeof ran);
        if (strcmp(ran, frames[k].ran)) {
            printf("%-16s '%s', not '%s'\n", what, ran, frames[k].ran);
            right = false;
        }
    }
    tyn_offline_destroy(&off);
    tyn_scene_finish(&scene);
    assert_true(right);
}

// Light of a map by the regions of its principal ordinates is the same light: fluence and net flux with one lobe and with eight.
static void lobes(void **state)
{
    gpu_test *t = *state;
    tyn_scene scene;
    sample_scene_load(&scene, "smoke-sky", t);
    double most = 0, flux = 0;
    static const float at[2][3] = {{0, 0.3f, 0}, {0.1f, 0.6f, 0.05f}};
    tyn_probe_result found[2][2];
    for (int k = 0; k < 2; k++) {
        char settings[128];
        snprintf(settings, sizeof settings,
                 "photon_trace.cells=8 photon_trace.generations=2 photon_trace.lobes=%d",
                 k ? 8 : 1);
        tyn_offline *off = scene_open(t->dev, "photon", settings);
        memcpy(found[k], scene_probes(t->dev, off, &scene, at, 2), sizeof found[k]);
        tyn_offline_destroy(&off);
    }
    for (int i = 0; i < 2; i++) {
        const double whole = (double)found[0][i].fluence[1];
        assert_true(whole > 0);
        most = maximum(most, fabs((double)found[1][i].fluence[1] / whole - 1));
        for (int a = 0; a < 3; a++) {
            const double one = (double)found[0][i].flux[3 * a + 1];
            flux = maximum(flux, fabs((double)found[1][i].flux[3 * a + 1] - one) / whole);
        }
    }
    printf("eight lobes against one: fluence %.4f %%, flux %.3f %%\n", 100 * most, 100 * flux);
    tyn_scene_finish(&scene);
    assert_true(most < 1e-4);
    assert_within(flux, 0.01, NULL); // of a channel: a lobe's is that of the mean of all
}

// Surfaces have the light of the cells in front of them: without it the cave is 40 % too dark. In cornell-smoke only a surface
// emits.
static void among_surfaces(void **state)
{
    static const struct {
        const char *name;
        uint32_t spp;
        double bound; // on blocks of 8x8 pixels
    } cases[] = {{"vpl-cave", 128, 0.2},
                 {"room", 64, 0.12},
                 {"fog-hall", 48, 0.15},
                 {"cornell-smoke", 64, 0.25}};
    gpu_test *t = *state;
    bool all = true;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        tyn_scene scene;
        sample_scene_load(&scene, cases[i].name, t);
        tyn_view view = {
            .width = 48, .height = 48, .camera = scene.cameras[0], .outputs = TYN_OUTPUT_RADIANCE};
        picture path, found;
        path_reference(&path, t->dev, &scene, &view, path_effort(cases[i].spp));
        picture_render(&found, t->dev, "photon", &scene, &view,
                       "photon_trace.generations=10 photon_trace.photons=16384", 1);
        const picture_error e = picture_compare(&found, &path, 8);
        printf("%s: %.1f %% (noise %.1f %%, bias %+.1f %%)\n", cases[i].name, 100 * e.reported,
               100 * e.noise, 100 * e.bias);
        all = within(e.rel_l1, cases[i].bound, BOUND_NOISE, "%s", cases[i].name) && all;
        picture_free(&path);
        picture_free(&found);
        tyn_scene_finish(&scene);
    }
    assert_true(all);
}

// What surfaces send is counted once: by the cells, not by virtual lights as well, though these light the surfaces.
static void probes_among_surfaces(void **state)
{
    static const float at[3][3] = {{0.1f, 0.3f, 0.1f}, {0.2f, 0.2f, 0.2f}, {0.3f, 0.4f, 0.3f}};
    gpu_test *t = *state;
    tyn_scene scene;
    sample_scene_load(&scene, "cornell-smoke", t);
    path_run path;
    path_run_open(&path, t->dev);
    const tyn_probe_result *right = path_run_probe(&path, &scene, at, 3, false, path_effort(1500));
    double sum = 0, off = 0;
    tyn_offline *photons =
        scene_open(t->dev, "photon", "photon_trace.generations=10 photon_trace.photons=65536");
    const tyn_probe_result *found = scene_probes(t->dev, photons, &scene, at, 3);
    for (int i = 0; i < 3; i++) {
        sum += (double)right[i].fluence[1];
        off += fabs((double)found[i].fluence[1] - (double)right[i].fluence[1]);
    }
    printf("fluence among surfaces: %.1f %% off\n", 100 * off / sum);
    tyn_offline_destroy(&photons);
    path_run_close(&path);
    tyn_scene_finish(&scene);
    assert_true(sum > 1);
    assert_within(off / sum, 0.06, BOUND_NOISE);
}

// Two runs, pixel by pixel.
static void same_bytes(void **state)
{
    gpu_test *t = *state;
    tyn_scene scene;
    tyn_view view = {.outputs = TYN_OUTPUT_RADIANCE};
    make_cube(&scene);
    scene_set_sky(&scene, 0.3f);
    view_perspective(&view, (float[]){2, 1.4f, 2.5f}, (float[]){0.5f, 0.5f, 0.5f}, 0.3f, 16);
    static float first[16 * 16 * 4];
    for (int k = 0; k < 2; k++) {
        tyn_offline *off = scene_open(t->dev, "photon", "photon_trace.photons=512");
        offline_frame(off, &scene, &view);
        const float *found = tyn_offline_output(off, TYN_OUTPUT_RADIANCE);
        if (k == 0) {
            memcpy(first, found, sizeof first);
        } else {
            assert_memory_equal(first, found, sizeof first);
        }
        tyn_offline_destroy(&off);
    }
    tyn_scene_finish(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fluence),        cmocka_unit_test(noise),
        cmocka_unit_test(obsolescence),   cmocka_unit_test(skips),
        cmocka_unit_test(same_bytes),     cmocka_unit_test(lobes),
        cmocka_unit_test(among_surfaces), cmocka_unit_test(probes_among_surfaces),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
