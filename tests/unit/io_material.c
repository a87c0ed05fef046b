// io_material.c -- what materials and textures of glTF files become.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "gltf_file.h"
#include "jpeg_write.h"

static const float square[4][3] = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}};
static const float texcoords[4][2] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
static const float other_texcoords[4][2] = {{0, 0}, {3, 0}, {3, 3}, {0, 3}};

// Accessors: 0 positions, 1 and 2 texture coordinates.
static void square_file(gltf_file *f)
{
    *f = (gltf_file){0};
    gltf_file_array(f, 5126, "VEC3", 4, square, sizeof square);
    gltf_file_array(f, 5126, "VEC2", 4, texcoords, sizeof texcoords);
    gltf_file_array(f, 5126, "VEC2", 4, other_texcoords, sizeof other_texcoords);
}

#define SQUARE(more)                                                                               \
    "'nodes': [{'mesh': 0}], 'meshes': [{'primitives': [{'mode': 6, 'attributes': {'POSITION': 0," \
    " 'TEXCOORD_0': 1, 'TEXCOORD_1': 2}" more "}]}]"

static tyn_result try_load(const gltf_file *f, const char *rest, tyn_scene *scene, io_log *log)
{
    io_log_init(log);
    return tyn_scene_load(scene, gltf_file_put(f, "material", rest), NULL, &log->log);
}

static tyn_scene load(const gltf_file *f, const char *rest)
{
    tyn_scene scene;
    io_log log;
    if (try_load(f, rest, &scene, &log) != TYN_OK) {
        print_error("%s\n", log.last);
        fail();
    }
    return scene;
}

static tyn_scene load_material(const char *material)
{
    gltf_file f;
    char rest[2048];
    square_file(&f);
    snprintf(rest, sizeof rest, SQUARE(", 'material': 0") ", 'materials': [%s]", material);
    return load(&f, rest);
}

static void near3(const float a[3], double x, double y, double z)
{
    if (!(fabs(a[0] - x) + fabs(a[1] - y) + fabs(a[2] - z) < 1e-5 * (1 + x + y + z))) {
        print_error("%g %g %g, expected %g %g %g\n", a[0], a[1], a[2], x, y, z);
        fail();
    }
}

// ---- factors ----------------------------------------------------------------------------------

static void factors(void **state)
{
    static const struct {
        const char *json;
        double albedo[3], emission[3];
        uint32_t flags, warnings;
    } cases[] = {
        {"{'pbrMetallicRoughness': {'baseColorFactor': [0.2, 0.4, 0.6, 1], 'metallicFactor': 0}}",
         {0.2, 0.4, 0.6},
         {0, 0, 0},
         0,
         0},
        {"{'pbrMetallicRoughness': {'baseColorFactor': [0.2, 0.4, 1, 1], 'metallicFactor': 0.75}}",
         {0.05, 0.1, 0.25},
         {0, 0, 0},
         0,
         0},
        {"{'pbrMetallicRoughness': {'metallicFactor': 0}, 'emissiveFactor': [1, 0.5, 0]}",
         {1, 1, 1},
         {1, 0.5, 0},
         0,
         0},
        {"{'pbrMetallicRoughness': {'baseColorFactor': [0, 0, 0, 1]}, 'doubleSided': true, "
         "'emissiveFactor': [1, 0.5, 0.25], 'extensions': {'KHR_materials_emissive_strength': "
         "{'emissiveStrength': 40}}}",
         {0, 0, 0},
         {40, 20, 10},
         1,
         0},
        // glTF's default is a metal, which reflects nothing diffusely: that is told.
        {"{}", {0, 0, 0}, {0, 0, 0}, 0, 1},
        {"{'pbrMetallicRoughness': {'metallicFactor': 0}, 'alphaMode': 'BLEND', 'extensions': "
         "{'KHR_materials_clearcoat': {}}}",
         {1, 1, 1},
         {0, 0, 0},
         0,
         2},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        tyn_scene s = load_material(cases[i].json);
        const tyn_surface_material *m = &s.surfaces.materials[0];
        assert_int_equal(s.surfaces.num_materials, 1);
        near3(m->albedo, cases[i].albedo[0], cases[i].albedo[1], cases[i].albedo[2]);
        near3(m->emission, cases[i].emission[0], cases[i].emission[1], cases[i].emission[2]);
        assert_int_equal(m->flags, cases[i].flags);
        assert_true(m->texture == TYN_NO_TEXTURE);
        assert_int_equal(s.num_warnings, cases[i].warnings);
        tyn_scene_finish(&s);
    }
}

