// rsm.c -- reflective shadow maps: their sums are what a lit square, a closed room and a cone of light reflect.
#include "bound.h"
#include "gpu_test.h"
#include "passes/methods/light/sources.h"
#include "passes/rsm/rsm.h"
#include "passes/shadow_map/shadow_map.h"
#include "solids.h"
#include <tyndall/registry.h>
#include <math.h>
#include <string.h>

static const double pi = 3.14159265358979;

// The medium's frame: turned about y and moved; rows world -> M.
static const float rows[3][4] = {{0.8f, 0, 0.6f, 1}, {0, 1, 0, -0.5f}, {-0.6f, 0, 0.8f, 2}};

static void turn(const float w[3], bool point, float m[3])
{
    for (int r = 0; r < 3; r++) {
        m[r] = point ? rows[r][3] : 0;
        for (int c = 0; c < 3; c++) {
            m[r] += rows[r][c] * w[c];
        }
    }
}

typedef struct sums { // over a map
    double flux[3], area,
        facing; // facing: of the flux, weighted with the cosine of normal and light
    uint32_t texels;
} sums;

// Runs the pass as methods do, for one light, and adds up its maps; `lo` and `hi` bound the positions found,
// in the world.
static sums run(gpu_test *t, const tyn_scene *scene, const struct light_block *light, float lo[3],
                float hi[3])
{
    const tyn_surfaces *s = &scene->surfaces;
    static tyn_frame_scene frame;
    memset(&frame, 0, sizeof frame);
    frame.lights.scene[0] = frame.lights.suns[0] = *light;
    frame.lights.num_suns = light->kind == TYN_LIGHT_KIND_DIRECTIONAL;
    frame.lights.num_directional = frame.lights.num_suns;
    frame.lights.num_lamps = 1 - frame.lights.num_suns;
    frame.num_triangles = frame.surfaces.num_triangles = s->num_triangles;
    frame.empty = true;
    memcpy(frame.surfaces.from_world, rows, sizeof rows);
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) {
            frame.surfaces.to_world[r][c] = rows[c][r];
            frame.surfaces.to_world[r][3] -= rows[c][r] * rows[c][3];
        }
    }
    for (int a = 0; a < 3; a++) {
        frame.surfaces.lo[a] = INFINITY;
        frame.surfaces.hi[a] = -INFINITY;
        for (uint32_t v = 0; v < s->num_vertices; v++) {
            frame.surfaces.lo[a] = fminf(frame.surfaces.lo[a], s->vertices[v].position[a]);
            frame.surfaces.hi[a] = fmaxf(frame.surfaces.hi[a], s->vertices[v].position[a]);
        }
    }
    tyn_settings *settings;
    assert_int_equal(tyn_settings_create(&settings), TYN_OK);
    tyn_graph_begin(t->graph);
    const uint32_t nothing[6] = {0};
    const tyn_job job = {
        .scene = scene,
        .frame = &frame,
        .settings = settings,
        .refs =
            {
                .suns = gpu_buffer(t, "suns", frame.lights.suns, sizeof frame.lights.suns),
                .lights = gpu_buffer(t, "lights", frame.lights.scene, sizeof frame.lights.scene),
                .geometry.surfaces =
                    gpu_buffer(t, "surfaces", &frame.surfaces, sizeof frame.surfaces),
                .geometry.triangles = gpu_buffer(t, "triangles", s->triangles,
                                                 s->num_triangles * sizeof *s->triangles),
                .geometry.vertices =
                    gpu_buffer(t, "vertices", s->vertices, s->num_vertices * sizeof *s->vertices),
                .materials.materials = gpu_buffer(t, "materials", s->materials,
                                                  s->num_materials * sizeof *s->materials),
                .materials.textures = gpu_buffer(t, "textures", nothing, sizeof nothing),
                .materials.texels = gpu_buffer(t, "texels", nothing, sizeof nothing),
                .geometry.nodes = gpu_buffer(t, "nodes", nothing, sizeof nothing), // no rays
            },
    };
    tyn_rsm rsm;
    tyn_add_rsm(t->graph, &job, &rsm);
    assert_int_equal(tyn_graph_status(t->graph), TYN_OK);
    tyn_settings_destroy(&settings);
    tyn_graph_output(t->graph, "flux", rsm.maps.rsm_flux, true);
    tyn_graph_output(t->graph, "position", rsm.maps.rsm_position, true);
    tyn_graph_output(t->graph, "normal", rsm.maps.rsm_normal, true);
    gpu_run(t);
    tyn_extent size;
    const float(*flux)[4] = (const float(*)[4])tyn_graph_map(t->graph, "flux", &size, NULL);
    const float(*position)[4] = (const float(*)[4])gpu_map(t, "position");
    const float(*normal)[4] = (const float(*)[4])gpu_map(t, "normal");

    sums sum = {{0}};
    for (uint32_t k = 0; k < rsm.num_tiles; k++) {
        const struct rsm_tile *tile = &rsm.tiles[k];
        assert_int_equal(tile->texels & (tile->texels - 1), 0);
        assert_int_equal(tile->light, frame.lights.num_suns ? 0 : TYN_SHADOW_LAMP(0));
        for (uint32_t i = 0; i < tile->texels * tile->texels; i++) {
            const uint32_t x = tile->offset[0] + i % tile->texels,
                           y = tile->offset[1] + i / tile->texels, at = y * size.x + x;
            assert_true(x < size.x && y < size.y);
            const double power = (double)flux[at][0] + (double)flux[at][1] + (double)flux[at][2];
            if (power == 0) {
                continue;
            }
            float way[3];
            double cosine = 0, length = 0;
            for (int c = 0; c < 3; c++) {
                way[c] = frame.lights.num_suns ? -light->direction[c]
                                               : light->position[c] - position[at][c];
                cosine += (double)(way[c] * normal[at][c]);
                length += (double)(way[c] * way[c]);
                sum.flux[c] += (double)flux[at][c];
            }
            for (int c = 0; c < 3; c++) { // back into the world
                float w = 0;
                for (int r = 0; r < 3; r++) {
                    w += rows[r][c] * (position[at][r] - rows[r][3]);
                }
                assert_true(w > lo[c] - 1e-4f && w < hi[c] + 1e-4f);
            }
            assert_true(cosine > 0 && position[at][3] > 0);
            sum.facing += power * cosine / sqrt(length);
            sum.area += (double)position[at][3];
            sum.texels++;
        }
    }
    return sum;
}

