// io_mesh.c -- what meshes of glTF files become: every way to write triangles, transforms, and files
// whose data is wrong.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "gltf_file.h"

#define MESH "'nodes': [{'mesh': 0}], 'meshes': [{'name': 'wall', 'primitives': [%s]}]"

// A square of 2 x 1 m in the plane z = 0, its front towards +z; v runs downwards.
static const float square[4][3] = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}};
static const float normals[4][3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
static const float texcoords[4][2] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};

static tyn_scene load(const char *path)
{
    tyn_scene scene;
    io_log log;
    io_log_init(&log);
    if (tyn_scene_load(&scene, path, NULL, &log.log) != TYN_OK) {
        print_error("%s\n", log.last);
        fail();
    }
    assert_int_equal(log.errors + log.warnings, 0);
    return scene;
}

static tyn_scene load_primitive(const gltf_file *f, const char *primitive)
{
    char rest[2048];
    snprintf(rest, sizeof rest, MESH, primitive);
    return load(gltf_file_put(f, "mesh", rest));
}

static double cross_of(const tyn_surfaces *s, uint32_t triangle, double n[3])
{
    const float *p[3];
    for (int k = 0; k < 3; k++) {
        p[k] = s->vertices[s->triangles[triangle].vertices[k]].position;
    }
    double length2 = 0;
    for (int a = 0; a < 3; a++) {
        const int b = (a + 1) % 3, c = (a + 2) % 3;
        n[a] = ((double)p[1][b] - p[0][b]) * ((double)p[2][c] - p[0][c]) -
               ((double)p[1][c] - p[0][c]) * ((double)p[2][b] - p[0][b]);
        length2 += n[a] * n[a];
    }
    return sqrt(length2);
}

// The surfaces are a flat piece of that area, with their front and all normals along `n`.
static void check_piece(const tyn_scene *scene, double area, double x, double y, double z)
{
    const tyn_surfaces *s = &scene->surfaces;
    const double front[3] = {x, y, z};
    double sum = 0;
    for (uint32_t i = 0; i < s->num_triangles; i++) {
        double n[3], along = 0;
        const double length = cross_of(s, i, n);
        for (int a = 0; a < 3; a++) {
            along += n[a] * front[a] / length;
            for (int k = 0; k < 3; k++) {
                const float *shading = s->vertices[s->triangles[i].vertices[k]].normal;
                assert_true(fabs(shading[a] - front[a]) < 1e-5);
            }
        }
        assert_true(along > 0.99999);
        sum += 0.5 * length;
    }
    if (fabs(sum - area) > 1e-5 * area) {
        print_error("area %g, expected %g\n", sum, area);
    }
    assert_true(fabs(sum - area) <= 1e-5 * area);
    assert_true(scene->surfaces.hash != 0);
}

// ---- ways to write triangles ------------------------------------------------------------------

static void indices(void **state)
{
    static const uint32_t order[6] = {0, 1, 2, 0, 2, 3};
    (void)state;
    for (int bytes = 1; bytes <= 4; bytes *= 2) {
        gltf_file f = {0};
        uint8_t packed[24] = {0};
        char primitive[256];
        for (int i = 0; i < 6; i++) {
            packed[i * bytes] = (uint8_t)order[i];
        }
        const int p = gltf_file_array(&f, 5126, "VEC3", 4, square, sizeof square);
        const int n = gltf_file_array(&f, 5126, "VEC3", 4, normals, sizeof normals);
        const int i = gltf_file_array(&f,
                                      bytes == 1   ? 5121
                                      : bytes == 2 ? 5123
                                                   : 5125,
                                      "SCALAR", 6, packed, 6 * (size_t)bytes);
        snprintf(primitive, sizeof primitive,
                 "{'attributes': {'POSITION': %d, 'NORMAL': %d}, 'indices': %d}", p, n, i);
        tyn_scene s = load_primitive(&f, primitive);
        check_piece(&s, 2, 0, 0, 1);
        assert_int_equal(s.surfaces.num_vertices, 4);
        assert_int_equal(s.surfaces.num_triangles, 2);
        assert_int_equal(s.num_meshes, 1);
        tyn_scene_finish(&s);
    }
}

