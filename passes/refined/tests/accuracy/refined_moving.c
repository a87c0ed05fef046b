// refined_moving.c -- method `refined` while the camera moves: what earlier frames found is carried over, so that pictures of one
// sample a pixel hardly flicker and are nearer to the truth; what changes is not held up by it.
#include "bound.h"
#include "gpu_test.h"
#include "numbers.h"
#include "offline_frame.h"
#include "path_run.h"
#include "picture.h"
#include "sample_scene.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 128, SMALL = 64, BLOCK = 8, VALUES = 3 * SIDE * SIDE };

static const char *const carried = "refine.grid=2", *const anew =
                                                        "refine.grid=2 refine.carry=false";

// About +Y and the middle of the scene.
static void turn_camera(const tyn_scene *scene, tyn_camera *camera, double degrees)
{
    const double angle = degrees * 3.14159265358979 / 180, c = cos(angle), s = sin(angle);
    float lo[3], hi[3];
    tyn_scene_bounds(scene, lo, hi);
    float *vectors[] = {camera->position, camera->right, camera->up, camera->back};
    for (int k = 0; k < 4; k++) {
        const double mx = k == 0 ? 0.5 * ((double)lo[0] + (double)hi[0]) : 0;
        const double mz = k == 0 ? 0.5 * ((double)lo[2] + (double)hi[2]) : 0;
        const double x = (double)vectors[k][0] - mx, z = (double)vectors[k][2] - mz;
        vectors[k][0] = (float)(mx + c * x + s * z);
        vectors[k][2] = (float)(mz - s * x + c * z);
    }
}

typedef struct film {
    tyn_scene scene;
    tyn_view view;
    tyn_offline *off;
    float last[3][VALUES];
    int frames;
    double second, mean;
} film;

static film *film_open(gpu_test *t, const char *name, const char *settings, uint32_t side)
{
    film *f = calloc(1, sizeof *f);
    sample_scene_load(&f->scene, name, t);
    f->view = (tyn_view){.width = side,
                         .height = side,
                         .camera = f->scene.cameras[0],
                         .num_samples = 4, // of four pixels
                         .no_background = true,
                         .outputs = TYN_OUTPUT_RADIANCE};
    f->off = scene_open(t->dev, "refined", settings);
    return f;
}

static void film_close(film *f)
{
    tyn_offline_destroy(&f->off);
    tyn_scene_finish(&f->scene);
    free(f);
}

// The next picture; second differences in time are what is not smooth motion.
static const float *film_frame(film *f, double degrees)
{
    turn_camera(&f->scene, &f->view.camera, degrees);
    f->view.seed++;
    offline_frame(f->off, &f->scene, &f->view);
    const float *light = tyn_offline_output(f->off, TYN_OUTPUT_RADIANCE);
    float *now = f->last[f->frames % 3];
    const int values = 3 * (int)(f->view.width * f->view.height);
    for (int i = 0; i < values; i++) {
        now[i] = light[4 * (i / 3) + i % 3];
    }
    f->frames++;
    for (int i = 0; i < values && f->frames >= 3; i++) {
        const double x = (double)f->last[(f->frames + 1) % 3][i];
        f->second += fabs((double)f->last[f->frames % 3][i] - 2 * x + (double)now[i]);
        f->mean += fabs(x);
    }
    return now;
}

static double error_of(const float *rgb, const picture *truth)
{
    const picture p = {truth->width, truth->height, (float *)rgb, NULL};
    return picture_compare(&p, truth, BLOCK).reported;
}

enum { FRAMES = 16 };

// Flicker of the last pictures of a film.
static double flicker_of(gpu_test *t, const char *name, const char *settings)
{
    film *f = film_open(t, name, settings, SIDE);
    for (int i = 0; i < 2 * FRAMES; i++) {
        if (i == 3 * FRAMES / 2) {
            f->frames = 0;
            f->second = f->mean = 0;
        }
        film_frame(f, 0.1);
    }
    const double flicker = f->second / f->mean;
    film_close(f);
    return flicker;
}

static void a_camera_path(void **state)
{
    static const struct {
        const char *name;
        double most; // flicker
    } cases[] = {{"smoke", 0.01}, {"room", 0.01}, {"plume-contrast", 0.01}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        print_message("%s: flicker %.2f %% without what is carried over\n", cases[k].name,
                      100 * flicker_of(*state, cases[k].name, anew));
        assert_true(within(flicker_of(*state, cases[k].name, carried), cases[k].most, NULL,
                           "%s, flicker", cases[k].name));
    }
}

static void swing_light(tyn_scene *scene)
{
    float *d = scene->lights[0].direction, x = d[0];
    d[0] = d[2];
    d[2] = -x;
}

typedef struct film_error {
    double moving, still,
        changed; // at the end of the camera path; some frames after; after the light has changed
} film_error;

static film_error errors_of(gpu_test *t, const char *name, const char *settings)
{
    enum { RUNS = 4, STILL = 12 };
    film_error mean = {0};
    for (uint32_t run = 0; run < RUNS; run++) {
        film *f = film_open(t, name, settings, SMALL);
        const tyn_camera end = f->view.camera;
        picture truth = {0};
        path_reference(&truth, t->dev, &f->scene, &f->view, 1024);
        f->view.seed = 100 * run;
        turn_camera(&f->scene, &f->view.camera, -0.1 * FRAMES);
        for (int i = 0; i < FRAMES - 1; i++) {
            film_frame(f, 0.1);
        }
        f->view.camera = end;
        mean.moving += error_of(film_frame(f, 0), &truth) / RUNS;
        for (int i = 1; i < STILL; i++) {
            film_frame(f, 0);
        }
        mean.still += error_of(film_frame(f, 0), &truth) / RUNS;
        swing_light(&f->scene);
        for (int i = 0; i < FRAMES; i++) {
            film_frame(f, 0);
        }
        for (int i = 0; i < 3; i++) { // and back
            swing_light(&f->scene);
        }
        mean.changed += error_of(film_frame(f, 0), &truth) / RUNS;
        picture_free(&truth);
        film_close(f);
    }
    print_message("%s: error %.2f %% at the end of a camera path, %.2f after %d still frames, %.2f "
                  "after the light has changed (%s)\n",
                  name, 100 * mean.moving, 100 * mean.still, STILL, 100 * mean.changed, settings);
    return mean;
}

static void errors(void **state)
{
    static const struct {
        const char *name;
        double moving, still; // of the errors without what is carried over, at most
    } cases[] = {{"smoke", 0.95, 0.95}, {"room", 0.6, 0.5}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const film_error before = errors_of(*state, cases[k].name, anew);
        const film_error after = errors_of(*state, cases[k].name, carried);
        assert_true(within(after.moving / before.moving, cases[k].moving, NULL,
                           "%s, error at the end of a camera path, of that anew", cases[k].name));
        assert_true(within(after.still / before.still, cases[k].still, NULL,
                           "%s, error after still frames, of that anew", cases[k].name));
        assert_true(within(after.changed / before.changed, 1.1, NULL,
                           "%s, error after the light has changed, of that anew", cases[k].name));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_camera_path), cmocka_unit_test(errors)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
