// selftest_tables.c -- slabs, the half space and lamps against tables, closed forms and the literature.
#include "selftest.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { PROBE_SAMPLES = 1 << 17 }; // a point
static const double pi = 3.14159265358979324;

// ---- slabs ------------------------------------------------------------------------------------

typedef struct slab_row {
    double tau, g, albedo, mu0; // mu0: cosine of the sun's direction with the vertical
    float ground;               // its albedo; 0: none
    // Fluxes for unit flux through a horizontal plane: up at the top, down (unscattered as well) at the bottom.
    double up, down;
    double down_up; // up at the bottom, from the ground
    const char *source;
} slab_row;

// Two points inside, next to the faces; net flux is up - down.
static int check_slab(selftest *t, const char *with, const tyn_promise *promised,
                      const slab_row *row)
{
    const float points[2][3] = {{0.5f, 0.9999f, 0.5f}, {0.5f, 0.0001f, 0.5f}};
    tyn_view view = {.width = 1,
                     .height = 1,
                     .outputs = TYN_OUTPUT_PROBE,
                     .num_samples = PROBE_SAMPLES,
                     .points = points,
                     .num_points = 2};
    selftest_camera(&view.camera, 0, 0, -1, 1);
    tyn_scene scene;
    if (!selftest_slab(&scene, (float)row->tau, (float)row->g, (float)row->albedo, (float)row->mu0,
                       row->ground, promised->wide_ground)) {
        return app_exit_code(t->a, TYN_ERR_MEMORY, false);
    }
    renderer r;
    int code = selftest_render(t, with, &scene, &view, &r);
    if (code == EXIT_DONE) {
        const tyn_probe_result *p = tyn_offline_output(r.offline, TYN_OUTPUT_PROBE);
        char name[80];
        // y is the second axis, green the second channel
        snprintf(name, sizeof name, "slab %g, g %g, albedo %g, mu %g, %s: up", row->tau, row->g,
                 row->albedo, row->mu0, with);
        selftest_check(t, name, p[0].flux[4] + 1, row->up, 4 * p[0].flux_se[4] + promised->slabs,
                       row->source);
        snprintf(name, sizeof name, "  %s: down", row->ground > 0 ? "over a ground" : "the same");
        selftest_check(t, name, row->down_up - p[1].flux[4], row->down,
                       4 * p[1].flux_se[4] + promised->slabs, row->source);
        renderer_close(&r);
    }
    tyn_scene_finish(&scene);
    return code;
}

int selftest_slabs(selftest *t)
{
    static const char disort[] = "DISORT 4.0.99";
    static const char hulst[] = "van de Hulst 1980";
    const double e1 = exp(-1.0);
    const slab_row rows[] = {
        {1, 0.5, 0.9, 1, 0, 0.12979328, e1 + 0.37121167, 0, disort},
        {1, 0.9, 0.9, 0.5, 0, 0.075920655, 0.13533528 + 0.58389752, 0, disort},
        {2, 0.75, 0.9, 1, 0, 0.09739, 0.66096, 0, hulst},
        {1, 0.75, 1, 1, 0, 0.2474 / pi, e1 + 1.7385 / pi, 0, hulst}, // table 37, beam flux pi
        {1, 0.75, 0.9, 1, 0.8f, 0.56875684, e1 + 0.56308377, 0.74477057, disort},
    };
    int code = EXIT_DONE;
    tyn_method_info info;
    const tyn_promise *p;
    for (uint32_t m = 0; code == EXIT_DONE && selftest_next(&m, &info, &p);) {
        for (size_t i = 0; i < ARRAY_SIZE(rows) && code == EXIT_DONE && p->slabs > 0; i++) {
            code = check_slab(t, info.name, p, &rows[i]);
        }
    }
    return code;
}

// ---- the half space ---------------------------------------------------------------------------

