// pop_spots.c -- the cone of a spot in a medium: its light along a ray against fine quadrature. Cones narrower than
// a step must not be hit or missed by chance, and what a shadow leaves of a step is taken where it is.
#include "bound.h"
#include "gpu_test.h"
#include "numbers.h"
#include "picture.h"
#include "solids.h"
#include "vector.h"
#include <math.h>
#include <stdlib.h>

enum { PIXELS = 48 };

static const float sigma_s = 0.2f, sigma_a = 0.1f, anisotropy = 0.4f;
static const double half = 2, view_half = 1.2; // of the box and of the picture, m

typedef struct spot {
    double at[3], axis[3]; // M
    double inner, outer;   // degrees
} spot;

// glTF: ((cos - cos_outer) / (cos_inner - cos_outer))^2 between the cones.
static double falloff(const spot *s, double cosine)
{
    double inner = cos(s->inner * M_PI / 180), outer = cos(s->outer * M_PI / 180);
    double x = fmin(fmax((cosine - outer) / (inner - outer), 0), 1);
    return x * x;
}

// Radiance once scattered along the ray from (x, y, half) along -z; W/sr = 1.
static double exact(const spot *s, double x, double y)
{
    const int steps = 40000;
    const double sigma_t = sigma_s + sigma_a, ds = 2 * half / steps, g = anisotropy;
    double sum = 0;
    for (int i = 0; i < steps; i++) {
        double t = (i + 0.5) * ds;
        double d[3] = {x - s->at[0], y - s->at[1], half - t - s->at[2]};
        double r = sqrt(vector_dot(d, d)), before = fmax(-half - s->at[0], 0) / d[0]; // the box
        double mu = d[2] / r;                                                         // to the eye
        double phase = (1 - g * g) / (4 * M_PI * pow(1 + g * g - 2 * g * mu, 1.5));
        sum += falloff(s, vector_dot(d, s->axis) / r) * phase *
               exp(-sigma_t * (r * (1 - before) + t)) / (r * r) * ds;
    }
    return sigma_s * sum;
}

static void compare(gpu_test *t, const char *method, spot s)
{
    double size = sqrt(vector_dot(s.axis, s.axis));
    for (int a = 0; a < 3; a++) {
        s.axis[a] /= size;
    }
    tyn_medium medium = grey_medium(sigma_s, sigma_a, anisotropy);
    tyn_scene *scene = malloc(sizeof *scene);
    tyn_scene_init(scene);
    const float hi = (float)half;
    scene_add_box(scene, &medium, (float[]){-hi, -hi, -hi}, (float[]){hi, hi, hi}, NULL, NULL);
    scene->lights[scene->num_lights++] = (tyn_light){
        .kind = TYN_LIGHT_SPOT,
        .color = {1, 1, 1},
        .position = {(float)s.at[0], (float)s.at[1], (float)s.at[2]},
        .direction = {(float)s.axis[0], (float)s.axis[1], (float)s.axis[2]},
        .cos_inner = (float)cos(s.inner * M_PI / 180),
        .cos_outer = (float)cos(s.outer * M_PI / 180),
    };
    tyn_view view = {0};
    view_orthographic(&view, (float[]){0, 0, 0}, 0, 0, -1, (float[]){0, 1, 0}, (float)view_half,
                      PIXELS);
    picture p;
    picture_render(&p, t->dev, method, scene, &view, "raymarch.sparse=0", 0);
    double most = 0, worst = 0, want[PIXELS];
    uint32_t seen = 0;
    for (uint32_t row = 0; row < PIXELS; row += 5) {
        double y = view_half * (1 - (2 * row + 1.0) / PIXELS);
        for (uint32_t i = 0; i < PIXELS; i++) {
            want[i] = exact(&s, view_half * ((2 * i + 1.0) / PIXELS - 1), y);
            most = maximum(most, want[i]);
        }
        for (uint32_t i = 0; i < PIXELS; i++) {
            double got = p.rgb[3 * (row * PIXELS + i)];
            // Relative, but where a pixel's middle only touches the cone.
            worst = maximum(worst, relative(fabs(got - want[i]), want[i] + 0.01 * most));
            seen += want[i] > 0.01 * most;
        }
    }
    print_message("%s, cones of %g and %g degrees: worst %.2f %% of %u pixels\n", method, s.inner,
                  s.outer, 100 * worst, seen);
    picture_free(&p);
    tyn_scene_finish(scene);
    free(scene);
    assert_true(seen >= 20);
    assert_within(worst, 0.005, NULL);
}

