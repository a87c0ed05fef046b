// io_gltf_broken.c -- every fault of a scene file is one line with the file, the place and the
// remedy.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "io_test.h"

#define A "{'asset': {'version': '2.0'}, "
#define NODE A "'nodes': [{"
#define MEDIUM A "'extensions': {'TYN_participating_media': {'media': [{"
#define LIGHT A "'extensions': {'KHR_lights_punctual': {'lights': [{"
#define CAMERA A "'cameras': [{"
#define BUFFER A "'buffers': [{'byteLength': 12, 'uri': 'data:;base64,AAAAAAAAAAAAAAAA'}], "
#define VIEW BUFFER "'bufferViews': [{'buffer': 0, 'byteLength': 12}], "

// JSON with ' for "; what the line must say.
static const struct {
    const char *text, *says, *also;
} files[] = {
    // Not JSON, or not as it should be.
    {"", "not valid JSON, line 1", ""},
    {"PNG", "not valid JSON, line 1", ""},
    {"[]", "must be an object", ""},
    {A "'nodes': [{}]", "not valid JSON", ""},
    {A "\n\n'nodes': [{} {}]}", "line 3", ""},
    {A "'nodes': []} {}", "text after the end", ""},
    {A "'nodes': [], 'nodes': []}", "nodes = []", "only once"},
    {"{'asset': {'version': '2.0'}, 'scenes': 1e999}", "scenes = ", "finite"},
    // The asset and what it requires.
    {"{}", "asset.version must be", ""},
    {"{'asset': {'version': '1.0'}}", "only glTF 2", ""},
    {"{'asset': 3}", "asset = 3", "must be an object"},
    {A "'extensionsRequired': ['KHR_draco_mesh_compression']}", "KHR_draco_mesh_compression",
     "'gltf-transform cp IN.glb OUT.glb' unpacks"},
    {A "'extensionsRequired': ['EXT_meshopt_compression']}", "EXT_meshopt_compression",
     "'gltf-transform cp IN.glb OUT.glb' unpacks"},
    {A "'extensionsRequired': ['EXT_texture_webp']}", "EXT_texture_webp",
     "'gltf-transform png IN.glb OUT.glb' unpacks"},
    {A "'extensionsRequired': ['EXT_something']}", "EXT_something", "not known"},
    // What is downloaded in place of a file.
    {"\n <!DOCTYPE html><html>", "a page of HTML", "raw"},
    {"<?xml version='1.0'?>", "a page of HTML", ""},
    {"version https://git-lfs.github.com/spec/v1\noid sha256:7\nsize 1\n", "Git LFS",
     "git lfs pull"},
    {"PK\x03\x04", "a zip archive", ""},
    {A "'extensionsRequired': [7]}", "extensionsRequired[0] = 7", "not known"},
    // Nodes.
    {A "'nodes': [7]}", "nodes[0] = 7", "must be an object"},
    {A "'nodes': {}}", "must be an array", ""},
    {NODE "'children': [1]}]}", "nodes[0].children[0] = 1", "there are 1"},
    {NODE "'children': [-1]}]}", "children[0] = -1", "index"},
    {NODE "'children': [0.5]}]}", "children[0] = 0.5", "index"},
    {NODE "'children': [0]}]}", "cycle", "nodes[0].children"},
    {NODE "'children': [1]}, {'children': [2]}, {'children': [0]}]}", "cycle", ""},
    {NODE "'children': [2]}, {'children': [2]}, {}]}", "two parents", ""},
    {NODE "'children': [1]}, {}], 'scenes': [{'nodes': [1]}]}", "root node", ""},
    {NODE "}], 'scenes': [{'nodes': [1]}]}", "scenes[0].nodes[0] = 1", ""},
    {NODE "}], 'scenes': [{'nodes': [0, 0]}]}", "named once", ""},
    {A "'scene': 1, 'scenes': [{}]}", "scene = 1", "there are 1"},
    {NODE "'mesh': 0}]}", "nodes[0].mesh = 0", "there are 0"},
    {NODE "'camera': 3}]}", "camera = 3", ""},
    {NODE "'matrix': [1, 2, 3]}]}", "array of 16", ""},
    {NODE "'matrix': [1,0,0,1, 0,1,0,0, 0,0,1,0, 0,0,0,1]}]}", "last row", ""},
    {NODE "'scale': [1, 'two', 3]}]}", "nodes[0].scale[1] = \"two\"", "finite"},
    {NODE "'scale': [1, 1e999, 3]}]}", "scale[1]", "finite"},
    {NODE "'rotation': [0, 0, 0, 0]}]}", "unit quaternion", ""},
    {NODE "'scale': [1, 1, 1], 'matrix': [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]}]}",
     "either a matrix", ""},
    {NODE "'name': 7}]}", "nodes[0].name = 7", "string"},
    // Buffers.
    {A "'buffers': [{'byteLength': 12}]}", "uri is missing", ""},
    {A "'buffers': [{'uri': 'none.bin'}]}", "byteLength is missing", ""},
    {A "'buffers': [{'byteLength': 12, 'uri': 'none.bin'}]}", "none.bin", "No such file"},
    {A "'buffers': [{'byteLength': 99, 'uri': 'data:;base64,AAAA'}]}", "data:", ""},
    {A "'buffers': [{'byteLength': -1, 'uri': 'a.bin'}]}", "byteLength = -1", ""},
    {A "'buffers': [{'byteLength': 1e15, 'uri': 'a.bin'}]}", "byteLength = 1e+15", ""},
    {BUFFER "'bufferViews': [{'buffer': 1, 'byteLength': 1}]}", "buffer = 1", "there are 1"},
    {BUFFER "'bufferViews': [{'buffer': 0, 'byteLength': 13}]}", "reaches byte 13", "ends at 12"},
    {BUFFER "'bufferViews': [{'buffer': 0, 'byteOffset': 12, 'byteLength': 1}]}", "reaches byte 13",
     ""},
    {VIEW "'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': 2, 'type': 'VEC3'}]}",
     "reaches byte 24", ""},
    {VIEW "'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': 1e9, 'type': 'VEC3'}]}",
     "reaches byte", ""},
    {VIEW "'accessors': [{'bufferView': 9, 'componentType': 5126, 'count': 1, 'type': 'VEC3'}]}",
     "bufferView = 9", ""},
    {VIEW "'accessors': [{'bufferView': 0, 'componentType': 5124, 'count': 1, 'type': 'VEC3'}]}",
     "accessors[0]", "needs"},
    {VIEW "'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': 1, 'type': 'VEC9'}]}",
     "accessors[0]", "needs"},
    {VIEW
     "'accessors': [{'componentType': 5126, 'count': 1, 'type': 'VEC3', 'sparse': {'count': 1}}]}",
     "sparse", "needs"},
    {VIEW
     "'accessors': [{'componentType': 5126, 'count': 3, 'type': 'VEC3', 'sparse': {'count': 1, "
     "'indices': {'bufferView': 0, 'componentType': 5122}, 'values': {'bufferView': 0}}}]}",
     "componentType must be 5121", ""},
    {A "'accessors': [{'componentType': 5126, 'count': 134217728, 'type': 'VEC3'}], 'meshes': "
       "[{'primitives': [{'attributes': {'POSITION': 0}}]}], 'nodes': [{'mesh': 0}]}",
     "accessors[0].count", "without a bufferView"},
    // Instances of what has no area, of a file without a buffer.
    {A "'accessors': [{'componentType': 5126, 'count': 4194304, 'type': 'VEC3'}, {'componentType': "
       "5126, 'count': 999999, 'type': 'VEC3'}], 'meshes': [{'primitives': [{'attributes': "
       "{'POSITION': 1}}]}], 'nodes': [{'mesh': 0, 'extensions': {'EXT_mesh_gpu_instancing': "
       "{'attributes': {'TRANSLATION': 0}}}}]}",
     "primitives[0]", "vertices and indices"},
    {A "'meshes': [{'primitives': [{'attributes': {'POSITION': 0}}]}]}", "POSITION = 0",
     "there are 0"},
    {A "'meshes': [{'primitives': [{'attributes': {}, 'indices': 4}]}]}", "indices = 4", ""},
    {A "'meshes': [{'primitives': [{'attributes': {}, 'material': 0}]}]}", "material = 0", ""},
    // Cameras and lights.
    {CAMERA "'type': 'fisheye'}]}", "cameras[0]", "perspective"},
    {CAMERA "'type': 'perspective'}]}", "perspective is missing", ""},
    {CAMERA "'type': 'perspective', 'perspective': {'yfov': 4, 'znear': 1}}]}", "yfov = 4", "pi"},
    {CAMERA "'type': 'perspective', 'perspective': {'yfov': 1}}]}", "znear is missing", ""},
    {CAMERA
     "'type': 'orthographic', 'orthographic': {'xmag': 1, 'ymag': 0, 'znear': 0, 'zfar': 1}}]}",
     "ymag = 0", "> 0"},
    {A "'cameras': [{'type': 'perspective', 'perspective': {'yfov': 1, 'znear': 1}}], 'nodes': "
       "[{'camera': 0, 'scale': [1, 1, 0]}]}",
     "flat", ""},
    {LIGHT "'type': 'area'}]}}}", "lights[0]", "directional"},
    {LIGHT "'type': 'point', 'intensity': -1}]}}}", "intensity = -1", ">= 0"},
    {LIGHT "'type': 'point', 'color': [1, 1]}]}}}", "color", "array of 3"},
    {LIGHT "'type': 'spot'}]}}}", "spot is missing", ""},
    {LIGHT "'type': 'spot', 'spot': {'outerConeAngle': 3}}]}}}", "outerConeAngle = 3", "pi/2"},
    {LIGHT "'type': 'spot', 'spot': {'innerConeAngle': 1, 'outerConeAngle': 0.5}}]}}}",
     "innerConeAngle", "<="},
    {NODE "'extensions': {'KHR_lights_punctual': {'light': 0}}}]}", "light = 0", "there are 0"},
    // Media.
    {MEDIUM "'scattering': -1}]}}}", "media[0].scattering = -1", ">= 0"},
    {MEDIUM "'scattering': [1, 2, -3]}]}}}", "scattering[2] = -3", ">= 0"},
    {MEDIUM "'absorption': [1, 2]}]}}}", "array of 3", ""},
    // Phase functions.
    {MEDIUM "'phase': 3}]}}}", "media[0].phase = 3", "must be an object"},
    {MEDIUM "'phase': {}}]}}}", "media[0].phase = ", "must have one of lobes"},
    {MEDIUM "'phase': {'angles': [0, 180]}}]}}}", "media[0].phase = ", "angles with values"},
    {MEDIUM "'phase': {'droplets': 20, 'legendre': [1]}}]}}}",
     "media[0].phase = ", "must have one"},
    {MEDIUM "'phase': {'droplets': 2}}]}}}", "phase.droplets = 2", "between 5 and 50"},
    {MEDIUM "'anisotropy': 0.5, 'phase': {'droplets': 20}}]}}}", "beside anisotropy",
     "one of the two"},
    {MEDIUM "'phase': [{'droplets': 20}]}]}}}", "media[0].phase = ", "three of them"},
    {MEDIUM "'phase': [{'droplets': 20}, {'droplets': 20}, 1]}]}}}", "media[0].phase[2] = 1",
     "must be an object"},
    {MEDIUM "'phase': {'lobes': []}}]}}}", "phase.lobes = []", "1 to 16 lobes"},
    {MEDIUM "'phase': {'lobes': [{'g': 1}]}}]}}}", "phase.lobes[0].g = 1", "between -0.999"},
    {MEDIUM "'phase': {'lobes': [{'weight': 0.9}, {'weight': 0.3}]}}]}}}", "media[0].phase.lobes",
     "add up to 1.2"},
    {MEDIUM "'phase': {'legendre': [1, 'x']}}]}}}", "phase.legendre[1] = \"x\"", "a number"},
    {MEDIUM "'phase': {'legendre': [1, 0.9, 0.1]}}]}}}", "media[0].phase: it is -8.9",
     "must be >= 0"},
    {MEDIUM "'phase': {'legendre': [2]}}]}}}", "media[0].phase.legendre[0] = 2",
     "between -1 and 1"},
    {MEDIUM "'phase': {'angles': [0, 90, 180], 'values': [1, 1]}}]}}}", "phase.values = [1,1]",
     "as many as there are angles, 3"},
    {MEDIUM "'phase': {'angles': [0, 90, 180], 'values': [1, 1, 1]}}]}}}",
     "integral over the sphere is 12.566", "must be 1"},
    {MEDIUM "'phase': {'angles': [0, 90, 90, 180], 'values': [1, 1, 1, 1]}}]}}}",
     "media[0].phase.angles[2] = 90", "greater than the one before it"},
    {MEDIUM "'phase': {'angles': [0, 90, 180], 'values': [1, -1, 1]}}]}}}",
     "media[0].phase.values[1] = -1", ">= 0"},
    {MEDIUM "'phase': {'angles': [1, 90, 180], 'values': [1, 1, 1]}}]}}}", "angles[0] = 1",
     "must be 0"},
    {MEDIUM "'absorption': 1e999}]}}}", "media[0].absorption", "finite"},
    {MEDIUM "'anisotropy': 1}]}}}", "anisotropy = 1", "both excluded"},
    {MEDIUM "'anisotropy': [0, 0, -1.5]}]}}}", "anisotropy[2] = -1.5", "both excluded"},
    {MEDIUM "'emission': null}]}}}", "emission = null", ""},
    {MEDIUM "'density': {}}]}}}", "uri is missing", ""},
    {MEDIUM "'density': {'uri': 7}}]}}}", "uri = 7", "name of a file"},
    {MEDIUM "'density': {'uri': 'none.nvdb'}}]}}}", "density.uri = \"none.nvdb\"", "No such file"},
    {MEDIUM "'density': {'uri': 'none.txt'}}]}}}", "unknown kind", ""},
    {MEDIUM "'density': {'uri': 'data:;base64,AAAA'}}]}}}", "beside the scene", ""},
    {MEDIUM "'density': {'uri': 'a%00b.nvdb'}}]}}}", "zero byte", ""},
    {MEDIUM "'density': {'uri': 'four.raw'}}]}}}", "needs \"size\"", ""},
    {MEDIUM "'density': {'uri': 'four.raw', 'size': [1, 1, 2], 'type': 'f32'}}]}}}", "four.raw",
     "has 4 bytes"},
    {MEDIUM "'density': {'uri': 'four.raw', 'size': [0, 1, 1], 'type': 'f32'}}]}}}", "size[0] = 0",
     ""},
    {MEDIUM "'density': {'uri': 'four.raw', 'size': [1, 1, 1], 'type': 'f64'}}]}}}", "\"f16\"", ""},
    {MEDIUM "'density': {'uri': 'four.raw', 'size': [1, 1, 1], 'type': 'f32', 'scale': -1}}]}}}",
     "scale = -1", ""},
    {MEDIUM "'density': {'uri': 'nan.raw', 'size': [1, 1, 1], 'type': 'f32'}}]}}}",
     "must be finite", ""},
    {MEDIUM "'density': {'uri': 'text.nvdb'}}]}}}", "text.nvdb", "must start with"},
    {NODE "'extensions': {'TYN_participating_media': {'medium': 0}}}]}", "medium = 0",
     "there are 0"},
    {NODE "'extensions': {'TYN_participating_media': {}}}]}", "medium is missing", ""},
    {NODE "'extensions': {'TYN_participating_media': {'medium': 0, 'shape': 'torus'}}}], "
          "'extensions': {'TYN_participating_media': {'media': [{}]}}}",
     "shape = \"torus\"", "sphere"},
    {NODE "'extensions': {'TYN_participating_media': {'medium': 0, 'shape': 'grid'}}}], "
          "'extensions': {'TYN_participating_media': {'media': [{}]}}}",
     "grid of their own", ""},
    {NODE "'extensions': {'TYN_participating_media': {'medium': 0, 'shape': 'sphere', 'repeat': "
          "[true, true, true]}}}], 'extensions': {'TYN_participating_media': {'media': [{}]}}}",
     "on a box", ""},
    {NODE "'extensions': {'TYN_participating_media': {'medium': 0, 'repeat': [1, 0, 1]}}}], "
          "'extensions': {'TYN_participating_media': {'media': [{}]}}}",
     "repeat[0] = 1", "true or false"},
    {NODE "'scale': [1, 0, 1], 'extensions': {'TYN_participating_media': {'medium': 0}}}], "
          "'extensions': {'TYN_participating_media': {'media': [{}]}}}",
     "invertible", ""},
    // Environments.
    {A "'scenes': [{'extensions': {'TYN_environment_map': {'environment': 0}}}]}",
     "environment = 0", "there are 0"},
    {A "'scenes': [{'extensions': {'TYN_environment_map': {}}}]}", "environment is missing", ""},
    {A "'scenes': [{'extensions': {'TYN_environment_map': {'environment': 0}}}], 'extensions': "
       "{'TYN_environment_map': {'environments': [{}]}}}",
     "needs a uri", ""},
    {A "'scenes': [{'extensions': {'TYN_environment_map': {'environment': 0}}}], 'extensions': "
       "{'TYN_environment_map': {'environments': [{'radiance': -1}]}}}",
     "radiance = -1", ">= 0"},
    {A "'scenes': [{'extensions': {'TYN_environment_map': {'environment': 0}}}], 'extensions': "
       "{'TYN_environment_map': {'environments': [{'radiance': 1, 'rotation': [0, 0, 0, 0]}]}}}",
     "unit quaternion", ""},
    {A "'scenes': [{'extensions': {'TYN_environment_map': {'environment': 0}}}], 'extensions': "
       "{'TYN_environment_map': {'environments': [{'uri': 'none.exr'}]}}}",
     "uri = \"none.exr\"", "No such file"},
    {A "'scenes': [{'extensions': {'TYN_environment_map': {'environment': 0}}}], 'extensions': "
       "{'TYN_environment_map': {'environments': [{'uri': 'text.nvdb'}]}}}",
     "must be .exr or .hdr", ""},
};

