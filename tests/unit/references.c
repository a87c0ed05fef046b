// references.c -- kept references: their key is another when anything that makes them is, and they are read as written.
#include "references.h"
#include "solids.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>
#include <tyndall/registry.h>

// A grid, a lamp, a sun, a map, a wall.
static void make(tyn_scene *scene, tyn_view *view)
{
    tyn_scene_init(scene);
    const tyn_medium medium = grey_medium(2, 0.5f, 0.3f);
    const float grid[8] = {1, 2, 3, 4, 5, 6, 7, 8};
    scene_add_box(scene, &medium, (float[]){0, 0, 0}, (float[]){1, 1, 1}, (uint32_t[]){2, 2, 2},
                  grid);
    scene_add_sun(scene, 0, -1, 0.5f, 1, 2, 3);
    scene_set_sky(scene, 0.25f);
    const uint32_t wall = solids_material(scene, (float[]){0.5f, 0.5f, 0.5f}, (float[]){0, 0, 0});
    solids_quad(scene, (float[]){0, 0, 0}, (float[]){1, 0, 0}, (float[]){0, 0, 1}, wall);
    *view = (tyn_view){.outputs = TYN_OUTPUT_RADIANCE, .num_samples = 16, .seed = 3};
    view_orthographic(view, (float[]){0, 0, 0}, 0, 0, -1, (float[]){0, 1, 0}, 0.5f, 8);
}

typedef void change(tyn_scene *scene, tyn_view *view);

static void voxel(tyn_scene *s, tyn_view *v)
{
    (void)v;
    s->volumes[0].data[5] += 1e-3f;
}
static void lobe(tyn_scene *s, tyn_view *v)
{
    (void)v;
    s->media[0].phase[2].g = 0.31f;
}
static void matrix(tyn_scene *s, tyn_view *v)
{
    (void)v;
    s->shapes[0].to_world[12] += 0.01f;
}
static void light(tyn_scene *s, tyn_view *v)
{
    (void)v;
    s->lights[0].color[1] = 2.5f;
}
static void sky(tyn_scene *s, tyn_view *v)
{
    (void)v;
    s->environment.strength = 2;
}
static void albedo(tyn_scene *s, tyn_view *v)
{
    (void)v;
    s->surfaces.materials[0].albedo[0] = 0.6f;
}
static void vertex(tyn_scene *s, tyn_view *v)
{
    (void)v;
    s->surfaces.vertices[2].position[1] = 0.1f;
}
static void samples(tyn_scene *s, tyn_view *v)
{
    (void)s;
    v->num_samples++;
}
static void seed(tyn_scene *s, tyn_view *v)
{
    (void)s;
    v->seed++;
}
static void camera(tyn_scene *s, tyn_view *v)
{
    (void)s;
    v->camera.position[0] += 0.1f;
}
static void depth(tyn_scene *s, tyn_view *v)
{
    (void)s;
    v->max_depth = 1;
}
// Another kernel.
static void output(tyn_scene *s, tyn_view *v)
{
    (void)s;
    v->outputs = TYN_OUTPUT_BALANCE;
}
static void nothing(tyn_scene *s, tyn_view *v)
{
    (void)v;
    const tyn_surface_triangle first = s->surfaces.triangles[0];
    s->surfaces.triangles[0] = s->surfaces.triangles[1];
    s->surfaces.triangles[1] = first;
    s->surfaces.hash = 17;
    s->volumes[0].hash = 23;
}

static uint64_t key_after(change *what)
{
    tyn_scene scene;
    tyn_view view = {0};
    make(&scene, &view);
    if (what) {
        what(&scene, &view);
    }
    const uint64_t key = reference_key(&scene, &view);
    tyn_scene_finish(&scene);
    return key;
}

static void keys(void **state)
{
    (void)state;
    static change *const changes[] = {voxel,  lobe,    matrix, light,  sky,   albedo,
                                      vertex, samples, seed,   camera, depth, output};
    enum { N = sizeof changes / sizeof *changes };
    uint64_t found[N + 1] = {key_after(NULL)};
    assert_true(key_after(nothing) == found[0]);
    for (int i = 0; i < N; i++) {
        found[i + 1] = key_after(changes[i]);
        for (int k = 0; k <= i; k++) {
            assert_true(found[k] != found[i + 1]);
        }
    }
}

static void pictures(void **state)
{
    (void)state;
    enum { W = 7, H = 5, N = 3 * W * H };
    float rgb[N], se[N];
    for (int i = 0; i < N; i++) {
        rgb[i] = 3e4f * expf(-0.2f * (float)i);
        se[i] = 1e-3f * rgb[i];
    }
    const picture made = {.width = W, .height = H, .rgb = rgb, .se = se};
    picture read = {0};
    setenv("TYN_REFERENCES", "write", 1);
    assert_false(reference_read_picture(77, &read));
    reference_write_picture(77, &made);
    unsetenv("TYN_REFERENCES");
    assert_true(reference_read_picture(77, &read));
    assert_int_equal(read.width, W);
    assert_int_equal(read.height, H);
    for (int i = 0; i < N; i++) {
        // Half a unit in the last place of a half float; of what is 2^-29 of the brightest and less, 2^-40.
        assert_true(fabsf(read.rgb[i] - rgb[i]) <= rgb[i] * 0x1p-11f + 3e4f * 0x1p-39f);
        assert_true(fabsf(read.se[i] - se[i]) <= se[i] * 0x1p-11f + 3e4f * 0x1p-39f);
    }
    picture_free(&read);
    assert_false(reference_read_picture(78, &read));
}

static void numbers(void **state)
{
    (void)state;
    const float made[4] = {1.0f / 3, -2e-30f, 0, 3e30f};
    float read[4];
    setenv("TYN_REFERENCES", "write", 1);
    reference_write_floats(77, made, 4);
    unsetenv("TYN_REFERENCES");
    assert_true(reference_read_floats(77, read, 4));
    assert_memory_equal(made, read, sizeof made);
    assert_false(reference_read_floats(78, read, 4));
}

static void note(const char *kernels)
{
    FILE *f = fopen(TYN_REFERENCES_DIR "/kernels", "w");
    assert_non_null(f);
    fputs(kernels, f);
    fclose(f);
}

// Of other kernels they are not read; noted as the present ones' they are.
static void other_kernels(void **state)
{
    (void)state;
    float read[4];
    note("0000000000000001\n");
    assert_false(reference_read_floats(77, read, 4));
    setenv("TYN_REFERENCES", "note", 1);
    assert_true(reference_read_floats(77, read, 4));
    unsetenv("TYN_REFERENCES");
    assert_true(reference_read_floats(77, read, 4));
}

int main(void)
{
    remove(TYN_REFERENCES_DIR "/kernels"); // of an earlier build
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(keys),
        cmocka_unit_test(pictures),
        cmocka_unit_test(numbers),
        cmocka_unit_test(other_kernels),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