// Isotropic scattering of albedo 0.9, looked at from straight above, the sun straight above or at 60 degrees.
// Chandrasekhar, Radiative Transfer (1960): radiance for unit flux through a horizontal plane is
// albedo / (4 pi) H(mu) H(mu0) / (mu + mu0). A slab of depth 20 lacks 1e-9 of it.
static int check_half_space(selftest *t, const tyn_method_info *with, double promised, double mu0,
                            double expected)
{
    const bool noisy = with->outputs & TYN_OUTPUT_ERROR;
    tyn_view view = selftest_picture(TYN_OUTPUT_RADIANCE | (noisy ? TYN_OUTPUT_ERROR : 0));
    selftest_camera(&view.camera, 0, -1, 0, 0.5f);
    tyn_scene scene;
    if (!selftest_slab(&scene, 20, 0, 0.9f, (float)mu0, 0, false)) {
        return app_exit_code(t->a, TYN_ERR_MEMORY, false);
    }
    renderer r;
    int code = selftest_render(t, with->name, &scene, &view, &r);
    if (code == EXIT_DONE) {
        double se,
            mean =
                selftest_mean(tyn_offline_output(r.offline, TYN_OUTPUT_RADIANCE),
                              noisy ? tyn_offline_output(r.offline, TYN_OUTPUT_ERROR) : NULL, &se);
        char name[64];
        snprintf(name, sizeof name, "half space, mu %g, %s: radiance", mu0, with->name);
        selftest_check(t, name, mean, expected, 4 * se + promised * expected, "Chandrasekhar's H");
        renderer_close(&r);
    }
    tyn_scene_finish(&scene);
    return code;
}

int selftest_half_space(selftest *t)
{
    static const struct {
        double mu0, h;
    } suns[] = {{1, 1.850175}, {0.5, 1.556033802}};
    const double albedo = 0.9, h1 = suns[0].h;
    int code = EXIT_DONE;
    for (size_t i = 0; i < ARRAY_SIZE(suns); i++) {
        const double expected = albedo / (4 * pi) * h1 * suns[i].h / (1 + suns[i].mu0);
        tyn_method_info info;
        const tyn_promise *p;
        for (uint32_t m = 0; code == EXIT_DONE && selftest_next(&m, &info, &p);) {
            if (p->half_space > 0) {
                code = check_half_space(t, &info, p->half_space, suns[i].mu0, expected);
            }
        }
    }
    return code;
}

// ---- lamps ------------------------------------------------------------------------------------

// Light scattered once along a ray past a lamp: the geometry of Sun et al. 2005, by quadrature to 1e-9. A lamp of
// 1 W/sr, D = 1 m from the eye, 60 degrees off the ray; extinction 0.3, scattering 0.25 /m.
static int check_airlight(selftest *t, const tyn_method_info *with, double promised, float g,
                          double expected)
{
    const bool noisy = with->outputs & TYN_OUTPUT_ERROR;
    tyn_view view = {.width = 8,
                     .height = 8,
                     .outputs = TYN_OUTPUT_RADIANCE | (noisy ? TYN_OUTPUT_ERROR : 0),
                     .num_samples = 1024,
                     .max_depth = 1};
    view.camera = (tyn_camera){.projection = TYN_PERSPECTIVE,
                               .right = {1, 0, 0},
                               .up = {0, 1, 0},
                               .back = {0, 0, 1},
                               .yfov = 1e-4f,
                               .aspect = 1};
    tyn_scene scene;
    selftest_lamp(&scene, 0.25f / 0.3f, 0.3f, 2 * (1 + 12 / 0.3f));
    for (int c = 0; c < 3; c++) {
        scene.media[0].phase[c].g = g;
    }
    scene.lights[0].position[0] = (float)sin(pi / 3);
    scene.lights[0].position[2] = -0.5f;
    renderer r;
    int code = selftest_render(t, with->name, &scene, &view, &r);
    if (code == EXIT_DONE) {
        const float *pixels = tyn_offline_output(r.offline, TYN_OUTPUT_RADIANCE);
        const float *errors = noisy ? tyn_offline_output(r.offline, TYN_OUTPUT_ERROR) : NULL;
        double mean = 0, variance = 0;
        for (int k = 0; k < 64; k++) {
            mean += pixels[4 * k + 1] / 64;
            variance += errors ? pow(errors[4 * k + 1] / 64, 2) : 0;
        }
        char name[64];
        snprintf(name, sizeof name, "airlight, g %g, %s%s: radiance", g, with->name,
                 with->single_only ? "" : ", one scattering");
        selftest_check(t, name, mean, expected, 4 * sqrt(variance) + promised * expected,
                       "quadrature");
        renderer_close(&r);
    }
    tyn_scene_finish(&scene);
    return code;
}

