// pop_flicker.c -- how steady `pop` is while the camera or the environment map turns.
//
// Half a degree a frame about a still medium, blocks of 4x4 pixels. RMS over blocks and frames, in % of the
// mean: the change from frame to frame of `pop` and of `path`; the difference of the two, which is
// what `pop` changes beyond what `path` shows; and what of the change of `pop` is not a cubic in time,
// which is what one sees flicker: four degrees of turning are no more than a cubic, behind the phase
// function.
//
// `path` comes as cubics in time from a table, made by this program with TYN_FLICKER_MAKE=FILE from two
// runs A and B with different random numbers: noise drops out of mean products of A and B.
#include "bound.h"
#include "gpu_test.h"
#include "numbers.h"
#include "offline_frame.h"
#include "picture.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FRAMES = 9, SIZE = 32, BLOCK = 4, SIDE = SIZE / BLOCK, VALUES = SIDE * SIDE * 3 };
enum { GRID = 32, SAMPLES = 2048 };

typedef enum motion { MAP_TURNS, CAMERA_TURNS } motion;
static const char *const motions[2] = {"map turns", "camera turns"};
static const float half_a_degree = 0.5f / 57.29578f;

// ---- the scene --------------------------------------------------------------------------------

static const double lamps[][5] = {
    // direction, cosine of its edge, radiance
    {0.5, 0.7, -0.5, 0.985, 60}, {-0.9, 0.3, -0.2, 0.97, 20}, {0.2, 0.2, 0.95, 0.99, 50},
    {-0.4, 0.1, 0.9, 0.95, 12},  {0.8, -0.3, 0.4, 0.98, 25},
};

// A dim room with five windows: most of the light is in a thirtieth of the sphere.
static void make_map(tyn_environment *map)
{
    enum { W = 256, H = 128 };
    *map = (tyn_environment){
        .present = true, .size = {W, H}, .radiance = {1, 1, 1}, .strength = 1, .hash = 77};
    map->data = malloc(W * H * 3 * sizeof *map->data);
    for (int i = 0; i < W * H; i++) {
        double azimuth = ((i % W + 0.5) / W - 0.5) * 6.283185307,
               polar = (i / W + 0.5) / H * 3.141592654;
        const double w[3] = {sin(polar) * sin(azimuth), cos(polar), -sin(polar) * cos(azimuth)};
        double level = 0.3 + 0.1 * w[1];
        for (size_t n = 0; n < sizeof lamps / sizeof *lamps; n++) {
            const double *l = lamps[n];
            double length = sqrt(l[0] * l[0] + l[1] * l[1] + l[2] * l[2]);
            double mu = (w[0] * l[0] + w[1] * l[1] + w[2] * l[2]) / length;
            level += mu > l[3] ? l[4] : 0;
        }
        for (int c = 0; c < 3; c++) {
            map->data[3 * i + c] = (float)(level * (1 - 0.15 * c));
        }
    }
}

// Smoke: three puffs.
static void make_scene(tyn_scene *scene)
{
    static const float puffs[3][4] = {
        {0.42f, 0.4f, 0.45f, 0.25f}, {0.6f, 0.6f, 0.55f, 0.2f}, {0.45f, 0.75f, 0.6f, 0.15f}};
    float *grid = malloc(GRID * GRID * GRID * sizeof *grid);
    for (int i = 0; i < GRID * GRID * GRID; i++) {
        float p[3] = {((float)(i % GRID) + 0.5f) / GRID, ((float)(i / GRID % GRID) + 0.5f) / GRID,
                      ((float)(i / (GRID * GRID)) + 0.5f) / GRID};
        float density = 0;
        for (int n = 0; n < 3; n++) {
            float r2 = 0;
            for (int a = 0; a < 3; a++) {
                r2 += (p[a] - puffs[n][a]) * (p[a] - puffs[n][a]);
            }
            density += fmaxf(0, 1 - r2 / (puffs[n][3] * puffs[n][3]));
        }
        grid[i] = density;
    }
    tyn_medium medium = grey_medium(10, 0.3f, 0.8f);
    scene_add_box(scene, &medium, (float[]){-0.5f, -0.5f, -0.5f}, (float[]){0.5f, 0.5f, 0.5f},
                  (uint32_t[]){GRID, GRID, GRID}, grid);
    free(grid);
    make_map(&scene->environment);
}

