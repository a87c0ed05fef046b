// io_gltf.c -- what a glTF scene becomes: transforms, cameras, lights, media, environment,
// containers.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "io/gltf.h"
#include "io_test.h"
#include "nvdb_write.h"

static const float tolerance = 1e-5f;

static void near_n(const float *a, const float *b, int n)
{
    for (int i = 0; i < n; i++) {
        if (fabsf(a[i] - b[i]) > tolerance) {
            print_error("element %d: %g, expected %g\n", i, a[i], b[i]);
        }
        assert_true(fabsf(a[i] - b[i]) <= tolerance);
    }
}
#define NEAR(a, ...)                                                                               \
    near_n(a, (const float[]){__VA_ARGS__}, (int)(sizeof(float[]){__VA_ARGS__} / sizeof(float)))

static void load(tyn_scene *scene, const char *text)
{
    io_log log;
    io_log_init(&log);
    tyn_scene_init(scene);
    const char *path = io_put_text("scene.gltf", text);
    tyn_result r = tyn_scene_load(scene, path, NULL, &log.log);
    if (r) {
        print_error("%s\n", log.last);
    }
    assert_int_equal(r, TYN_OK);
    assert_int_equal(log.errors + log.warnings, 0);
}

#define ASSET "{'asset': {'version': '2.0'}"

// JSON is written with ' for ".
static const char *quoted(const char *text)
{
    static char out[8][4096];
    static int next;
    char *p = out[next++ % 8];
    snprintf(p, sizeof out[0], "%s", text);
    for (char *c = p; *c; c++) {
        *c = *c == '\'' ? '"' : *c;
    }
    return p;
}

static void nodes(void **state)
{
    tyn_scene s;
    (void)state;
    // A parent turned by 90 degrees about y (x -> -z) and moved; below it a scaled box, a camera
    // under a non-uniform scale, a lamp.
    load(
        &s,
        quoted(
            ASSET
            ", 'scene': 1, 'scenes': [{}, {'name': 'second', 'nodes': [0, 4]}], 'nodes': ["
            "{'translation': [1, 2, 3], 'rotation': [0, 0.7071067811865476, 0, 0.7071067811865476],"
            " 'children': [1, 2, 3]},"
            "{'scale': [2, 4, 6], 'extensions': {'TYN_participating_media': {'medium': 0}}},"
            "{'name': 'view', 'camera': 0, 'translation': [10, 0, 0], 'scale': [1, 5, -2]},"
            "{'extensions': {'KHR_lights_punctual': {'light': 0}}, 'translation': [0, 1, 0]},"
            "{'matrix': [1, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1], 'camera': 1, 'mesh': 0}],"
            "'cameras': [{'name': 'lens', 'type': 'perspective', 'perspective': {'yfov': 0.5,"
            " 'aspectRatio': 2, 'znear': 1}}, {'type': 'orthographic', 'orthographic': {'xmag': 3,"
            " 'ymag': 1.5, 'znear': 0, 'zfar': 9}}],"
            "'meshes': [{'name': 'wall', 'primitives': [{'attributes': {}}]}],"
            "'extensionsRequired': ['KHR_lights_punctual'],"
            "'extensions': {'KHR_lights_punctual': {'lights': [{'type': 'spot', 'color': [1, 0.5, "
            "0],"
            " 'intensity': 8, 'spot': {'innerConeAngle': 0.5, 'outerConeAngle': 0.5}}]},"
            " 'TYN_participating_media': {'media': [{'name': 'fog', 'scattering': 2, 'absorption': "
            "[1, 2, 3],"
            " 'anisotropy': [-0.5, 0, 0.5], 'emission': 0.25}]}}}"));
    assert_string_equal(s.name, "second");
    assert_int_equal(s.num_shapes, 1);
    NEAR(s.shapes[0].to_world, 0, 0, -2, 0, 0, 4, 0, 0, 6, 0, 0, 0, 1, 2, 3, 1);
    assert_int_equal(s.num_media, 1);
    assert_string_equal(s.media[0].name, "fog");
    NEAR(s.media[0].sigma_s, 2, 2, 2);
    NEAR(s.media[0].sigma_a, 1, 2, 3);
    float g[3];
    tyn_phase_get(s.media[0].phase, tyn_phase_parameters(), g);
    NEAR(g, -0.5f, 0, 0.5f);
    NEAR(s.media[0].emission, 0.25f, 0.25f, 0.25f);
    assert_true(s.media[0].volume == -1 && s.media[0].density_scale == 1);

    assert_int_equal(s.num_cameras, 2);
    const tyn_camera *c = &s.cameras[0];
    assert_string_equal(c->name, "view");
    assert_string_equal(c->camera_name, "lens");
    assert_true(c->projection == TYN_PERSPECTIVE && c->yfov == 0.5f && c->aspect == 2);
    NEAR(c->position, 1, 2, -7);
    // -Z of the node under scale -2 points along the parent's +Z = world +X.
    NEAR(c->back, -1, 0, 0);
    NEAR(c->up, 0, 1, 0);
    NEAR(c->right, 0, 0, 1); // forward x up
    c = &s.cameras[1];       // sheared: up is made perpendicular
    assert_true(c->projection == TYN_ORTHOGRAPHIC && c->ymag == 1.5f && c->aspect == 2);
    NEAR(c->back, 0, 0, 1);
    NEAR(c->position, 5, 6, 7);
    assert_null(c->name);

    assert_int_equal(s.num_lights, 1);
    const tyn_light *l = &s.lights[0];
    assert_int_equal(l->kind, TYN_LIGHT_SPOT);
    NEAR(l->color, 8, 4, 0);
    NEAR(l->position, 1, 3, 3);
    NEAR(l->direction, -1, 0, 0);
    assert_true(l->cos_inner == l->cos_outer && fabsf(l->cos_inner - cosf(0.5f)) < tolerance);
    assert_int_equal(s.num_meshes, 1);
    assert_int_equal(s.num_warnings, 1);
    tyn_scene_finish(&s);
}

