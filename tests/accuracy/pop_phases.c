// pop_phases.c -- pictures of media whose phase functions are tables: `pop` and `single` against `path`, and against the lobe
// itself where the table is of one.
//
// Asserted: pictures of `pop` are within the bound of one-lobe media (pop_path.c), each printed beside that of the lobe of
// its mean cosine; a table of one lobe gives the lobe's own picture under every kind of light; first scattering of `single`
// is `path`'s; what does not know the table gives the picture of the lobe of its mean cosine, to the bit.
#include "built_in.h"
#include "bound.h"
#include "path_run.h"
#include "numbers.h"
#include "phases.h"
#include "skip.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void take(tyn_scene *scene, tyn_phase phase)
{
    for (uint32_t i = 0; i < 3 * scene->num_media; i++) {
        scene->media[i / 3].phase[i % 3] = phase;
    }
}

// ---- pictures ---------------------------------------------------------------------------------

enum { PIXELS = 64 };

static void make_cube(tyn_scene *scene, tyn_view *view)
{
    const tyn_medium medium = grey_medium(8, 0.2f, 0);
    tyn_scene_init(scene);
    scene_add_box(scene, &medium, (float[]){0, 0, 0}, (float[]){1, 1, 1}, (uint32_t[]){1, 1, 1},
                  NULL);
    scene_add_sun(scene, -2, -5, 3, 3, 2.5f, 2);
    *view = (tyn_view){0};
    view_orthographic(view, (float[]){0.5f, 0.5f, 0.5f}, 4, -2, -5, (float[]){0, 1, 0}, 0.8f,
                      PIXELS);
}

static picture_error compare(path_run *r, const char *name, const tyn_scene *scene,
                             const tyn_view *view, const picture *reference)
{
    picture ours;
    picture_render(&ours, r->dev, "pop", scene, view, NULL, 0);
    const picture_error e = picture_compare(&ours, reference, 8);
    printf("%-28s error %5.2f %% (rel_l1 %5.2f, noise %4.2f, bias %+5.2f)\n", name,
           100 * e.reported, 100 * e.rel_l1, 100 * e.noise, 100 * e.bias);
    picture_free(&ours);
    return e;
}

static void pictures(void **state)
{
    path_run *r = *state;
    double worst = 0;
    for (int kind = 0; kind < PHASES_COUNT; kind++) {
        tyn_scene scene;
        tyn_view view = {0};
        picture reference = {0};
        make_cube(&scene, &view);
        const tyn_phase phase = phases_add(&scene, (phases_kind)kind);
        for (int one = 0; one < 2; one++) {
            char name[64];
            snprintf(name, sizeof name, "%s%s", phases_name((phases_kind)kind),
                     one ? ", one lobe" : "");
            take(&scene, one ? (tyn_phase){.g = phase.g} : phase);
            path_run_picture(r, &reference, &scene, &view, path_effort(1024));
            const picture_error e = compare(r, name, &scene, &view, &reference);
            worst = one ? worst : maximum(worst, e.reported);
        }
        picture_free(&reference);
        tyn_scene_finish(&scene);
    }
    assert_within(worst, 0.12, NULL); // as media of one lobe
}

// ---- one lobe as a table ----------------------------------------------------------------------

typedef enum lit_by { LIT_SUN, LIT_LAMP, LIT_LAMPS, LIT_MAP, LIT_COUNT } lit_by;

// A bright patch in one corner of the sky, a sun in a grey one.
static void set_map(tyn_scene *scene)
{
    enum { WIDTH = 64, HEIGHT = 32 };
    scene_set_sky(scene, 1);
    tyn_environment *env = &scene->environment;
    env->size[0] = WIDTH;
    env->size[1] = HEIGHT;
    env->data = malloc(3 * WIDTH * HEIGHT * sizeof(float));
    assert_non_null(env->data);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        const bool patch = i % WIDTH < 16 && i / WIDTH < 14;
        for (int c = 0; c < 3; c++) {
            env->data[3 * i + c] = patch ? 4 : 0.3f;
        }
    }
    for (int c = 0; c < 3; c++) {
        env->data[3 * (10 * WIDTH + 40) + c] = 3000;
    }
}

