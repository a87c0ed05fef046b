// i3rc.c -- the clouds of I3RC phase I, cases 1 to 3 (Cahalan et al., Bull. Amer. Meteor. Soc. 86, 2005): periodic
// fields of constant cells, Henyey-Greenstein of g = 0.85, domain means of reflectance, transmittance and
// absorptance against the consensus of the intercomparison (../shared/reference/i3rc; skipped where absent).
//
// Asserted: `path` within 0.5 % of each value, `pop` within 5 %. The consensus is a mean over several Monte Carlo
// models without a stated spread; its own R + T + A is off 1 by up to 8e-4, and this and 2 standard errors of
// ours are allowed for. Those of `path`, whose paths start at the sun, are at most half of the bound, with TYN_LONG=4
// at most a quarter.
//
// Cells are constant in these clouds and trilinear here: each is SPLIT voxels wide (FINER in case 2, whose depths are
// the most uneven), so that what is blended is 1 / SPLIT of it.
#include "bound.h"
#include "numbers.h"
#include "offline_frame.h"
#include "path_run.h"
#include "gpu_test.h"
#include "npy.h"
#include "skip.h"
#include "solids.h"
#include "todo.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    SPLIT = 2,
    FINER = 4,
    STEP_COLUMNS = 32,
    MMCR_X = 640,
    MMCR_ROWS = 54,
    MMCR_Z = 40,
    SAT = 128
};

// A field of extinction, 1/m; y is up, x is the way of the sun.
typedef struct cloud {
    uint32_t size[3];
    float sides[3]; // m
    float *extinction;
} cloud;

typedef struct experiment {
    const char *name;
    int field; // case
    float sun; // zenith angle, degrees
    float albedo, ground;
    bool brief;         // by `path` without TYN_LONG as well
    const char *missed; // which of R, T and A `pop` has farther off than 5 %, or NULL, and why
    const char *why;
} experiment;

// Of a homogeneous slab of depth 2 under this sun `pop` has T 4 % too large (0.746, `path` 0.719), of one of depth 10
// 1 % too small. The lattice solves its own equation right: a Monte Carlo of delta scaling with a linear phase
// function in its 14 directions has 0.744 +- 0.002. Two moments do not hold what this one sends up and down.
static const char *const low_sun =
    "what a thin layer scatters forward out of a low sun goes on straight, too short a way";
static const experiment experiments[] = {
    {"case1_exp1", 1, 0, 1, 0, false, NULL, NULL},
    {"case1_exp2", 1, 60, 1, 0, false, NULL, NULL},
    {"case1_exp4", 1, 60, 0.99f, 0, true, "TA", low_sun},
    {"case2_exp1", 2, 0, 1, 0, true, NULL, NULL},
    {"case2_exp4", 2, 60, 0.99f, 0, false, NULL, NULL},
    {"case2_exp5", 2, 60, 1, 0.4f, false, NULL, NULL},
    {"case3_exp1", 3, 0, 1, 0, false, NULL, NULL},
    {"case3_exp3", 3, 0, 0.99f, 0, false, NULL, NULL},
    {"case3_exp4", 3, 60, 0.99f, 0, true, NULL, NULL},
};
enum { NUM_EXPERIMENTS = sizeof experiments / sizeof experiments[0] };

// ---- the fields -------------------------------------------------------------------------------

// Skips the case where it is absent.
static FILE *open_file(const char *name)
{
    char path[512], below[128];
    snprintf(below, sizeof below, "reference/i3rc/%s", name);
    FILE *f = shared_path(path, sizeof path, below) ? fopen(path, "r") : NULL;
    if (!f) {
        skip_without(below);
    }
    return f;
}

static float *read_numbers(const char *name, size_t count)
{
    FILE *f = open_file(name);
    float *values = malloc(count * sizeof *values);
    for (size_t i = 0; i < count; i++) {
        if (fscanf(f, "%f", &values[i]) != 1) {
            fail_msg("%s: fewer than %zu numbers", name, count);
        }
    }
    fclose(f);
    return values;
}