static float ramp(int32_t i, int32_t j, int32_t k)
{
    return (float)(i + 10 * j + 100 * k);
}

// Cameras stand in the order of the file's list, whatever the nodes' order, and know their place in
// it.
static void camera_order(void **state)
{
    tyn_scene s;
    (void)state;
    load(&s, quoted(ASSET ", 'scene': 0, 'scenes': [{'nodes': [0, 1, 2]}], 'nodes': ["
                          "{'name': 'late', 'camera': 2}, {'name': 'early', 'camera': 0},"
                          "{'name': 'again', 'camera': 0}], 'cameras': ["
                          "{'type': 'perspective', 'perspective': {'yfov': 0.5, 'znear': 1}},"
                          "{'type': 'perspective', 'perspective': {'yfov': 0.6, 'znear': 1}},"
                          "{'type': 'perspective', 'perspective': {'yfov': 0.7, 'znear': 1}}]}"));
    assert_int_equal(s.num_cameras, 3);
    assert_string_equal(s.cameras[0].name, "early");
    assert_string_equal(s.cameras[1].name, "again");
    assert_string_equal(s.cameras[2].name, "late");
    assert_true(s.cameras[0].index == 0 && s.cameras[1].index == 0 && s.cameras[2].index == 2);
    tyn_scene_finish(&s);
}

