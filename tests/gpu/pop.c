// pop.c -- method `pop` as a whole: what it refuses, warns of and leaves out; its layers add up.
#include "bound.h"
#include "gpu_test.h"
#include "numbers.h"
#include "offline_frame.h"
#include "picture.h"
#include "solids.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIZE = 32, PIXELS = SIZE * SIZE };

static const uint32_t all_layers = TYN_OUTPUT_RADIANCE | TYN_OUTPUT_TRANSMITTANCE |
                                   TYN_OUTPUT_DEPTH | TYN_OUTPUT_SINGLE | TYN_OUTPUT_MULTIPLE;

typedef struct stage {
    tyn_scene scene;
    tyn_view view;
    tyn_offline *off;
    tyn_device *dev;
} stage;

static stage *set_stage_with(gpu_test *t, float sigma_s, const char *sweeps)
{
    tyn_settings *settings = NULL;
    assert_int_equal(tyn_settings_create(&settings), TYN_OK);
    if (sweeps) {
        assert_int_equal(tyn_settings_set(settings, "lattice.sweeps", sweeps, NULL), TYN_OK);
    }
    stage *s = calloc(1, sizeof *s);
    s->dev = t->dev;
    tyn_scene_init(&s->scene);
    tyn_medium medium = grey_medium(sigma_s, 0.5f, 0.7f);
    scene_add_box(&s->scene, &medium, (float[]){0, 0, 0}, (float[]){1, 1, 1}, NULL, NULL);
    scene_add_sun(&s->scene, 1, -2, 0.5f, 2, 1.5f, 1);
    view_orthographic(&s->view, (float[]){0.5f, 0.5f, 0.5f}, -1, -1, -2, (float[]){0, 1, 0}, 0.9f,
                      SIZE);
    assert_int_equal(tyn_offline_create(t->dev,
                                        tyn_offline_params(.method = "pop", .settings = settings),
                                        &s->off),
                     TYN_OK);
    tyn_settings_destroy(&settings);
    return s;
}

static stage *set_stage(gpu_test *t, float sigma_s)
{
    return set_stage_with(t, sigma_s, NULL);
}

static void strike(stage *s)
{
    tyn_offline_destroy(&s->off);
    tyn_scene_finish(&s->scene);
    free(s);
}

static void show(stage *s)
{
    offline_frame(s->off, &s->scene, &s->view);
    assert_int_equal(tyn_device_validation_messages(s->dev), 0);
}

static bool warns_of(stage *s, const char *words)
{
    tyn_report report;
    tyn_offline_report(s->off, &report);
    for (uint32_t i = 0; i < report.num_warnings; i++) {
        if (strstr(report.warnings[i], words)) {
            return true;
        }
    }
    return false;
}

static const char *state_of(stage *s, const char *node)
{
    tyn_report report;
    tyn_offline_report(s->off, &report);
    for (uint32_t i = 0; i < report.num_nodes; i++) {
        if (!strcmp(report.nodes[i].name, node)) {
            return report.nodes[i].state;
        }
    }
    return "absent";
}

