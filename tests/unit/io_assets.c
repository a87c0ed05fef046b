// io_assets.c -- glTF as others write it: instances, animations, extensions that are not understood, pictures that are
// not there.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include "gltf_file.h"
#include "numbers.h"

static const float triangle[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

static tyn_scene load_at(const char *path, const tyn_moment *moment)
{
    tyn_scene scene;
    io_log log;
    io_log_init(&log);
    if (tyn_scene_load_moment(&scene, path, NULL, moment, &log.log) != TYN_OK) {
        print_error("%s\n", log.last);
        fail();
    }
    return scene;
}

static void refused(const char *path, const tyn_moment *moment, const char *says)
{
    tyn_scene scene;
    io_log log;
    io_log_init(&log);
    const tyn_result r = tyn_scene_load_moment(&scene, path, NULL, moment, &log.log);
    if (r != TYN_ERR_PARAMS || log.errors != 1 || log.newlines || !strstr(log.last, says)) {
        print_error("gave %d, %d errors: %s\nexpected: %s\n", r, log.errors, log.last, says);
        fail();
    }
}

static uint32_t warnings_with(const tyn_scene *scene, const char *words)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < scene->num_warnings; i++) {
        count += strstr(scene->warnings[i], words) != NULL;
    }
    return count;
}

static void near3(const float a[3], double x, double y, double z)
{
    if (!(fabs(a[0] - x) + fabs(a[1] - y) + fabs(a[2] - z) <
          1e-5 * (1 + fabs(x) + fabs(y) + fabs(z)))) {
        print_error("%g %g %g, expected %g %g %g\n", (double)a[0], (double)a[1], (double)a[2], x, y,
                    z);
        fail();
    }
}

// ---- instances --------------------------------------------------------------------------------

#define INSTANCES(attributes)                                                                      \
    "'extensionsUsed': ['EXT_mesh_gpu_instancing'], 'extensionsRequired': "                        \
    "['EXT_mesh_gpu_instancing'], 'meshes': [{'primitives': [{'attributes': {'POSITION': 0}}]}], " \
    "'nodes': [{'mesh': 0, 'translation': [10, 0, 0], 'scale': [2, 2, 2], 'extensions': "          \
    "{'EXT_mesh_gpu_instancing': {'attributes': {" attributes "}}}}]"

static void instances(void **state)
{
    static const float at[3][3] = {{0, 0, 0}, {0, 5, 0}, {0, 0, -1}};
    static const int8_t turned[3][4] = {{0, 0, 0, 127}, {0, 0, 90, 90}, {0, 0, 127, 0}};
    static const float scales[3][3] = {{1, 1, 1}, {1, 2, 1}, {0, 0, 0}};
    (void)state;
    gltf_file f = {0};
    gltf_file_array(&f, 5126, "VEC3", 3, triangle, sizeof triangle);
    gltf_file_array(&f, 5126, "VEC3", 3, at, sizeof at);
    gltf_file_accessor(&f, gltf_file_view(&f, turned, sizeof turned, 0), 0, 5120, "VEC4", 3,
                       ", 'normalized': true");
    gltf_file_array(&f, 5126, "VEC3", 3, scales, sizeof scales);
    tyn_scene s = load_at(
        gltf_file_put(&f, "many", INSTANCES("'TRANSLATION': 1, 'ROTATION': 2, 'SCALE': 3")), NULL);
    // The second is turned by 90 degrees about z; the third has no size and shows nothing.
    const tyn_surfaces *m = &s.surfaces;
    assert_int_equal(m->num_triangles, 2);
    assert_int_equal(s.num_meshes, 3);
    const tyn_surface_triangle *t = m->triangles;
    near3(m->vertices[t[0].vertices[1]].position, 12, 0, 0);
    near3(m->vertices[t[1].vertices[0]].position, 10, 10, 0);
    near3(m->vertices[t[1].vertices[1]].position, 10, 12, 0);
    near3(m->vertices[t[1].vertices[2]].position, 6, 10, 0);
    assert_int_equal(warnings_with(&s, "extension"), 0);
    tyn_scene_finish(&s);

    static const float lost[3][4] = {{0, 0, 0, 1}, {0, 0, 0, 0}, {0, 0, 0, 1}};
    gltf_file_array(&f, 5126, "VEC4", 3, lost, sizeof lost);
    gltf_file_array(&f, 5126, "VEC3", 2, at, 24);
    refused(gltf_file_put(&f, "lost", INSTANCES("'ROTATION': 4")), NULL,
            "element 1 is no rotation");
    refused(gltf_file_put(&f, "few", INSTANCES("'TRANSLATION': 1, 'SCALE': 5")), NULL,
            "has 2 elements, the one before has 3");
    refused(gltf_file_put(&f, "none", INSTANCES("'TRANSLATION': 9")), NULL, "there are 6");
    refused(gltf_file_put(&f, "kind", INSTANCES("'TRANSLATION': 2")), NULL, "VEC3");
}

