// selftest_pictures.c -- furnaces, the unit cube against references, energy, and the same bytes twice.
#include "selftest.h"
#include <math.h>
#include <stdio.h>

enum { BALANCE_SAMPLES = 256 }; // of many thousand paths each

static double worst_of(const float *pixels, double expected)
{
    double worst = 0;
    for (int i = 0; i < SELFTEST_SIZE * SELFTEST_SIZE; i++) {
        for (int c = 0; c < 3; c++) {
            double off = fabs(pixels[4 * i + c] - expected);
            worst = isnan(worst) || off <= worst ? worst : off;
        }
    }
    return worst;
}

// Mean of a picture of the cube along a direction of view, with its standard error where the method has one.
static int mean_of_cube(selftest *t, const char *with, float g, const float view_along[3],
                        double *mean, double *se)
{
    tyn_scene scene;
    renderer r;
    tyn_method_info info;
    if (!method_find(t->a, with, &info)) {
        return EXIT_FAILED;
    }
    const bool noisy = info.outputs & TYN_OUTPUT_ERROR;
    tyn_view view = selftest_picture(TYN_OUTPUT_RADIANCE | (noisy ? TYN_OUTPUT_ERROR : 0));
    selftest_camera(&view.camera, view_along[0], view_along[1], view_along[2], 0.5f);
    selftest_cube(&scene, g, false);
    int code = selftest_render(t, with, &scene, &view, &r);
    if (code == EXIT_DONE) {
        *mean = selftest_mean(tyn_offline_output(r.offline, TYN_OUTPUT_RADIANCE),
                              noisy ? tyn_offline_output(r.offline, TYN_OUTPUT_ERROR) : NULL, se);
        renderer_close(&r);
    }
    tyn_scene_finish(&scene);
    return code;
}

// Nothing is absorbed and 1 comes from everywhere: 1 is seen everywhere.
static int check_furnace(selftest *t, const tyn_method_info *with, double promised, float g)
{
    const bool noisy = with->outputs & TYN_OUTPUT_ERROR;
    tyn_view view = selftest_picture(TYN_OUTPUT_RADIANCE | (noisy ? TYN_OUTPUT_ERROR : 0));
    selftest_camera(&view.camera, -0.5f, -0.7f, -0.4f, 0.9f);
    tyn_scene scene;
    selftest_cube(&scene, g, true);
    renderer r;
    int code = selftest_render(t, with->name, &scene, &view, &r);
    if (code == EXIT_DONE) {
        char name[64];
        const float *pixels = tyn_offline_output(r.offline, TYN_OUTPUT_RADIANCE);
        if (noisy) {
            double se,
                mean = selftest_mean(pixels, tyn_offline_output(r.offline, TYN_OUTPUT_ERROR), &se);
            snprintf(name, sizeof name, "furnace, %s, g %g: mean", with->name, g);
            selftest_check(t, name, mean, 1, 4 * se + promised, "exact");
        } else {
            snprintf(name, sizeof name, "furnace, %s, g %g: worst pixel off 1 by", with->name, g);
            selftest_check(t, name, worst_of(pixels, 1), 0, promised, "exact");
        }
        renderer_close(&r);
    }
    tyn_scene_finish(&scene);
    return code;
}

int selftest_furnace(selftest *t)
{
    static const float g[] = {0, 0.5f, 0.9f};
    int code = EXIT_DONE;
    for (size_t i = 0; i < ARRAY_SIZE(g); i++) {
        tyn_method_info info;
        const tyn_promise *p;
        for (uint32_t m = 0; code == EXIT_DONE && selftest_next(&m, &info, &p);) {
            code = p->furnace > 0 ? check_furnace(t, &info, p->furnace, g[i]) : EXIT_DONE;
        }
    }
    return code;
}

static double henyey_greenstein(double g, double cosine)
{
    return (1 - g * g) / (4 * 3.14159265358979324 * pow(1 + g * g - 2 * g * cosine, 1.5));
}

static int check_cube(selftest *t, const tyn_method_info *with, float g, const char *view,
                      const float along[3], double expected, double promised, const char *source)
{
    double se, mean;
    char name[64];
    if (!(promised > 0)) {
        return EXIT_DONE;
    }
    int code = mean_of_cube(t, with->name, g, along, &mean, &se);
    if (code == EXIT_DONE) {
        snprintf(name, sizeof name, "cube, %s, g %g, %s view: mean", with->name, g, view);
        selftest_check(t, name, mean, expected, 4 * se + promised * expected, source);
    }
    return code;
}

