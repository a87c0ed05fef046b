// surfaces.c -- surfaces filled by hand: checks, bounds, hash, and what the GPU gets of their textures.
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "frame/frame_scene.h"
#include "io_test.h"
#include "solids.h"

static const float grey[3] = {0.5f, 0.5f, 0.5f}, dark[3] = {0, 0, 0};

// A cube of 2 m with its centre at (1, 2, 3), textured, with a hierarchy of three nodes.
static void fill(tyn_scene *scene)
{
    tyn_scene_init(scene);
    tyn_surfaces *s = &scene->surfaces;
    uint32_t material = solids_material(scene, grey, dark);
    solids_box(scene, (float[]){0, 1, 2}, (float[]){2, 3, 4}, 0, false, material);
    s->textures = calloc(1, sizeof *s->textures);
    s->textures[s->num_textures++] = (tyn_texture){.size = {3, 2}, .texels = calloc(6, 4)};
    s->materials[0].texture = 0;
    s->nodes = calloc(3, sizeof *s->nodes);
    s->num_nodes = 3;
    s->nodes[0] = (tyn_surface_node){{0, 1, 2}, 1, {2, 3, 4}, 0};
    s->nodes[1] = (tyn_surface_node){{0, 1, 2}, 0, {2, 3, 4}, 6};
    s->nodes[2] = (tyn_surface_node){{0, 1, 2}, 6, {2, 3, 4}, 6};
}

static void boxes(void **state)
{
    tyn_scene scene;
    float lo[3], hi[3];
    (void)state;
    fill(&scene);
    assert_true(tyn_scene_bounds(&scene, lo, hi));
    for (int a = 0; a < 3; a++) {
        assert_true(fabsf(lo[a] - (float)a) < 1e-6f && fabsf(hi[a] - (float)(a + 2)) < 1e-6f);
    }
    // Fronts are outside: every normal looks away from the centre.
    const tyn_surfaces *s = &scene.surfaces;
    for (uint32_t i = 0; i < s->num_triangles; i++) {
        const float *p[3];
        float away = 0;
        for (int k = 0; k < 3; k++) {
            p[k] = s->vertices[s->triangles[i].vertices[k]].position;
        }
        for (int a = 0; a < 3; a++) {
            int b = (a + 1) % 3, c = (a + 2) % 3;
            float n = (p[1][b] - p[0][b]) * (p[2][c] - p[0][c]) -
                      (p[1][c] - p[0][c]) * (p[2][b] - p[0][b]);
            float shading = s->vertices[s->triangles[i].vertices[0]].normal[a];
            assert_true(fabsf(n / 4 - shading) < 1e-6f);
            away += n * (p[0][a] - (float)(a + 1));
        }
        assert_true(away > 0);
    }
    // Media, where there are any, frame the scene alone.
    scene.num_media = scene.num_shapes = 1;
    scene.media[0] = (tyn_medium){.density_scale = 1, .volume = -1};
    scene.shapes[0] = (tyn_shape){.to_world = {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1}};
    assert_true(tyn_scene_bounds(&scene, lo, hi));
    assert_true(lo[2] == -1 && hi[2] == 1);
    tyn_scene_finish(&scene);
    assert_false(tyn_scene_bounds(&scene, lo, hi));
}

static void set_fault(tyn_surfaces *s, int fault)
{
    switch (fault) {
    case 0:
        s->vertices[5].position[1] = NAN;
        break;
    case 1:
        s->vertices[5].normal[0] = s->vertices[5].normal[1] = s->vertices[5].normal[2] = 0;
        break;
    case 2:
        s->vertices[0].u = INFINITY;
        break;
    case 3:
        s->triangles[11].vertices[2] = 24;
        break;
    case 4:
        s->triangles[3].material = 1;
        break;
    case 5:
        s->materials[0].albedo[2] = 1.01f;
        break;
    case 6:
        s->materials[0].albedo[0] = NAN;
        break;
    case 7:
        s->materials[0].emission[1] = -1;
        break;
    case 8:
        s->materials[0].texture = 1;
        break;
    case 9:
        s->materials[0].flags = 2;
        break;
    case 10:
        s->textures[0].size[1] = 0;
        break;
    case 11:
        s->textures[0].wrap[1] = (tyn_wrap)3;
        break;
    case 12:
        s->nodes[0].first = 0; // its own child
        break;
    case 13:
        s->nodes[0].first = 2; // the second child is missing
        break;
    case 14:
        s->nodes[2].count = 7;
        break;
    case 15:
        s->nodes[1].lo[0] = NAN;
        break;
    case 16:
        s->nodes[2].count = 0; // a leaf becomes a parent without children
        break;
    }
}