static void make_cloud(cloud *c, uint32_t x, uint32_t y, uint32_t z)
{
    c->size[0] = x;
    c->size[1] = y;
    c->size[2] = z;
    c->extinction = calloc((size_t)x * y * z, sizeof(float));
}

static float *voxel(cloud *c, uint32_t x, uint32_t y, uint32_t z)
{
    return &c->extinction[((size_t)z * c->size[1] + y) * c->size[0] + x];
}

// 32 columns over 500 m, 250 m high: 16 of depth 2, 16 of depth 18.
static void step_cloud(cloud *c)
{
    enum { FINE = 8 * STEP_COLUMNS };
    *c = (cloud){.sides = {500, 250, 500}};
    make_cloud(c, FINE, 1, 1);
    for (uint32_t x = 0; x < FINE; x++) {
        *voxel(c, x, 0, 0) = (x < FINE / 2 ? 2 : 18) / 250.0f;
    }
}

// Depths of cells 50 m wide and 45 m high, the top first.
static void radar_cloud(cloud *c)
{
    float *tau = read_numbers("case2_tau_54x640.txt", (size_t)MMCR_ROWS * MMCR_X);
    *c = (cloud){.sides = {50.0f * MMCR_X, 45.0f * MMCR_Z, 1000}};
    make_cloud(c, FINER * MMCR_X, FINER * MMCR_Z, 1);
    for (uint32_t y = 0; y < FINER * MMCR_Z; y++) {
        for (uint32_t x = 0; x < FINER * MMCR_X; x++) {
            *voxel(c, x, y, 0) = tau[(MMCR_Z - 1 - y / FINER) * MMCR_X + x / FINER] / 45;
        }
    }
    free(tau);
}

// Columns 30 m wide with a depth and a height each, from their common base in layers of 20 m.
static void satellite_cloud(cloud *c)
{
    float *tau = read_numbers("case3_tau_128x128.txt", (size_t)SAT * SAT);
    float *high = read_numbers("case3_dz_128x128.txt", (size_t)SAT * SAT); // km
    const float layer = 20;
    float most = 0;
    for (int i = 0; i < SAT * SAT; i++) {
        most = (float)maximum(most, 1000 * high[i]);
    }
    const uint32_t layers = (uint32_t)ceilf(most / layer);
    *c = (cloud){.sides = {30.0f * SAT, layer * (float)layers, 30.0f * SAT}};
    make_cloud(c, SPLIT * SAT, layers, SPLIT * SAT);
    for (uint32_t z = 0; z < SPLIT * SAT; z++) {
        for (uint32_t x = 0; x < SPLIT * SAT; x++) {
            const uint32_t column = z / SPLIT * SAT + x / SPLIT;
            const float top = 1000 * high[column];
            for (uint32_t y = 0; y < layers && top > 0; y++) {
                float part = fminf(fmaxf(top / layer - (float)y, 0), 1); // of the layer
                *voxel(c, x, y, z) = part * tau[column] / top;
            }
        }
    }
    free(tau);
    free(high);
}

// ---- the scene --------------------------------------------------------------------------------

static void make_scene(tyn_scene *scene, const cloud *c, const experiment *e)
{
    tyn_scene_init(scene);
    const tyn_medium medium = grey_medium(e->albedo, e->albedo < 1 ? 1 - e->albedo : 0, 0.85f);
    tyn_shape *shape =
        scene_add_box(scene, &medium, (float[]){0, 0, 0}, c->sides, c->size, c->extinction);
    shape->repeat[0] = shape->repeat[2] = true;
    const float mu0 = cosf(e->sun * (float)M_PI / 180), irradiance = 1 / mu0;
    scene_add_sun(scene, sqrtf(1 - mu0 * mu0), -mu0, 0, irradiance, irradiance, irradiance);
    if (e->ground > 0) {
        uint32_t material =
            solids_material(scene, (float[]){e->ground, e->ground, e->ground}, (float[]){0, 0, 0});
        solids_quad(scene, (float[]){0, 0, 0}, (float[]){0, 0, c->sides[2]},
                    (float[]){c->sides[0], 0, 0}, material);
    }
}