static void volumes(void **state)
{
    nvdb_spec spec = {.name = "smoke",
                      .type = NVDB_FLOAT,
                      .grid_class = 2,
                      .lo = {2, 0, 0},
                      .hi = {5, 1, 0},
                      .value = ramp,
                      .voxel = 0.5};
    const float raw[2] = {-1, 3};
    size_t size;
    tyn_scene s;
    (void)state;
    uint8_t *file = nvdb_write(&spec, &size, NULL);
    io_put("a b.nvdb", file, size);
    io_put("two.raw", raw, sizeof raw);
    free(file);
    load(
        &s,
        quoted(
            ASSET
            ", 'nodes': ["
            "{'translation': [100, 0, 0], 'extensions': {'TYN_participating_media': {'medium': 0, "
            "'shape': 'grid'}}},"
            "{'extensions': {'TYN_participating_media': {'medium': 1, 'shape': 'sphere'}}},"
            "{'extensions': {'TYN_participating_media': {'medium': 2, 'shape': 'box', 'repeat': "
            "[true, false, true]}}}],"
            "'extensions': {'TYN_participating_media': {'media': ["
            "{'density': {'uri': 'a%20b.nvdb', 'grid': 'smoke', 'scale': 3}},"
            "{'density': {'uri': 'two.raw', 'size': [1, 2, 1], 'type': 'f32'}},"
            "{'density': {'uri': './two.raw', 'size': [1, 2, 1], 'type': 'f32', 'scale': 0}}]}}}"));
    assert_int_equal(s.num_volumes, 2); // the raw file is there once
    assert_int_equal(s.media[0].volume, 0);
    assert_int_equal(s.media[1].volume, 1);
    assert_int_equal(s.media[2].volume, 1);
    assert_true(s.media[0].density_scale == 3);
    assert_true(s.media[2].sigma_s[0] == 0 && s.media[2].sigma_a[0] == 0); // scale 0
    assert_true(s.volumes[0].data[0] == 2 && s.volumes[0].max_density == 15);
    assert_true(s.volumes[1].data[0] == 0 && s.volumes[1].data[1] == 3);
    assert_int_equal(s.clamped_negative, 1);
    assert_int_equal(s.num_warnings, 1);
    // Voxel centres at half their index, outer corners half a voxel further out: x from 0.75 to
    // 2.75.
    NEAR(s.shapes[0].to_world, 2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0.5f, 0, 101.75f, 0.25f, 0, 1);
    assert_int_equal(s.shapes[1].kind, TYN_SHAPE_SPHERE);
    assert_true(s.shapes[2].repeat[0] && !s.shapes[2].repeat[1] && s.shapes[2].repeat[2]);
    tyn_scene_finish(&s);
}

// Every form of a phase function, for all channels or for each.
static void phases(void **state)
{
    static const struct {
        const char *phase;
        float g[3];
        uint32_t tables[3];
    } cases[] = {
        {"{'lobes': [{'g': 0.3}]}", {0.3f, 0.3f, 0.3f}, {0, 0, 0}},
        {"{'lobes': [{'g': 0.85, 'weight': 0.9}, {'g': -0.3, 'weight': 0.1}]}",
         {0.735f, 0.735f, 0.735f},
         {1, 1, 1}},
        {"{'lobes': [{'alpha': 1}]}", {0, 0, 0}, {1, 1, 1}},
        {"{'droplets': 10}", {0.864164f, 0.864164f, 0.864164f}, {1, 1, 1}},
        {"{'legendre': [1, 0.25, 0.1]}", {0.25f, 0.25f, 0.25f}, {1, 1, 1}},
        {"{'angles': [0, 180], 'values': [0.07957747, 0.07957747]}", {0, 0, 0}, {1, 1, 1}},
        {"[{'droplets': 10}, {'legendre': [1, -0.25]}, {'lobes': [{'g': 0.6}]}]",
         {0.864164f, -0.25f, 0.6f},
         {1, 2, 0}},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char text[1024];
        tyn_scene s;
        snprintf(text, sizeof text,
                 ASSET ", 'extensions': {'TYN_participating_media': {'media': [{'phase': %s}]}}}",
                 cases[i].phase);
        load(&s, quoted(text));
        for (int c = 0; c < 3; c++) {
            assert_true(fabsf(s.media[0].phase[c].g - cases[i].g[c]) < 1e-5f);
            assert_int_equal(s.media[0].phase[c].table, cases[i].tables[c]);
        }
        assert_int_equal(tyn_scene_check(&s, NULL), TYN_OK);
        assert_int_equal(s.num_warnings, 0);
        tyn_scene_finish(&s);
    }
}

