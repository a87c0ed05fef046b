// balance.c -- where the energy goes, against the same sums in double precision.
#include "gpu_test.h"
#include "shaders/lattice/lattice_power.h"
#include "shaders/light/ordinate_args.h"
#include "passes/balance/balance.h"
#include "shaders/common/scene_args.h"
#include <tyndall/context.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { NX = 5, NY = 4, NZ = 3, N = NX * NY * NZ, LEAKS = 37, SUNS = 2, GROUPS = 3 };

typedef struct setup {
    tyn_balance_params params;
    struct medium_block medium;
    struct env_block environment;
    struct light_block lights[TYN_LIGHTS_MAX];
    struct ordinates_block ordinates;
    float cells[3][N][4], moments[3][N][4], source[3][N][4], leaks[3][LEAKS], walls[3][N][2];
    struct lattice_power power[SUNS * 3];
    struct lattice_lamp_power lamps[GROUPS * 3];
    bool with_source, with_walls;
} setup;

static float any(void)
{
    return 0.1f + (float)rand() / (float)RAND_MAX;
}

static void fill(setup *s, uint32_t channels)
{
    memset(s, 0, sizeof *s);
    srand(channels);
    s->params.channels = channels;
    for (int c = 0; c < 3; c++) {
        s->params.tint[c] = channels == 1 ? 1 / (float)(1 + c) : 1;
        s->environment.sky[c] = 0.3f * s->params.tint[c];
        s->medium.extent[c] = (float[]){2.5f, 2, 1.5f}[c];
        for (int i = 0; i < N; i++) {
            for (int k = 0; k < 4; k++) {
                s->cells[c][i][k] = any();
                s->moments[c][i][k] = any();
                s->source[c][i][k] = any();
            }
            s->walls[c][i][0] = any();
            s->walls[c][i][1] = any();
        }
        for (int i = 0; i < LEAKS; i++) {
            s->leaks[c][i] = any() - 0.3f;
        }
        for (int n = 0; n < SUNS; n++) {
            s->lights[n].color[c] = (float)(n + 1) * s->params.tint[c];
            s->power[n * 3 + c].entering = any();
            s->power[n * 3 + c].scale = any();
        }
        for (int n = 0; n < GROUPS; n++) {
            s->lamps[n * 3 + c].entering = any();
            s->lamps[n * 3 + c].emitted = any();
            s->lamps[n * 3 + c].scale = n == 0 && c == 0 ? 0 : any(); // no light there
        }
    }
    s->ordinates.count = 3;
    for (int n = 0; n < 3; n++) {
        struct ordinate *o = &s->ordinates.list[n];
        for (int c = 0; c < 3; c++) {
            o->direction[c] = n == c ? -0.6f : c == (n + 1) % 3 ? 0.8f : 0;
            o->irradiance[c] = 0.2f * (float)(n + 1) * s->params.tint[c];
        }
    }
}

static const tyn_balance *run(gpu_test *t, const setup *s)
{
    const tyn_pass_desc *pass = &tyn_pass_balance;
    const uint32_t channels = s->params.channels;
    const tyn_extent size = {NX, NY, NZ * channels};
    // Of one channel what follows each other by channel is packed.
    struct lattice_power power[SUNS * 3];
    struct lattice_lamp_power lamps[GROUPS * 3];
    for (uint32_t i = 0; i < SUNS * channels; i++) {
        power[i] = s->power[i / channels * 3 + i % channels];
    }
    for (uint32_t i = 0; i < GROUPS * channels; i++) {
        lamps[i] = s->lamps[i / channels * 3 + i % channels];
    }
    tyn_ref refs[TYN_MAX_PORTS] = {{0}};
    tyn_graph_begin(t->graph);
    *gpu_port(pass, refs, "medium") = gpu_buffer(t, "medium", &s->medium, sizeof s->medium);
    *gpu_port(pass, refs, "lights") = gpu_buffer(t, "lights", s->lights, sizeof s->lights);
    *gpu_port(pass, refs, "cells") = gpu_image(t, "cells", TYN_IMAGE_3D, size, 4, s->cells[0][0]);
    *gpu_port(pass, refs, "moments") =
        gpu_image(t, "moments", TYN_IMAGE_3D, size, 4, s->moments[0][0]);
    if (s->with_source) {
        *gpu_port(pass, refs, "source") =
            gpu_image(t, "source", TYN_IMAGE_3D, size, 4, s->source[0][0]);
    }
    *gpu_port(pass, refs, "power") = gpu_buffer(t, "power", power, sizeof power);
    *gpu_port(pass, refs, "leaks") =
        gpu_buffer(t, "leaks", s->leaks, channels * LEAKS * sizeof(float));
    *gpu_port(pass, refs, "environment") =
        gpu_buffer(t, "environment", &s->environment, sizeof s->environment);
    *gpu_port(pass, refs, "ordinates") =
        gpu_buffer(t, "ordinates", &s->ordinates, sizeof s->ordinates);
    *gpu_port(pass, refs, "lamp_power") = gpu_buffer(t, "lamp_power", lamps, sizeof lamps);
    if (s->with_walls) {
        *gpu_port(pass, refs, "wall_power") =
            gpu_buffer(t, "wall_power", s->walls, channels * N * 2 * sizeof(float));
    }
    assert_int_equal(tyn_graph_add(t->graph, pass, &s->params, refs), TYN_OK);
    tyn_graph_output(t->graph, "balance", *gpu_port(pass, refs, "balance"), true);
    gpu_run(t);
    return gpu_map(t, "balance");
}

