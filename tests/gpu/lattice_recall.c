// lattice_recall.c -- the last frame's solution at this frame's cells, against a linear field and sums in double precision.
#include "gpu_test.h"
#include "passes/lattice_recall/lattice_recall.h"
#include "shaders/lattice/lattice_args.h"
#include "shaders/common/scene_args.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { NX = 6, NY = 5, NZ = 4, N = NX * NY * NZ };

static const double pi = 3.14159265358979;

typedef struct frame { // M -> world
    float rows[3][4];
} frame;

typedef struct setup {
    tyn_lattice_recall_params params;
    struct {
        struct lattice_memory_block head;
        float moments[3 * N][4];
    } memory;
    float cells[3 * N][4], source[3 * N][4];
    struct env_block environment;
} setup;

static setup s; // large

// The field that is remembered, linear in the world: fluence, then flux.
static double field(const double p[3], int component)
{
    return component == 0 ? 5 + p[0] - 0.5 * p[1] + 0.25 * p[2]
                          : 0.3 * component + 0.1 * p[component - 1];
}

static void to_world(const float *rows, const double p[3], double w[3])
{
    for (int r = 0; r < 3; r++) {
        w[r] = (double)rows[4 * r + 3];
        for (int c = 0; c < 3; c++) {
            w[r] += (double)rows[4 * r + c] * p[c];
        }
    }
}

static const frame plain = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
static const frame turned = {{{0.8f, 0, 0.6f, 0.3f}, {0, 1, 0, 0.2f}, {-0.6f, 0, 0.8f, 0.9f}}};

// What was solved in a box of 3 m x 2.5 m x 2 m, in `then`; now the box is `now`, half as large.
static void start(uint32_t channels, const frame *then, const frame *now)
{
    memset(&s, 0, sizeof s);
    s.params.shape = (tyn_lattice_shape){
        .extent = {1.5f, 1.25f, 1}, .cells = NX, .channels = channels, .tint = {1, 0.5f, 0.25f}};
    memcpy(s.params.world, now->rows, sizeof now->rows);
    struct lattice_memory_block *m = &s.memory.head;
    memcpy(m->world, then->rows, sizeof then->rows);
    memcpy(&m->extent, (float[]){3, 2.5f, 2}, 12);
    memcpy(&m->dims, (uint32_t[]){NX, NY, NZ}, 12);
    memcpy(&m->tint, s.params.shape.tint, 12);
    m->channels = channels;
    srand(channels);
    for (uint32_t i = 0; i < channels * N; i++) {
        const int n = (int)(i % N), ch = (int)(i / N);
        const double p[3] = {0.5 * (n % NX + 0.5), 0.5 * (n / NX % NY + 0.5),
                             0.5 * (n / NX / NY + 0.5)};
        double w[3], flux[3];
        to_world(then->rows[0], p, w);
        for (int k = 0; k < 3; k++) {
            flux[k] = field(w, 1 + k);
        }
        s.memory.moments[i][0] = (float)((ch + 1) * field(w, 0));
        for (int k = 0; k < 3; k++) { // in the frame of the box
            for (int a = 0; a < 3; a++) {
                s.memory.moments[i][1 + k] +=
                    (float)((ch + 1) * (double)then->rows[a][k] * flux[a]);
            }
        }
        for (int k = 0; k < 4; k++) {
            s.cells[i][k] = (float)rand() / (float)RAND_MAX;
            s.source[i][k] = (float)rand() / (float)RAND_MAX - (k ? 0.5f : 0);
        }
        s.cells[i][0] *= ch ? 50 : 1; // where it is dense, all that enters collides
    }
    for (int c = 0; c < 3; c++) {
        s.environment.sky[c] = 0.2f * s.params.shape.tint[c];
    }
}

// What light puts into the cells, as the pass measures it.
static double power_of(uint32_t ch)
{
    const double dx = 0.25,
                 unhindered = 4 * pi * 0.2 *
                              (s.params.shape.channels == 1 ? 1 : (double)s.params.shape.tint[ch]);
    double sum = 0, scattering = 0;
    for (int i = 0; i < N; i++) {
        const float *cell = s.cells[ch * N + (uint32_t)i];
        sum += dx * dx * dx *
               ((double)(cell[0] * fabsf(s.source[ch * N + (uint32_t)i][0])) +
                4 * pi * (double)cell[3]);
        scattering += dx * dx * dx * (double)cell[0];
    }
    const double entering = 0.5 * (1.5 * 1.25 + 1.25 * 1 + 1 * 1.5) * unhindered;
    return sum + fmin(scattering * unhindered, entering);
}

static const float (*guess)[4];
static const float *power;

