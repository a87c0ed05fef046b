// walls.c -- the sample scenes with lamps and walls are what they are said to be: solids are closed and turned
// outwards, so that no light leaks, and the room is that of the reference. argv[1] is their folder.
#include "scenes.h"

// ---- closed surfaces ----------------------------------------------------------------------------

typedef struct place {
    float position[3];
    uint32_t vertex;
} place;

static int by_place(const void *a, const void *b)
{
    const place *p = a, *q = b;
    for (int k = 0; k < 3; k++) {
        if (p->position[k] != q->position[k]) {
            return p->position[k] < q->position[k] ? -1 : 1;
        }
    }
    return 0;
}

// For every vertex the number of its place: those of one position have one.
static uint32_t *weld(const tyn_surfaces *s)
{
    place *places = malloc(s->num_vertices * sizeof(*places));
    uint32_t *welded = malloc(s->num_vertices * sizeof(*welded));
    for (uint32_t i = 0; i < s->num_vertices; i++) {
        memcpy(places[i].position, s->vertices[i].position, sizeof(places[i].position));
        places[i].vertex = i;
    }
    qsort(places, s->num_vertices, sizeof(*places), by_place);
    for (uint32_t i = 0; i < s->num_vertices; i++) {
        const bool new = i == 0 || by_place(&places[i - 1], &places[i]) != 0;
        welded[places[i].vertex] = new ? i : welded[places[i - 1].vertex];
    }
    free(places);
    return welded;
}

static int by_value(const void *a, const void *b)
{
    const uint64_t p = *(const uint64_t *)a, q = *(const uint64_t *)b;
    return p < q ? -1 : p > q;
}

// Edges that are not met by one of the opposite direction.
static uint32_t open_edges(const tyn_surfaces *s, const uint32_t *welded)
{
    const uint32_t n = 3 * s->num_triangles;
    uint64_t *edges = malloc(n * sizeof(*edges)), *back = malloc(n * sizeof(*back));
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t *v = s->triangles[i / 3].vertices;
        const uint64_t a = welded[v[i % 3]], b = welded[v[(i + 1) % 3]];
        edges[i] = a << 32 | b;
        back[i] = b << 32 | a;
    }
    qsort(edges, n, sizeof(*edges), by_value);
    qsort(back, n, sizeof(*back), by_value);
    uint32_t open = 0;
    for (uint32_t i = 0, j = 0; i < n; i++) {
        // No edge is there twice: two triangles would lie on the same side of it.
        assert_true(i == 0 || edges[i] != edges[i - 1]);
        while (j < n && back[j] < edges[i]) {
            j++;
        }
        open += j == n || back[j] != edges[i];
    }
    free(edges);
    free(back);
    return open;
}

static uint32_t root(uint32_t *parent, uint32_t i)
{
    while (parent[i] != i) {
        i = parent[i] = parent[parent[i]];
    }
    return i;
}

// The least volume that a connected piece encloses, m^3: negative where fronts are inside.
static double least_volume(const tyn_surfaces *s, const uint32_t *welded)
{
    uint32_t *parent = malloc(s->num_vertices * sizeof(*parent));
    double *volume = calloc(s->num_vertices, sizeof(*volume)), least = 1e30;
    for (uint32_t i = 0; i < s->num_vertices; i++) {
        parent[i] = i;
    }
    for (uint32_t t = 0; t < s->num_triangles; t++) {
        const uint32_t *v = s->triangles[t].vertices;
        const uint32_t a = root(parent, welded[v[0]]);
        parent[root(parent, welded[v[1]])] = a;
        parent[root(parent, welded[v[2]])] = root(parent, a);
    }
    for (uint32_t t = 0; t < s->num_triangles; t++) {
        const uint32_t *v = s->triangles[t].vertices;
        const float *a = s->vertices[v[0]].position, *b = s->vertices[v[1]].position;
        const float *c = s->vertices[v[2]].position;
        double sum = 0;
        for (int k = 0; k < 3; k++) {
            const int i = (k + 1) % 3, j = (k + 2) % 3;
            sum += (double)a[k] * ((double)b[i] * (double)c[j] - (double)b[j] * (double)c[i]) / 6;
        }
        volume[root(parent, welded[v[0]])] += sum;
    }
    for (uint32_t i = 0; i < s->num_vertices; i++) {
        least = volume[i] != 0 && volume[i] < least ? volume[i] : least;
    }
    free(parent);
    free(volume);
    return least;
}