// Meshes without a material share one; those that share a material do too; unused ones stay behind.
static void shared(void **state)
{
    gltf_file f;
    (void)state;
    square_file(&f);
    tyn_scene s =
        load(&f, "'nodes': [{'mesh': 0}, {'mesh': 1}], 'materials': [{}, {'pbrMetallicRoughness': "
                 "{'metallicFactor': 0}}], 'meshes': [{'primitives': [{'mode': 6, 'attributes': "
                 "{'POSITION': 0}, 'material': 1}, {'mode': 6, 'attributes': {'POSITION': 0}}]}, "
                 "{'primitives': [{'mode': 6, 'attributes': {'POSITION': 0}}, {'mode': 6, "
                 "'attributes': {'POSITION': 0}, 'material': 1}]}]");
    static const uint32_t expected[8] = {0, 0, 1, 1, 1, 1, 0, 0};
    assert_int_equal(s.surfaces.num_triangles, 8);
    assert_int_equal(s.surfaces.num_materials, 2);
    for (int i = 0; i < 8; i++) {
        assert_int_equal(s.surfaces.triangles[i].material, expected[i]);
    }
    assert_int_equal(s.num_warnings, 1);
    assert_non_null(strstr(s.warnings[0], "of meshes without one"));
    tyn_scene_finish(&s);
}

// A colour that all vertices share multiplies the material's; where colours vary, facets have their own.
static void colors(void **state)
{
    (void)state;
    for (int varies = 0; varies < 2; varies++) {
        gltf_file f;
        uint8_t rgba[4][4];
        square_file(&f);
        for (int i = 0; i < 4; i++) {
            const uint8_t color[4] = {51, 102, varies ? (uint8_t)(i * 85) : 255, 0};
            memcpy(rgba[i], color, 4);
        }
        gltf_file_accessor(&f, gltf_file_view(&f, rgba, sizeof rgba, 0), 0, 5121, "VEC4", 4,
                           ", 'normalized': true");
        tyn_scene s =
            load(&f, "'nodes': [{'mesh': 0}], 'materials': [{'pbrMetallicRoughness': "
                     "{'metallicFactor': 0.5}}], 'meshes': [{'primitives': [{'mode': 6, "
                     "'attributes': {'POSITION': 0, 'COLOR_0': 3}, 'material': 0}, {'mode': 6, "
                     "'attributes': {'POSITION': 0, 'COLOR_0': 3}, 'material': 0}]}]");
        const tyn_surface_triangle *t = s.surfaces.triangles;
        if (!varies) {
            assert_int_equal(t[0].material, t[3].material);
            near3(s.surfaces.materials[t[0].material].albedo, 0.1, 0.2, 0.5);
        }
        assert_int_equal(s.num_warnings, 0);
        tyn_scene_finish(&s);
    }
}

// ---- textures ---------------------------------------------------------------------------------

static void base64(char *out, const uint8_t *bytes, size_t size)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < size; i += 3) {
        uint32_t three = 0;
        for (size_t k = 0; k < 3; k++) {
            three = three << 8 | (i + k < size ? bytes[i + k] : 0u);
        }
        for (size_t k = 0; k < 4; k++) {
            *out++ = k > size - i ? '=' : digits[three >> (18 - 6 * k) & 63];
        }
    }
    *out = 0;
}

// A picture of 3 x 2 texels; its file in memory.
static const uint8_t texels[6][3] = {{255, 0, 0},  {0, 255, 0},   {0, 0, 255},
                                     {10, 20, 30}, {128, 128, 0}, {255, 255, 255}};
