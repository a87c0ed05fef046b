// path_fluence.c -- probes of `path` against fluence in the cells of a cube and power through its faces
// (own Monte Carlo, tied to DISORT and pbrt).
//
// Asserted: the mean difference of each layer of cells along the light, of all cells, and of each face, within 3
// combined standard errors (4096 cells and 6 faces a g; points are drawn at random in every cell and face).
#include "npy.h"
#include "numbers.h"
#include "path_scene.h"
#include "skip.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CELLS = 16, NUM_CELLS = CELLS * CELLS * CELLS, FACE_POINTS = 2048 };

static float random_unit(void)
{
    static uint64_t state = 88172645463325252ull;
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return (float)(state >> 40) * 0x1p-24f;
}

static void make_cube(path_scene *s, float g)
{
    path_scene_box(s, (float[]){1, 1, 1}, (float[]){4, 4, 4}, (float[]){0, 0, 0},
                   (float[]){g, g, g}, NULL, NULL);
    path_scene_sun(s, (float[]){1, 0, 0}, (float[]){1, 1, 1});
    s->params.scattered = 1;
    s->params.seed = (uint32_t)(g * 10);
}

// Mean and standard error of what is added.
typedef struct tally {
    double n, sum, squares;
} tally;

static void add(tally *t, double x)
{
    t->n++;
    t->sum += x;
    t->squares += x * x;
}

static double mean(const tally *t)
{
    return t->sum / t->n;
}

static double error(const tally *t)
{
    return sqrt(maximum(t->squares / t->n - mean(t) * mean(t), 0) / (t->n - 1));
}

static void fluence_of_cells(void **state)
{
    static float points[NUM_CELLS][3];
    for (int k = 0; k < 3; k++) {
        float g = (const float[]){0, 0.5f, 0.9f}[k];
        char name[64], path[512];
        npy_array ref;
        snprintf(name, sizeof name, "reference/cube_fluence_g%.2f.npy", (double)g);
        if (!shared_path(path, sizeof path, name)) {
            skip_without(name);
        }
        assert_true(npy_read(&ref, path));
        for (int i = 0; i < NUM_CELLS; i++) {
            const int cell[3] = {i % CELLS, i / CELLS % CELLS, i / CELLS / CELLS};
            for (int a = 0; a < 3; a++) {
                points[i][a] = ((float)cell[a] + random_unit()) / CELLS;
            }
        }
        path_scene s;
        make_cube(&s, g);
        s.samples = 64;
        const tyn_probe_result *p =
            path_scene_probe(*state, &s, (const float(*)[3])points, NUM_CELLS, 256);
        tally all = {0}, layers[CELLS] = {{0}};
        double var_ref = 0, sum_ref = 0;
        for (int i = 0; i < NUM_CELLS; i++) {
            double difference = (double)p[i].fluence[0] - (double)ref.data[2 * i];
            add(&all, difference);
            add(&layers[i % CELLS], difference);
            sum_ref += ref.data[2 * i];
            var_ref += (double)ref.data[2 * i + 1] * ref.data[2 * i + 1];
        }
        double se = sqrt(error(&all) * error(&all) + var_ref / NUM_CELLS / NUM_CELLS);
        printf("fluence g %.1f: mean %.5f, difference %+.5f +- %.5f (z %+.2f)\n", (double)g,
               sum_ref / NUM_CELLS, mean(&all), se, mean(&all) / se);
        assert_true(fabs(mean(&all)) <= 3 * se);
        double worst = 0;
        for (int i = 0; i < CELLS; i++) {
            worst = maximum(worst, fabs(mean(&layers[i]) / error(&layers[i])));
        }
        printf("    layers: largest z %.2f\n", worst);
        assert_true(worst <= 3.5); // the largest of 16
        npy_free(&ref);
    }
}

// Power that leaves through a face after scattering: the flux there, as nothing scattered comes in.
static double face_reference(float g, const char *face, double *se)
{
    char path[512], line[256];
    if (!shared_path(path, sizeof path, "reference/cube_face_flux.csv")) {
        return -1;
    }
    FILE *f = fopen(path, "r");
    double power = -1;
    while (f && fgets(line, sizeof line, f)) {
        double row_g;
        char row_face[64];
        double p, e;
        if (sscanf(line, "%lf,%63[^,],%lf,%lf", &row_g, row_face, &p, &e) == 4 &&
            fabs(row_g - (double)g) < 1e-6 && !strcmp(row_face, face)) {
            power = p;
            *se = e;
        }
    }
    if (f) {
        fclose(f);
    }
    return power;
}

static void power_through_faces(void **state)
{
    static const char *const faces[] = {"entry(x=0)", "exit(x=1) diffuse", "y=0", "y=1", "z=0",
                                        "z=1"};
    static float points[6 * FACE_POINTS][3];
    for (int k = 0; k < 3; k++) {
        float g = (const float[]){0, 0.5f, 0.9f}[k];
        for (int i = 0; i < 6 * FACE_POINTS; i++) {
            int face = i / FACE_POINTS;
            for (int a = 0; a < 3; a++) {
                points[i][a] = random_unit();
            }
            points[i][face / 2] = face % 2 ? 1 - 1e-6f : 1e-6f;
        }
        path_scene s;
        make_cube(&s, g);
        s.samples = 64;
        const tyn_probe_result *p =
            path_scene_probe(*state, &s, (const float(*)[3])points, 6 * FACE_POINTS, 256);
        for (int face = 0; face < 6; face++) {
            double se_ref = 0, ref = face_reference(g, faces[face], &se_ref);
            if (ref < 0) {
                skip_without("reference/cube_face_flux.csv");
            }
            tally t = {0};
            for (int i = 0; i < FACE_POINTS; i++) {
                double flux = p[face * FACE_POINTS + i].flux[face / 2 * 3];
                add(&t, face % 2 ? flux : -flux);
            }
            double z = (mean(&t) - ref) / hypot(error(&t), se_ref);
            printf("power g %.1f %-18s %.5f +- %.5f  reference %.5f  z %+.2f\n", (double)g,
                   faces[face], mean(&t), error(&t), ref, z);
            assert_true(fabs(z) <= 3);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fluence_of_cells),
        cmocka_unit_test(power_through_faces),
    };
    setvbuf(stdout, NULL, _IOLBF, 0);
    return run_cases(tests, gpu_setup, gpu_teardown);
}