// ---- animations -------------------------------------------------------------------------------

#define ANIMATION(channels, samplers)                                                              \
    "'cameras': [{'type': 'perspective', 'perspective': {'yfov': 1, 'znear': 0.1}}], "             \
    "'meshes': [{'primitives': [{'attributes': {'POSITION': 0}}]}], 'nodes': [{'camera': 0, "      \
    "'translation': [7, 7, 7]}, {'mesh': 0, 'children': [2]}, {'mesh': 0}], "                      \
    "'animations': [{'channels': [" channels "], 'samplers': [" samplers "]}]"
#define CHANNEL(sampler, node, path)                                                               \
    "{'sampler': " #sampler ", 'target': {'node': " #node ", 'path': '" path "'}}"

// Accessors: 0 a triangle, 1 keys at 1, 2 and 4 s, 2 values, 3 a cubic spline's, 4 quaternions.
static void moving_file(gltf_file *f)
{
    static const float keys[3] = {1, 2, 4}, values[3][3] = {{0, 0, 0}, {1, 2, 3}, {5, 2, 3}};
    static const float spline[9][3] = {{0},       {0, 0, 0}, {3, 0, 0}, {0, 0, 0}, {1, 2, 3},
                                       {1, 0, 0}, {2, 0, 0}, {5, 2, 3}, {0}};
    // By 0, 90 and 180 degrees about y: the last one's sign is that of the longer way round.
    const float h = sqrtf(0.5f);
    const float turns[3][4] = {{0, 0, 0, 1}, {0, h, 0, h}, {0, -1, 0, 0}};
    *f = (gltf_file){0};
    gltf_file_array(f, 5126, "VEC3", 3, triangle, sizeof triangle);
    gltf_file_array(f, 5126, "SCALAR", 3, keys, sizeof keys);
    gltf_file_array(f, 5126, "VEC3", 3, values, sizeof values);
    gltf_file_array(f, 5126, "VEC3", 9, spline, sizeof spline);
    gltf_file_array(f, 5126, "VEC4", 3, turns, sizeof turns);
}

static void check_camera(const char *path, double seconds, double x, double y, double z)
{
    const tyn_moment moment = {.timed = true, .seconds = seconds};
    tyn_scene s = load_at(path, &moment);
    assert_int_equal(s.num_cameras, 1);
    near3(s.cameras[0].position, x, y, z);
    assert_int_equal(warnings_with(&s, "animation"), 0);
    tyn_scene_finish(&s);
}