// A member of the two extensions that is not known is named, the first of them; what any object may have is no such.
static void unknown_members(void **state)
{
    static const struct {
        const char *medium, *shape, *map, *warning;
    } cases[] = {
        {"'name': 'fog', 'scattering': 1, 'extras': {'a': 1}", "'extras': 2", "'name': 'sky'",
         NULL},
        {"'scatering': 1", "", "",
         "extensions.TYN_participating_media.media[0].scatering: not known and left out; known "
         "here: scattering absorption emission density temperature emission_density albedo phase "
         "anisotropy"},
        {"'absorption': 1", "'Shape': 'sphere'", "'turn': 3",
         "nodes[0].extensions.TYN_participating_media.Shape and 1 more: not known and left out; "
         "known here: medium shape repeat"},
        {"'density scattering': 1", "", "",
         "extensions.TYN_participating_media.media[0].density scattering: not known and left out; "
         "known here: scattering absorption emission density temperature emission_density albedo "
         "phase "
         "anisotropy"},
        {"'scatt\\nering': 1", "", "",
         "extensions.TYN_participating_media.media[0].scatt?ering: not known and left out; known "
         "here: scattering absorption emission density temperature emission_density albedo phase "
         "anisotropy"},
        {"'phase': [{'droplets': 9}, {'droplets': 9}, {'lobes': [{'G': 0.5}]}]", "", "",
         "extensions.TYN_participating_media.media[0].phase[2].lobes[0].G: not known and left out; "
         "known here: weight g alpha"},
        {"", "", "'Radiance': [1, 1, 1]",
         "extensions.TYN_environment_map.environments[0].Radiance: not known and left out; known "
         "here: uri radiance rotation"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char text[2048];
        tyn_scene s;
        snprintf(text, sizeof text,
                 ASSET ", 'scene': 0, 'scenes': [{'nodes': [0], 'extensions': "
                       "{'TYN_environment_map': {'environment': 0}}}], 'nodes': [{'extensions': "
                       "{'TYN_participating_media': {'medium': 0%s%s}}}], 'extensions': "
                       "{'TYN_participating_media': {'media': [{%s}]}, 'TYN_environment_map': "
                       "{'environments': [{'radiance': 1%s%s}]}}}",
                 *cases[i].shape ? ", " : "", cases[i].shape, cases[i].medium,
                 *cases[i].map ? ", " : "", cases[i].map);
        load(&s, quoted(text));
        assert_int_equal(s.num_warnings, cases[i].warning != NULL);
        if (cases[i].warning) {
            assert_string_equal(s.warnings[0], cases[i].warning);
        }
        tyn_scene_finish(&s);
    }
}

static void environments(void **state)
{
    const uint8_t hdr[] =
        "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n\x80\x80\x80\x81\x40\x40\x40\x81";
    tyn_scene s;
    (void)state;
    io_put("sky.hdr", hdr, sizeof hdr - 1);
    const char *text =
        quoted(ASSET ", 'scenes': [{'extensions': {'TYN_environment_map': {'environment': 1}}}],"
                     "'extensions': {'TYN_environment_map': {'environments': [{'radiance': 2},"
                     "{'uri': 'sky.hdr', 'radiance': [1, 2, 3], 'rotation': [0, 1, 0, 0]}]}}}");
    load(&s, text);
    // A map of 2 x 1 texels is refined: the centres of the old texels keep their values.
    assert_true(s.environment.present && s.environment.size[0] == 66 &&
                s.environment.size[1] == 33);
    NEAR(s.environment.data + 3 * 16, 1, 1, 1);
    NEAR(s.environment.data + 3 * 49, 0.5f, 0.5f, 0.5f);
    NEAR(s.environment.radiance, 1, 2, 3);
    NEAR(s.environment.rotation, 0, 1, 0, 0);
    assert_true(s.environment.strength == 1);
    tyn_scene_finish(&s);
    // Another map replaces it whole.
    io_log log;
    io_log_init(&log);
    const char *path = io_put_text("scene.gltf", text);
    assert_int_equal(tyn_scene_load(&s, path, io_path("sky.hdr"), &log.log), TYN_OK);
    NEAR(s.environment.radiance, 1, 1, 1);
    NEAR(s.environment.rotation, 0, 0, 0, 1);
    tyn_scene_finish(&s);
    load(&s, quoted(ASSET
                    ", 'scenes': [{'extensions': {'TYN_environment_map': {'environment': 0}}}],"
                    "'extensions': {'TYN_environment_map': {'environments': [{'radiance': 2}]}}}"));
    assert_true(s.environment.present && !s.environment.data && s.environment.radiance[2] == 2);
    tyn_scene_finish(&s);
}

// In a sequence a run of # in the name of a file is the picture's number.
static void numbered_files(void **state)
{
    tyn_scene s;
    io_log log;
    (void)state;
    io_log_init(&log);
    io_put("smoke.0007.raw", "\0\1\2\3\4\5\6\7", 8);
    const char *text = "{'uri': 'smoke.####.raw', 'size': [2, 2, 2], 'type': 'u8'}";
    char whole[1024];
    snprintf(whole, sizeof whole,
             ASSET ", 'scenes': [{'nodes': [0]}], 'scene': 0, 'nodes': [{'extensions': "
                   "{'TYN_participating_media': {'medium': 0, 'shape': 'box'}}}], 'extensions': "
                   "{'TYN_participating_media': {'media': [{'scattering': 1, 'density': %s}]}}}",
             text);
    const char *path = io_put_text("sequence.gltf", quoted(whole));
    assert_int_equal(tyn_scene_load_frame(&s, path, NULL, 7, &log.log), TYN_OK);
    assert_int_equal(s.num_volumes, 1);
    assert_true(s.volumes[0].data[7] == 7.0f / 255);
    tyn_scene_finish(&s);
    assert_int_equal(log.errors, 0);
    assert_int_equal(tyn_scene_load_frame(&s, path, NULL, 12345, &log.log), TYN_ERR_IO);
    assert_non_null(strstr(log.last, "smoke.12345.raw"));
    io_log_init(&log);
    assert_int_equal(tyn_scene_load(&s, path, NULL, &log.log), TYN_ERR_PARAMS);
    assert_non_null(strstr(log.last, "smoke.####.raw"));
    assert_non_null(strstr(log.last, "--frame"));
}

typedef struct found_files {
    char text[1024];
} found_files;

static void add_file(void *user, const char *path)
{
    found_files *found = user;
    const char *slash = strrchr(path, '/');
    strncat(found->text, slash ? slash + 1 : path, sizeof found->text - strlen(found->text) - 2);
    strcat(found->text, "|");
}

// What a scene is read from: names decoded, of a sequence numbered, data left out; of a binary one as well.
static void files(void **state)
{
    io_log log;
    (void)state;
    io_log_init(&log);
    const char *text = quoted(
        ASSET
        ", 'buffers': [{'byteLength': 12, 'uri': 'my%20data.bin'},"
        "{'byteLength': 1, 'uri': 'data:application/octet-stream;base64,AAAA'}],"
        "'images': [{'uri': 'none.png'}, {'uri': 'https://example.org/a.png'}], 'extensions':"
        "{'TYN_participating_media': {'media': [{'density': {'uri': 'smoke-%23%23.nvdb'}}]}}}");
    found_files found = {""};
    const uint32_t frame = 7;
    const char *path = io_put_text("files.gltf", text);
    assert_int_equal(tyn_scene_files(path, &frame, add_file, &found, &log.log), TYN_OK);
    assert_string_equal(found.text, "files.gltf|my data.bin|none.png|smoke-07.nvdb|");
    uint8_t glb[1024] = "glTF";
    const uint32_t json = (uint32_t)(strlen(text) + 3) & ~3u, total = 20 + json, version = 2;
    memset(glb + 20, ' ', json);
    memcpy(glb + 4, &version, 4);
    memcpy(glb + 8, &total, 4);
    memcpy(glb + 12, &json, 4);
    memcpy(glb + 16, "JSON", 4);
    memcpy(glb + 20, text, strlen(text));
    found.text[0] = 0;
    path = io_put("files.glb", glb, total);
    assert_int_equal(tyn_scene_files(path, &frame, add_file, &found, &log.log), TYN_OK);
    assert_string_equal(found.text, "files.glb|my data.bin|none.png|smoke-07.nvdb|");
    found.text[0] = 0;
    assert_int_equal(tyn_scene_files("a.nvdb", NULL, add_file, &found, &log.log), TYN_OK);
    assert_string_equal(found.text, "a.nvdb|");
    assert_int_equal(log.errors, 0);
    path = io_put_text("broken.gltf", "{");
    assert_int_equal(tyn_scene_files(path, NULL, add_file, &found, &log.log), TYN_ERR_PARAMS);
    assert_int_equal(log.errors, 1);
}

static void containers(void **state)
{
    tyn_scene s;
    io_log log;
    (void)state;
    io_log_init(&log);
    io_put("data.bin", "123456789012", 12);
    io_put("a+b 50%off.bin", "123456789012", 12);
    const char *buffers =
        "'buffers': [{'byteLength': 12%s}], 'bufferViews': [{'buffer': 0, 'byteLength': 12}],"
        "'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': 1, 'type': 'VEC3'}],"
        "'meshes': [{'primitives': [{'mode': 0, 'attributes': {'POSITION': 0}}]}], 'nodes': "
        "[{'mesh': 0}]}";
    const char *uris[] = {", 'uri': 'data.bin'", ", 'uri': 'a+b%2050%off.bin'",
                          ", 'uri': 'data:application/octet-stream;base64,AAAAAAAAAAAAAAAA'"};
    char text[2048], part[1024];
    for (int i = 0; i < 3; i++) {
        snprintf(part, sizeof part, buffers, uris[i]);
        snprintf(text, sizeof text, ASSET ", 'images': [{'uri': 'none.png'}], %s", part);
        load(&s, quoted(text));
        assert_int_equal(s.num_meshes, 1);
        tyn_scene_finish(&s);
    }
    // Binary: JSON padded to four bytes, then the buffer.
    snprintf(part, sizeof part, buffers, "");
    snprintf(text, sizeof text, ASSET ", %s", part);
    uint8_t glb[2048] = "glTF";
    uint32_t json = (uint32_t)(strlen(text) + 3) / 4 * 4, bin = 12, total = 20 + json + 8 + bin,
             version = 2;
    memset(glb + 20, ' ', json);
    memcpy(glb + 4, &version, 4);
    memcpy(glb + 8, &total, 4);
    memcpy(glb + 12, &json, 4);
    memcpy(glb + 16, "JSON", 4);
    memcpy(glb + 20, quoted(text), strlen(text));
    memcpy(glb + 20 + json, &bin, 4);
    memcpy(glb + 24 + json, "BIN", 4);
    const char *path = io_put("scene.glb", glb, total);
    assert_int_equal(tyn_scene_load(&s, path, NULL, &log.log), TYN_OK);
    assert_int_equal(s.num_meshes, 1);
    tyn_scene_finish(&s);
    for (uint32_t cut = 0; cut < total; cut++) { // truncated anywhere
        io_log_init(&log);
        assert_int_equal(tyn_gltf_parse(&s, glb, cut, "cut.glb", NULL, NULL, &log.log),
                         TYN_ERR_PARAMS);
        assert_int_equal(log.errors, 1);
        assert_int_equal(log.newlines, 0);
    }
}

// A long chain of nodes is no deep recursion.
static void long_chain(void **state)
{
    enum { COUNT = 20000 };
    char *text = malloc(COUNT * 64), *p = text;
    tyn_scene s;
    (void)state;
    p += sprintf(p, "{\"asset\": {\"version\": \"2.0\"}, \"nodes\": [");
    for (int i = 0; i < COUNT - 1; i++) {
        p += sprintf(p, "{\"children\": [%d]},", i + 1);
    }
    sprintf(p, "{}]}");
    load(&s, text);
    tyn_scene_finish(&s);
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nodes),          cmocka_unit_test(camera_order),
        cmocka_unit_test(volumes),        cmocka_unit_test(unknown_members),
        cmocka_unit_test(phases),         cmocka_unit_test(environments),
        cmocka_unit_test(numbered_files), cmocka_unit_test(containers),
        cmocka_unit_test(files),          cmocka_unit_test(long_chain)};
    return cmocka_run_group_tests(tests, NULL, io_test_clean);
}