// The cube's faces: all orders against reference images, one order against its closed form.
int selftest_cubes(selftest *t)
{
    static const struct {
        const char *name;
        float along[3];
        double g0, g5; // mean radiance at g 0 and 0.5
    } views[] = {
        {"side", {0, -1, 0}, 0.0631537, 0.0623459},
        {"exit", {-1, 0, 0}, 0.0308069, 0.0972802},
        {"entry", {1, 0, 0}, 0.108614, 0.0553141},
    };
    static const char pbrt[] = "pbrt-v3";
    // sigma_s 4, the sun along x: its way in, then the way to the eye; p(0), p(1) and p(-1).
    const double s = 4, e = exp(-s), g = 0.5, mean_in = (1 - e) / s;
    const double once[] = {s * henyey_greenstein(g, 0) * mean_in * mean_in,
                           s * henyey_greenstein(g, 1) * e,
                           henyey_greenstein(g, -1) * (1 - e * e) / 2};
    int code = EXIT_DONE;
    tyn_method_info info;
    const tyn_promise *p;
    for (uint32_t m = 0; code == EXIT_DONE && selftest_next(&m, &info, &p);) {
        for (size_t i = 0; i < ARRAY_SIZE(views) && code == EXIT_DONE; i++) {
            const char *view = views[i].name;
            const float *along = views[i].along;
            code = check_cube(t, &info, 0, view, along, views[i].g0, p->cube_isotropic, pbrt);
            if (code == EXIT_DONE) {
                code = check_cube(t, &info, 0.5f, view, along, views[i].g5, p->cube_forward, pbrt);
            }
            if (code == EXIT_DONE) {
                code =
                    check_cube(t, &info, 0.5f, view, along, once[i], p->cube_once, "closed form");
            }
        }
        if (code == EXIT_DONE) {
            code = check_cube(t, &info, 0.5f, views[0].name, views[0].along, p->cube_recorded,
                              p->cube_as_recorded, "as recorded");
        }
    }
    return code;
}

// A method that no check knows is not known to be right; what plugins promise is theirs to test.
int selftest_rows(selftest *t)
{
    for (uint32_t m = 0; m < tyn_num_methods(); m++) {
        tyn_method_info info;
        tyn_method_at(m, &info);
        char name[64];
        snprintf(name, sizeof name, "rows, %s: missing", info.name);
        if (info.plugin) {
            selftest_skip(t, name, "a plugin's method");
            continue;
        }
        selftest_check(t, name, !info.promise, 0, 0, "tyn_method_info.promise");
    }
    return EXIT_DONE;
}

// Entering = absorbed + escaped: with absorption, and with a lamp in the medium.
static int check_energy(selftest *t, const char *with, double promised, bool lamp)
{
    tyn_view view = {
        .width = 1, .height = 1, .outputs = TYN_OUTPUT_BALANCE, .num_samples = BALANCE_SAMPLES};
    selftest_camera(&view.camera, 0, 0, -1, 1);
    tyn_scene scene;
    if (lamp) {
        selftest_lamp(&scene, 0.9f, 4, 2);
    } else {
        selftest_cube(&scene, 0.5f, false);
    }
    renderer r;
    int code = selftest_render(t, with, &scene, &view, &r);
    if (code == EXIT_DONE) {
        const tyn_balance *b = tyn_offline_output(r.offline, TYN_OUTPUT_BALANCE);
        char name[64];
        snprintf(name, sizeof name, "energy, %s, %s: imbalance", with,
                 lamp ? "lamp in a medium" : "cube in the sun");
        selftest_check(t, name, b->imbalance[1], 0, promised + 4 * b->imbalance_se[1], "exact");
        renderer_close(&r);
    }
    tyn_scene_finish(&scene);
    return code;
}

int selftest_energy(selftest *t)
{
    int code = EXIT_DONE;
    tyn_method_info info;
    const tyn_promise *p;
    for (uint32_t m = 0; code == EXIT_DONE && selftest_next(&m, &info, &p);) {
        for (int lamp = 0; lamp < 2 && code == EXIT_DONE && p->energy > 0; lamp++) {
            code = check_energy(t, info.name, p->energy, lamp == 1);
        }
    }
    return code;
}

// The same inputs give the same bytes.
int selftest_repeats(selftest *t)
{
    int code = EXIT_DONE;
    for (uint32_t i = 0; i < tyn_num_methods() && code == EXIT_DONE; i++) {
        tyn_method_info info;
        tyn_method_at(i, &info);
        uint64_t hash[2] = {0};
        for (int k = 0; k < 2 && code == EXIT_DONE; k++) {
            renderer r;
            code = selftest_render_cube(t, info.name, 8, &r);
            if (code == EXIT_DONE) {
                hash[k] = text_hash(tyn_offline_output(r.offline, TYN_OUTPUT_RADIANCE),
                                    sizeof(float[4]) * SELFTEST_SIZE * SELFTEST_SIZE, 0);
                renderer_close(&r);
            }
        }
        if (code == EXIT_DONE) {
            char name[64];
            snprintf(name, sizeof name, "repeats, %s: differing pictures", info.name);
            selftest_check(t, name, hash[0] != hash[1], 0, 0, "exact");
        }
    }
    return code;
}