static void interpolation(void **state)
{
    (void)state;
    gltf_file f;
    moving_file(&f);
    const char *linear = gltf_file_put(
        &f, "linear", ANIMATION(CHANNEL(0, 0, "translation"), "{'input': 1, 'output': 2}"));
    check_camera(linear, -3, 0, 0, 0);
    check_camera(linear, 1.25, 0.25, 0.5, 0.75);
    check_camera(linear, 3, 3, 2, 3);
    check_camera(linear, 4, 5, 2, 3);
    check_camera(linear, 1e6, 5, 2, 3);
    tyn_scene s = load_at(linear, NULL); // as it stands
    near3(s.cameras[0].position, 7, 7, 7);
    assert_int_equal(warnings_with(&s, "1 animation: "), 1);
    tyn_scene_finish(&s);

    const char *step =
        gltf_file_put(&f, "step",
                      ANIMATION(CHANNEL(0, 0, "translation"),
                                "{'input': 1, 'output': 2, 'interpolation': 'STEP'}"));
    check_camera(step, 1.999, 0, 0, 0);
    check_camera(step, 2, 1, 2, 3);
    check_camera(step, 3.999, 1, 2, 3);

    // Hermite: at half of [1, 2] the ends' mean, and an eighth of what the tangents differ by, over 1 s; of [2, 4] over 2 s.
    const char *cubic =
        gltf_file_put(&f, "cubic",
                      ANIMATION(CHANNEL(0, 0, "translation"),
                                "{'input': 1, 'output': 3, 'interpolation': 'CUBICSPLINE'}"));
    check_camera(cubic, 1, 0, 0, 0);
    check_camera(cubic, 1.5, 0.5 + 3.0 / 8, 1, 1.5);
    check_camera(cubic, 3, 3 + 2 * (1.0 - 2) / 8, 2, 3);
    // At a quarter of [1, 2]: h00 0.84375, h10 0.140625, h01 0.15625, h11 -0.046875.
    check_camera(cubic, 1.25, 0.140625 * 3 + 0.15625, 0.15625 * 2, 0.15625 * 3);
    check_camera(cubic, 9, 5, 2, 3);
}

// Rotations go the shorter way; children follow their parents; scale and rotation of one node are independent.
static void rotations(void **state)
{
    (void)state;
    gltf_file f;
    moving_file(&f);
    const char *path =
        gltf_file_put(&f, "turn",
                      ANIMATION(CHANNEL(0, 1, "rotation") ", " CHANNEL(1, 2, "scale") ", " CHANNEL(
                                    0, 0, "rotation"),
                                "{'input': 1, 'output': 4}, {'input': 1, 'output': 2}"));
    tyn_moment moment = {.timed = true, .seconds = 1.5};
    tyn_scene s = load_at(path, &moment); // 45 degrees about y
    const double h = sqrt(0.5);
    near3(s.cameras[0].back, h, 0, h);
    const tyn_surfaces *m = &s.surfaces;
    near3(m->vertices[m->triangles[0].vertices[1]].position, h, 0, -h);
    near3(m->vertices[m->triangles[1].vertices[1]].position, 0.5 * h, 0, -0.5 * h); // half its size
    tyn_scene_finish(&s);
    moment.seconds = 3;
    s = load_at(path, &moment); // 135 degrees
    near3(s.cameras[0].back, h, 0, -h);
    tyn_scene_finish(&s);
}