static void *png_file(size_t *size)
{
    io_log log;
    void *bytes;
    io_log_init(&log);
    const char *path = io_path("a picture.png");
    assert_int_equal(tyn_png_write(path, 3, 2, 3, texels[0], &log.log), TYN_OK);
    assert_int_equal(tyn_file_read(path, 1 << 20, &bytes, size, &log.log), TYN_OK);
    return bytes;
}

#define TEXTURED                                                                                   \
    SQUARE(", 'material': 0")                                                                      \
    ", 'materials': [{'pbrMetallicRoughness': {'metallicFactor': 0, 'baseColorFactor': [1, 0.5, "  \
    "0.25, 1], 'baseColorTexture': {'index': 1%s}}}], 'textures': [{'source': 0}, {'source': 1, "  \
    "'sampler': 0}], 'samplers': [{'wrapS': 33071, 'wrapT': 33648}], 'images': [{'uri': "          \
    "'none.png'}, %s]"

static void check_texels(const tyn_texture *t)
{
    assert_int_equal(t->size[0], 3);
    assert_int_equal(t->size[1], 2);
    for (int i = 0; i < 6; i++) {
        for (int c = 0; c < 3; c++) {
            assert_int_equal(t->texels[4 * i + c], texels[i][c]);
        }
        assert_int_equal(t->texels[4 * i + 3], 255);
    }
}

// A PNG beside the scene, in a buffer, in the document; the image that nothing uses is not opened.
static void sources(void **state)
{
    size_t size;
    uint8_t *png = png_file(&size);
    (void)state;
    for (int source = 0; source < 3; source++) {
        gltf_file f;
        char rest[8192], image[4096] = "{'uri': 'a%20picture.png'}";
        square_file(&f);
        if (source == 1) {
            snprintf(image, sizeof image,
                     "{'name': 'embedded', 'mimeType': 'image/png', "
                     "'bufferView': %d}",
                     gltf_file_view(&f, png, size, 0));
        } else if (source == 2) {
            char text[3000];
            assert_true(size < 2000);
            base64(text, png, size);
            snprintf(image, sizeof image, "{'uri': 'data:image/png;base64,%s'}", text);
        }
        snprintf(rest, sizeof rest, TEXTURED, "", image);
        tyn_scene s = load(&f, rest);
        assert_int_equal(s.num_warnings, 0);
        assert_int_equal(s.surfaces.num_textures, 1);
        const tyn_texture *t = &s.surfaces.textures[0];
        check_texels(t);
        assert_int_equal(t->wrap[0], TYN_WRAP_CLAMP);
        assert_int_equal(t->wrap[1], TYN_WRAP_MIRROR);
        if (source == 2) {
            assert_null(t->name);
        } else {
            assert_string_equal(t->name, source ? "embedded" : "a%20picture.png");
        }
        near3(s.surfaces.materials[0].albedo, 1, 0.5, 0.25);
        assert_int_equal(s.surfaces.materials[0].texture, 0);
        for (int i = 0; i < 3; i++) { // the fan's first triangle is 1, 2, 0
            const int k = (i + 1) % 3;
            assert_true(s.surfaces.vertices[i].u == texcoords[k][0]);
            assert_true(s.surfaces.vertices[i].v == texcoords[k][1]);
        }
        tyn_scene_finish(&s);
    }
    free(png);
}

static void jpeg(void **state)
{
    enum { SIDE = 16 };
    gltf_file f;
    uint8_t rgb[SIDE * SIDE * 3], file[4096];
    char rest[4096], image[128];
    (void)state;
    for (int i = 0; i < SIDE * SIDE; i++) {
        const uint8_t color[3] = {200, 100, 50};
        memcpy(rgb + 3 * i, color, 3);
    }
    square_file(&f);
    const size_t size = jpeg_write(file, sizeof file, SIDE, SIDE, rgb);
    snprintf(image, sizeof image, "{'bufferView': %d}", gltf_file_view(&f, file, size, 0));
    snprintf(rest, sizeof rest, TEXTURED, "", image);
    tyn_scene s = load(&f, rest);
    const tyn_texture *t = &s.surfaces.textures[0];
    assert_int_equal(t->size[0], SIDE);
    for (int i = 0; i < SIDE * SIDE * 4; i++) {
        const int expected = i % 4 == 3 ? 255 : rgb[i / 4 * 3 + i % 4];
        assert_true(abs(t->texels[i] - expected) <= 3);
    }
    tyn_scene_finish(&s);
}