static void check(const char *name, const char *text, const char *says, const char *also)
{
    char json[8192];
    tyn_scene scene;
    io_log log;
    io_log_init(&log);
    snprintf(json, sizeof json, "%s", text);
    for (char *c = json; *c; c++) {
        *c = *c == '\'' ? '"' : *c;
    }
    const char *path = io_put_text(name, json);
    tyn_result r = tyn_scene_load(&scene, path, NULL, &log.log);
    bool right = (r == TYN_ERR_PARAMS || r == TYN_ERR_IO) && log.errors == 1 && log.warnings == 0 &&
                 log.newlines == 0 && strncmp(log.last, path, strlen(path)) == 0 &&
                 strstr(log.last, says) && strstr(log.last, also);
    if (!right) {
        print_error("%s\n  gave %d, %d errors: %s\n", json, r, log.errors, log.last);
    }
    assert_true(right);
    assert_true(scene.num_volumes == 0 && scene.num_media == 0 && scene.cameras == NULL);
}

static void one_line_each(void **state)
{
    const float one = 1, nan_value = 0.0f / 0.0f * (float)(state != NULL);
    io_put("four.raw", &one, 4);
    io_put("nan.raw", &nan_value, 4);
    io_put("text.nvdb", "not a volume, and more than sixteen bytes", 41);
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        check("bad.gltf", files[i].text, files[i].says, files[i].also);
    }
    print_message("%zu broken scenes\n", sizeof files / sizeof files[0]);
}