static void expect(const char *what, double found, double right)
{
    if (!(fabs(found - right) <= 1e-5 * (1 + fabs(right)))) {
        fail_msg("%s: %g, not %g", what, found, right);
    }
}

// Of one channel: in units of the tint.
static void compare(const setup *s, const tyn_balance *found)
{
    const bool one = s->params.channels == 1;
    const float *extent = s->medium.extent;
    const double volume = 0.125,
                 faces[3] = {(double)(extent[1] * extent[2]), (double)(extent[2] * extent[0]),
                             (double)(extent[0] * extent[1])};
    for (int c = 0; c < 3; c++) {
        const int k = one ? 0 : c;
        const double unit = one ? (double)s->params.tint[c] : 1;
        double entering = 0, emitted = 0, absorbed = 0, collided = 0, escaped = 0, walls = 0;
        for (int a = 0; a < 3; a++) {
            entering += acos(-1) * (double)s->environment.sky[c] / unit * 2 * faces[a];
            for (uint32_t n = 0; n < s->ordinates.count; n++) {
                entering += (double)s->ordinates.list[n].irradiance[c] / unit *
                            fabs((double)s->ordinates.list[n].direction[a]) * faces[a];
            }
        }
        for (uint32_t n = 0; n < s->params.num_suns; n++) {
            entering += (double)s->lights[n].color[c] / unit * (double)s->power[n * 3 + k].entering;
        }
        for (uint32_t n = 0; n < s->params.num_groups; n++) {
            entering += (double)s->lamps[n * 3 + k].entering;
            emitted += (double)s->lamps[n * 3 + k].emitted;
            escaped += (double)s->lamps[n * 3 + k].emitted; // what does not collide
        }
        for (int i = 0; i < N; i++) {
            const float *cell = s->cells[k][i];
            const double beams = s->with_source ? (double)s->source[k][i][0] : 0;
            absorbed += volume * (double)cell[1] * ((double)s->moments[k][i][0] + beams);
            emitted += volume * 4 * acos(-1) * (double)cell[3];
            collided += volume * (double)(cell[0] + cell[1]) * beams;
            walls += s->with_walls ? (double)s->walls[k][i][0] : 0;
            emitted += s->with_walls ? (double)s->walls[k][i][1] : 0;
        }
        escaped += entering - collided;
        for (int i = 0; i < LEAKS; i++) {
            escaped += (double)s->leaks[k][i];
        }
        expect("entering", found->entering[c], unit * entering);
        expect("emitted", found->emitted[c], unit * emitted);
        expect("absorbed by media", found->absorbed_media[c], unit * absorbed);
        expect("absorbed by surfaces", found->absorbed_surfaces[c], unit * walls);
        expect("escaped", found->escaped[c], unit * escaped);
        expect("imbalance", found->imbalance[c],
               1 - (absorbed + walls + escaped) / (entering + emitted));
    }
}

static void widen(double range[2], double scale)
{
    range[0] = scale > 0 && (range[1] == 0 || scale < range[0]) ? scale : range[0];
    range[1] = fmax(range[1], scale);
}

// The factors by kind of light, those of no light left out.
static void compare_scales(const setup *s, const tyn_balance *found)
{
    double suns[2] = {0}, lamps[2] = {0}, vpls[2] = {0};
    for (uint32_t c = 0; c < s->params.channels; c++) {
        for (uint32_t n = 0; n < s->params.num_suns; n++) {
            widen(suns, (double)s->power[n * 3 + c].scale);
        }
        for (uint32_t n = 0; n < s->params.num_groups; n++) {
            const bool vpl = n + s->params.vpls >= s->params.num_groups && s->params.vpls;
            widen(vpl ? vpls : lamps, (double)s->lamps[n * 3 + c].scale);
        }
    }
    for (int i = 0; i < 2; i++) {
        expect("factors of suns", found->scale_suns[i], suns[i]);
        expect("factors of lamps", found->scale_lamps[i], lamps[i]);
        expect("factors of VPLs", found->scale_vpls[i], vpls[i]);
    }
}

static void sums(void **state)
{
    static setup s;
    for (int variant = 0; variant < 5; variant++) {
        fill(&s, variant < 3 ? 3 : 1);
        s.with_source = variant != 1;
        s.with_walls = variant >= 2;
        s.params.num_suns = variant == 1 ? 0 : SUNS;
        s.params.num_groups = variant == 0 ? 0 : GROUPS;
        s.params.vpls = variant >= 2 && variant != 4;
        const tyn_balance *found = run(*state, &s);
        compare(&s, found);
        compare_scales(&s, found);
    }
}

// Nothing given is nothing amiss.
static void darkness(void **state)
{
    static setup s;
    memset(&s, 0, sizeof s);
    s.params.channels = 3;
    s.medium.extent[0] = s.medium.extent[1] = s.medium.extent[2] = 1;
    const tyn_balance *found = run(*state, &s);
    const tyn_balance none = {{0}};
    assert_memory_equal(found, &none, sizeof none);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(sums), cmocka_unit_test(darkness)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