// Fluence about a lamp of 1 W in an infinite medium of extinction 1 /m and albedo 0.5, at 0.5 and 1 m: exact (Case
// and Zweifel 1967). Means over directions, evenly spread along a spiral: the lattice of pop has directions of its own.
static int check_point_source(selftest *t, const char *with, double promised)
{
    static const struct {
        float r;
        double fluence;
    } rows[] = {{0.5f, 0.294763122}, {1, 0.0586951375}};
    enum { DIRECTIONS = 32 };
    float points[2 * DIRECTIONS][3];
    uint32_t count = 0;
    for (size_t i = 0; i < ARRAY_SIZE(rows); i++) {
        for (int k = 0; k < DIRECTIONS; k++) {
            const double z = 1 - (2 * k + 1.0) / DIRECTIONS, azimuth = k * pi * (3 - sqrt(5));
            const double across = sqrt(1 - z * z), r = rows[i].r;
            points[count][0] = (float)(r * across * cos(azimuth));
            points[count][1] = (float)(r * z);
            points[count++][2] = (float)(r * across * sin(azimuth));
        }
    }
    tyn_view view = {.width = 1,
                     .height = 1,
                     .outputs = TYN_OUTPUT_PROBE,
                     .num_samples = PROBE_SAMPLES / 16,
                     .points = (const float(*)[3])points,
                     .num_points = count};
    selftest_camera(&view.camera, 0, 0, -1, 1);
    tyn_scene scene;
    selftest_lamp(&scene, 0.5f, 1, 2 * (1 + 5)); // what is 5 free paths away does not matter
    for (int c = 0; c < 3; c++) {
        scene.lights[0].color[c] = (float)(1 / (4 * pi));
    }
    renderer r;
    int code = selftest_render(t, with, &scene, &view, &r);
    for (size_t k = 0; k < ARRAY_SIZE(rows) && code == EXIT_DONE; k++) {
        const tyn_probe_result *p = tyn_offline_output(r.offline, TYN_OUTPUT_PROBE);
        double mean = 0, variance = 0;
        for (int m = 0; m < DIRECTIONS; m++) {
            mean += p[DIRECTIONS * k + m].fluence[1] / DIRECTIONS;
            variance += pow(p[DIRECTIONS * k + m].fluence_se[1] / DIRECTIONS, 2);
        }
        char name[64];
        snprintf(name, sizeof name, "point source, %g m, %s: fluence", rows[k].r, with);
        selftest_check(t, name, mean, rows[k].fluence,
                       promised * rows[k].fluence + 4 * sqrt(variance), "Case and Zweifel");
    }
    if (code == EXIT_DONE) {
        renderer_close(&r);
    }
    tyn_scene_finish(&scene);
    return code;
}

int selftest_lamps(selftest *t)
{
    static const struct {
        float g;
        double radiance;
    } rows[] = {{0, 0.0228435636}, {0.5f, 0.011678683}};
    int code = EXIT_DONE;
    tyn_method_info info;
    const tyn_promise *p;
    for (uint32_t m = 0; code == EXIT_DONE && selftest_next(&m, &info, &p);) {
        for (size_t i = 0; i < ARRAY_SIZE(rows) && code == EXIT_DONE && p->airlight > 0; i++) {
            code = check_airlight(t, &info, p->airlight, rows[i].g, rows[i].radiance);
        }
        if (code == EXIT_DONE && p->point_source > 0) {
            code = check_point_source(t, info.name, p->point_source);
        }
    }
    return code;
}
