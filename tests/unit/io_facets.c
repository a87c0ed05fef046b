// io_facets.c -- what is painted on triangles of glTF files: colours of vertices, emissive textures, masks.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "gltf_file.h"
#include "io/gltf_facets.h"

static const float square[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
static const float texcoords[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};

// Accessors: 0 positions of a square of 1 m, 1 texture coordinates that are its x and y.
static gltf_file square_file(void)
{
    gltf_file f = {0};
    gltf_file_array(&f, 5126, "VEC3", 4, square, sizeof square);
    gltf_file_array(&f, 5126, "VEC2", 4, texcoords, sizeof texcoords);
    return f;
}

#define SQUARE(attributes, material)                                                               \
    "'nodes': [{'mesh': 0}], 'meshes': [{'name': 'card', 'primitives': [{'mode': 6, "              \
    "'attributes': {'POSITION': 0, 'TEXCOORD_0': 1" attributes "}, 'material': 0}]}], "            \
    "'materials': [" material "], 'textures': [{'source': 0, 'sampler': 0}], 'images': [{'uri': "  \
    "'painted.png'}], 'samplers': [{'wrapS': 33071, 'wrapT': 33071}]"

static tyn_scene load(const gltf_file *f, const char *rest)
{
    tyn_scene scene;
    io_log log;
    io_log_init(&log);
    if (tyn_scene_load(&scene, gltf_file_put(f, "facets", rest), NULL, &log.log) != TYN_OK) {
        print_error("%s\n", log.last);
        fail();
    }
    assert_int_equal(tyn_scene_check(&scene, NULL), TYN_OK);
    return scene;
}

enum { SIDE = 64 };
typedef void (*paint_fn)(double x, double y, uint8_t rgba[4]);

static void put_picture(paint_fn paint)
{
    static uint8_t texels[SIDE][SIDE][4];
    for (int y = 0; y < SIDE; y++) {
        for (int x = 0; x < SIDE; x++) {
            paint((x + 0.5) / SIDE, (y + 0.5) / SIDE, texels[y][x]);
        }
    }
    assert_int_equal(tyn_png_write(io_path("painted.png"), SIDE, SIDE, 4, &texels[0][0][0], NULL),
                     TYN_OK);
}

// Area and middle of a triangle of the plane z = 0, whose front is towards +z.
static double triangle_area(const tyn_surfaces *s, uint32_t i, double middle[2])
{
    const float *p[3];
    middle[0] = middle[1] = 0;
    for (int k = 0; k < 3; k++) {
        const tyn_surface_vertex *v = &s->vertices[s->triangles[i].vertices[k]];
        p[k] = v->position;
        assert_true(fabsf(v->normal[2] - 1) < 1e-6f);
        for (int a = 0; a < 2; a++) {
            middle[a] += (double)p[k][a] / 3;
        }
    }
    const double area =
        0.5 * (((double)p[1][0] - (double)p[0][0]) * ((double)p[2][1] - (double)p[0][1]) -
               ((double)p[1][1] - (double)p[0][1]) * ((double)p[2][0] - (double)p[0][0]));
    assert_true(area > -1e-9);
    return area;
}

static const tyn_surface_material *material_of(const tyn_scene *s, uint32_t triangle)
{
    return &s->surfaces.materials[s->surfaces.triangles[triangle].material];
}

static double area_of(const tyn_scene *s)
{
    double middle[2], area = 0;
    for (uint32_t i = 0; i < s->surfaces.num_triangles; i++) {
        area += triangle_area(&s->surfaces, i, middle);
    }
    return area;
}

// ---- colours of vertices ----------------------------------------------------------------------

// Red grows with x, green with y, on a grey base: every facet is within a step of what is interpolated, the mean is exact.
static void colors(void **state)
{
    static const float ramp[4][3] = {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    (void)state;
    gltf_file f = square_file();
    gltf_file_array(&f, 5126, "VEC3", 4, ramp, sizeof ramp);
    tyn_scene s =
        load(&f, SQUARE(", 'COLOR_0': 2", "{'pbrMetallicRoughness': {'metallicFactor': 0, "
                                          "'baseColorFactor': [0.5, 0.5, 0.5, 1]}}"));
    double mean[3] = {0}, middle[2];
    for (uint32_t i = 0; i < s.surfaces.num_triangles; i++) {
        const float *albedo = material_of(&s, i)->albedo;
        const double area = triangle_area(&s.surfaces, i, middle);
        for (int c = 0; c < 2; c++) {
            assert_true(fabs((double)albedo[c] - 0.5 * middle[c]) < 0.002);
        }
        for (int c = 0; c < 3; c++) {
            mean[c] += area * (double)albedo[c];
        }
        assert_true(area <= 0.5 / 256 + 1e-9); // a side of 1 in 16 steps
    }
    assert_true(fabs(mean[0] - 0.25) < 1e-3 && fabs(mean[1] - 0.25) < 1e-3);
    assert_true(fabs(mean[2] - 0.5) < 1e-5);
    assert_int_equal(s.surfaces.num_triangles, 512);
    assert_true(s.surfaces.num_materials <= 512);
    assert_int_equal(s.num_warnings, 0);
    tyn_scene_finish(&s);
}

// ---- emission ---------------------------------------------------------------------------------

static const double radius = 0.3;

static double away(double x, double y)
{
    return hypot(x - 0.45, y - 0.55);
}

static void paint_lamp(double x, double y, uint8_t rgba[4])
{
    const bool on = away(x, y) < radius;
    const uint8_t texel[4] = {on ? 255 : 0, on ? 188 : 0, 0, 255};
    memcpy(rgba, texel, 4);
}

// A disc shines, the rest is dark: the power is that of the texture, and it is where the disc is.
static void emission(void **state)
{
    (void)state;
    put_picture(paint_lamp);
    gltf_file f = square_file();
    tyn_scene s =
        load(&f, SQUARE("", "{'pbrMetallicRoughness': {'metallicFactor': 0}, 'emissiveFactor': "
                            "[1, 1, 1], 'emissiveTexture': {'index': 0}, 'extensions': "
                            "{'KHR_materials_emissive_strength': {'emissiveStrength': 10}}}"));
    double sent[3] = {0}, misplaced = 0, middle[2], area = 0;
    for (uint32_t i = 0; i < s.surfaces.num_triangles; i++) {
        const tyn_surface_material *m = material_of(&s, i);
        const double a = triangle_area(&s.surfaces, i, middle);
        area += a;
        for (int c = 0; c < 3; c++) {
            sent[c] += a * (double)m->emission[c];
        }
        misplaced +=
            away(middle[0], middle[1]) > radius + 2.0 / SIDE ? a * (double)m->emission[0] : 0;
        assert_true(m->albedo[0] == 1 && m->texture == TYN_NO_TEXTURE);
    }
    const double disc = M_PI * radius * radius;
    assert_true(fabs(area - 1) < 1e-5);
    assert_true(fabs(sent[0] - 10 * disc) < 0.02 * 10 * disc);
    assert_true(fabs(sent[1] - 0.5029 * sent[0]) < 0.01 * sent[0] && sent[2] == 0);
    assert_true(misplaced == 0);
    assert_true(s.surfaces.num_triangles < 4000);
    print_message("emission: %u facets, %u materials\n", s.surfaces.num_triangles,
                  s.surfaces.num_materials);
    tyn_scene_finish(&s);
}

// An emissive texture has texture coordinates of its own.
static void emission_elsewhere(void **state)
{
    (void)state;
    put_picture(paint_lamp);
    gltf_file f = square_file();
    float half[4][2];
    for (int i = 0; i < 4; i++) { // all of the texture on the left half, its right edge on the rest
        half[i][0] = 2 * texcoords[i][0];
        half[i][1] = texcoords[i][1];
    }
    gltf_file_array(&f, 5126, "VEC2", 4, half, sizeof half);
    tyn_scene s = load(&f, SQUARE(", 'TEXCOORD_1': 2",
                                  "{'emissiveFactor': [1, 1, 1], 'emissiveTexture': {'index': 0, "
                                  "'texCoord': 1}}"));
    double sent = 0, middle[2];
    for (uint32_t i = 0; i < s.surfaces.num_triangles; i++) {
        const double power =
            triangle_area(&s.surfaces, i, middle) * (double)material_of(&s, i)->emission[0];
        assert_true(power == 0 || middle[0] < 0.5);
        sent += power;
    }
    const double expected = 0.5 * M_PI * radius * radius;
    assert_true(fabs(sent - expected) < 0.03 * expected);
    tyn_scene_finish(&s);
}

// ---- masks ------------------------------------------------------------------------------------

// Alpha falls from the middle outwards: 0.5 at `radius`, 1/64 of a side from texel to texel by a twentieth.
static void paint_leaf(double x, double y, uint8_t rgba[4])
{
    const double alpha = 0.5 + (radius - away(x, y)) * 3;
    const uint8_t texel[4] = {255, 255, 255, (uint8_t)(255 * fmin(fmax(alpha, 0), 1) + 0.5)};
    memcpy(rgba, texel, 4);
}

static void mask(void **state)
{
    (void)state;
    put_picture(paint_leaf);
    gltf_file f = square_file();
    static const struct {
        const char *more;
        double radius; // of what is left; 0: all of it
    } cases[] = {
        {", 'alphaMode': 'MASK'", 0.3},
        {", 'alphaMode': 'MASK', 'alphaCutoff': 0.8", 0.2},
        {", 'alphaMode': 'OPAQUE'", 0},
        {"", 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char rest[2048];
        snprintf(rest, sizeof rest,
                 SQUARE("", "{'pbrMetallicRoughness': {'metallicFactor': 0, 'baseColorTexture': "
                            "{'index': 0}}%s}"),
                 cases[i].more);
        tyn_scene s = load(&f, rest);
        const double expected = cases[i].radius ? M_PI * cases[i].radius * cases[i].radius : 1;
        const double area = area_of(&s);
        if (!(fabs(area - expected) < 0.005 * expected)) {
            fail_msg("case %zu: %g m^2, not %g", i, area, expected);
        }
        double middle[2];
        for (uint32_t k = 0; cases[i].radius && k < s.surfaces.num_triangles; k++) {
            triangle_area(&s.surfaces, k, middle);
            assert_true(away(middle[0], middle[1]) < cases[i].radius + 0.5 / SIDE);
        }
        // Texture coordinates of what is left are those of the place.
        for (uint32_t k = 0; k < s.surfaces.num_vertices; k++) {
            const tyn_surface_vertex *v = &s.surfaces.vertices[k];
            assert_true(fabsf(v->u - v->position[0]) < 1e-5f &&
                        fabsf(v->v - v->position[1]) < 1e-5f);
        }
        print_message("mask, case %zu: %u facets\n", i, s.surfaces.num_triangles);
        assert_true(cases[i].radius ? s.surfaces.num_triangles < 4000
                                    : s.surfaces.num_triangles == 2);
        assert_int_equal(s.num_warnings, 0);
        tyn_scene_finish(&s);
    }
}

// Factors and colours of vertices make alpha, too; what has none of it is not there, which is no fault.
static void mask_of_factors(void **state)
{
    static const float fading[4][4] = {{1, 1, 1, 0}, {1, 1, 1, 1}, {1, 1, 1, 1}, {1, 1, 1, 0}};
    (void)state;
    gltf_file f = square_file();
    gltf_file_array(&f, 5126, "VEC4", 4, fading, sizeof fading);
    // Alpha is x times the factor 0.8: enough from x = 0.625 on.
    tyn_scene s = load(&f, SQUARE(", 'COLOR_0': 2",
                                  "{'pbrMetallicRoughness': {'metallicFactor': 0, "
                                  "'baseColorFactor': [1, 1, 1, 0.8]}, 'alphaMode': 'MASK'}"));
    assert_true(fabs(area_of(&s) - 0.375) < 1e-4);
    tyn_scene_finish(&s);
    s = load(&f, SQUARE("", "{'pbrMetallicRoughness': {'metallicFactor': 0, 'baseColorFactor': "
                            "[1, 1, 1, 0.4]}, 'alphaMode': 'MASK'}"));
    assert_int_equal(s.surfaces.num_triangles, 0);
    assert_int_equal(s.num_warnings, 0);
    tyn_scene_finish(&s);
    s = load(&f, SQUARE("", "{'pbrMetallicRoughness': {'metallicFactor': 0, 'baseColorFactor': "
                            "[1, 1, 1, 0.4]}, 'alphaMode': 'BLEND'}"));
    assert_int_equal(s.surfaces.num_triangles, 2);
    assert_int_equal(s.num_warnings, 1);
    assert_non_null(strstr(s.warnings[0], "not BLEND"));
    tyn_scene_finish(&s);
    tyn_scene scene;
    io_log log;
    io_log_init(&log);
    assert_int_equal(tyn_scene_load(&scene,
                                    gltf_file_put(&f, "wrong", SQUARE("", "{'alphaMode': 'HALF'}")),
                                    NULL, &log.log),
                     TYN_ERR_PARAMS);
    assert_non_null(strstr(log.last, "must be OPAQUE, MASK or BLEND"));
}

// ---- without a budget -------------------------------------------------------------------------

typedef struct total {
    double area, glow; // of the facets, relative to the triangle's area
    uint32_t count;
} total;

static bool add_up(void *user, const gltf_facet *f)
{
    total *t = user;
    double w[2][2];
    for (int k = 0; k < 2; k++) {
        for (int a = 0; a < 2; a++) {
            w[k][a] = f->corners[k + 1][a] - f->corners[0][a];
        }
    }
    const double area = w[0][0] * w[1][1] - w[0][1] * w[1][0];
    t->area += area;
    t->glow += area * (double)f->glow[0];
    t->count++;
    return true;
}

// Triangles are left whole, with means; of a mask most of what is to be seen is still there.
static void no_budget(void **state)
{
    (void)state;
    double uv[3][2] = {{0, 0}, {1, 0}, {0, 1}};
    for (int masked = 0; masked < 2; masked++) {
        put_picture(masked ? paint_leaf : paint_lamp);
        tyn_texture texture = {.wrap = {TYN_WRAP_CLAMP, TYN_WRAP_CLAMP}};
        gltf_picture picture;
        assert_int_equal(tyn_png_read(io_path("painted.png"), &texture.size[0], &texture.size[1],
                                      &texture.texels, NULL),
                         TYN_OK);
        assert_true(tyn_gltf_picture_make(&picture, &texture));
        total rich = {0}, poor = {0};
        int64_t much = 1 << 20, none = 0;
        const gltf_painted painted = {.alpha = masked ? &picture : NULL,
                                      .glow = masked ? NULL : &picture,
                                      .alpha_uv = uv,
                                      .glow_uv = uv,
                                      .opacity = 1,
                                      .cutoff = masked ? 0.5 : 0};
        assert_true(tyn_gltf_cut(&painted, &much, add_up, &rich));
        assert_true(tyn_gltf_cut(&painted, &none, add_up, &poor));
        assert_int_equal(much, (1 << 20) - (int64_t)rich.count + 1);
        if (masked) {
            assert_true(poor.count > 1 && poor.count < 128);
            assert_true(fabs(poor.area - rich.area) < 0.05 * rich.area);
        } else {
            assert_int_equal(poor.count, 1);
            assert_true(poor.area == 1 && fabs(poor.glow - rich.glow) < 0.3 * rich.glow);
        }
        tyn_gltf_picture_finish(&picture);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(colors),
        cmocka_unit_test(emission),
        cmocka_unit_test(emission_elsewhere),
        cmocka_unit_test(mask),
        cmocka_unit_test(mask_of_factors),
        cmocka_unit_test(no_budget),
    };
    return cmocka_run_group_tests(tests, NULL, io_test_clean);
}