typedef struct means {
    double value[3], se[3]; // R, T, A
} means;

// Where light of suns goes, followed from there. All of what comes down meets the ground, if there is one.
static void measure_path(tyn_offline *off, const tyn_scene *scene, const experiment *e,
                         uint32_t samples, means *m)
{
    tyn_view view = {.width = 1, .height = 1, .outputs = TYN_OUTPUT_FLUXES, .num_samples = samples};
    tyn_camera_frame_scene(&view.camera, scene);
    offline_frame(off, scene, &view);
    const tyn_fluxes *f = tyn_offline_output(off, TYN_OUTPUT_FLUXES);
    const tyn_flux_values *all[2] = {&f->mean, &f->se};
    double *to[2] = {m->value, m->se};
    for (int i = 0; i < 2; i++) {
        const double incident = f->mean.incident[0];
        to[i][0] = all[i]->reflected[0] / incident;
        to[i][1] =
            (e->ground > 0 ? all[i]->arriving_surfaces[0] : all[i]->transmitted[0]) / incident;
        to[i][2] = all[i]->absorbed_media[0] / incident;
    }
}

// Points over one period, one in every part of it, at `height`.
static uint32_t spread(const cloud *c, uint32_t nx, uint32_t nz, float height, float (*points)[3])
{
    uint32_t seed = 1;
    for (uint32_t i = 0; i < nx * nz; i++) {
        float jitter[2];
        for (int k = 0; k < 2; k++) {
            seed = seed * 1664525u + 1013904223u;
            jitter[k] = (float)(seed >> 8) / (1 << 24);
        }
        points[i][0] = c->sides[0] * ((float)(i % nx) + jitter[0]) / (float)nx;
        points[i][1] = height;
        points[i][2] = c->sides[2] * ((float)(i / nx) + jitter[1]) / (float)nz;
    }
    return nx * nz;
}

// From the balance, which is exact in a lattice, and the net flux at the bottom; at the top the lattice's flux is that
// of cells that reach over it.
static void measure_pop(tyn_offline *off, const tyn_scene *scene, const cloud *c,
                        const experiment *e, means *m)
{
    enum { NX = 256, NZ = 64 };
    static float points[NX * NZ][3];
    tyn_view view = {.width = 1, .height = 1, .outputs = TYN_OUTPUT_PROBE};
    view.num_points = spread(c, NX, NZ, 1e-5f * c->sides[1], points);
    view.points = (const float(*)[3])points;
    tyn_camera_frame_scene(&view.camera, scene);
    offline_frame(off, scene, &view);
    const tyn_probe_result *p = tyn_offline_output(off, TYN_OUTPUT_PROBE);
    double net = 0;
    for (uint32_t i = 0; i < view.num_points; i++) {
        net -= (double)p[i].flux[3] / view.num_points;
    }
    view.outputs = TYN_OUTPUT_BALANCE;
    view.num_points = 0;
    offline_frame(off, scene, &view);
    const tyn_balance *b = tyn_offline_output(off, TYN_OUTPUT_BALANCE);
    const double absorbed = b->absorbed_media[0] / b->entering[0];
    // The ground takes a part of what comes down.
    *m = (means){.value = {1 - absorbed - net, net / (1 - (double)e->ground), absorbed}};
}

// ---- against the consensus --------------------------------------------------------------------

// Means of the columns R, T and A; NAN where the file has none.
static void read_consensus(const char *name, double mean[3])
{
    char file[64], line[512];
    snprintf(file, sizeof file, "%s.csv", name);
    FILE *f = open_file(file);
    int column[3] = {-1, -1, -1};
    double sums[3] = {0};
    long rows = 0;
    bool heading = false;
    while (fgets(line, sizeof line, f)) {
        if (line[0] == '#') {
            continue;
        }
        int at = 0;
        for (char *word = strtok(line, ",\n"); word; word = strtok(NULL, ",\n"), at++) {
            for (int k = 0; k < 3; k++) {
                if (!heading && strlen(word) == 1 && word[0] == "RTA"[k]) {
                    column[k] = at;
                }
                sums[k] += heading && at == column[k] ? atof(word) : 0;
            }
        }
        rows += heading;
        heading = true;
    }
    fclose(f);
    assert_true(rows > 0);
    for (int k = 0; k < 3; k++) {
        mean[k] = column[k] >= 0 ? sums[k] / rows : NAN;
    }
    assert_false(isnan(mean[0])); // all files that are compared with have R
}