// The second set of coordinates, and coordinates that are moved, scaled and turned.
static void coordinates(void **state)
{
    size_t size;
    free(png_file(&size));
    static const struct {
        const char *info;
        const float (*from)[2];
        double uv[2][3];
    } cases[] = {
        {", 'texCoord': 1", other_texcoords, {{1, 0, 0}, {0, 1, 0}}},
        {", 'extensions': {'KHR_texture_transform': {'offset': [0.5, 0.25], 'scale': [2, 3]}}",
         texcoords,
         {{2, 0, 0.5}, {0, 3, 0.25}}},
        // A quarter turn: (u, v) becomes (v, -u).
        {", 'extensions': {'KHR_texture_transform': {'rotation': 1.5707963267948966, 'texCoord': "
         "1}}",
         other_texcoords,
         {{0, 1, 0}, {-1, 0, 0}}},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        gltf_file f;
        char rest[4096];
        square_file(&f);
        snprintf(rest, sizeof rest, TEXTURED, cases[i].info, "{'uri': 'a%20picture.png'}");
        tyn_scene s = load(&f, rest);
        assert_int_equal(s.num_warnings, 0);
        for (int k = 0; k < 3; k++) {
            const float *t = cases[i].from[(k + 1) % 3];
            const double(*m)[3] = cases[i].uv;
            const tyn_surface_vertex *v = &s.surfaces.vertices[k];
            assert_true(fabs(v->u - (m[0][0] * t[0] + m[0][1] * t[1] + m[0][2])) < 1e-6);
            assert_true(fabs(v->v - (m[1][0] * t[0] + m[1][1] * t[1] + m[1][2])) < 1e-6);
        }
        tyn_scene_finish(&s);
    }
}

// Of textures that surfaces have no place for the mean counts, which is told.
static double facet_area(const tyn_surfaces *s, uint32_t triangle)
{
    const float *p[3];
    for (int k = 0; k < 3; k++) {
        p[k] = s->vertices[s->triangles[triangle].vertices[k]].position;
    }
    return 0.5 * fabs(((double)p[1][0] - (double)p[0][0]) * ((double)p[2][1] - (double)p[0][1]) -
                      ((double)p[1][1] - (double)p[0][1]) * ((double)p[2][0] - (double)p[0][0]));
}

static void means(void **state)
{
    size_t size;
    free(png_file(&size));
    gltf_file f;
    (void)state;
    square_file(&f);
    tyn_scene s = load(
        &f,
        SQUARE(
            ", 'material': 0") ", 'materials': [{'name': 'lamp', 'pbrMetallicRoughness': "
                               "{'metallicFactor': 0.5, 'metallicRoughnessTexture': {'index': 0}}, "
                               "'emissiveFactor': [1, 1, 1], 'emissiveTexture': {'index': 0}, "
                               "'normalTexture': {'index': 0}}], 'textures': [{'source': 0}], "
                               "'images': [{'uri': 'a%20picture.png'}]");
    double blue = 0, light[3] = {0};
    for (int i = 0; i < 6; i++) {
        blue += texels[i][2] / 255.0 / 6;
        for (int c = 0; c < 3; c++) {
            const double x = texels[i][c] / 255.0;
            light[c] += (x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4)) / 6;
        }
    }
    const double albedo = 1 - 0.5 * blue;
    near3(s.surfaces.materials[0].albedo, albedo, albedo, albedo);
    // The facets send on the whole what the texture does.
    double sent[3] = {0};
    for (uint32_t i = 0; i < s.surfaces.num_triangles; i++) {
        const tyn_surface_material *m = &s.surfaces.materials[s.surfaces.triangles[i].material];
        for (int c = 0; c < 3; c++) {
            sent[c] += facet_area(&s.surfaces, i) * (double)m->emission[c] / 2;
        }
    }
    for (int c = 0; c < 3; c++) {
        assert_true(fabs(sent[c] - light[c]) < 0.02 * light[c]);
    }
    assert_int_equal(s.surfaces.num_textures, 0);
    assert_int_equal(s.num_warnings, 2);
    assert_non_null(strstr(s.warnings[0], "material 'lamp': of metallicRoughnessTexture"));
    tyn_scene_finish(&s);
}