static void modes(void **state)
{
    // As single triangles, a strip (its second triangle is turned), a fan; without normals.
    static const int orders[3][6] = {{0, 1, 2, 0, 2, 3}, {0, 1, 3, 2}, {1, 2, 3, 0}};
    static const int counts[] = {6, 4, 4};
    (void)state;
    for (int mode = 4; mode <= 6; mode++) {
        for (int indexed = 0; indexed < 2; indexed++) {
            gltf_file f = {0};
            char primitive[256], of_indices[32] = "";
            float positions[6][3];
            uint16_t order[6];
            const int count = counts[mode - 4];
            for (int i = 0; i < count; i++) {
                order[i] = (uint16_t)orders[mode - 4][i];
                memcpy(positions[i], square[order[i]], sizeof positions[i]);
            }
            if (indexed) {
                gltf_file_array(&f, 5126, "VEC3", 4, square, sizeof square);
                gltf_file_array(&f, 5123, "SCALAR", count, order, (size_t)count * 2);
                snprintf(of_indices, sizeof of_indices, ", 'indices': 1");
            } else {
                gltf_file_array(&f, 5126, "VEC3", count, positions, (size_t)count * 12);
            }
            snprintf(primitive, sizeof primitive, "{'attributes': {'POSITION': 0}, 'mode': %d%s}",
                     mode, of_indices);
            tyn_scene s = load_primitive(&f, primitive);
            check_piece(&s, 2, 0, 0, 1);
            assert_int_equal(s.surfaces.num_vertices, 6); // flat: none are shared
            tyn_scene_finish(&s);
        }
    }
}

// A longer strip keeps its side all along, and leaves out triangles without area.
static void strip(void **state)
{
    enum { STEPS = 7 };
    gltf_file f = {0};
    float positions[2 * STEPS + 2][3] = {{0}};
    (void)state;
    for (int i = 0; i < 2 * STEPS; i++) {
        positions[i][0] = (float)(i / 2);
        positions[i][1] = i % 2 ? 0 : 1;
    }
    memcpy(positions[2 * STEPS], positions[2 * STEPS - 1], 12);
    memcpy(positions[2 * STEPS + 1], positions[2 * STEPS - 1], 12);
    gltf_file_array(&f, 5126, "VEC3", 2 * STEPS + 2, positions, sizeof positions);
    tyn_scene s = load_primitive(&f, "{'attributes': {'POSITION': 0}, 'mode': 5}");
    assert_int_equal(s.surfaces.num_triangles, 2 * STEPS - 2);
    check_piece(&s, STEPS - 1, 0, 0, 1);
    tyn_scene_finish(&s);
}

// Integers with and without normalisation, of every size, interleaved with other bytes.
static void quantised(void **state)
{
    static const struct {
        int type, bytes;
        double one; // what stands for 1 if normalised
    } kinds[] = {{5120, 1, 127}, {5121, 1, 255}, {5122, 2, 32767}, {5123, 2, 65535}};
    (void)state;
    for (size_t k = 0; k < 4; k++) {
        for (int normalised = 0; normalised < 2; normalised++) {
            gltf_file f = {0};
            uint8_t data[4 * 12] = {0};
            const double one = normalised ? kinds[k].one : 1;
            for (int i = 0; i < 4; i++) {
                for (int c = 0; c < 3; c++) {
                    const int value = (int)(square[i][c] / 2 * one * (normalised ? 1 : 2));
                    memcpy(data + 12 * i + c * kinds[k].bytes, &value, (size_t)kinds[k].bytes);
                }
            }
            const int view = gltf_file_view(&f, data, sizeof data, 12);
            gltf_file_accessor(&f, view, 0, kinds[k].type, "VEC3", 4,
                               normalised ? ", 'normalized': true" : "");
            tyn_scene s = load_primitive(&f, "{'attributes': {'POSITION': 0}, 'mode': 6}");
            double lo, hi;
            lo = hi = s.surfaces.vertices[0].position[0];
            for (uint32_t i = 0; i < s.surfaces.num_vertices; i++) {
                lo = fmin(lo, s.surfaces.vertices[i].position[0]);
                hi = fmax(hi, s.surfaces.vertices[i].position[0]);
            }
            assert_true(lo == 0 && fabs(hi - (normalised ? 1 : 2)) < 1e-6);
            tyn_scene_finish(&s);
        }
    }
}

