// resume.c -- samples that one context takes up from another's: the same picture, and what is refused.
#include "bound.h"
#include "built_in.h"
#include "gpu_test.h"
#include "numbers.h"
#include "offline_frame.h"
#include "picture.h"
#include "solids.h"
#include <float.h>
#include <math.h>
#include <string.h>

enum { SIZE = 16, FLOATS = 4 * SIZE * SIZE, FIRST = 48, MORE = 80, NUM = 8 };

static const tyn_output outputs[NUM] = {
    TYN_OUTPUT_RADIANCE, TYN_OUTPUT_LOW,      TYN_OUTPUT_DEVIATION,     TYN_OUTPUT_ERROR,
    TYN_OUTPUT_SINGLE,   TYN_OUTPUT_MULTIPLE, TYN_OUTPUT_TRANSMITTANCE, TYN_OUTPUT_ALBEDO};

typedef struct pictures {
    float values[NUM][FLOATS];
} pictures;

// Smoke over a floor that covers half of the picture, in a sun and a sky.
static void set_scene(tyn_scene *scene, tyn_view *view)
{
    tyn_scene_init(scene);
    const tyn_medium medium = grey_medium(1.5f, 0.5f, 0.3f);
    scene_add_box(scene, &medium, (float[]){0, 0, 0}, (float[]){1, 1, 1}, NULL, NULL);
    scene_add_sun(scene, 1, -1, 0, 2, 1.5f, 1);
    scene_set_sky(scene, 0.25f);
    const uint32_t grey = solids_material(scene, (float[]){0.5f, 0.25f, 0.75f}, (float[]){0, 0, 0});
    solids_quad(scene, (float[]){-1, 0.5f, -1}, (float[]){0, 0, 3}, (float[]){3, 0, 0}, grey);
    solids_hierarchy(scene, 1);
    view_orthographic(view, (float[]){0.5f, 0.5f, 0.5f}, 0, -0.6f, -0.8f, (float[]){0, 1, 0}, 0.8f,
                      SIZE);
    view->outputs = 0;
    for (int i = 0; i < NUM; i++) {
        view->outputs |= outputs[i];
    }
}

static void take(tyn_offline *off, pictures *p)
{
    for (int i = 0; i < NUM; i++) {
        const float *from = tyn_offline_output(off, outputs[i]);
        assert_non_null(from);
        memcpy(p->values[i], from, sizeof p->values[i]);
    }
}

// On a card the samples of a record follow measured times, and merges of other samples round otherwise (path_threads.c):
// by so much in units of the samples' size and spread, at most.
static void nearly_same(const pictures *a, const pictures *b, uint32_t samples)
{
    const double rounding = 4 * sqrt(samples) * 0.5 * (double)FLT_EPSILON;
    double most = 0;
    for (int k = 0; k < FLOATS; k++) {
        const double error = (double)a->values[3][k],
                     size = k % 4 == 3 ? 1 // alpha
                                       : fabs((double)a->values[0][k]) + sqrt(samples) * error;
        for (int i = 0; i < NUM; i++) {
            const double x = (double)a->values[i][k], y = (double)b->values[i][k];
            const double off = outputs[i] == TYN_OUTPUT_ERROR ? fabs(x * x - y * y) : fabs(x - y);
            const double unit = outputs[i] == TYN_OUTPUT_DEVIATION       ? samples * size * size
                                : outputs[i] == TYN_OUTPUT_ERROR         ? size * size / samples
                                : outputs[i] == TYN_OUTPUT_TRANSMITTANCE ? 1
                                                                         : size;
            most = maximum(most, off > 0 ? off / unit : 0);
        }
    }
    assert_true(within(most, rounding, BOUND_ROUNDING, "largest difference of a pixel"));
}