static void set_frame(tyn_scene *scene, tyn_view *view, motion m, int frame)
{
    float angle = half_a_degree * (float)frame;
    float camera_angle = m == CAMERA_TURNS ? angle : 0;
    scene->environment.rotation[0] = scene->environment.rotation[2] = 0;
    scene->environment.rotation[1] = m == MAP_TURNS ? sinf(0.5f * angle) : 0;
    scene->environment.rotation[3] = m == MAP_TURNS ? cosf(0.5f * angle) : 1;
    view->camera.yfov = 0.5f;
    const float from[3] = {2.4f * sinf(0.4f + camera_angle), 0.5f,
                           2.4f * cosf(0.4f + camera_angle)};
    assert_int_equal(tyn_camera_look_at(&view->camera, from, (float[]){0, 0, 0}), TYN_OK);
    view->width = view->height = SIZE;
    view->no_background = true;
}

// ---- pictures ---------------------------------------------------------------------------------

// Means over blocks.
typedef struct frames {
    double at[FRAMES][VALUES];
} frames;

// `settings`: "name=value name=value" or NULL.
static void render(gpu_test *t, const char *method, const char *settings, tyn_scene *scene,
                   motion m, uint32_t seed, frames *out)
{
    tyn_settings *values;
    tyn_offline *off;
    char text[256];
    assert_int_equal(tyn_settings_create(&values), TYN_OK);
    snprintf(text, sizeof text, "%s", settings ? settings : "");
    for (char *word = strtok(text, " "); word; word = strtok(NULL, " ")) {
        char *equals = strchr(word, '=');
        *equals = 0;
        assert_int_equal(tyn_settings_set(values, word, equals + 1, NULL), TYN_OK);
    }
    assert_int_equal(
        tyn_offline_create(t->dev, tyn_offline_params(.method = method, .settings = values), &off),
        TYN_OK);
    for (int frame = 0; frame < FRAMES; frame++) {
        tyn_view view = {.seed = seed};
        set_frame(scene, &view, m, frame);
        view.num_samples = strcmp(method, "path") ? 0 : SAMPLES;
        offline_frame(off, scene, &view);
        const float *rgba = tyn_offline_output(off, TYN_OUTPUT_RADIANCE);
        memset(out->at[frame], 0, sizeof out->at[frame]);
        for (int i = 0; i < SIZE * SIZE; i++) {
            int block = i / SIZE / BLOCK * SIDE + i % SIZE / BLOCK;
            for (int c = 0; c < 3; c++) {
                out->at[frame][3 * block + c] += (double)rgba[4 * i + c] / (BLOCK * BLOCK);
            }
        }
    }
    tyn_offline_destroy(&off);
    tyn_settings_destroy(&values);
}

// An orthonormal basis of the cubics in time.
static void cubics(double basis[4][FRAMES])
{
    for (int degree = 0; degree < 4; degree++) {
        double norm = 0;
        for (int k = 0; k < FRAMES; k++) {
            basis[degree][k] = pow(2.0 * k / (FRAMES - 1) - 1, degree);
        }
        for (int lower = 0; lower < degree; lower++) { // Gram and Schmidt
            double along = 0;
            for (int k = 0; k < FRAMES; k++) {
                along += basis[degree][k] * basis[lower][k];
            }
            for (int k = 0; k < FRAMES; k++) {
                basis[degree][k] -= along * basis[lower][k];
            }
        }
        for (int k = 0; k < FRAMES; k++) {
            norm += basis[degree][k] * basis[degree][k];
        }
        for (int k = 0; k < FRAMES; k++) {
            basis[degree][k] /= sqrt(norm);
        }
    }
}

typedef struct cubic_fit {
    double part[VALUES][4];
} cubic_fit;

static void fit(const frames *f, cubic_fit *out)
{
    double basis[4][FRAMES];
    cubics(basis);
    memset(out, 0, sizeof *out);
    for (int i = 0; i < VALUES * 4; i++) {
        for (int k = 0; k < FRAMES; k++) {
            out->part[i / 4][i % 4] += basis[i % 4][k] * f->at[k][i / 4];
        }
    }
}

static void unfold(const cubic_fit *c, frames *out)
{
    double basis[4][FRAMES];
    cubics(basis);
    memset(out, 0, sizeof *out);
    for (int i = 0; i < VALUES * 4; i++) {
        for (int k = 0; k < FRAMES; k++) {
            out->at[k][i / 4] += c->part[i / 4][i % 4] * basis[i % 4][k];
        }
    }
}

static double change(const frames *a, const frames *b, int k, int i)
{
    return a->at[k + 1][i] - a->at[k][i] - (b ? b->at[k + 1][i] - b->at[k][i] : 0);
}

// Mean over blocks and pairs of frames of the product of the changes of a - b and of c - d. NULL: 0.
static double product(const frames *a, const frames *b, const frames *c, const frames *d)
{
    double sum = 0;
    for (int k = 0; k + 1 < FRAMES; k++) {
        for (int i = 0; i < VALUES; i++) {
            sum += change(a, b, k, i) * change(c, d, k, i);
        }
    }
    return sum / ((FRAMES - 1) * VALUES);
}

