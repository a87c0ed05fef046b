// pop_lamps.c -- lamps in media: `single` against closed forms, `pop` against a Monte Carlo of a sphere with a
// source in its middle and against the exact fluence in an infinite medium.
#include "bound.h"
#include "gpu_test.h"
#include "npy.h"
#include "numbers.h"
#include "offline_frame.h"
#include "picture.h"
#include "skip.h"
#include "todo.h"
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
        skip_without("reference/airlight_single.csv");
    }
    double worst = 0, sum = 0;
    for (uint32_t i = 0; i < count; i++) {
        double got = airlight(*state, "single", rows[i]), error = got / rows[i][5] - 1;
        if (fabs(error) > 0.005) {
            print_message("st %g g %g D %g gamma %g: %g, exact %g (%+.2f %%)\n", rows[i][0],
                          rows[i][2], rows[i][3], rows[i][4], got, rows[i][5], 100 * error);
        }
        worst = maximum(worst, fabs(error));
        sum += fabs(error);
    }
    print_message("airlight: %u rows, worst %.2f %%, mean %.2f %%\n", count, 100 * worst,
                  100 * sum / count);
    assert_within(worst, 0.01, NULL);
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
        skip_without("reference/sphere_profile.csv");
    }
    for (uint32_t i = 0; i + RINGS <= count; i += RINGS) {
        if (rows[i][2] > 0) {
            continue; // an emitter of finite size
        }
        double reference[RINGS], g = rows[i][1];
        for (int k = 0; k < RINGS; k++) {
            reference[k] = rows[i + (uint32_t)k][4];
        }
        const double off = sphere_error(*state, rows[i][0], g, reference, NULL);
        assert_true(
            within(off, g < 0.5 ? 0.05 : 0.1, NULL, "sphere, sigma %g, g %g", rows[i][0], g));
    }
}

// ---- an infinite medium -----------------------------------------------------------------------------

// Fluence at distances from a source of 1 W in a cube from -half to half.
static void fluence_of(gpu_test *t, float albedo, float half, int cells, const float (*points)[3],
                       uint32_t count, double *fluence)
{
    tyn_medium medium = grey_medium(albedo, 1 - albedo, 0);
    tyn_scene *scene = malloc(sizeof *scene);
    tyn_scene_init(scene);
    scene_add_box(scene, &medium, (float[]){-half, -half, -half}, (float[]){half, half, half}, NULL,
                  NULL);
    add_lamp(scene, (float[]){0, 0, 0}, 0.25f / (float)M_PI);
    tyn_settings *settings;
    char number[16];
    snprintf(number, sizeof number, "%d", cells);
    assert_int_equal(tyn_settings_create(&settings), TYN_OK);
    assert_int_equal(tyn_settings_set(settings, "lattice.cells", number, NULL), TYN_OK);
    assert_int_equal(tyn_settings_set(settings, "lattice.sweeps", "12", NULL), TYN_OK);
    tyn_offline *off;
    assert_int_equal(
        tyn_offline_create(t->dev, tyn_offline_params(.method = "pop", .settings = settings), &off),
        TYN_OK);
    tyn_settings_destroy(&settings);
    tyn_view view = {.width = 1,
                     .height = 1,
                     .outputs = TYN_OUTPUT_PROBE,
                     .points = points,
                     .num_points = count};
    tyn_camera_frame_scene(&view.camera, scene);
    offline_frame(off, scene, &view);
    const tyn_probe_result *results = tyn_offline_output(off, TYN_OUTPUT_PROBE);
    for (uint32_t i = 0; i < count; i++) {
        fluence[i] = results[i].fluence[0];
    }
    tyn_offline_destroy(&off);
    tyn_scene_finish(scene);
    free(scene);
}

// How far light of an albedo gets, as e^-(distance / this), in an isotropically scattering medium.
static double decay_length(double albedo)
{
    double nu = 1; // 1 = albedo nu atanh(1 / nu), nu > 1: decay as e^-(r / nu)
    double lo = 1 + 1e-12, hi = 1e4;
    for (int i = 0; i < 200; i++) {
        nu = 0.5 * (lo + hi);
        *(albedo * nu * atanh(1 / nu) > 1 ? &lo : &hi) = nu;
    }
    return nu;
}