static void run(gpu_test *t)
{
    const tyn_pass_desc *pass = &tyn_pass_lattice_recall;
    const uint32_t channels = s.params.shape.channels;
    const tyn_extent size = {NX, NY, NZ * channels};
    tyn_ref refs[TYN_MAX_PORTS] = {{0}};
    tyn_graph_begin(t->graph);
    *gpu_port(pass, refs, "memory") = gpu_buffer(t, "memory", &s.memory, sizeof s.memory);
    *gpu_port(pass, refs, "cells") = gpu_image(t, "cells", TYN_IMAGE_3D, size, 4, s.cells[0]);
    *gpu_port(pass, refs, "source") = gpu_image(t, "source", TYN_IMAGE_3D, size, 4, s.source[0]);
    *gpu_port(pass, refs, "environment") =
        gpu_buffer(t, "environment", &s.environment, sizeof s.environment);
    assert_int_equal(tyn_graph_add(t->graph, pass, &s.params, refs), TYN_OK);
    tyn_graph_output(t->graph, "guess", *gpu_port(pass, refs, "guess"), true);
    tyn_graph_output(t->graph, "power", *gpu_port(pass, refs, "power"), true);
    gpu_run(t);
    guess = (const float(*)[4])gpu_map(t, "guess");
    power = gpu_map(t, "power");
    for (uint32_t ch = 0; ch < 3; ch++) {
        const double right = ch < channels ? power_of(ch) : 0;
        assert_true(fabs((double)power[ch] - right) <= 1e-5 * right);
    }
}

// `grown`: by how much what is remembered is scaled; 0: it is not taken, and all is as if unhindered. Where the linear
// field would have to be continued beyond the outermost cells' centres nothing is asked. Returns how many cells are new.
static int compare(double grown)
{
    int remembered = 0, fresh = 0;
    for (uint32_t i = 0; i < s.params.shape.channels * N; i++) {
        const int n = (int)(i % N), ch = (int)(i / N);
        const double p[3] = {0.25 * (n % NX + 0.5), 0.25 * (n / NX % NY + 0.5),
                             0.25 * (n / NX / NY + 0.5)};
        double w[3], then[3] = {0}, flux[4] = {0};
        to_world(s.params.world[0], p, w);
        for (int k = 0; k < 3; k++) {
            for (int a = 0; a < 3; a++) {
                const float *row = (const float *)&s.memory.head.world[a];
                then[k] += (double)row[k] * (w[a] - (double)row[3]);
                flux[1 + k] += (double)s.params.world[a][k] * field(w, 1 + a);
            }
        }
        flux[0] = field(w, 0);
        const float *size = (const float *)&s.memory.head.extent;
        bool amid = true, beyond = false;
        for (int a = 0; a < 3; a++) {
            amid = amid && then[a] > 0.2501 && then[a] < (double)size[a] - 0.2501;
            beyond = beyond || then[a] < -1e-4 || then[a] > (double)size[a] + 1e-4;
        }
        const double sky =
            4 * pi * 0.2 * (s.params.shape.channels == 1 ? 1 : (double)s.params.shape.tint[ch]);
        for (int k = 0; k < 4; k++) {
            const double found = (double)guess[i][k];
            if (grown <= 0 || beyond) {
                assert_true(fabs(found - (k ? 0 : sky)) < 1e-5);
            } else if (amid) {
                assert_true(fabs(found - grown * (ch + 1) * flux[k]) < 1e-4 * grown * (ch + 1));
            }
        }
        remembered += grown > 0 && amid;
        fresh += beyond;
    }
    print_message("%d cells remember, %d are new\n", remembered, fresh);
    assert_true(grown <= 0 || remembered >= N / 10);
    return fresh;
}

// Boxes that are turned and moved; cells that were not in the last one's.
static void places(void **state)
{
    const frame *const frames[] = {&plain, &turned};
    int fresh = 0;
    for (int i = 0; i < 8; i++) {
        start(i / 4 ? 3 : 1, frames[i & 1], frames[i >> 1 & 1]);
        for (uint32_t ch = 0; ch < s.params.shape.channels; ch++) {
            ((float *)&s.memory.head.power)[ch] = (float)power_of(ch);
        }
        run(*state);
        fresh += compare(1);
    }
    assert_true(fresh > N / 2);
}

// Much more light, or less, scales it; a little is left to the sweeps; another light, or no solution, starts anew.
static void other_light(void **state)
{
    const double ratios[] = {1.4, 0.7, 3, 0.25, 17, 0.05}, grown[] = {1, 1, 3, 0.25, 0, 0};
    for (int i = 0; i < 9; i++) {
        start(3, &turned, &turned);
        for (uint32_t ch = 0; ch < 3; ch++) {
            ((float *)&s.memory.head.power)[ch] = (float)(power_of(ch) / (i < 6 ? ratios[i] : 1));
        }
        if (i == 6) {
            s.memory.head.channels = 0;
        }
        if (i == 7) {
            ((float *)&s.memory.head.tint)[1] = 0.9f;
        }
        if (i == 8) {
            for (int k = 0; k < 3 * N; k++) {
                s.memory.moments[k][2] = NAN;
            }
        }
        run(*state);
        compare(i < 6 ? grown[i] : 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(places), cmocka_unit_test(other_light)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