static void same_bits(const pictures *a, const pictures *b)
{
    for (int i = 0; i < NUM; i++) {
        for (int k = 0; k < FLOATS; k++) {
            if (memcmp(&a->values[i][k], &b->values[i][k], sizeof(float)) != 0) {
                fail_msg("%s, value %d: %.9g, not %.9g", tyn_output_name(outputs[i]), k,
                         (double)b->values[i][k], (double)a->values[i][k]);
            }
        }
    }
}

static void same(const gpu_test *t, const pictures *a, const pictures *b, uint32_t samples)
{
    if (t->dev->capacity.software) {
        same_bits(a, b);
    } else {
        nearly_same(a, b, samples);
    }
}

static tyn_resume resume_of(const pictures *p)
{
    return (tyn_resume){.num_samples = FIRST,
                        .radiance = p->values[0],
                        .low = p->values[1],
                        .deviation = p->values[2],
                        .single = p->values[4],
                        .multiple = p->values[5],
                        .transmittance = p->values[6],
                        .hash = 1};
}

// Some samples and then more in one context; the same with another context for the rest, in one frame and in three.
static void same_picture(void **state)
{
    gpu_test *t = *state;
    static pictures first, whole, other;
    tyn_scene scene;
    tyn_view view = {0};
    set_scene(&scene, &view);
    tyn_offline *off = scene_open(t->dev, "path", NULL);
    view.num_samples = FIRST;
    offline_frame(off, &scene, &view);
    assert_int_equal(tyn_offline_samples(off), FIRST);
    take(off, &first);
    view.first_sample = FIRST;
    view.num_samples = MORE;
    offline_frame(off, &scene, &view);
    take(off, &whole);
    tyn_offline_destroy(&off);

    const tyn_resume resume = resume_of(&first);
    for (int parts = 1; parts <= 2; parts++) {
        off = scene_open(t->dev, "path", NULL);
        view.resume = &resume;
        view.first_sample = FIRST;
        view.num_samples = MORE;
        offline_frame(off, &scene, &view);
        take(off, &other);
        same(t, &whole, &other, FIRST + MORE);
        if (parts == 2) { // what has been taken up goes on as anything does
            static pictures longer, again;
            view.first_sample = FIRST + MORE;
            offline_frame(off, &scene, &view);
            take(off, &longer);
            view.first_sample = FIRST; // from there once more, in the same context
            offline_frame(off, &scene, &view);
            take(off, &again);
            same(t, &whole, &again, FIRST + MORE);
            assert_true(memcmp(longer.values[0], whole.values[0], sizeof whole.values[0]) != 0);
        }
        tyn_offline_destroy(&off);
    }

    // Without the sums it is another picture.
    static pictures rounded;
    rounded = first;
    memset(rounded.values[1], 0, sizeof rounded.values[1]);
    tyn_resume lossy = resume_of(&rounded);
    lossy.hash = 2;
    off = scene_open(t->dev, "path", NULL);
    view.resume = &lossy;
    view.first_sample = FIRST;
    offline_frame(off, &scene, &view);
    take(off, &other);
    assert_true(memcmp(other.values[0], whole.values[0], sizeof whole.values[0]) != 0);
    tyn_offline_destroy(&off);
    tyn_scene_finish(&scene);
}

static void same_picture_on_a_card(void **state)
{
    gpu_test *t = *state;
    const tyn_capacity own = t->dev->capacity;
    t->dev->capacity = (tyn_capacity){.short_loops = own.short_loops, .threads = 4096};
    same_picture(state);
    t->dev->capacity = own;
}