// ---- wrong data -------------------------------------------------------------------------------

static void broken(void **state)
{
    static const struct {
        const char *rest, *says;
    } cases[] = {
        {"'materials': [{'pbrMetallicRoughness': {'metallicFactor': 2}}]", "metallicFactor = 2"},
        {"'materials': [{'pbrMetallicRoughness': {'baseColorFactor': [1, 1, 1]}}]", "array of 4"},
        {"'materials': [{'pbrMetallicRoughness': {'baseColorFactor': [1, 1, -1, 1]}}]",
         "materials[0].pbrMetallicRoughness.baseColorFactor[2] = -1: must be between 0 and 1"},
        {"'materials': [{'emissiveFactor': [0, 2, 0]}]", "emissiveFactor[1] = 2"},
        {"'materials': [{'extensions': {'KHR_materials_emissive_strength': {'emissiveStrength': "
         "-1}}}]",
         "emissiveStrength = -1"},
        {"'materials': [{'pbrMetallicRoughness': {'baseColorTexture': {'index': 0}}}]",
         "index = 0: must be an index of textures, there are 0"},
        {"'materials': [{'emissiveTexture': {}}]", "index is missing"},
        {"'materials': [{}], 'textures': [{'source': 1}], 'images': [{'uri': 'a.png'}]",
         "source = 1"},
        {"'materials': [{}], 'textures': [{'sampler': 0}]", "sampler = 0"},
        {"'materials': [{}], 'samplers': [{'wrapS': 7}]", "wrapS = 7: must be 10497"},
        {"'materials': [{}], 'images': [{}]", "images[0] = an object: needs either a uri"},
        {"'materials': [{}], 'images': [{'bufferView': 99}]", "bufferView = 99"},
#define WITH_IMAGE(image)                                                                          \
    "'materials': [{'pbrMetallicRoughness': {'baseColorTexture': {'index': 0}}}], 'textures': "    \
    "[{'source': 0}], 'images': [" image "]"
        {WITH_IMAGE("{'uri': 'text.png'}"), "must be a PNG or JPEG picture"},
        {WITH_IMAGE("{'uri': 'cut.png'}"), "must be a PNG or JPEG picture"},
        {WITH_IMAGE("{'bufferView': 0}"), "images[0] = an object: must be a PNG or JPEG"},
        {WITH_IMAGE("{'uri': 'data:image/png;base64,AAAA'}"), "must be a PNG or JPEG"},
        {"'materials': [{'pbrMetallicRoughness': {'baseColorTexture': {'index': 0}}}], 'textures': "
         "[{}]",
         "textures[0] = an object: source is missing"},
    };
    size_t size;
    uint8_t *png = png_file(&size);
    (void)state;
    io_put("text.png", "not a picture", 13);
    io_put("cut.png", png, size / 2);
    free(png);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        gltf_file f;
        tyn_scene scene;
        io_log log;
        char rest[2048];
        square_file(&f);
        snprintf(rest, sizeof rest, SQUARE(", 'material': 0") ", %s", cases[i].rest);
        const tyn_result r = try_load(&f, rest, &scene, &log);
        if ((r != TYN_ERR_PARAMS && r != TYN_ERR_IO) || log.errors != 1 || log.newlines ||
            !strstr(log.last, cases[i].says)) {
            print_error("%s\n  gave %d, %d errors: %s\n", cases[i].rest, r, log.errors, log.last);
            fail();
        }
        assert_true(!scene.surfaces.materials && !scene.surfaces.textures);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(factors), cmocka_unit_test(shared),
                                       cmocka_unit_test(colors),  cmocka_unit_test(sources),
                                       cmocka_unit_test(jpeg),    cmocka_unit_test(coordinates),
                                       cmocka_unit_test(means),   cmocka_unit_test(broken)};
    return cmocka_run_group_tests(tests, NULL, io_test_clean);
}
