// pop_lamps.c -- lamps in media: `single` against closed forms, `pop` against a Monte Carlo of a sphere with a
// source in its middle and against the exact fluence in an infinite medium.
#include "gpu_test.h"
#include "npy.h"
#include "picture.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Rows of a table of the shared references: numbers by column; 0 rows if it is absent.
enum { MAX_ROWS = 512, MAX_COLUMNS = 6 };
static uint32_t read_table(const char *name, double rows[][MAX_COLUMNS], uint32_t columns)
{
    char path[512], line[256];
    FILE *file = shared_path(path, sizeof path, name) ? fopen(path, "r") : NULL;
    uint32_t count = 0;
    while (file && count < MAX_ROWS && fgets(line, sizeof line, file)) {
        char *at = line, *end = line;
        uint32_t c = 0;
        for (; c < columns; c++, at = end + 1) {
            rows[count][c] = strtod(at, &end);
            if (end == at) {
                break;
            }
        }
        count += c == columns;
    }
    if (file) {
        fclose(file);
    }
    return count;
}

static void add_lamp(tyn_scene *scene, const float at[3], float intensity)
{
    scene->lights[scene->num_lights++] = (tyn_light){
        .kind = TYN_LIGHT_POINT,
        .color = {intensity, intensity, intensity},
        .position = {at[0], at[1], at[2]},
        .direction = {0, 0, -1},
    };
}

// ---- airlight -------------------------------------------------------------------------------------

// One ray from the origin along -z; the lamp at an angle to it.
static double airlight(gpu_test *t, const char *method, const double *row)
{
    float st = (float)row[0], ss = (float)row[1], g = (float)row[2], d = (float)row[3];
    double gamma = row[4] * M_PI / 180;
    tyn_medium medium = grey_medium(ss, st - ss, g);
    tyn_scene *scene = malloc(sizeof *scene);
    tyn_scene_init(scene);
    float half = d + 12 / st;
    scene_add_box(scene, &medium, (float[]){-half, -half, -half}, (float[]){half, half, half}, NULL,
                  NULL);
    add_lamp(scene, (float[]){d * (float)sin(gamma), 0, -d * (float)cos(gamma)}, 1);
    tyn_view view = {.width = 1, .height = 1};
    view.camera = (tyn_camera){.projection = TYN_PERSPECTIVE,
                               .right = {1, 0, 0},
                               .up = {0, 1, 0},
                               .back = {0, 0, 1},
                               .yfov = 1e-4f};
    picture p;
    picture_render(&p, t->dev, method, scene, &view, NULL, 0);
    double radiance = p.rgb[1];
    picture_free(&p);
    tyn_scene_finish(scene);
    free(scene);
    return radiance;
}

static void airlight_rows(void **state)
{
    static double rows[MAX_ROWS][MAX_COLUMNS];
    uint32_t count = read_table("reference/airlight_single.csv", rows, 6);
    if (count == 0) {
        print_message("skipped: no airlight_single.csv\n");
        skip();
    }
    double worst = 0, sum = 0;
    for (uint32_t i = 0; i < count; i++) {
        double got = airlight(*state, "single", rows[i]), error = got / rows[i][5] - 1;
        if (fabs(error) > 0.005) {
            print_message("st %g g %g D %g gamma %g: %g, exact %g (%+.2f %%)\n", rows[i][0],
                          rows[i][2], rows[i][3], rows[i][4], got, rows[i][5], 100 * error);
        }
        worst = fmax(worst, fabs(error));
        sum += fabs(error);
    }
    print_message("airlight: %u rows, worst %.2f %%, mean %.2f %%\n", count, 100 * worst,
                  100 * sum / count);
    assert_true(worst <= 0.01);
}

// ---- a sphere with a source in its middle -----------------------------------------------------------

enum { RINGS = 40, SPHERE_PIXELS = 160 };

static double sphere_error(gpu_test *t, double sigma, double g, const double *reference,
                           const char *settings)
{
    tyn_medium medium = grey_medium((float)sigma, 0, (float)g);
    tyn_scene *scene = malloc(sizeof *scene);
    tyn_scene_init(scene);
    tyn_shape *shape = scene_add_box(scene, &medium, (float[]){-2.5f, -2.5f, -2.5f},
                                     (float[]){2.5f, 2.5f, 2.5f}, NULL, NULL);
    shape->kind = TYN_SHAPE_SPHERE;
    add_lamp(scene, (float[]){0, 0, 0}, 1);
    tyn_view view = {0};
    view_orthographic(&view, (float[]){0, 0, 0}, 0, -1, 0, (float[]){0, 0, 1}, 2.5f, SPHERE_PIXELS);
    picture p;
    picture_render(&p, t->dev, "pop", scene, &view, settings, 0);
    double ring[RINGS] = {0}, pixels[RINGS] = {0}, off = 0, sum = 0, bias = 0;
    for (int i = 0; i < SPHERE_PIXELS * SPHERE_PIXELS; i++) {
        double x = (2 * (i % SPHERE_PIXELS) + 1.0) / SPHERE_PIXELS - 1;
        double y = (2 * (i / SPHERE_PIXELS) + 1.0) / SPHERE_PIXELS - 1;
        int k = (int)((x * x + y * y) * RINGS);
        if (k < RINGS) {
            ring[k] += p.rgb[3 * i];
            pixels[k]++;
        }
    }
    for (int k = 0; k < RINGS; k++) {
        double value = ring[k] / pixels[k];
        off += fabs(value - reference[k]);
        bias += value - reference[k];
        sum += reference[k];
        if (getenv("TYN_VERBOSE")) {
            print_message("   %2d: %.5f, reference %.5f (%+.1f %%)\n", k, value, reference[k],
                          100 * (value / reference[k] - 1));
        }
    }
    print_message("sphere sigma %.1f g %.1f: rel_l1 %.2f %%, bias %+.2f %%\n", sigma, g,
                  100 * off / sum, 100 * bias / sum);
    picture_free(&p);
    tyn_scene_finish(scene);
    free(scene);
    return off / sum;
}

static void sphere_rings(void **state)
{
    static double rows[MAX_ROWS][MAX_COLUMNS];
    uint32_t count = read_table("reference/sphere_profile.csv", rows, 6);
    if (count == 0) {
        print_message("skipped: no sphere_profile.csv\n");
        skip();
    }
    for (uint32_t i = 0; i + RINGS <= count; i += RINGS) {
        if (rows[i][2] > 0) {
            continue; // an emitter of finite size
        }
        double reference[RINGS], g = rows[i][1];
        for (int k = 0; k < RINGS; k++) {
            reference[k] = rows[i + (uint32_t)k][4];
        }
        assert_true(sphere_error(*state, rows[i][0], g, reference, NULL) <=
                    (g < 0.5 ? 0.08 : 0.12));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(airlight_rows),
        cmocka_unit_test(sphere_rings),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