// Within 5 % as the mean over directions. In every direction only close to the lamp, where light has hardly
// scattered: what has left the lamp's cell travels along the lattice's 14 lines, and the more a medium absorbs the
// straighter is the light that gets far. So beyond 0.7 free paths that is known to fail.
static void infinite_medium(void **state)
{
    static double rows[MAX_ROWS][MAX_COLUMNS];
    uint32_t count = read_table("reference/pointsource_infinite_exact.csv", rows, 5);
    if (count == 0) {
        skip_without("reference/pointsource_infinite_exact.csv");
    }
    enum { CELLS = 48, DIRECTIONS = 128 };
    static const char rays[] = "light travels along the lattice's 14 lines";
    double worst = 0;
    bool expected = true;
    uint32_t done = 0, single = 0;
    for (uint32_t i = 0; i < count; i++) {
        double albedo = rows[i][0], r = rows[i][1];
        if (albedo >= 1) {
            // No box is large enough: its vacuum takes 3 / (4 pi (half + 0.71)) from every fluence.
            print_message("albedo 1, r %g: left out, is of a box without end\n", r);
            continue;
        }
        double half = r + 8 * decay_length(albedo), cell = 2 * half / CELLS;
        if (r < cell) {
            print_message("albedo %g, r %g: left out, is within a cell of %d\n", albedo, r, CELLS);
            continue;
        }
        static float points[DIRECTIONS][3];
        for (int k = 0; k < DIRECTIONS; k++) { // evenly over the sphere
            double z = 1 - (2 * k + 1.0) / DIRECTIONS, phi = 2.399963 * k;
            points[k][0] = (float)(r * sqrt(1 - z * z) * cos(phi));
            points[k][1] = (float)(r * sqrt(1 - z * z) * sin(phi));
            points[k][2] = (float)(r * z);
        }
        double got[DIRECTIONS], mean = 0, least = INFINITY, most = 0, squares = 0;
        fluence_of(*state, (float)albedo, (float)half, CELLS, (const float(*)[3])points, DIRECTIONS,
                   got);
        for (int k = 0; k < DIRECTIONS; k++) {
            mean += got[k] / DIRECTIONS;
            squares += pow(got[k] / rows[i][2] - 1, 2) / DIRECTIONS;
            least = minimum(least, got[k]);
            most = maximum(most, got[k]);
        }
        double exact = rows[i][2], error = mean / exact - 1;
        const double low = least / exact - 1, high = most / exact - 1;
        const bool everywhere = maximum(-low, high) <= 0.05;
        print_message(
            "albedo %g, r %g (%.1f cells): mean of all directions %+.1f %%, least %+.1f %%, "
            "most %+.1f %%, RMS %.1f %%\n",
            albedo, r, r / cell, 100 * error, 100 * low, 100 * high, 100 * sqrt(squares));
        expected = todo_if(r > 0.7, everywhere, rays,
                           "albedo %g, r %g within 5 %% in every direction", albedo, r) &&
                   expected;
        assert_true(albedo < 0.9 || within(-low, 0.15, NULL, "albedo %g, least", albedo));
        assert_true(albedo < 0.9 || within(high, 0.35, NULL, "albedo %g, most", albedo));
        single += everywhere;
        worst = maximum(worst, fabs(error));
        done++;
    }
    print_message("%u rows, worst mean %.1f %%; %u of them within 5 %% in every direction\n", done,
                  100 * worst, single);
    assert_true(done >= 2);
    assert_within(worst, 0.05, NULL);
    assert_true(expected);
}

// ---- energy, and what may go wrong --------------------------------------------------------------------