static void nesting(void **state)
{
    static const char head[] = "{\"extras\":";
    const size_t before = sizeof head - 1, depths[] = {65, 66, 100000};
    (void)state;
    for (int i = 0; i < 3; i++) {
        size_t depth = depths[i], size = before + 2 * depth + 1;
        char *text = malloc(size);
        tyn_scene scene;
        io_log log;
        io_log_init(&log);
        assert_non_null(text);
        memcpy(text, head, before);
        memset(text + before, '[', depth);
        memset(text + before + depth, ']', depth);
        text[size - 1] = '}';
        const char *path = io_put("deep.gltf", text, size);
        assert_int_equal(tyn_scene_load(&scene, path, NULL, &log.log), TYN_ERR_PARAMS);
        assert_int_equal(log.errors, 1);
        assert_non_null(strstr(log.last, "deeper than 64"));
        free(text);
    }
}

static void limits(void **state)
{
    char *text = malloc(100000), *p = text;
    (void)state;
    p += sprintf(p, A "'extensions': {'TYN_participating_media': {'media': [{}");
    for (int i = 0; i < 16; i++) {
        p += sprintf(p, ", {}");
    }
    sprintf(p, "]}}}");
    check("many.gltf", text, "media[16]", "there may be 16");
    free(text);
}

static void not_there(void **state)
{
    tyn_scene scene;
    io_log log;
    (void)state;
    io_log_init(&log);
    assert_int_equal(tyn_scene_load(&scene, io_path("none.gltf"), NULL, &log.log), TYN_ERR_IO);
    assert_int_equal(tyn_scene_load(&scene, "/tmp", NULL, &log.log), TYN_ERR_PARAMS);
    assert_int_equal(tyn_scene_load(&scene, "", NULL, &log.log), TYN_ERR_PARAMS);
    assert_int_equal(log.errors, 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(one_line_each), cmocka_unit_test(nesting),
                                       cmocka_unit_test(limits), cmocka_unit_test(not_there)};
    return cmocka_run_group_tests(tests, NULL, io_test_clean);
}