static void cones(void **state)
{
    const spot across = {{-1.5, 0.1, 0.3}, {1, 0.05, -0.1}, 1.5, 3};
    const spot sharp = {{-1.5, 0.1, 0.3}, {1, 0.05, -0.1}, 2.999, 3};
    const spot oblique = {{-1.2, 0.9, 1.2}, {0.8, -0.6, -1}, 0, 4};
    const spot wide = {{0.3, 1.6, -0.2}, {0, -1, 0.2}, 25, 60};
    const spot half_space = {{0.3, 1.6, -0.2}, {0, -1, 0.2}, 0, 90};
    const spot outside = {{-4, 0.3, 0}, {1, 0, 0.1}, 2, 5};
    const spot *all[] = {&across, &sharp, &oblique, &wide, &half_space, &outside};
    for (int i = 0; i < 6; i++) {
        compare(*state, "single", *all[i]);
    }
}

// A spot or a point light above a lid with a hole in it: a shaft narrower than the steps of a coarse lattice's march.
// Light that was taken in the middle of steps, visible or not, was 11 % too much.
static void through_a_hole(void **state)
{
    gpu_test *t = *state;
    const tyn_medium medium = grey_medium(0.3f, 0.02f, 0.6f);
    for (int kind = 0; kind < 2; kind++) {
        tyn_scene *scene = malloc(sizeof *scene);
        tyn_scene_init(scene);
        scene_add_box(scene, &medium, (float[]){0, 0, 0}, (float[]){4, 3, 4}, NULL, NULL);
        scene->lights[scene->num_lights++] = (tyn_light){
            .kind = kind ? TYN_LIGHT_POINT : TYN_LIGHT_SPOT,
            .color = {40, 40, 40},
            .position = {1.2f, 4.5f, 2},
            .direction = {0.344f, -0.939f, 0},
            .cos_inner = 0.94f,
            .cos_outer = 0.94f,
        };
        const uint32_t black = solids_material(scene, (float[]){0, 0, 0}, (float[]){0, 0, 0});
        solids_quad(scene, (float[]){-3, 3, -3}, (float[]){0, 0, 10}, (float[]){4.5f, 0, 0}, black);
        solids_quad(scene, (float[]){2, 3, -3}, (float[]){0, 0, 10}, (float[]){5, 0, 0}, black);
        solids_quad(scene, (float[]){1.5f, 3, -3}, (float[]){0, 0, 4.75f}, (float[]){0.5f, 0, 0},
                    black);
        solids_quad(scene, (float[]){1.5f, 3, 2.25f}, (float[]){0, 0, 4.75f}, (float[]){0.5f, 0, 0},
                    black);
        solids_hierarchy(scene, 4);
        tyn_view view = {0};
        view_orthographic(&view, (float[]){2, 1.5f, 2}, -0.7f, -0.1f, -0.7f, (float[]){0, 1, 0},
                          1.4f, PIXELS);
        picture coarse, fine;
        picture_render(&coarse, t->dev, "pop", scene, &view, "lattice.cells=8 raymarch.sparse=0",
                       0);
        picture_render(&fine, t->dev, "pop", scene, &view,
                       "lattice.cells=8 raymarch.sparse=0 raymarch.step=0.05", 0);
        const picture_error e = picture_compare(&coarse, &fine, 4);
        print_message("%s through a hole: mean %+.2f %%, blocks of 4x4 pixels %.2f %%\n",
                      kind ? "point" : "spot", 100 * e.bias, 100 * e.rel_l1);
        picture_free(&coarse);
        picture_free(&fine);
        tyn_scene_finish(scene);
        free(scene);
        // Twice what the usual steps leave.
        assert_within(fabs(e.bias), 0.007, NULL);
        assert_within(e.rel_l1, 0.009, NULL);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cones),
        cmocka_unit_test(through_a_hole),
    };
    cmocka_set_test_filter(getenv("TYN_TEST_FILTER"));
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