// Sparse values over a view, and over nothing.
static void sparse(void **state)
{
    (void)state;
    for (int based = 0; based < 2; based++) {
        gltf_file f = {0};
        float positions[4][3];
        const uint8_t replaced[3] = {1, 2, 3};
        char more[256];
        memcpy(positions, square, sizeof positions);
        positions[1][0] = positions[2][0] = 77;
        const int base = gltf_file_view(&f, positions, sizeof positions, 0);
        const int at = gltf_file_view(&f, replaced, sizeof replaced, 0);
        const int values = gltf_file_view(&f, square[1], 36, 0);
        snprintf(more, sizeof more,
                 ", 'sparse': {'count': 3, 'indices': {'bufferView': %d, 'componentType': 5121}, "
                 "'values': {'bufferView': %d}}",
                 at, values);
        gltf_file_accessor(&f, base, 0, 5126, "VEC3", 4, more);
        if (!based) { // without its view: zeros under the sparse values
            snprintf(f.accessors, sizeof f.accessors,
                     "{'componentType': 5126, 'type': 'VEC3', 'count': 4%s}", more);
        }
        tyn_scene s = load_primitive(&f, "{'attributes': {'POSITION': 0}, 'mode': 6}");
        check_piece(&s, 2, 0, 0, 1);
        tyn_scene_finish(&s);
    }
}

// ---- transforms -------------------------------------------------------------------------------

