// warm.c -- a solve that starts from the last frame's solution: nothing changes where there is none; it is
// nearer to the solution where something moved a little; what is gone leaves no light behind.
#include "bound.h"
#include "gpu_test.h"
#include "offline_frame.h"
#include "picture.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIZE = 24, PIXELS = SIZE * SIZE, GRID = 20 };

typedef struct stage {
    tyn_scene scene;
    tyn_view view;
    tyn_device *dev;
} stage;

// A soft ball of smoke whose middle is at `x`, in the box [0, 1]^3.
static void fill_ball(float *density, float x)
{
    for (int i = 0; i < GRID * GRID * GRID; i++) {
        const float p[3] = {(float)(i % GRID), (float)(i / GRID % GRID), (float)(i / GRID / GRID)};
        float r2 = 0;
        for (int a = 0; a < 3; a++) {
            const float d = (p[a] + 0.5f) / GRID - (a == 0 ? x : 0.5f);
            r2 += d * d;
        }
        const float t = fmaxf(0, 1 - r2 / 0.16f);
        density[i] = t * t;
    }
}

static stage *set_stage(gpu_test *t)
{
    static float density[GRID * GRID * GRID];
    stage *s = calloc(1, sizeof *s);
    s->dev = t->dev;
    tyn_scene_init(&s->scene);
    tyn_medium medium = grey_medium(60, 0.1f, 0.6f);
    fill_ball(density, 0.5f);
    scene_add_box(&s->scene, &medium, (float[]){0, 0, 0}, (float[]){1, 1, 1},
                  (uint32_t[]){GRID, GRID, GRID}, density);
    scene_add_sun(&s->scene, 1, -2, 0.5f, 2, 2, 2);
    scene_set_sky(&s->scene, 0.05f);
    view_orthographic(&s->view, (float[]){0.5f, 0.5f, 0.5f}, -1, -1, -2, (float[]){0, 1, 0}, 0.9f,
                      SIZE);
    s->view.no_background = true;
    return s;
}

static void strike(stage *s)
{
    tyn_scene_finish(&s->scene);
    free(s);
}

static void move_ball(stage *s, float x)
{
    tyn_volume *v = &s->scene.volumes[0];
    fill_ball(v->data, x);
    v->hash = (uint64_t)(x * 1e6f) + 1;
    v->max_density = 1;
}

static void aim_sun(stage *s, float x, float y, float z)
{
    const float length = sqrtf(x * x + y * y + z * z);
    float *d = s->scene.lights[0].direction;
    d[0] = x / length;
    d[1] = y / length;
    d[2] = z / length;
}

static tyn_offline *renderer(const stage *s, bool warm, int sweeps)
{
    char number[16];
    snprintf(number, sizeof number, "%d", sweeps);
    tyn_settings *settings = NULL;
    tyn_offline *off = NULL;
    assert_int_equal(tyn_settings_create(&settings), TYN_OK);
    assert_int_equal(tyn_settings_set(settings, "lattice.cells", "16", NULL), TYN_OK);
    assert_int_equal(tyn_settings_set(settings, "lattice.sweeps", number, NULL), TYN_OK);
    assert_int_equal(tyn_settings_set(settings, "lattice.warm", warm ? "1" : "0", NULL), TYN_OK);
    assert_int_equal(
        tyn_offline_create(s->dev, tyn_offline_params(.method = "pop", .settings = settings), &off),
        TYN_OK);
    tyn_settings_destroy(&settings);
    return off;
}

static const float *show(const stage *s, tyn_offline *off)
{
    offline_frame(off, &s->scene, &s->view);
    assert_int_equal(tyn_device_validation_messages(s->dev), 0);
    return tyn_offline_output(off, TYN_OUTPUT_RADIANCE);
}

typedef void (*change_fn)(stage *s, int frame);

enum { FRAMES = 4, CONVERGED = 24 };

// sum |a - b| / sum |b| of the last of FRAMES frames against the solution.
static double error_of(gpu_test *t, change_fn change, bool warm, int sweeps)
{
    stage *s = set_stage(t);
    tyn_offline *off = renderer(s, warm, sweeps), *exact = renderer(s, false, CONVERGED);
    const float *seen = NULL;
    for (int frame = 0; frame < FRAMES; frame++) {
        change(s, frame);
        seen = show(s, off);
    }
    const float *right = show(s, exact);
    double difference = 0, sum = 0;
    for (int i = 0; i < 4 * PIXELS; i++) {
        difference += i % 4 < 3 ? fabs((double)seen[i] - (double)right[i]) : 0;
        sum += i % 4 < 3 ? fabs((double)right[i]) : 0;
    }
    tyn_offline_destroy(&off);
    tyn_offline_destroy(&exact);
    strike(s);
    return difference / sum;
}