static void layers_add_up(void **state)
{
    stage *s = set_stage(*state, 4);
    scene_set_sky(&s->scene, 0.3f);
    s->view.outputs = all_layers;
    show(s);
    const float *rgb = tyn_offline_output(s->off, TYN_OUTPUT_RADIANCE);
    const float *single = tyn_offline_output(s->off, TYN_OUTPUT_SINGLE);
    const float *multiple = tyn_offline_output(s->off, TYN_OUTPUT_MULTIPLE);
    const float *through = tyn_offline_output(s->off, TYN_OUTPUT_TRANSMITTANCE);
    const float *depth = tyn_offline_output(s->off, TYN_OUTPUT_DEPTH);
    int inside = 0;
    for (int i = 0; i < PIXELS * 4; i++) {
        if (i % 4 == 3) {
            assert_true(rgb[i] == 1); // an environment is seen everywhere
            continue;
        }
        float sum = single[i] + multiple[i] + 0.3f * through[i];
        assert_true(fabsf(sum - rgb[i]) <= 1e-5f * rgb[i]);
        assert_true(through[i] >= 0 && through[i] <= 1 && single[i] >= 0 && multiple[i] >= 0);
        inside += through[i] < 1;
    }
    assert_true(inside > PIXELS);
    for (int i = 0; i < PIXELS; i++) {
        assert_true(isinf(depth[4 * i]));
        assert_true(isinf(depth[4 * i + 1]) == (through[4 * i] > 0.5f));
    }
    // Without its background the picture is the medium alone, premultiplied.
    float with[PIXELS * 4], behind[PIXELS * 4];
    memcpy(with, rgb, sizeof with);
    memcpy(behind, through, sizeof behind);
    s->view.no_background = true;
    show(s);
    rgb = tyn_offline_output(s->off, TYN_OUTPUT_RADIANCE);
    for (int i = 0; i < PIXELS * 4; i++) {
        float expected = i % 4 < 3 ? with[i] - 0.3f * behind[i] : 1 - behind[i - 1];
        assert_true(fabsf(rgb[i] - expected) < 1e-5f);
    }
    strike(s);
}

static void refuses_what_repeats_everywhere(void **state)
{
    gpu_test *t = *state;
    stage *s = set_stage(t, 4);
    bool *repeat = s->scene.shapes[0].repeat;
    repeat[2] = true;
    show(s); // along one or two axes the medium may
    repeat[0] = repeat[1] = true;
    t->quiet = true;
    assert_int_equal(tyn_offline_frame(s->off, &s->scene, &s->view, false), TYN_ERR_PARAMS);
    assert_non_null(strstr(t->last_error, "repeats along all three axes"));
    t->quiet = false;
    strike(s);
}

// Surfaces do not repeat with a medium: a floor of one period is told of, and one that shines is refused.
static void periodic_surfaces(void **state)
{
    gpu_test *t = *state;
    for (int shines = 0; shines < 2; shines++) {
        stage *s = set_stage(t, 4);
        const float light = (float)shines;
        s->scene.shapes[0].repeat[0] = true;
        const uint32_t m =
            solids_material(&s->scene, (float[]){0.5f, 0.5f, 0.5f}, (float[]){light, light, light});
        solids_quad(&s->scene, (float[]){-0.4f, -0.4f, -0.4f}, (float[]){0, 0, 0.8f},
                    (float[]){0.8f, 0, 0}, m);
        solids_hierarchy(&s->scene, 2);
        t->quiet = shines;
        assert_int_equal(tyn_offline_frame(s->off, &s->scene, &s->view, false),
                         shines ? TYN_ERR_PARAMS : TYN_OK);
        assert_true(shines ? strstr(t->last_error, "surfaces that emit") != NULL
                           : warns_of(s, "surfaces do not repeat"));
        t->quiet = false;
        strike(s);
    }
}

static bool counts_non_finite(stage *s, const char *node)
{
    tyn_report report;
    tyn_offline_report(s->off, &report);
    bool counts = false;
    for (uint32_t i = 0; i < report.num_nodes; i++) {
        const tyn_node_report *n = &report.nodes[i];
        for (uint32_t k = 0; k < n->num_work && !strcmp(n->name, node); k++) {
            counts = counts || !strcmp(n->work[k].name, "non_finite");
        }
    }
    return counts;
}

// Where values that are not finite are set to 0 the report says how many, so that offline_frame sees them.
static void reports_what_is_not_finite(void **state)
{
    static const char *const nodes[] = {"beam",  "radial_beam", "columns", "lattice",
                                        "merge", "probe",       "raymarch"};
    static const float point[3] = {0.4f, 0.5f, 0.6f};
    stage *s = set_stage(*state, 4);
    for (int i = 0; i < 4; i++) { // five suns: the last one is an ordinate
        scene_add_sun(&s->scene, 1, -2, 0.2f * (float)i, 0.1f, 0.1f, 0.1f);
    }
    s->scene.lights[s->scene.num_lights++] =
        (tyn_light){.kind = TYN_LIGHT_POINT, .color = {1, 1, 1}, .position = {2, 2, 2}};
    s->view.outputs = TYN_OUTPUT_RADIANCE | TYN_OUTPUT_PROBE;
    s->view.points = &point;
    s->view.num_points = 1;
    show(s);
    for (size_t i = 0; i < sizeof nodes / sizeof *nodes; i++) {
        print_message("%s\n", nodes[i]);
        assert_true(counts_non_finite(s, nodes[i]));
    }
    strike(s);
}

