// pop_near.c -- lamps nearer to a floor than a pixel is wide: a picture holds as much of their light as its part of
// the floor gets, however large its pixels are.
#include "bound.h"
#include "gpu_test.h"
#include "numbers.h"
#include "picture.h"
#include "solids.h"
#include <math.h>
#include <stdlib.h>

#define COS_INNER 0.98
#define COS_OUTER 0.85

typedef struct shot {
    const char *name;
    double away[3]; // from the middle of the floor to the camera, m
    bool perspective;
    double half; // half of the picture: m, or tangent
    double edge; // of the floor in x; beyond it there is nothing
    bool spot;   // of COS_INNER and COS_OUTER, downwards
} shot;

static void look(tyn_view *view, const shot *s, uint32_t size)
{
    *view = (tyn_view){0};
    const double *a = s->away;
    view_orthographic(view, (float[]){0, 0, 0}, (float)-a[0], (float)-a[1], (float)-a[2],
                      (float[]){0, 0, -1}, (float)s->half, size);
    for (int i = 0; i < 3; i++) {
        view->camera.position[i] = (float)a[i];
    }
    if (s->perspective) {
        view->camera.projection = TYN_PERSPECTIVE;
        view->camera.yfov = (float)(2 * atan(s->half));
    } else {
        view->camera.ymag = (float)s->half;
    }
}

// Mean irradiance over the picture of a lamp of 1 W/sr. The directions in which it shines down, in equal parts: each
// brings its solid angle to one place, which takes as much of the picture as the camera makes of it.
static double expected(const tyn_camera *c, const shot *s, const double lamp[3])
{
    enum { RINGS = 500, TURNS = 700 };
    double sum = 0;
    for (int i = 0; i < RINGS; i++) {
        double down = (i + 0.5) / RINGS, r = lamp[1] * sqrt(1 - down * down) / down;
        for (int k = 0; k < TURNS; k++) {
            double turn = 2 * M_PI * (k + 0.5) / TURNS;
            double x = lamp[0] + r * cos(turn), z = lamp[2] + r * sin(turn);
            double d[3] = {x - c->position[0], 0 - c->position[1], z - c->position[2]},
                   at[3] = {0, 0, 0};
            for (int a = 0; a < 3; a++) {
                at[0] += d[a] * c->right[a];
                at[1] += d[a] * c->up[a];
                at[2] -= d[a] * c->back[a];
            }
            double depth = s->perspective ? at[2] : 1, half = s->half * depth;
            if (x > s->edge || fabs(at[0]) > half || fabs(at[1]) > half) {
                continue;
            }
            // Part of the picture by m^2 of the floor.
            double slope = s->perspective ? c->position[1] / depth : fabs(c->back[1]);
            double t = fmin(fmax((down - COS_OUTER) / (COS_INNER - COS_OUTER), 0), 1);
            sum += (s->spot ? t * t : 1) * slope / (4 * half * half);
        }
    }
    return sum * 2 * M_PI / ((double)RINGS * TURNS);
}

// How far the mean of the picture is off.
static double check(gpu_test *t, const shot *s, uint32_t size, double height, const double place[2])
{
    tyn_scene *scene = malloc(sizeof *scene);
    tyn_scene_init(scene);
    uint32_t material = solids_material(scene, (float[]){1, 1, 1}, (float[]){0, 0, 0});
    const float wide = 12, edge = (float)s->edge;
    solids_quad(scene, (float[]){-wide, 0, -wide}, (float[]){0, 0, 2 * wide},
                (float[]){wide + edge, 0, 0}, material);
    solids_hierarchy(scene, 4);
    const double lamp[3] = {place[0], height, place[1]};
    scene->lights[scene->num_lights++] =
        (tyn_light){.kind = s->spot ? TYN_LIGHT_SPOT : TYN_LIGHT_POINT,
                    .direction = {0, -1, 0},
                    .cos_inner = (float)COS_INNER,
                    .cos_outer = (float)COS_OUTER,
                    .color = {1, 1, 1},
                    .position = {(float)lamp[0], (float)lamp[1], (float)lamp[2]}};
    tyn_view view = {0};
    look(&view, s, size);
    picture p;
    picture_render(&p, t->dev, "pop", scene, &view, NULL, 1);
    double mean = 0;
    for (uint32_t i = 0; i < size * size; i++) {
        mean += M_PI * p.rgb[3 * i] / ((double)size * size);
    }
    double want = expected(&view.camera, s, lamp);
    picture_free(&p);
    tyn_scene_finish(scene);
    free(scene);
    return mean / want - 1;
}

static void means(void **state)
{
    const shot shots[] = {
        {"from above", {0, 3, 0}, false, 1, 12, false},
        {"oblique", {2, 1.5, 0.7}, false, 1, 12, false},
        {"perspective", {0.3, 2.5, 1.2}, true, 0.45, 12, false},
        {"flat", {1.5, 0.35, 0.8}, true, 0.12, 12, false},
        {"at the floor's end", {0.3, 2.5, 1.2}, true, 0.45, 0.15, false},
        {"spot", {0.3, 2.5, 1.2}, true, 0.45, 12, true},
        {"flat spot", {1.5, 0.35, 0.8}, true, 0.12, 12, true},
    };
    const double heights[] = {1, 0.1, 0.02, 0.005, 0.001};
    const double places[][2] = {{0.0137, -0.0071}, {-0.1043, 0.0918}, {0.0612, 0.1101}};
    const uint32_t sizes[] = {32, 64, 256};
    double worst = 0, worst_spot = 0;
    for (int i = 0; i < 7; i++) {
        for (int k = 0; k < 3; k++) {
            for (int h = 0; h < (shots[i].spot ? 3 : 5); h++) {
                const double *place = places[(i + k + h) % 3];
                double off = check(*state, &shots[i], sizes[k], heights[h], place);
                print_message("%s, %u^2, lamp at %g m: %+.2f %%\n", shots[i].name, sizes[k],
                              heights[h], 100 * off);
                double *most = shots[i].spot ? &worst_spot : &worst;
                *most = maximum(*most, fabs(off));
            }
        }
    }
    assert_within(worst, 0.02, NULL);
    assert_within(worst_spot, 0.04, NULL); // cones a sixth of a pixel wide
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(means),
    };
    cmocka_set_test_filter(getenv("TYN_TEST_FILTER"));
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