static void expect(const char *what, double found, double right, double tolerance)
{
    print_message("%s: %.5g, should be %.5g\n", what, found, right);
    const double off = fabs(found - right) / fabs(right);
    assert_true(tolerance > 1e-4 ? within(off, tolerance, NULL, "%s within %g", what, tolerance)
                                 : off <= tolerance);
}

static void a_square_in_the_sun(void **state)
{
    tyn_scene scene;
    tyn_scene_init(&scene);
    const uint32_t m = solids_material(&scene, (float[]){0.5f, 0.25f, 0.1f}, (float[3]){0});
    const uint32_t black = solids_material(&scene, (float[3]){0}, (float[3]){0});
    solids_quad(&scene, (float[]){1, 0, 1}, (float[]){2, 0, 0}, (float[]){0, 0, 1},
                m); // its back is lit
    solids_quad(&scene, (float[]){1.5f, 1, -3}, (float[]){0.5f, 0, 0}, (float[]){0, 0, 8}, black);
    const float travel[3] = {0, -0.8f, 0.6f};
    struct light_block sun = {.kind = TYN_LIGHT_KIND_DIRECTIONAL, .color = {1, 2, 4}};
    turn(travel, false, sun.direction);
    sums s = run(*state, &scene, &sun, (float[]){1, 0, 1}, (float[]){3, 0, 2});
    // A quarter of it is in the shadow of the black card.
    expect("red", s.flux[0], 1 * 0.5 * 1.5 * 0.8, 0.02);
    expect("green", s.flux[1], 2 * 0.25 * 1.5 * 0.8, 0.02);
    expect("blue", s.flux[2], 4 * 0.1 * 1.5 * 0.8, 0.02);
    expect("area", s.area, 1.5, 0.02);
    expect("cosine", s.facing / (s.flux[0] + s.flux[1] + s.flux[2]), 0.8, 1e-5);
    tyn_scene_finish(&scene);
}