static void transforms(void **state)
{
    gltf_file f = {0};
    char rest[2048];
    (void)state;
    gltf_file_array(&f, 5126, "VEC3", 4, square, sizeof square);
    gltf_file_array(&f, 5126, "VEC3", 4, normals, sizeof normals);
    const char *shape =
        "'meshes': [{'primitives': [{'mode': 6, 'attributes': {'POSITION': 0%s}}]}]";
    static const struct {
        const char *node;
        double area, n[3];
    } cases[] = {
        {"{'mesh': 0, 'translation': [5, 6, 7]}", 2, {0, 0, 1}},
        {"{'mesh': 0, 'scale': [3, 0.5, 9]}", 3, {0, 0, 1}},
        // Mirrored across its own plane: the front is on the mirrored side; along it: it stays.
        {"{'mesh': 0, 'scale': [1, 1, -1]}", 2, {0, 0, -1}},
        {"{'mesh': 0, 'scale': [-2, 1, 1]}", 4, {0, 0, 1}},
        // y and z change places: mirrored, the front looks along +y.
        {"{'mesh': 0, 'matrix': [1,0,0,0, 0,0,1,0, 0,1,0,0, 0,0,0,1]}", 2, {0, 1, 0}},
        // Sheared: z += x tilts the square; its normal is not that of the matrix.
        {"{'mesh': 0, 'matrix': [1,0,1,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]}",
         2.8284271,
         {-0.70710678, 0, 0.70710678}},
        // Below a turned parent: 90 degrees about y, z -> x.
        {"{'children': [1], 'rotation': [0, 0.70710678, 0, 0.70710678]}, {'mesh': 0}",
         2,
         {1, 0, 0}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        for (int with_normals = 0; with_normals < 2; with_normals++) {
            char meshes[256];
            snprintf(meshes, sizeof meshes, shape, with_normals ? ", 'NORMAL': 1" : "");
            snprintf(rest, sizeof rest, "'nodes': [%s], 'scenes': [{'nodes': [0]}], %s",
                     cases[i].node, meshes);
            tyn_scene s = load(gltf_file_put(&f, "placed", rest));
            const double *n = cases[i].n;
            check_piece(&s, cases[i].area, n[0], n[1], n[2]);
            tyn_scene_finish(&s);
        }
    }
    // One mesh at two places.
    snprintf(rest, sizeof rest,
             "'nodes': [{'mesh': 0}, {'mesh': 0, 'translation': [0, 0, 3]}], 'meshes': "
             "[{'primitives': [{'mode': 6, 'attributes': {'POSITION': 0}}]}]");
    tyn_scene s = load(gltf_file_put(&f, "twice", rest));
    float lo[3], hi[3];
    assert_int_equal(s.num_meshes, 2);
    assert_int_equal(s.surfaces.num_triangles, 4);
    assert_true(tyn_scene_bounds(&s, lo, hi) && lo[2] == 0 && hi[0] == 2 && hi[2] == 3);
    check_piece(&s, 4, 0, 0, 1);
    tyn_scene_finish(&s);
}

// A normal of length 0 is replaced by the triangle's; vertices that nothing uses stay behind.
static void odd_vertices(void **state)
{
    gltf_file f = {0};
    float bad[4][3];
    const uint8_t order[3] = {0, 1, 2};
    (void)state;
    memcpy(bad, normals, sizeof bad);
    bad[1][2] = 0;
    bad[2][2] = 1e-3f;
    gltf_file_array(&f, 5126, "VEC3", 4, square, sizeof square);
    gltf_file_array(&f, 5126, "VEC3", 4, bad, sizeof bad);
    gltf_file_array(&f, 5121, "SCALAR", 3, order, 3);
    tyn_scene s = load_primitive(&f, "{'attributes': {'POSITION': 0, 'NORMAL': 1}, 'indices': 2}");
    check_piece(&s, 1, 0, 0, 1);
    assert_int_equal(s.surfaces.num_vertices, 3);
    tyn_scene_finish(&s);
}

// What is not done is left out with one line.
static void left_out(void **state)
{
    gltf_file f = {0};
    (void)state;
    gltf_file_array(&f, 5126, "VEC3", 4, square, sizeof square);
    tyn_scene s = load_primitive(&f, "{'attributes': {'POSITION': 0}, 'mode': 1}, {'attributes': "
                                     "{'POSITION': 0}, 'mode': 3}, {'attributes': {}}");
    assert_int_equal(s.surfaces.num_triangles, 0);
    assert_int_equal(s.num_warnings, 2);
    assert_string_equal(s.warnings[0], "mesh 'wall' and others: points and lines are left out");
    assert_string_equal(s.warnings[1], "mesh 'wall': a primitive without POSITION is left out");
    tyn_scene_finish(&s);
}

// A mesh without any area is told of; triangles without area among others are not, since strips are sewn with them.
static void without_area(void **state)
{
    static const float line[3][3] = {{0, 0, 0}, {1, 1, 0}, {2, 2, 0}};
    static const uint8_t sewn[] = {0, 1, 2, 2, 2, 3, 0, 2, 3};
    gltf_file f = {0};
    (void)state;
    gltf_file_array(&f, 5126, "VEC3", 4, square, sizeof square);
    gltf_file_array(&f, 5126, "VEC3", 3, line, sizeof line);
    gltf_file_array(&f, 5121, "SCALAR", 9, sewn, sizeof sewn);
    tyn_scene s = load_primitive(&f, "{'attributes': {'POSITION': 0}, 'indices': 2}");
    check_piece(&s, 2, 0, 0, 1);
    assert_int_equal(s.num_warnings, 1); // of the material that is missing
    assert_null(strstr(s.warnings[0], "area"));
    tyn_scene_finish(&s);
    s = load_primitive(&f, "{'attributes': {'POSITION': 0}, 'indices': 2},"
                           "{'attributes': {'POSITION': 1}}");
    check_piece(&s, 2, 0, 0, 1);
    assert_int_equal(s.num_warnings, 2);
    assert_string_equal(s.warnings[0],
                        "mesh 'wall': a primitive whose triangles all have no area is left out");
    tyn_scene_finish(&s);
}

// ---- wrong data -------------------------------------------------------------------------------

static void check_broken(const gltf_file *f, const char *rest, const char *says)
{
    tyn_scene scene;
    io_log log;
    io_log_init(&log);
    const char *path = gltf_file_put(f, "broken", rest);
    const tyn_result r = tyn_scene_load(&scene, path, NULL, &log.log);
    if (r != TYN_ERR_PARAMS || log.errors != 1 || log.newlines || !strstr(log.last, says)) {
        print_error("%s\n  gave %d, %d errors: %s\n", rest, r, log.errors, log.last);
        fail();
    }
    assert_null(scene.surfaces.vertices);
}

static void broken(void **state)
{
    gltf_file f = {0};
    float wrong[4][3];
    const uint16_t far[3] = {0, 1, 4};
    char more[256];
    (void)state;
    memcpy(wrong, square, sizeof wrong);
    wrong[2][1] = NAN;
    gltf_file_array(&f, 5126, "VEC3", 4, square, sizeof square);
    gltf_file_array(&f, 5126, "VEC3", 4, wrong, sizeof wrong);
    gltf_file_array(&f, 5126, "VEC2", 4, texcoords, sizeof texcoords);
    gltf_file_array(&f, 5123, "SCALAR", 3, far, sizeof far);
    gltf_file_array(&f, 5126, "SCALAR", 3, square, 12);
    gltf_file_array(&f, 5126, "VEC3", 3, normals, 36);
    const uint8_t beyond = 4;
    const int at = gltf_file_view(&f, &beyond, 1, 0);
    snprintf(more, sizeof more,
             ", 'sparse': {'count': 1, 'indices': {'bufferView': %d, 'componentType': 5121}, "
             "'values': {'bufferView': 0}}",
             at);
    gltf_file_accessor(&f, 0, 0, 5126, "VEC3", 4, more);
    static const struct {
        const char *primitive, *says;
    } cases[] = {
        {"{'attributes': {'POSITION': 0}, 'mode': 7}", "mode = 7"},
        {"{'attributes': {'POSITION': 0}}", "has 4 vertices: triangles need a multiple of 3"},
        {"{'attributes': {'POSITION': 1}, 'mode': 6}",
         "meshes[0].primitives[0].attributes.POSITION = 1: element 2 of its accessor is not "
         "finite"},
        {"{'attributes': {'POSITION': 2}, 'mode': 6}",
         "POSITION = 2: its accessor must be of type"},
        {"{'attributes': {'POSITION': 0}, 'indices': 3}", "index 2 is 4: there are 4 vertices"},
        {"{'attributes': {'POSITION': 0}, 'indices': 4}", "type SCALAR, of unsigned"},
        {"{'attributes': {'POSITION': 0, 'NORMAL': 5}, 'mode': 6}",
         "NORMAL = 5: has 3 elements, POSITION has 4"},
        {"{'attributes': {'POSITION': 6}, 'mode': 6}", "accessors[6].sparse"},
    };
    char rest[1024];
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        snprintf(rest, sizeof rest, MESH, cases[i].primitive);
        check_broken(&f, rest, cases[i].says);
    }
    check_broken(&f,
                 "'nodes': [{'mesh': 0, 'scale': [1, 0, 1]}], 'meshes': [{'primitives': "
                 "[{'mode': 6, 'attributes': {'POSITION': 0}}]}]",
                 "nodes[0] = an object: its mesh is flat");
    // Elements of no view: memory is not taken for as many as a file likes.
    snprintf(f.accessors, sizeof f.accessors,
             "{'componentType': 5126, 'type': 'VEC3', 'count': 2147483647}");
    snprintf(rest, sizeof rest, MESH, "{'mode': 6, 'attributes': {'POSITION': 0}}");
    check_broken(&f, rest, "accessors[0].count = 2147483647: at most");
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(indices),      cmocka_unit_test(modes),
                                       cmocka_unit_test(strip),        cmocka_unit_test(quantised),
                                       cmocka_unit_test(sparse),       cmocka_unit_test(transforms),
                                       cmocka_unit_test(odd_vertices), cmocka_unit_test(left_out),
                                       cmocka_unit_test(without_area), cmocka_unit_test(broken)};
    return cmocka_run_group_tests(tests, NULL, io_test_clean);
}