static void light(tyn_scene *scene, lit_by lit)
{
    scene->num_lights = lit == LIT_SUN ? scene->num_lights : 0;
    for (int i = 0; i < (lit == LIT_LAMPS ? 6 : lit == LIT_LAMP); i++) {
        scene_add_lamp(scene, (float[]){0.2f + 0.1f * (float)i, 1.3f, 0.4f}, 2);
    }
    if (lit == LIT_MAP) {
        set_map(scene);
    }
}

// Against the lobe itself: every kernel that reads moments or the table, grey and in colours.
static void same_lobe(void **state)
{
    static const char *const names[LIT_COUNT] = {"sun", "lamp", "six lamps", "map"};
    path_run *r = *state;
    const tyn_phase_lobe halves[2] = {{.weight = 0.5f, .g = 0.8f}, {.weight = 0.5f, .g = 0.8f}};
    const tyn_phase_form form = {.count = 2, .lobes = halves};
    double worst = 0;
    static const struct {
        const char *method;
        lit_by lit;
        bool colours;
    } cases[] = {{"pop", LIT_SUN, false}, {"pop", LIT_LAMP, true},   {"pop", LIT_LAMPS, false},
                 {"pop", LIT_MAP, true},  {"single", LIT_SUN, true}, {"single", LIT_LAMP, false},
                 {"lpv", LIT_SUN, true}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const char *method = cases[i].method;
        const lit_by lit = cases[i].lit;
        if (!is_built_in(method)) {
            continue;
        }
        tyn_scene scene;
        tyn_view view = {0};
        tyn_phase phase;
        picture with[2];
        make_cube(&scene, &view);
        light(&scene, lit);
        scene.media[0].sigma_s[2] *= cases[i].colours ? 0.5f : 1;
        assert_int_equal(tyn_scene_add_phase(&scene, &form, "phase", &phase, NULL), TYN_OK);
        for (int table = 0; table < 2; table++) {
            take(&scene, table ? phase : (tyn_phase){.g = 0.8f});
            picture_render(&with[table], r->dev, method, &scene, &view, NULL, 0);
        }
        const picture_error e = picture_compare(&with[1], &with[0], 1);
        printf("a table of one lobe, %s, %s%s: rel_l1 %.2g\n", method, names[lit],
               cases[i].colours ? ", colours" : "", e.rel_l1);
        worst = maximum(worst, e.rel_l1);
        picture_free(&with[0]);
        picture_free(&with[1]);
        tyn_scene_finish(&scene);
    }
    assert_true(worst < 1e-5);
}

// Media of unequal coefficients that share a table: two boxes in one place are one box of the sum. The second scatters too;
// or absorbs alone, with another phase function.
static void two_of_one_phase(void **state)
{
    static const struct {
        const char *method;
        lit_by lit;
        phases_kind kind;
        bool absorbs;
    } cases[] = {
        {"pop", LIT_SUN, PHASES_RAYLEIGH, false}, {"pop", LIT_LAMP, PHASES_DROPLETS, true},
        {"pop", LIT_LAMPS, PHASES_BOTH, false},   {"pop", LIT_MAP, PHASES_RAYLEIGH, false},
        {"pop", LIT_MAP, PHASES_DROPLETS, true},  {"single", LIT_SUN, PHASES_RAYLEIGH, false},
        {"lpv", LIT_SUN, PHASES_RAYLEIGH, false}};
    path_run *r = *state;
    double worst = 0;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        if (!is_built_in(cases[i].method)) {
            continue;
        }
        tyn_scene scene;
        tyn_view view = {0};
        picture with[2];
        make_cube(&scene, &view);
        light(&scene, cases[i].lit);
        const tyn_phase phase = phases_add(&scene, cases[i].kind);
        for (int parts = 1; parts <= 2; parts++) {
            if (parts == 2) {
                const tyn_medium other = grey_medium(1, 0, 0);
                scene_add_box(&scene, &other, (float[]){0, 0, 0}, (float[]){1, 1, 1},
                              (uint32_t[]){1, 1, 1}, NULL);
            }
            tyn_medium *first = &scene.media[0], *last = &scene.media[parts - 1];
            take(&scene, phase);
            for (int c = 0; c < 3; c++) {
                const float scattered = cases[i].absorbs ? 0 : (float)c + 1,
                            absorbed = cases[i].absorbs ? (float)c + 1 : 0;
                last->sigma_s[c] = scattered;
                last->sigma_a[c] = absorbed;
                last->phase[c] = cases[i].absorbs && parts == 2 ? (tyn_phase){.g = -0.5f} : phase;
                first->sigma_s[c] = 8 - (parts == 2 ? scattered : 0);
                first->sigma_a[c] = 0.2f + (parts == 1 ? absorbed : 0);
            }
            picture_render(&with[parts - 1], r->dev, cases[i].method, &scene, &view, NULL, 0);
        }
        const picture_error e = picture_compare(&with[1], &with[0], 1);
        printf("two media of one table, %s, case %zu: rel_l1 %.2g\n", cases[i].method, i, e.rel_l1);
        worst = maximum(worst, e.rel_l1);
        picture_free(&with[0]);
        picture_free(&with[1]);
        tyn_scene_finish(&scene);
    }
    assert_within(worst, 0.003, "two media are resampled, one is not");
}