static void balance(void **state)
{
    gpu_test *t = *state;
    static const float places[][3] = {
        {0.5f, 0.5f, 0.5f}, {0, 0, 0}, {0.51f, 0.3f, 0.9f}, {0.5f, 0.5f, -1}};
    for (int i = 0; i < 12; i++) {
        tyn_medium medium = grey_medium(4, i % 3 == 1 ? 1 : 0, i % 3 == 2 ? 0.9f : 0);
        tyn_scene *scene = malloc(sizeof *scene);
        tyn_scene_init(scene);
        scene_add_box(scene, &medium, (float[]){0, 0, 0}, (float[]){1, 1, 1}, NULL, NULL);
        add_lamp(scene, places[i / 3], 2);
        double four = scene_imbalance(t->dev, "pop", scene, "lattice.cells=16 lattice.sweeps=6");
        print_message("lamp %d, medium %d: imbalance %.3f %%\n", i / 3, i % 3, 100 * four);
        assert_true(four <= 6e-5);
        tyn_scene_finish(scene);
        free(scene);
    }
}

// Nothing may be infinite, negative or no number, whatever the medium and wherever the lamps are.
static void stress(void **state)
{
    gpu_test *t = *state;
    static const float sigmas[] = {0, 1e-6f, 1, 1e5f};
    static const float powers[] = {1e-6f, 1, 1e8f};
    float *grid = malloc(8 * 8 * 8 * sizeof *grid);
    for (int i = 0; i < 512; i++) {
        grid[i] = (float)((i * 7919) % 11) / 10;
    }
    for (int k = 0; k < 12; k++) {
        tyn_medium medium = grey_medium(sigmas[k % 4], 0.1f * sigmas[k % 4], k % 2 ? 0.9f : 0);
        tyn_scene *scene = malloc(sizeof *scene);
        tyn_scene_init(scene);
        scene_add_box(scene, &medium, (float[]){-1, -1, -1}, (float[]){1, 1, 1},
                      (uint32_t[]){8, 8, 8}, k % 3 ? grid : NULL);
        float power = powers[k / 4];
        add_lamp(scene, (float[]){0, 0, 0}, power);                // a face of voxels
        add_lamp(scene, (float[]){0, 0, 0}, power);                // and another one there
        add_lamp(scene, (float[]){0.125f, 0.125f, 0.125f}, power); // the centre of a voxel
        add_lamp(scene, (float[]){1, 1, 1}, power);                // a corner of the box
        add_lamp(scene, (float[]){0, 0, 3}, power);                // outside, on a camera ray
        add_lamp(scene, (float[]){0, -1, 0.3f}, power);            // in a face
        scene->lights[5].kind = TYN_LIGHT_SPOT;                    // of equal angles
        scene->lights[5].cos_inner = scene->lights[5].cos_outer = 0.7f;
        for (int inside = 0; inside < 2; inside++) {
            tyn_view view = {.width = 17, .height = 17};
            view.camera = (tyn_camera){.projection = TYN_PERSPECTIVE,
                                       .position = {0, 0, inside ? 0.5f : 6},
                                       .right = {1, 0, 0},
                                       .up = {0, 1, 0},
                                       .back = {0, 0, 1},
                                       .yfov = 0.6f};
            for (int m = 0; m < 2; m++) {
                picture p;
                picture_render(&p, t->dev, m ? "single" : "pop", scene, &view, "lattice.cells=12",
                               0);
                uint32_t wrong = 0;
                double sum = 0;
                for (int i = 0; i < 17 * 17 * 3; i++) {
                    wrong += !(p.rgb[i] >= 0 && p.rgb[i] < 1e30f);
                    sum += p.rgb[i];
                }
                print_message("sigma %g, power %g, %s, %s: %u wrong, mean %g\n",
                              (double)sigmas[k % 4], (double)power, inside ? "inside" : "outside",
                              m ? "single" : "pop", wrong, sum / (17 * 17 * 3));
                assert_int_equal(wrong, 0);
                assert_true(sigmas[k % 4] > 1 || (sigmas[k % 4] > 0) == (sum > 0));
                picture_free(&p);
            }
        }
        tyn_scene_finish(scene);
        free(scene);
    }
    free(grid);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(airlight_rows),   cmocka_unit_test(sphere_rings),
        cmocka_unit_test(infinite_medium), cmocka_unit_test(balance),
        cmocka_unit_test(stress),
    };
    cmocka_set_test_filter(getenv("TYN_TEST_FILTER"));
    return run_cases(tests, gpu_setup, gpu_teardown);
}