// Corners whose shading normal is not on the triangle's front.
static uint32_t wrong_normals(const tyn_surfaces *s)
{
    uint32_t wrong = 0;
    for (uint32_t t = 0; t < s->num_triangles; t++) {
        const uint32_t *v = s->triangles[t].vertices;
        float edge[2][3], n[3];
        for (int k = 0; k < 3; k++) {
            for (int e = 0; e < 2; e++) {
                edge[e][k] = s->vertices[v[e + 1]].position[k] - s->vertices[v[0]].position[k];
            }
        }
        for (int k = 0; k < 3; k++) {
            const int i = (k + 1) % 3, j = (k + 2) % 3;
            n[k] = edge[0][i] * edge[1][j] - edge[0][j] * edge[1][i];
        }
        for (int c = 0; c < 3; c++) {
            const float *m = s->vertices[v[c]].normal;
            wrong += !(n[0] * m[0] + n[1] * m[1] + n[2] * m[2] > 0);
        }
    }
    return wrong;
}

static void surfaces_are_closed(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        uint32_t triangles, open, points, spots, suns, textures;
        bool solid; // all is solid: its outside is the front
    } scenes[] = {
        {"room", 18, 4, 0, 1, 0, 0, false},          // the hole in the ceiling
        {"fog-hall", 12612, 0, 0, 0, 1, 2, true},    //
        {"lantern", 4364, 0, 1, 0, 0, 1, true},      //
        {"cornell-smoke", 42, 4, 0, 0, 0, 0, false}, // the side that is open
        {"vpl-cave", 7982, 0, 0, 0, 1, 0, true},     //
        {"many-lights", 11112, 0, 20, 10, 0, 1, true},
    };
    for (size_t i = 0; i < sizeof(scenes) / sizeof(scenes[0]); i++) {
        tyn_scene scene = scenes_load(scenes[i].name);
        const tyn_surfaces *s = &scene.surfaces;
        uint32_t kinds[3] = {0, 0, 0};
        for (uint32_t l = 0; l < scene.num_lights; l++) {
            kinds[scene.lights[l].kind]++;
        }
        uint32_t *welded = weld(s);
        const uint32_t open = open_edges(s, welded), wrong = wrong_normals(s);
        const double least = least_volume(s, welded);
        print_message("%s: %u triangles, %u open edges, smallest piece %.3g m^3, %u lights\n",
                      scenes[i].name, s->num_triangles, open, least, scene.num_lights);
        assert_int_equal(s->num_triangles, scenes[i].triangles);
        assert_int_equal(open, scenes[i].open);
        assert_int_equal(wrong, 0);
        assert_true(!scenes[i].solid || least > 0);
        assert_int_equal(kinds[TYN_LIGHT_POINT], scenes[i].points);
        assert_int_equal(kinds[TYN_LIGHT_SPOT], scenes[i].spots);
        assert_int_equal(kinds[TYN_LIGHT_DIRECTIONAL], scenes[i].suns);
        assert_int_equal(s->num_textures, scenes[i].textures);
        assert_true(scene.num_cameras >= 1 && scene.num_shapes >= 1);
        free(welded);
        tyn_scene_finish(&scene);
    }
}

// ---- what they show -----------------------------------------------------------------------------

static void near(float found, double wanted)
{
    assert_true(fabs((double)found - wanted) < 1e-6 * (1 + fabs(wanted)));
}