static void make_room(tyn_scene *scene)
{
    tyn_scene_init(scene);
    const uint32_t m = solids_material(scene, (float[]){0.5f, 0.6f, 0.7f}, (float[3]){0});
    solids_box(scene, (float[]){-1, 0, -2}, (float[]){3, 2, 1}, 0, true, m);
}

static void a_lamp_in_a_room(void **state)
{
    tyn_scene scene;
    make_room(&scene);
    struct light_block lamp = {.kind = TYN_LIGHT_KIND_POINT, .color = {3, 2, 1}};
    turn((float[]){0.3f, 1.4f, -0.2f}, true, lamp.position);
    sums s = run(*state, &scene, &lamp, (float[]){-1, 0, -2}, (float[]){3, 2, 1});
    expect("red", s.flux[0], 4 * pi * 3 * 0.5, 2e-4);
    expect("green", s.flux[1], 4 * pi * 2 * 0.6, 2e-4);
    expect("blue", s.flux[2], 4 * pi * 1 * 0.7, 2e-4);
    expect("area", s.area, 2 * (4 * 2 + 2 * 3 + 3 * 4), 3e-3);
    tyn_scene_finish(&scene);
}

static void spots_in_a_room(void **state)
{
    tyn_scene scene;
    make_room(&scene);
    // One in a map of its own, one so wide that it needs a cube.
    const float inner[2] = {0.95f, 0.5f}, outer[2] = {0.8f, 0.1f};
    static const double most[2] = {2.5e-5, 1.9e-4};
    for (int k = 0; k < 2; k++) {
        struct light_block spot = {.kind = TYN_LIGHT_KIND_SPOT,
                                   .color = {3, 2, 1},
                                   .cos_inner = inner[k],
                                   .cos_outer = outer[k]};
        turn((float[]){0.3f, 1.4f, -0.2f}, true, spot.position);
        turn((float[]){0.36f, -0.8f, 0.48f}, false, spot.direction);
        sums s = run(*state, &scene, &spot, (float[]){-1, 0, -2}, (float[]){3, 2, 1});
        const double angle = 2 * pi * (1 - (2 * (double)inner[k] + (double)outer[k]) / 3);
        expect("red", s.flux[0], angle * 3 * 0.5, most[k]);
        expect("blue", s.flux[2], angle * 1 * 0.7, most[k]);
    }
    tyn_scene_finish(&scene);
}

// A closed box from outside: nothing is in front of its faces, so nothing sees what they reflect.
static void a_house_from_outside(void **state)
{
    tyn_scene scene;
    tyn_scene_init(&scene);
    const uint32_t m = solids_material(&scene, (float[]){0.5f, 0.6f, 0.7f}, (float[3]){0});
    solids_box(&scene, (float[]){-1, 0, -2}, (float[]){3, 2, 1}, 0, false, m);
    struct light_block sun = {.kind = TYN_LIGHT_KIND_DIRECTIONAL, .color = {1, 2, 4}};
    turn((float[]){0.48f, -0.8f, 0.36f}, false, sun.direction);
    sums s = run(*state, &scene, &sun, (float[]){-1, 0, -2}, (float[]){3, 2, 1});
    assert_int_equal(s.texels, 0);
    // With a yard around it, the walls light that, and the yard lights the walls.
    solids_quad(&scene, (float[]){-5, 0, -5}, (float[]){0, 0, 10}, (float[]){10, 0, 0}, m);
    s = run(*state, &scene, &sun, (float[]){-5, 0, -5}, (float[]){5, 2, 5});
    const double yard = 10 * 10 * 0.8,
                 roof = 4 * 3 * 0.8; // what goes through: the roof's light is lost
    expect("red", s.flux[0], 0.5 * (yard - roof), 1.7e-4);
    tyn_scene_finish(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_square_in_the_sun),
        cmocka_unit_test(a_lamp_in_a_room),
        cmocka_unit_test(spots_in_a_room),
        cmocka_unit_test(a_house_from_outside),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