static void check(void **state)
{
    (void)state;
    for (int fault = -1; fault < 17; fault++) {
        tyn_scene scene;
        io_log log;
        io_log_init(&log);
        fill(&scene);
        set_fault(&scene.surfaces, fault);
        assert_int_equal(tyn_scene_check(&scene, &log.log), fault < 0 ? TYN_OK : TYN_ERR_PARAMS);
        assert_int_equal(log.errors, fault >= 0);
        assert_int_equal(log.newlines, 0);
        tyn_scene_finish(&scene);
    }
}

static void hash(void **state)
{
    tyn_scene scene;
    (void)state;
    fill(&scene);
    uint64_t first = tyn_surfaces_hash(&scene.surfaces);
    assert_true(first == tyn_surfaces_hash(&scene.surfaces));
    scene.surfaces.textures[0].texels[23] = 1;
    assert_true(first != tyn_surfaces_hash(&scene.surfaces));
    scene.surfaces.hash = 7;
    assert_true(tyn_surfaces_hash(&scene.surfaces) == 7);
    scene.surfaces.num_triangles = 0;
    assert_true(tyn_surfaces_hash(&scene.surfaces) == 0);
    tyn_scene_finish(&scene);
}

static double linear(uint32_t texel, int channel)
{
    double v = (double)(texel >> (8 * channel) & 255) / 255;
    return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

// Every level has the mean light of the first, within what 8 bits keep.
static void mip_chain(void **state)
{
    static const uint32_t sizes[][2] = {{1, 1}, {2, 2}, {3, 2}, {5, 7}, {64, 1}, {33, 16}};
    (void)state;
    for (size_t k = 0; k < sizeof sizes / sizeof sizes[0]; k++) {
        tyn_scene scene;
        io_log log;
        tyn_surface_data data = {0};
        io_log_init(&log);
        fill(&scene);
        tyn_texture *t = &scene.surfaces.textures[0];
        const size_t count = (size_t)sizes[k][0] * sizes[k][1];
        free(t->texels);
        t->texels = malloc(count * 4);
        memcpy(t->size, sizes[k], sizeof t->size);
        for (size_t i = 0; i < count * 4; i++) {
            t->texels[i] = (uint8_t)(i * 2654435761u >> 13);
        }
        assert_int_equal(tyn_surface_data_update(&data, &scene.surfaces, &log.log), TYN_OK);
        assert_int_equal(data.num_textures, 1);
        size_t at = data.textures[0].first;
        double mean[3] = {0};
        for (uint32_t level = 0; level < data.textures[0].levels; level++) {
            uint32_t w = t->size[0] >> level, h = t->size[1] >> level;
            size_t texels = (size_t)(w ? w : 1) * (h ? h : 1);
            for (int c = 0; c < 3; c++) {
                double sum = 0;
                for (size_t i = 0; i < texels; i++) {
                    sum += linear(data.texels[at + i], c) / (double)texels;
                }
                mean[c] = level ? mean[c] : sum;
                assert_true(fabs(sum - mean[c]) < 0.01);
            }
            at += texels;
        }
        assert_int_equal(at, data.num_texels);
        assert_int_equal(data.textures[0].levels > 1, count > 1);
        tyn_surface_data_finish(&data);
        tyn_scene_finish(&scene);
    }
}

// A fault is found before anything is made of the surfaces.
static void update(void **state)
{
    tyn_scene scene;
    io_log log;
    tyn_surface_data data = {0};
    (void)state;
    io_log_init(&log);
    fill(&scene);
    assert_int_equal(tyn_surface_data_update(&data, &scene.surfaces, &log.log), TYN_OK);
    assert_true(data.hash && data.hi[2] == 4);
    // What views need of the hierarchy is made once, and anew for another one.
    const struct surface_range *below = data.below;
    assert_true(below && below[0].first == 0 && below[0].count == 12);
    assert_int_equal(tyn_surface_data_update(&data, &scene.surfaces, &log.log), TYN_OK);
    assert_ptr_equal(data.below, below);
    scene.surfaces.num_nodes = 0;
    assert_int_equal(tyn_surface_data_update(&data, &scene.surfaces, &log.log), TYN_OK);
    assert_true(data.hash && !data.below);
    scene.surfaces.num_nodes = 3;
    set_fault(&scene.surfaces, 3);
    assert_int_equal(tyn_surface_data_update(&data, &scene.surfaces, &log.log), TYN_ERR_PARAMS);
    assert_true(!data.hash && !data.texels && log.errors == 1);
    scene.surfaces.num_triangles = 0;
    assert_int_equal(tyn_surface_data_update(&data, &scene.surfaces, &log.log), TYN_OK);
    assert_true(!data.hash);
    tyn_scene_finish(&scene);
}

static void apply(const tyn_vec4 rows[3], const float p[3], double out[3])
{
    for (int i = 0; i < 3; i++) {
        out[i] = (double)rows[i][0] * p[0] + (double)rows[i][1] * p[1] + (double)rows[i][2] * p[2] +
                 rows[i][3];
    }
}

static tyn_frame_scene frame_of(const tyn_scene *scene)
{
    tyn_frame_scene frame;
    tyn_surface_data data = {0};
    io_log log;
    io_log_init(&log);
    const tyn_view view = {.width = 8, .height = 8, .camera = {.yfov = 1}};
    const tyn_map_light map = {{0}};
    const tyn_frame_projection projection = {.half = {0.5, 0.5}};
    assert_int_equal(tyn_surface_data_update(&data, &scene->surfaces, &log.log), TYN_OK);
    assert_int_equal(
        tyn_frame_scene_build(&frame, scene, &view, &projection, &map, &data, &log.log), TYN_OK);
    tyn_surface_data_finish(&data);
    return frame;
}

// M and the world are rigid to each other, and M's origin is a corner of its box, whoever spans it.
static void frames(void **state)
{
    tyn_scene scene;
    (void)state;
    fill(&scene);
    for (int with_medium = 0; with_medium < 2; with_medium++) {
        if (with_medium) { // a box of 2 x 3 x 4 m, turned about y
            scene.num_media = scene.num_shapes = 1;
            scene.media[0] = (tyn_medium){.density_scale = 1, .volume = -1, .sigma_s = {1, 1, 1}};
            scene.shapes[0] = (tyn_shape){
                .to_world = {1.2f, 0, 1.6f, 0, 0, 3, 0, 0, -3.2f, 0, 2.4f, 0, 5, 6, 7, 1}};
        }
        const tyn_frame_scene f = frame_of(&scene);
        assert_int_equal(f.num_triangles, 12);
        assert_int_equal(f.surfaces.num_nodes, 3);
        assert_true(f.empty == !with_medium);
        const float *extent = f.medium.extent,
                    size[3] = {2, with_medium ? 3 : 2, with_medium ? 4 : 2};
        double corner[3], back[3];
        apply(f.surfaces.to_world, (float[]){0, 0, 0}, corner);
        for (int a = 0; a < 3; a++) {
            const float p[3] = {(float)corner[0], (float)corner[1], (float)corner[2]};
            apply(f.surfaces.from_world, p, back);
            assert_true(fabs(back[a]) < 1e-5);
            assert_true(fabsf(extent[a] - size[a]) < 1e-5f);
            assert_true(f.surfaces.lo[a] == (float)a && f.surfaces.hi[a] == (float)(a + 2));
            for (int b = 0; b < 3; b++) { // rows are orthonormal, columns of the inverse
                double dot = 0;
                for (int c = 0; c < 3; c++) {
                    dot += (double)f.surfaces.to_world[a][c] * f.surfaces.to_world[b][c];
                }
                assert_true(fabs(dot - (a == b)) < 1e-5);
                assert_true(f.surfaces.to_world[a][b] == f.surfaces.from_world[b][a]);
                assert_true(f.m_from_world[4 * b + a] == f.surfaces.from_world[a][b]);
            }
        }
        // The corner: of the cube; of the turned box 5 - 0.6 - (-1.6), 6 - 1.5, 7 - 0.8 - 1.2.
        const double at[3] = {with_medium ? 6 : 0, with_medium ? 4.5 : 1, with_medium ? 5 : 2};
        for (int a = 0; a < 3; a++) {
            assert_true(fabs(corner[a] - at[a]) < 1e-5);
        }
    }
    tyn_scene_finish(&scene);
    // One wall alone: a box with a little depth.
    tyn_scene_init(&scene);
    solids_quad(&scene, (float[]){1, 2, 3}, (float[]){4, 0, 0}, (float[]){0, 5, 0},
                solids_material(&scene, grey, dark));
    const tyn_frame_scene flat = frame_of(&scene);
    assert_true(fabsf(flat.medium.extent[2] - 0.005f) < 1e-6f && flat.medium.extent[1] == 5);
    tyn_scene_finish(&scene);
    const tyn_frame_scene none = frame_of(&scene);
    assert_int_equal(none.num_triangles, 0);
    assert_true(none.medium.extent[0] == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(boxes),  cmocka_unit_test(check),
                                       cmocka_unit_test(hash),   cmocka_unit_test(mip_chain),
                                       cmocka_unit_test(update), cmocka_unit_test(frames)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