// ---- the table of path ------------------------------------------------------------------------

static void make_table(gpu_test *t, tyn_scene *scene, motion m, const char *path)
{
    static frames f;
    static cubic_fit runs[2];
    for (uint32_t run = 0; run < 2; run++) {
        render(t, "path", NULL, scene, m, run + 1, &f);
        fit(&f, &runs[run]);
    }
    FILE *file = fopen(path, m == MAP_TURNS ? "w" : "a");
    assert_non_null(file);
    if (m == MAP_TURNS) {
        fprintf(file,
                "# motion,block and channel,cubic of run A,cubic of run B: %d samples a pixel\n",
                SAMPLES);
    }
    for (int i = 0; i < VALUES; i++) {
        fprintf(file, "%d,%d", (int)m, i);
        for (int k = 0; k < 8; k++) {
            fprintf(file, ",%.5g", runs[k / 4].part[i][k % 4]);
        }
        fprintf(file, "\n");
    }
    fclose(file);
}

static void read_table(motion m, frames *a, frames *b)
{
    static cubic_fit runs[2];
    char line[512];
    int found = 0;
    FILE *file = fopen(TYN_TEST_DATA "/flicker.csv", "r");
    assert_non_null(file);
    while (fgets(line, sizeof line, file)) {
        char *at = line;
        long of = strtol(at, &at, 10), i = line[0] == '#' ? -1 : strtol(at + 1, &at, 10);
        if (i < 0 || of != (long)m || i >= VALUES) {
            continue;
        }
        for (int k = 0; k < 8; k++) {
            runs[k / 4].part[i][k % 4] = strtod(at + 1, &at);
        }
        found++;
    }
    fclose(file);
    assert_int_equal(found, VALUES);
    unfold(&runs[0], a);
    unfold(&runs[1], b);
}

// ---- the test ---------------------------------------------------------------------------------

static bool uses_ordinates(const char *method)
{
    tyn_method_info info;
    for (uint32_t i = 0; i < tyn_num_methods(); i++) {
        tyn_method_at(i, &info);
        for (int k = 0; !strcmp(info.name, method) && info.passes[k]; k++) {
            if (!strcmp(info.passes[k]->name, "ordinates")) {
                return true;
            }
        }
    }
    return false;
}

static void motion_of(gpu_test *t, motion m)
{
    static frames a, b, p, smooth;
    static cubic_fit of_pop;
    static const char *const settings[] = {"", "ordinates.count=16"};
    assert_true(uses_ordinates("pop"));
    tyn_scene *scene = malloc(sizeof *scene);
    tyn_scene_init(scene);
    make_scene(scene);
    if (getenv("TYN_FLICKER_MAKE")) {
        make_table(t, scene, m, getenv("TYN_FLICKER_MAKE"));
    }
    read_table(m, &a, &b);
    double mean = 0;
    for (int i = 0; i < VALUES; i++) {
        mean += 0.5 * (a.at[0][i] + b.at[0][i]) / VALUES;
    }
    double path = sqrt(maximum(product(&a, NULL, &b, NULL), 0)) / mean;
    double noise = sqrt(product(&a, &b, &a, &b) / 2) / mean;
    print_message("%s: path %.2f %% (noise of one run %.2f)\n", motions[m], 100 * path,
                  100 * noise);
    for (int i = 0; i < 2; i++) {
        render(t, "pop", settings[i], scene, m, 0, &p);
        fit(&p, &of_pop);
        unfold(&of_pop, &smooth);
        double change = sqrt(product(&p, NULL, &p, NULL)) / mean, off = 0;
        double difference = sqrt(maximum(product(&p, &a, &p, &b), 0)) / mean;
        double flicker = sqrt(product(&p, &smooth, &p, &smooth)) / mean;
        for (int j = 0; j < VALUES; j++) {
            off += fabs(p.at[0][j] - 0.5 * (a.at[0][j] + b.at[0][j])) / (VALUES * mean);
        }
        print_message(
            "  %-42s pop %.2f %%, difference %.2f, not cubic %.2f; rel_l1 of a picture %.1f\n",
            settings[i], 100 * change, 100 * difference, 100 * flicker, 100 * off);
        assert_within(flicker, 4e-4, NULL);
        assert_true(within(difference, 0.005, NULL, "%s, difference", motions[m]));
    }
    tyn_scene_finish(scene);
    free(scene);
}

static void map_turns(void **state)
{
    motion_of(*state, MAP_TURNS);
}

static void camera_turns(void **state)
{
    motion_of(*state, CAMERA_TURNS);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(map_turns), cmocka_unit_test(camera_turns)};
    setvbuf(stdout, NULL, _IOLBF, 0);
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