// Samples [FIRST, FIRST + MORE) alone: with those before they make the mean of all.
static void offset(void **state)
{
    gpu_test *t = *state;
    static pictures first, rest, whole;
    tyn_scene scene;
    tyn_view view = {0};
    set_scene(&scene, &view);
    const uint32_t begin[3] = {0, FIRST, 0}, count[3] = {FIRST, MORE, FIRST + MORE};
    pictures *const to[3] = {&first, &rest, &whole};
    for (int i = 0; i < 3; i++) {
        tyn_offline *off = scene_open(t->dev, "path", NULL);
        view.sample_offset = begin[i];
        view.num_samples = count[i];
        offline_frame(off, &scene, &view);
        take(off, to[i]);
        tyn_offline_destroy(&off);
    }
    for (int k = 0; k < FLOATS; k++) {
        const double mean = ((double)FIRST * (double)first.values[0][k] +
                             (double)MORE * (double)rest.values[0][k]) /
                            (FIRST + MORE);
        assert_true(fabs(mean - (double)whole.values[0][k]) <= 1e-6 * (1 + fabs(mean)));
    }
    assert_true(memcmp(first.values[0], rest.values[0], sizeof rest.values[0]) != 0);
    tyn_scene_finish(&scene);
}

static void refused(gpu_test *t, const char *method, const tyn_scene *scene, const tyn_view *view)
{
    tyn_offline *off = scene_open(t->dev, method, NULL);
    assert_int_equal(tyn_offline_frame(off, scene, view, false), TYN_ERR_PARAMS);
    tyn_offline_destroy(&off);
}

static void wrong(void **state)
{
    gpu_test *t = *state;
    static pictures some;
    tyn_scene scene;
    tyn_view view = {0};
    set_scene(&scene, &view);
    view.first_sample = FIRST;
    view.num_samples = 1;
    const tyn_resume right = resume_of(&some);
    tyn_resume resume = right;
    view.resume = &resume;
    t->quiet = true;
    resume.low = NULL;
    refused(t, "path", &scene, &view);
    resume = right;
    resume.hash = 0;
    refused(t, "path", &scene, &view);
    resume = right;
    resume.single = NULL; // an output of the view
    refused(t, "path", &scene, &view);
    resume = right;
    view.first_sample = FIRST - 1;
    refused(t, "path", &scene, &view);
    view.first_sample = FIRST;
    view.outputs = TYN_OUTPUT_RADIANCE;
    refused(t, "pop", &scene, &view);
    t->quiet = false;
    tyn_scene_finish(&scene);
}

// All methods that draw surfaces tell the same of them.
static void guides(void **state)
{
    gpu_test *t = *state;
    static const char *const methods[] = {"path", "pop",    "pop-paper",
                                          "lpv",  "photon", "constellation"};
    static float albedo[FLOATS], normal[FLOATS];
    tyn_scene scene;
    tyn_view view = {0};
    set_scene(&scene, &view);
    view.outputs = TYN_OUTPUT_ALBEDO | TYN_OUTPUT_NORMAL;
    view.num_samples = 1;
    for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
        if (!is_built_in(methods[m])) {
            continue;
        }
        tyn_offline *off = scene_open(t->dev, methods[m], NULL);
        offline_frame(off, &scene, &view);
        const float *a = tyn_offline_output(off, TYN_OUTPUT_ALBEDO);
        const float *n = tyn_offline_output(off, TYN_OUTPUT_NORMAL);
        assert_true(a && n);
        if (m == 0) {
            memcpy(albedo, a, sizeof albedo);
            memcpy(normal, n, sizeof normal);
            const float *middle = &a[4 * (SIZE / 2 * SIZE + SIZE / 2)];
            const float *up = &n[4 * (SIZE / 2 * SIZE + SIZE / 2)];
            assert_true(fabsf(middle[0] - 0.5f) < 1e-5f && fabsf(middle[2] - 0.75f) < 1e-5f);
            assert_true(fabsf(up[1] - 1) < 1e-4f && middle[3] == 1);
        }
        assert_memory_equal(albedo, a, sizeof albedo);
        assert_memory_equal(normal, n, sizeof normal);
        tyn_offline_destroy(&off);
    }
    tyn_scene_finish(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(same_picture), cmocka_unit_test(same_picture_on_a_card),
        cmocka_unit_test(offset),       cmocka_unit_test(wrong),
        cmocka_unit_test(guides),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
