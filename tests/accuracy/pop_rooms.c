// pop_rooms.c -- rooms that are hard for `pop`, in `pop` and `path`: behind a door, around a small medium, before bright fog, about a
// lamp that lies on the floor.
#include "bound.h"
#include "gpu_test.h"
#include "path_run.h"
#include "picture.h"
#include "solids.h"
#include "todo.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIZE = 48 };

typedef struct room_case {
    const char *name;
    float walls[14][6]; // boxes; those of no size are none
    float albedo;
    float fog[7]; // box, sigma_s
    float lamp[3], intensity;
    float glow[6]; // a box of fog that emits
    float eye[3], at[3], fov;
    double error, bias;
    const char *reason; // of a known failure
} room_case;

#define SHELL(x0, x1, y1, z)                                                                       \
    {x0 - 0.1f, -0.1f, -z, x1 + 0.1f, 0, z}, {x0 - 0.1f, y1, -z, x1 + 0.1f, y1 + 0.1f, z},         \
        {x0 - 0.1f, 0, -z, x0, y1, z}, {x0 - 0.1f, -0.1f, -z - 0.1f, x1 + 0.1f, y1 + 0.1f, -z},    \
    {                                                                                              \
        x0 - 0.1f, -0.1f, z, x1 + 0.1f, y1 + 0.1f, z + 0.1f                                        \
    }

static const room_case cases[] = {
    {"behind a door",
     {SHELL(-4, 4, 2.5f, 2),
      {4, 0, -2, 4.1f, 2.5f, 2},
      {-0.05f, 0, -2, 0.05f, 2.5f, -0.5f},
      {-0.05f, 0, 0.5f, 0.05f, 2.5f, 2},
      {-0.05f, 2, -0.5f, 0.05f, 2.5f, 0.5f}},
     0.7f,
     {-4, 0, -2, 4, 2.5f, 2, 0.1f},
     {-2, 2, -1.2f},
     10,
     {0},
     {3.8f, 1.6f, 1.8f},
     {1, 1, -1},
     1.2f,
     0.1,
     0.05,
     "light in the door's shadow comes along lines of the lattice, and its edges lie in cells"},
    {"small medium in a room",
     {SHELL(-3, 3, 3, 3), {3, 0, -3, 3.1f, 3, 3}},
     0.7f,
     {-1, 0.5f, -1, 1, 2.5f, 1, 1},
     {1.8f, 2.5f, 0},
     10,
     {0},
     {-2.5f, 1.5f, 2.5f},
     {3, 0.3f, -3},
     1,
     0.1,
     0.05,
     "what leaves the medium and lights walls far from it is reflected no further"},
    {"bright fog before a window",
     {SHELL(-2, 2, 2.5f, 2),
      {2, 0, -2, 2.1f, 0.8f, 2},
      {2, 2, -2, 2.1f, 2.5f, 2},
      {2, 0.8f, -2, 2.1f, 2, -0.6f},
      {2, 0.8f, 0.6f, 2.1f, 2, 2}},
     0.6f,
     {-2, 0, -2, 2, 2.5f, 2, 0.2f},
     {0},
     0,
     {2.3f, -0.5f, -3, 6, 3.5f, 3},
     {1.5f, 1.5f, 1.8f},
     {-2, 1, -1},
     1.2f,
     0.1,
     0.05,
     "light of a medium goes through a window along the fourteen lines of the lattice"},
    {"lamp on a floor",
     {SHELL(-3, 3, 3, 3), {3, 0, -3, 3.1f, 3, 3}},
     0.6f,
     {-3, 0, -3, 3, 3, 3, 0.1f},
     {0, 0.02f, 0},
     10,
     {0},
     {2.5f, 1.5f, 2.5f},
     {0, 0.5f, 0},
     1,
     0.1, // of single bright samples of path
     0.03,
     NULL},
};

static void make_room(tyn_scene *scene, const room_case *c)
{
    tyn_scene_init(scene);
    const uint32_t m =
        solids_material(scene, (float[]){c->albedo, c->albedo, c->albedo}, (float[]){0, 0, 0});
    for (size_t i = 0; i < sizeof c->walls / sizeof c->walls[0]; i++) {
        if (c->walls[i][0] < c->walls[i][3]) {
            solids_box(scene, c->walls[i], c->walls[i] + 3, 0, false, m);
        }
    }
    solids_hierarchy(scene, 4);
    const tyn_medium fog = grey_medium(c->fog[6], 0.1f * c->fog[6], 0.3f);
    scene_add_box(scene, &fog, c->fog, c->fog + 3, NULL, NULL);
    if (c->intensity > 0) {
        scene_add_lamp(scene, c->lamp, c->intensity);
    }
    if (c->glow[0] < c->glow[3]) {
        tyn_medium glow = grey_medium(1, 0.01f, 0.3f);
        for (int k = 0; k < 3; k++) {
            glow.emission[k] = 2;
        }
        scene_add_box(scene, &glow, c->glow, c->glow + 3, NULL, NULL);
    }
}

static void against_path(void **state)
{
    gpu_test *t = *state;
    path_run runs;
    path_run_open(&runs, t->dev);
    bool good = true;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const room_case *c = &cases[i];
        tyn_scene scene;
        tyn_view view = {0};
        make_room(&scene, c);
        view_perspective(&view, c->eye, c->at, c->fov, SIZE);
        picture p, reference = {0};
        picture_render(&p, t->dev, "pop", &scene, &view, NULL, 0);
        path_run_picture(&runs, &reference, &scene, &view, path_effort(512));
        const picture_error e = picture_compare(&p, &reference, 8);
        printf("%s: rel_l1 %.1f %% (noise %.1f), bias %+.1f %%\n", c->name, 100 * e.rel_l1,
               100 * e.noise, 100 * e.bias);
        const bool near = within(e.reported, c->error, NULL, "%s, error", c->name);
        const bool even = within(fabs(e.bias), c->bias, picture_bias_why(&e), "%s, bias", c->name);
        good = todo_if(c->reason, near && even, c->reason, "%s", c->name) && good;
        picture_free(&p);
        picture_free(&reference);
        tyn_scene_finish(&scene);
    }
    path_run_close(&runs);
    assert_true(good);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(against_path)};
    setvbuf(stdout, NULL, _IOLBF, 0);
    cmocka_set_test_filter(getenv("TYN_TEST_FILTER"));
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