static void wrong_animations(void **state)
{
    (void)state;
    gltf_file f;
    moving_file(&f);
    static const struct {
        const char *rest, *says;
    } cases[] = {
        {ANIMATION(CHANNEL(0, 0, "translation"), "{'input': 1}"),
         "animations[0].samplers[0] = an object: needs input and output"},
        {ANIMATION(CHANNEL(0, 0, "translation"), "{'input': 1, 'output': 3}"),
         "has 9 elements for 3 keys, must have 3"},
        {ANIMATION(CHANNEL(0, 0, "translation"), "{'input': 1, 'output': 4}"), "VEC3"},
        {ANIMATION(CHANNEL(0, 0, "translation"), "{'input': 2, 'output': 2}"), "SCALAR"},
        {ANIMATION(CHANNEL(0, 0, "translation"),
                   "{'input': 1, 'output': 2, 'interpolation': 'SINE'}"),
         "must be LINEAR, STEP or CUBICSPLINE"},
        {ANIMATION(CHANNEL(0, 8, "translation"), "{'input': 1, 'output': 2}"), "there are 3"},
        {ANIMATION(CHANNEL(3, 0, "translation"), "{'input': 1, 'output': 2}"), "there are 1"},
        {"'nodes': [{'matrix': [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]}], 'animations': [{'channels': "
         "[" CHANNEL(0, 0, "scale") "], 'samplers': [{'input': 1, 'output': 2}]}]",
         "this node has a matrix"},
    };
    const tyn_moment moment = {.timed = true, .seconds = 1.5};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        refused(gltf_file_put(&f, "wrong", cases[i].rest), &moment, cases[i].says);
    }
    const char *path = gltf_file_put(
        &f, "when", ANIMATION(CHANNEL(0, 0, "translation"), "{'input': 1, 'output': 2}"));
    refused(path, &(tyn_moment){.timed = true, .seconds = NAN}, "must be finite");
    // What moves something else is left alone.
    path = gltf_file_put(&f, "weights",
                         ANIMATION(CHANNEL(0, 1, "weights"), "{'input': 1, 'output': 1}"));
    tyn_scene s = load_at(path, &moment);
    assert_int_equal(warnings_with(&s, "weights of morph targets"), 1);
    tyn_scene_finish(&s);
}

// ---- extensions, pictures ---------------------------------------------------------------------

static void extensions(void **state)
{
    (void)state;
    gltf_file f = {0};
    gltf_file_array(&f, 5126, "VEC3", 3, triangle, sizeof triangle);
    tyn_scene s =
        load_at(gltf_file_put(
                    &f, "odd",
                    "'extensionsUsed': ['EXT_a', 'EXT_b', 'EXT_c'], 'extensions': {'EXT_a': {}}, "
                    "'extras': {'extensions': {'EXT_none': 1}}, "
                    "'materials': [{'extensions': {'EXT_b': {'x': 1}}, 'pbrMetallicRoughness': "
                    "{'metallicFactor': 0}}], 'nodes': [{'mesh': 0, 'extensions': {'EXT_c': {}}}, "
                    "{'extensions': {'EXT_c': {}, 'EXT_b': {}}}, {'extensions': {'EXT_c': {}}}], "
                    "'meshes': [{'primitives': [{'attributes': {'POSITION': 0}, 'material': 0}]}]"),
                NULL);
    assert_int_equal(s.num_warnings, 3);
    assert_int_equal(warnings_with(&s, "extensions.EXT_a: this extension is not understood"), 1);
    assert_int_equal(
        warnings_with(&s, "materials[0].extensions.EXT_b and 1 more: this extension is not"), 1);
    assert_int_equal(warnings_with(&s, "nodes[0].extensions.EXT_c and 2 more"), 1);
    tyn_scene_finish(&s);

    // What a material has beside its extensions is enough for a picture, though the file requires them. Unlit ones and
    // those of specular-glossiness are no metal, whatever the default is.
    gltf_file g = {0};
    gltf_file_array(&g, 5126, "VEC3", 3, triangle, sizeof triangle);
    s = load_at(
        gltf_file_put(&g, "required",
                      "'extensionsUsed': ['KHR_materials_unlit'], 'extensionsRequired': "
                      "['KHR_materials_unlit', 'KHR_materials_variants', "
                      "'KHR_materials_pbrSpecularGlossiness', 'KHR_materials_sheen'], 'materials': "
                      "[{'extensions': {'KHR_materials_unlit': {}, 'KHR_materials_sheen': {}}, "
                      "'pbrMetallicRoughness': {'baseColorFactor': [0.25, 0.5, 0.75, 1]}}, "
                      "{'extensions': {'KHR_materials_pbrSpecularGlossiness': {'diffuseFactor': "
                      "[0.5, 0.25, 0.125, 1]}}}], 'nodes': [{'mesh': 0}], 'meshes': "
                      "[{'primitives': [{'attributes': {'POSITION': 0}, 'material': 0}, "
                      "{'attributes': {'POSITION': 0}, 'material': 1}]}]"),
        NULL);
    assert_int_equal(s.surfaces.num_triangles, 2);
    assert_int_equal(s.surfaces.num_materials, 2);
    const float albedo[2][3] = {{0.25f, 0.5f, 0.75f}, {0.5f, 0.25f, 0.125f}};
    for (int k = 0; k < 6; k++) {
        assert_near(s.surfaces.materials[k / 3].albedo[k % 3], albedo[k / 3][k % 3], 1e-6);
    }
    assert_int_equal(warnings_with(&s, "KHR_materials_sheen: this extension is not understood"), 1);
    assert_int_equal(warnings_with(&s, "KHR_materials_unlit: it is lit as others are"), 1);
    assert_int_equal(warnings_with(&s, "the diffuse part is kept"), 1);
    tyn_scene_finish(&s);
}