static void warns(void **state)
{
    stage *s = set_stage(*state, 4);
    show(s);
    assert_false(warns_of(s, ""));
    for (int i = 0; i < 4; i++) {
        scene_add_sun(&s->scene, 1, -2, 0.2f * (float)i, 0.1f, 0.1f, 0.1f);
    }
    tyn_light *lamp = &s->scene.lights[s->scene.num_lights++];
    *lamp = (tyn_light){.kind = TYN_LIGHT_POINT, .color = {1, 1, 1}, .position = {2, 2, 2}};
    show(s);
    assert_false(warns_of(s, "point or spot light"));
    assert_false(warns_of(s, "directional lights:"));
    assert_string_equal(state_of(s, "columns"), "ran"); // the fifth sun has no aligned grid
    strike(s);
}

// What a scene does not need is not run.
static void leaves_out(void **state)
{
    stage *s = set_stage(*state, 0.01f);
    show(s); // so thin that light scatters but once
    assert_string_equal(state_of(s, "lattice"), "absent");
    assert_string_equal(state_of(s, "raymarch"), "ran");
    s->scene.media[0].sigma_s[1] = 4;
    show(s);
    assert_string_equal(state_of(s, "lattice"), "ran");
    s->view.camera.position[0] += 0.1f;
    show(s);
    assert_string_equal(state_of(s, "lattice"), "unchanged");
    assert_string_equal(state_of(s, "beam"), "unchanged");
    assert_string_equal(state_of(s, "merge"), "ran");
    show(s);
    assert_string_equal(state_of(s, "raymarch"), "unchanged");
    // No medium: the environment alone.
    s->scene.num_shapes = 0;
    scene_set_sky(&s->scene, 2);
    show(s);
    assert_string_equal(state_of(s, "lattice"), "absent");
    assert_string_equal(state_of(s, "medium"), "absent");
    const float *rgb = tyn_offline_output(s->off, TYN_OUTPUT_RADIANCE);
    for (int i = 0; i < PIXELS; i++) {
        assert_true(rgb[4 * i] == 2 && rgb[4 * i + 3] == 1);
    }
    strike(s);
}

// Several suns are the sum of their pictures.
static void suns_add_up(void **state)
{
    gpu_test *t = *state;
    static const float suns[3][6] = {
        {1, -2, 0.5f, 2, 1.5f, 1}, {-1, -1, 1, 0.5f, 0.5f, 2}, {0.2f, 1, -2, 1, 0, 0}};
    double sum[PIXELS * 3] = {0};
    for (int k = 0; k < 4; k++) {
        stage *s = set_stage(t, 4);
        s->scene.num_lights = 0;
        for (int i = 0; i < 3; i++) {
            if (k == i || k == 3) {
                scene_add_sun(&s->scene, suns[i][0], suns[i][1], suns[i][2], suns[i][3], suns[i][4],
                              suns[i][5]);
            }
        }
        picture p;
        picture_render(&p, t->dev, "pop", &s->scene, &s->view,
                       "lattice.sweeps=12 raymarch.sparse=0", 0);
        double most = 0;
        for (int i = 0; i < PIXELS * 3; i++) {
            if (k < 3) {
                sum[i] += p.rgb[i];
            } else {
                most = maximum(most, fabs(p.rgb[i] - sum[i]) / (sum[i] + 1e-3));
            }
        }
        print_message(k == 3 ? "three suns at once: %.2e off their sum\n" : "", most);
        assert_true(most < 1e-4);
        picture_free(&p);
        strike(s);
    }
}