static const double consensus_off = 8e-4;

static bool check(const char *method, const experiment *e, const double consensus[3],
                  const means *m, double bound, const char *missed)
{
    bool good = true;
    const bool effort = getenv("TYN_LONG") != NULL;
    for (int k = 0; k < 3; k++) {
        if (isnan(consensus[k])) {
            continue;
        }
        const double off = m->value[k] - consensus[k];
        printf("%s %-5s %c %.5f +- %.5f, consensus %.5f: %+.2f %%\n", e->name, method, "RTA"[k],
               m -> value[k], m -> se[k], consensus[k], 100 * off / consensus[k]);
        const double allowed = bound * consensus[k] + 2 * m->se[k] + consensus_off;
        assert_true(m->se[k] <= (effort ? 0.25 : 0.5) * bound * consensus[k]);
        const bool known = missed && strchr(missed, "RTA"[k]);
        const bool holds = within(fabs(off), allowed, m->se[k] > 0 ? BOUND_NOISE : NULL,
                                  "%s, %s, %c", method, known ? e->name : "all", "RTA"[k]);
        good = todo_if(known, holds, e->why, "%s %s, %c", e->name, method, "RTA"[k]) && good;
    }
    return good;
}

static void open_field(int field, cloud *c)
{
    (field == 1 ? step_cloud : field == 2 ? radar_cloud : satellite_cloud)(c);
}

// The radar's field is 18 times as long as it is high.
static tyn_offline *open_method(gpu_test *t, const char *method, int field)
{
    tyn_settings *s = NULL;
    assert_int_equal(tyn_settings_create(&s), TYN_OK);
    assert_int_equal(tyn_settings_set(s, "lattice.cells", field == 2 ? "256" : "64", NULL), TYN_OK);
    tyn_offline *off = NULL;
    assert_int_equal(
        tyn_offline_create(t->dev, tyn_offline_params(.method = method, .settings = s), &off),
        TYN_OK);
    tyn_settings_destroy(&s);
    return off;
}

// All experiments of all fields.
static void run(gpu_test *t, const char *method, uint32_t samples, double bound)
{
    tyn_offline *off = NULL;
    cloud c = {0};
    bool good = true;
    int field = 0;
    for (int i = 0; i < NUM_EXPERIMENTS; i++) {
        const experiment *e = &experiments[i];
        if (samples && !e->brief && !getenv("TYN_LONG")) {
            continue;
        }
        if (e->field != field) {
            free(c.extinction);
            field = e->field;
            tyn_offline_destroy(&off);
            off = open_method(t, method, field);
            open_field(field, &c);
        }
        double consensus[3];
        read_consensus(e->name, consensus);
        means m;
        tyn_scene scene;
        make_scene(&scene, &c, e);
        if (samples) {
            measure_path(off, &scene, e, samples, &m);
        } else {
            measure_pop(off, &scene, &c, e, &m);
        }
        tyn_scene_finish(&scene);
        const char *missed = strcmp(method, "pop") ? NULL : e->missed;
        good = check(method, e, consensus, &m, bound, missed) && good;
    }
    free(c.extinction);
    tyn_offline_destroy(&off);
    assert_true(good);
}

static void by_path(void **state)
{
    run(*state, "path", path_effort(110), 0.005);
}

static void by_pop(void **state)
{
    run(*state, "pop", 0, 0.05);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(by_path), cmocka_unit_test(by_pop)};
    setvbuf(stdout, NULL, _IOLBF, 0);
    cmocka_set_test_filter(getenv("TYN_TEST_FILTER"));
    return run_cases(tests, gpu_setup, gpu_teardown);
}