static void pictures(void **state)
{
    (void)state;
    gltf_file f = {0};
    gltf_file_array(&f, 5126, "VEC3", 3, triangle, sizeof triangle);
    gltf_file_array(&f, 5126, "VEC2", 3, (float[6]){0, 0, 1, 0, 0, 1}, 24);
#define PICTURED(images)                                                                           \
    "'nodes': [{'mesh': 0}], 'meshes': [{'primitives': [{'attributes': {'POSITION': 0, "           \
    "'TEXCOORD_0': 1}, 'material': 0}, {'attributes': {'POSITION': 0}, 'material': 1}]}], "        \
    "'materials': [{'pbrMetallicRoughness': {'metallicFactor': 0, 'baseColorTexture': {'index': "  \
    "0}}}, "                                                                                       \
    "{'pbrMetallicRoughness': {'metallicRoughnessTexture': {'index': 1}}}], 'textures': [" images
    tyn_scene s =
        load_at(gltf_file_put(&f, "gone",
                              PICTURED("{'source': 0}, {'extensions': {'EXT_texture_webp': "
                                       "{'source': 0}}}], 'images': [{'uri': 'gone.png'}]")),
                NULL);
    assert_int_equal(s.surfaces.num_textures, 1);
    const tyn_texture *t = &s.surfaces.textures[0];
    assert_true(t->size[0] == 1 && t->size[1] == 1 && t->texels[0] == 188 && t->texels[3] == 255);
    near3(s.surfaces.materials[1].albedo, 1 - 188 / 255.0, 1 - 188 / 255.0, 1 - 188 / 255.0);
    assert_int_equal(warnings_with(&s, "texture 0 'gone.png' and 1 more: there is no such picture"),
                     1);
    assert_int_equal(warnings_with(&s, "EXT_texture_webp"), 1);
    tyn_scene_finish(&s);
    mkdir(io_path("folder.png"), 0700); // it is there, and no picture
    tyn_scene none;
    io_log log;
    io_log_init(&log);
    const char *path = gltf_file_put(
        &f, "folder", PICTURED("{'source': 0}, {'source': 0}], 'images': [{'uri': 'folder.png'}]"));
    assert_int_equal(tyn_scene_load_moment(&none, path, NULL, NULL, &log.log), TYN_ERR_IO);
    assert_non_null(strstr(log.last, "is a folder: must be a regular file"));
    rmdir(io_path("folder.png"));
    io_put("w.webp", "RIFF\x10\0\0\0WEBPVP8 ", 16);
    refused(gltf_file_put(&f, "webp",
                          PICTURED("{'source': 0}, {'source': 0}], 'images': "
                                   "[{'uri': 'w.webp'}]")),
            NULL, "it is WebP; 'gltf-transform png IN.glb OUT.glb' unpacks it");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(instances),  cmocka_unit_test(interpolation),
        cmocka_unit_test(rotations),  cmocka_unit_test(wrong_animations),
        cmocka_unit_test(extensions), cmocka_unit_test(pictures),
    };
    return cmocka_run_group_tests(tests, NULL, io_test_clean);
}