// Says where the lattice is not solved to the end, and only there: after how many sweeps that is depends on the medium.
static void unsettled(void **state)
{
    static const struct {
        float sigma_s, albedo;
        const char *sweeps;
        bool warns;
    } cases[] = {
        {50, 1, "1", true},     {50, 1, "3", false},   {50, 1, "4", false},
        {4, 0.9f, "1", true},   {4, 0.9f, "3", false}, {0.1f, 0.9f, "1", false},
        {50, 0.2f, "3", false},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        stage *s = set_stage_with(*state, cases[i].sigma_s, cases[i].sweeps);
        for (int c = 0; c < 3; c++) {
            s->scene.media[0].sigma_a[c] = cases[i].sigma_s * (1 / cases[i].albedo - 1);
        }
        show(s);
        const bool said = warns_of(s, "the lattice is not solved to the end");
        print_message("sigma_s %g, albedo %g, %s sweeps: %s\n", (double)cases[i].sigma_s,
                      (double)cases[i].albedo, cases[i].sweeps, said ? "warns" : "silent");
        assert_int_equal(said, cases[i].warns);
        strike(s);
    }
}

// A channel that is hardly there may be as unsettled as it likes: what counts is its share of the light.
static void unsettled_channel(void **state)
{
    for (int k = 0; k < 2; k++) {
        stage *s = set_stage_with(*state, 0.1f, "1");
        s->scene.media[0].sigma_s[2] = 50;
        s->scene.media[0].sigma_a[2] = 0;
        s->scene.lights[0].color[2] = k == 0 ? 1 : 1e-4f;
        show(s);
        assert_int_equal(warns_of(s, "the lattice is not solved to the end"), k == 0);
        strike(s);
    }
}

// A part of a picture is the same values as in the whole one, also where it is as wide as a picture may be: then no margin is
// rendered beside it.
static void parts(void **state)
{
    enum { WHOLE = 200, X = 131, Y = 97, WIDTH = 69, HEIGHT = 30 };
    stage *s = set_stage(*state, 4);
    s->view.width = s->view.height = WHOLE;
    show(s);
    float *whole = malloc(sizeof(float) * 4 * WHOLE * WHOLE);
    assert_non_null(whole);
    memcpy(whole, tyn_offline_output(s->off, TYN_OUTPUT_RADIANCE),
           sizeof(float) * 4 * WHOLE * WHOLE);
    s->view.whole[0] = s->view.whole[1] = WHOLE;
    s->view.corner[0] = X;
    s->view.corner[1] = Y;
    s->view.width = WIDTH;
    s->view.height = HEIGHT;
    show(s);
    const float *part = tyn_offline_output(s->off, TYN_OUTPUT_RADIANCE);
    double most = 0, sum = 0;
    for (int i = 0; i < 4 * WIDTH * HEIGHT; i++) {
        const int of_whole = 4 * ((Y + i / (4 * WIDTH)) * WHOLE + X) + i % (4 * WIDTH);
        most = maximum(most, fabs((double)part[i] - (double)whole[of_whole]));
        sum += (double)part[i];
    }
    free(whole);
    print_message("mean %g, a value at most %g off the whole picture's\n",
                  sum / (4 * WIDTH * HEIGHT), most);
    assert_true(sum > 0.05 * 4 * WIDTH * HEIGHT && most == 0); // a medium alone: no edges
    tyn_view *wide = &s->view;
    wide->whole[0] = 20000;
    wide->whole[1] = 64;
    wide->corner[0] = 100;
    wide->corner[1] = 20;
    wide->width = 16384;
    wide->height = 8;
    show(s);
    strike(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(layers_add_up),
        cmocka_unit_test(refuses_what_repeats_everywhere),
        cmocka_unit_test(periodic_surfaces),
        cmocka_unit_test(warns),
        cmocka_unit_test(reports_what_is_not_finite),
        cmocka_unit_test(leaves_out),
        cmocka_unit_test(suns_add_up),
        cmocka_unit_test(unsettled),
        cmocka_unit_test(unsettled_channel),
        cmocka_unit_test(parts),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