// Methods that know lobes alone, and media of different phase functions, take the lobe of the mean cosine.
static void lobe_instead(void **state)
{
    path_run *r = *state;
    for (int i = 0; i < 3; i++) {
        const char *method = i == 0 ? "constellation" : i == 1 ? "pop" : "single";
        if (!is_built_in(method)) {
            continue;
        }
        tyn_scene scene;
        tyn_view view = {0};
        picture with[2];
        make_cube(&scene, &view);
        const tyn_phase phase = phases_add(&scene, PHASES_DROPLETS);
        if (i > 0) {
            const tyn_medium other = grey_medium(1, 2, 0);
            scene_add_box(&scene, &other, (float[]){0, 0, 0}, (float[]){0.5f, 0.5f, 0.5f},
                          (uint32_t[]){1, 1, 1}, NULL);
        }
        for (int table = 0; table < 2; table++) {
            take(&scene, table ? phase : (tyn_phase){.g = phase.g});
            scene.media[scene.num_media - 1].phase[2] =
                i > 0 ? (tyn_phase){.g = 0.2f} : scene.media[0].phase[2];
            picture_render(&with[table], r->dev, method, &scene, &view, NULL, 0);
        }
        assert_true(picture_compare(&with[1], &with[0], 1).rel_l1 == 0);
        picture_free(&with[0]);
        picture_free(&with[1]);
        tyn_scene_finish(&scene);
    }
}

// ---- first scattering -------------------------------------------------------------------------

// First scattering of `single` against `path`'s layer of it.
static void first_scattering(void **state)
{
    path_run *r = *state;
    double worst = 0;
    for (int kind = 0; kind < PHASES_COUNT; kind++) {
        tyn_scene scene;
        tyn_view view = {0};
        picture ours;
        make_cube(&scene, &view);
        take(&scene, phases_add(&scene, (phases_kind)kind));
        view.max_depth = 1;
        picture reference = {0};
        path_run_picture(r, &reference, &scene, &view, path_effort(64));
        view.max_depth = 0;
        picture_render(&ours, r->dev, "single", &scene, &view, NULL, 0);
        const picture_error e = picture_compare(&ours, &reference, 8);
        printf("%s, once: rel_l1 %.4f, noise %.4f, bias %+.4f\n", phases_name((phases_kind)kind),
               e.rel_l1, e.noise, e.bias);
        worst = maximum(worst, e.reported);
        picture_free(&ours);
        picture_free(&reference);
        tyn_scene_finish(&scene);
    }
    assert_within(worst, 0.01, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(same_lobe),
                                       cmocka_unit_test(two_of_one_phase),
                                       cmocka_unit_test(lobe_instead), cmocka_unit_test(pictures),
                                       cmocka_unit_test(first_scattering)};
    setvbuf(stdout, NULL, _IOLBF, 0);
    cmocka_set_test_filter(getenv("TYN_TEST_FILTER"));
    return run_cases(tests, path_run_setup_kept, path_run_teardown);
}
