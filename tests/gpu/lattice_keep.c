// lattice_keep.c -- what is put away for the next frame is what was solved, to the bit.
#include "gpu_test.h"
#include "passes/lattice_recall/lattice_recall.h"
#include "passes/lattice_keep/lattice_keep.h"
#include "shaders/lattice/lattice_args.h"
#include <stdlib.h>
#include <string.h>

enum { NX = 5, NY = 4, NZ = 3, N = NX * NY * NZ };

static void kept(void **state)
{
    gpu_test *t = *state;
    const tyn_pass_desc *pass = &tyn_pass_lattice_keep;
    for (uint32_t channels = 1; channels <= 3; channels += 2) {
        static float moments[3 * N][4];
        srand(channels);
        for (uint32_t i = 0; i < channels * N * 4; i++) {
            moments[i / 4][i % 4] = (float)rand() / (float)RAND_MAX - 0.3f;
        }
        const float power[3] = {3, 0.25f, 7};
        const tyn_lattice_recall_params params = {
            .shape = {.extent = {2.5f, 2, 1.5f},
                      .cells = NX,
                      .channels = channels,
                      .tint = {1, 0.5f, 0.25f}},
            .world = {{0.8f, 0, 0.6f, 1}, {0, 1, 0, -2}, {-0.6f, 0, 0.8f, 3}}};
        tyn_ref refs[TYN_MAX_PORTS] = {{0}};
        tyn_graph_begin(t->graph);
        *gpu_port(pass, refs, "moments") = gpu_image(
            t, "moments", TYN_IMAGE_3D, (tyn_extent){NX, NY, NZ * channels}, 4, moments[0]);
        *gpu_port(pass, refs, "power") = gpu_buffer(t, "power", power, sizeof power);
        *gpu_port(pass, refs, "memory") =
            tyn_graph_history_buffer(t->graph, "memory", tyn_lattice_memory_size(NX, channels), 1);
        assert_int_equal(tyn_graph_add(t->graph, pass, &params, refs), TYN_OK);
        tyn_graph_output(t->graph, "memory", *gpu_port(pass, refs, "memory"), true);
        gpu_run(t);
        const struct lattice_memory_block *memory = gpu_map(t, "memory");
        assert_memory_equal(memory + 1, moments, channels * N * sizeof *moments);
        assert_memory_equal(memory->world, params.world, sizeof params.world);
        assert_memory_equal(&memory->extent, params.shape.extent, sizeof params.shape.extent);
        assert_memory_equal(&memory->dims, ((uint32_t[]){NX, NY, NZ}), 12);
        assert_memory_equal(&memory->tint, params.shape.tint, sizeof params.shape.tint);
        assert_memory_equal(&memory->power, power, sizeof power);
        assert_int_equal(memory->channels, channels);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(kept)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
