// impostor_camera.c -- a node that holds what it has made: until its key changes, or for so many frames with something new.
#include "gpu_test.h"
#include "passes/photon/impostor_camera/impostor_camera.h"
#include "shaders/common/scene_args.h"

// The camera of a march after a frame in which it could have been made at x.
static float taken_at(gpu_test *t, float x, tyn_hold hold)
{
    const tyn_impostor_camera_params params = {
        .camera = {.origin = {x, 2 * x, 0}, .half_width = 1, .size = {4, 4}}, .hold = hold};
    tyn_ref refs[TYN_MAX_PORTS] = {{0}};
    tyn_graph_begin(t->graph);
    refs[IMPOSTOR_CAMERA_PORT_TAKEN] =
        tyn_graph_history_buffer(t->graph, "taken", sizeof params.camera, hold.key);
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_impostor_camera, &params, refs), TYN_OK);
    tyn_graph_output(t->graph, "taken", refs[IMPOSTOR_CAMERA_PORT_TAKEN], true);
    gpu_run(t);
    const struct camera_block *taken = gpu_map(t, "taken");
    assert_true(taken->origin[1] == 2 * taken->origin[0] && taken->size[1] == 4);
    return taken->origin[0];
}

static void held(void **state)
{
    gpu_test *t = *state;
    const tyn_hold always = {.key = 1, .frames = UINT32_MAX}, other = {2, UINT32_MAX, 0},
                   third = {3, 3, 0}, never = {4, 0, 0};
    assert_true(taken_at(t, 1, always) == 1);
    assert_true(taken_at(t, 2, always) == 1);
    assert_true(taken_at(t, 3, always) == 1);
    assert_true(taken_at(t, 4, other) == 4);
    assert_true(taken_at(t, 5, other) == 4);
    // Every third frame with something new; those with nothing new do not count.
    assert_true(taken_at(t, 6, third) == 6);
    assert_true(taken_at(t, 6, third) == 6);
    assert_true(taken_at(t, 7, third) == 6);
    assert_true(taken_at(t, 8, third) == 6);
    assert_true(taken_at(t, 9, third) == 9);
    assert_true(taken_at(t, 10, third) == 9);
    for (int k = 11; k < 14; k++) {
        assert_true(taken_at(t, (float)k, never) == (float)k);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(held)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