static void drift(stage *s, int frame)
{
    move_ball(s, 0.45f + 0.02f * (float)frame);
}
static void turn_sun(stage *s, int frame)
{
    const float a = 0.4f + 0.0349f * (float)frame; // 2 degrees a frame
    aim_sun(s, cosf(a), -1, sinf(a));
}
static void jump_sun(stage *s, int frame)
{
    aim_sun(s, frame + 1 < FRAMES ? 1 : -1, frame + 1 < FRAMES ? -1 : 1, 0.2f);
}
static void set_sun(stage *s, float power)
{
    for (int c = 0; c < 3; c++) {
        s->scene.lights[0].color[c] = power;
    }
}
static void switch_off(stage *s, int frame)
{
    set_sun(s, frame + 1 < FRAMES ? 50 : 0);
}
static void switch_off_weak(stage *s, int frame)
{
    set_sun(s, frame + 1 < FRAMES ? 2 : 0);
}
static void switch_on(stage *s, int frame)
{
    set_sun(s, frame + 1 < FRAMES ? 0 : 50);
}
static void dim(stage *s, int frame)
{
    const float power = frame + 1 < FRAMES ? 2.0f : 0.2f;
    for (int c = 0; c < 3; c++) {
        s->scene.lights[0].color[c] = power;
        s->scene.environment.radiance[c] = 0.025f * power;
    }
}
// The box grows around the same ball: lattice and medium frame are others every frame.
static void grow_box(stage *s, int frame)
{
    const float side = 1 + 0.06f * (float)frame;
    float *m = s->scene.shapes[0].to_world;
    m[0] = m[5] = m[10] = side;
    m[13] = 0.5f + 0.05f * (float)frame;
}
// Nothing changes in the world, but the frame of the medium turns about the middle of the ball.
static void turn_frame(stage *s, int frame)
{
    float *m = s->scene.shapes[0].to_world;
    const float a = 1.5707963f * (float)frame;
    memset(m, 0, 16 * sizeof *m);
    m[0] = m[10] = cosf(a);
    m[2] = -sinf(a);
    m[8] = sinf(a);
    m[5] = m[15] = 1;
    m[12] = m[13] = m[14] = 0.5f;
}

static void starts_nearer(void **state)
{
    static const struct {
        const char *name;
        change_fn change;
        double two, four; // the most of the cold error that may be left after so many sweeps
    } cases[] = {
        {"smoke that drifts 2 % of the box a frame", drift, 0.2, 0.4},
        {"a sun that turns 2 degrees a frame", turn_sun, 0.03, 0.06},
        {"a box that grows 6 % a frame", grow_box, 0.8, 0.8},
        {"a frame of the medium that turns 90 degrees", turn_frame, 0.02, 0},
        {"all lights dimmed to a tenth at once", dim, 0.3, 0.07},
        {"a sun that jumps to the other side", jump_sun, 3, 3},
        {"a sun 1000 times the sky that is switched on", switch_on, 1, 1},
        {"a sun 1000 times the sky that is switched off", switch_off, 1, 1},
        {"a sun 40 times the sky that is switched off", switch_off_weak, 200, 60},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        double cold[3], warm[3];
        for (int k = 0; k < 3; k++) {
            cold[k] = error_of(*state, cases[i].change, false, 2 + k);
            warm[k] = error_of(*state, cases[i].change, true, 2 + k);
        }
        print_message("%-46s sweeps 2, 3, 4: cold %.4f %.4f %.4f %%, warm %.4f %.4f %.4f %%\n",
                      cases[i].name, 100 * cold[0], 100 * cold[1], 100 * cold[2], 100 * warm[0],
                      100 * warm[1], 100 * warm[2]);
        assert_true(
            within(warm[0], cases[i].two * cold[0] + 1e-5, NULL, "%s, 2 sweeps", cases[i].name));
        const double four = cases[i].four * cold[2] + 1e-5;
        assert_true(four > 1e-4 ? within(warm[2], four, NULL, "%s, 4 sweeps", cases[i].name)
                                : warm[2] <= four);
        assert_within(warm[2], 0.005, NULL); // no light of before is left
    }
}

// The first frame is the one without memory, to the bit; an unchanged one does nothing.
static void first_and_unchanged(void **state)
{
    stage *s = set_stage(*state);
    tyn_offline *cold = renderer(s, false, 4), *warm = renderer(s, true, 4);
    const float *a = show(s, cold), *b = show(s, warm);
    assert_memory_equal(a, b, 4 * PIXELS * sizeof *a);
    float before[4 * PIXELS];
    memcpy(before, b, sizeof before);
    b = show(s, warm);
    assert_memory_equal(before, b, sizeof before);
    tyn_report report;
    tyn_offline_report(warm, &report);
    uint32_t found = 0;
    for (uint32_t i = 0; i < report.num_nodes; i++) {
        if (strncmp(report.nodes[i].name, "lattice", 7) == 0) {
            assert_string_equal(report.nodes[i].state, "unchanged");
            found++;
        }
    }
    assert_true(found >= 5);
    tyn_offline_destroy(&cold);
    tyn_offline_destroy(&warm);
    strike(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(first_and_unchanged),
        cmocka_unit_test(starts_nearer),
    };
    return cmocka_run_group_tests_name("warm", tests, gpu_setup, gpu_teardown);
}