static void room_is_the_reference(void **state)
{
    (void)state;
    const double pi = 3.14159265358979;
    tyn_scene scene = scenes_load("room");
    const tyn_medium *fog = &scene.media[0];
    const tyn_light *lamp = &scene.lights[0];
    const tyn_camera *camera = &scene.cameras[0];
    const double down = sqrt(0.55 * 0.55 + 1.5 * 1.5);
    const double ahead[3] = {1.8 - 3.6, 1.3 - 1.5, 1.6 - 3.8};
    const double length = sqrt(ahead[0] * ahead[0] + ahead[1] * ahead[1] + ahead[2] * ahead[2]);
    for (int k = 0; k < 3; k++) {
        near(fog->sigma_s[k], 0.3);
        near(fog->sigma_a[k], 0.02);
        near(fog->phase[k].g, 0.6);
        near(lamp->color[k], 40);
        near(lamp->position[k], (const double[]){1.2, 4.5, 2}[k]);
        near(lamp->direction[k], (const double[]){0.55 / down, -1.5 / down, 0}[k]);
        near(camera->position[k], (const double[]){3.6, 1.5, 3.8}[k]);
        near(-camera->back[k], ahead[k] / length);
    }
    near(lamp->cos_inner, cos(20 * pi / 180));
    near(lamp->cos_outer, cos(20 * pi / 180));
    near(camera->yfov, pi / 3);
    float lo[3], hi[3];
    assert_true(tyn_scene_bounds(&scene, lo, hi));
    for (int k = 0; k < 3; k++) {
        near(lo[k], 0);
        near(hi[k], (const double[]){4, 3, 4}[k]);
    }
    // Red is what lies in the plane x = 0, and only that.
    const tyn_surfaces *s = &scene.surfaces;
    for (uint32_t t = 0; t < s->num_triangles; t++) {
        const tyn_surface_material *m = &s->materials[s->triangles[t].material];
        const uint32_t *v = s->triangles[t].vertices;
        const bool red = s->vertices[v[0]].position[0] == 0 && s->vertices[v[1]].position[0] == 0 &&
                         s->vertices[v[2]].position[0] == 0;
        for (int k = 0; k < 3; k++) {
            near(m->albedo[k], red ? (const double[]){0.75, 0.15, 0.1}[k] : 0.75);
        }
    }
    tyn_scene_finish(&scene);
}

// The dust of the cave is very uneven, and thin enough to see across.
static void cave_is_dusty(void **state)
{
    (void)state;
    tyn_scene scene = scenes_load("vpl-cave");
    const tyn_volume *v = &scene.volumes[0];
    const size_t n = (size_t)v->size[0] * v->size[1] * v->size[2];
    double mean = 0;
    for (size_t i = 0; i < n; i++) {
        mean += (double)v->data[i] / (double)n;
    }
    const double across =
        20 * mean * (double)(scene.media[0].sigma_s[1] + scene.media[0].sigma_a[1]);
    print_message("cave: density %.4f, at most %.3f; optical depth across %.2f\n", mean,
                  (double)v->max_density, across);
    assert_true((double)v->max_density > 10 * mean && across > 1 && across < 4);
    tyn_scene_finish(&scene);
}

// What shines in the Cornell box is its lamp alone, downwards.
static void cornell_has_its_lamp(void **state)
{
    (void)state;
    tyn_scene scene = scenes_load("cornell-smoke");
    const tyn_surfaces *s = &scene.surfaces;
    double area = 0;
    for (uint32_t t = 0; t < s->num_triangles; t++) {
        const uint32_t *v = s->triangles[t].vertices;
        const float *a = s->vertices[v[0]].position, *b = s->vertices[v[1]].position;
        const float *c = s->vertices[v[2]].position;
        if (s->materials[s->triangles[t].material].emission[0] > 0) {
            const float down = (b[2] - a[2]) * (c[0] - a[0]) - (b[0] - a[0]) * (c[2] - a[2]);
            assert_true(down < 0);
            near(a[1], 0.5488);
            area -= 0.5 * (double)down;
        }
    }
    print_message("cornell-smoke: a lamp of %.5f m^2\n", area);
    assert_true(fabs(area - 0.13 * 0.105) < 1e-6);
    tyn_scene_finish(&scene);
}

int main(int argc, char **argv)
{
    if (!scenes_folder(argc, argv)) {
        return 2;
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(surfaces_are_closed),
        cmocka_unit_test(room_is_the_reference),
        cmocka_unit_test(cave_is_dusty),
        cmocka_unit_test(cornell_has_its_lamp),
    };
    return cmocka_run_group_tests_name("walls", tests, NULL, NULL);
}
