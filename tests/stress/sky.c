// sky.c -- `pop` under maps that break things, around media that break things: no NaN, nothing negative, no
// validation message, and where the answer is known, that answer.
#include "gpu_test.h"
#include "numbers.h"
#include "picture.h"
#include "sky.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PIXELS = 24, GRID = 16 };

typedef enum map_kind {
    MAP_SKY,
    MAP_HOT,      // one texel of 1e6 on a faint sky
    MAP_HOT_POLE, // ... in the row at the pole
    MAP_ONLY_HOT, // ... on black
    MAP_BLACK,
    MAP_ONE, // 1 x 1
    MAP_COLUMN,
    MAP_ROW,
    MAP_COLOURS, // each hemisphere its own colour, which the others lack
    MAP_LARGE,   // 8192 x 4096
    MAP_FAINT,   // 1e-20
    MAP_BRIGHT,  // 1e15
} map_kind;

static void make_map(tyn_environment *map, map_kind kind)
{
    static const uint32_t sizes[][2] = {{32, 16}, {64, 32},     {64, 32}, {64, 32},
                                        {8, 4},   {1, 1},       {1, 32},  {64, 1},
                                        {16, 8},  {8192, 4096}, {16, 8},  {16, 8}};
    const uint32_t w = sizes[kind][0], h = sizes[kind][1];
    float base = kind == MAP_ONLY_HOT || kind == MAP_BLACK ? 0
                 : kind == MAP_FAINT                       ? 1e-20f
                 : kind == MAP_BRIGHT                      ? 1e15f
                                                           : 0.5f;
    sky_constant_map(map, w, h, base);
    for (uint32_t i = 0; i < w * h && base > 0; i++) {
        for (uint32_t c = 0; c < 3; c++) {
            float v = (float)((i * 7919u + c * 104729u) % 101) / 100;
            map->data[3 * i + c] *= kind == MAP_COLOURS ? (float)(i % w * 3 / w == c) : v;
        }
    }
    uint32_t hot = kind == MAP_HOT_POLE ? w / 3 : h / 3 * w + w / 4;
    if (kind == MAP_HOT || kind == MAP_HOT_POLE || kind == MAP_ONLY_HOT) {
        map->data[3 * hot] = 1e6f;
        map->data[3 * hot + 1] = 9e5f;
        map->data[3 * hot + 2] = 6e5f;
    }
    map->hash = 1000u + (uint64_t)kind;
}

static const char *const map_names[] = {"sky",     "hot texel", "hot pole", "hot on black",
                                        "black",   "1 x 1",     "column",   "row",
                                        "colours", "8192x4096", "faint",    "bright"};

static float *checkers(void)
{
    float *grid = malloc(GRID * GRID * GRID * sizeof *grid);
    for (int i = 0; i < GRID * GRID * GRID; i++) {
        grid[i] = (float)((i % GRID / 4 + i / GRID % GRID / 4 + i / GRID / GRID / 4) & 1);
    }
    return grid;
}

// Whether the answers are radiances: finite, not negative. `most` > 0: none above it.
static void check(const picture *p, const char *name, double most)
{
    double least = HUGE_VAL, greatest = -HUGE_VAL;
    for (uint32_t i = 0; i < p->width * p->height * 3; i++) {
        if (!isfinite(p->rgb[i])) {
            print_message("%s: pixel %u is %g\n", name, i / 3, (double)p->rgb[i]);
        }
        assert_true(isfinite(p->rgb[i]));
        least = minimum(least, p->rgb[i]);
        greatest = maximum(greatest, p->rgb[i]);
    }
    print_message("%-60s %.4g to %.4g\n", name, least, greatest);
    assert_true(least >= 0);
    assert_true(most <= 0 || greatest <= most);
}

typedef struct stress {
    map_kind map;
    float sigma, albedo, g;
    bool grid, sphere, inside, parallel, two;
    int ordinates;  // 0: as many as usual
    float strength; // of the map
    double most;
} stress;

static void render(gpu_test *t, const stress *s)
{
    tyn_scene *scene = malloc(sizeof *scene);
    tyn_scene_init(scene);
    float *grid = checkers();
    float scattering = s->sigma * s->albedo, absorption = s->sigma - scattering;
    tyn_medium medium = grey_medium(scattering, absorption, s->g);
    tyn_shape *shape = scene_add_box(scene, &medium, (float[]){-1, -1, -1}, (float[]){1, 1, 1},
                                     (uint32_t[]){GRID, GRID, GRID}, s->grid ? grid : NULL);
    shape->kind = s->sphere ? TYN_SHAPE_SPHERE : TYN_SHAPE_BOX;
    if (s->two) {
        tyn_medium other = grey_medium(0.5f * absorption, 2 * scattering, -0.5f * s->g);
        scene_add_box(scene, &other, (float[]){-0.5f, 0, -2}, (float[]){1.5f, 2, 0.5f}, NULL, NULL);
    }
    make_map(&scene->environment, s->map);
    for (int c = 0; c < 3; c++) {
        scene->environment.radiance[c] *=
            s->strength; // a strength of 0 would be one that is not given
    }
    sky_turn(&scene->environment, 1, 2, 3, 0.7f);
    tyn_view view = {0};
    view_orthographic(&view, (float[]){0, 0, 0}, -1, -0.4f, -0.7f, (float[]){0, 1, 0}, 1.6f,
                      PIXELS);
    if (!s->parallel) {
        view.camera.projection = TYN_PERSPECTIVE;
        view.camera.yfov = 1;
        for (int i = 0; i < 3; i++) {
            view.camera.position[i] = s->inside ? 0.3f : 4 * view.camera.back[i];
        }
    }
    char name[160], settings[80] = "lattice.cells=12";
    snprintf(name, sizeof name, "%s, sigma %g, albedo %g, g %g%s%s%s%s%s%s", map_names[s->map],
             (double)s->sigma, (double)s->albedo, (double)s->g, s->grid ? ", grid" : "",
             s->sphere ? ", sphere" : "", s->inside ? ", inside" : "",
             s->parallel ? ", parallel" : "", s->two ? ", two media" : "",
             s->strength > 0 ? "" : ", dark");
    if (s->ordinates) {
        snprintf(settings, sizeof settings, "lattice.cells=12 ordinates.count=%d", s->ordinates);
    }
    picture p;
    picture_render(&p, t->dev, "pop", scene, &view, settings, 0);
    check(&p, name, s->strength > 0 ? s->most : 1e-30);
    picture_free(&p);
    tyn_scene_finish(scene);
    free(scene);
    free(grid);
}

static void media(void **state)
{
    static const float sigmas[] = {0, 1e-6f, 0.1f, 3, 100, 1e4f, 1e8f};
    static const float gs[] = {-0.99f, -0.5f, 0, 0.5f, 0.9f, 0.99f, 0.9999f};
    static const float albedos[] = {1, 0.999f, 0.5f, 1e-6f, 0};
    int turn = 0;
    for (int i = 0; i < 7; i++) {
        for (int j = 0; j < 7; j++, turn++) {
            render(*state, &(stress){.map = turn % 2 ? MAP_SKY : MAP_HOT,
                                     .sigma = sigmas[i],
                                     .g = gs[j],
                                     .albedo = albedos[(i + 2 * j) % 5],
                                     .grid = turn % 3 == 0,
                                     .sphere = turn % 5 == 0,
                                     .inside = turn % 4 == 0,
                                     .parallel = turn % 7 == 0,
                                     .two = turn % 6 == 0,
                                     .strength = 1,
                                     // Out of a map of at most 0.5, hardly more; but backward peaks
                                     // that cells do not resolve are summed too high.
                                     .most = turn % 2 ? (gs[j] < -0.9f ? 5 : 1) : 0});
        }
    }
}

static void maps(void **state)
{
    for (int i = 0; i <= MAP_BRIGHT; i++) {
        if (i == MAP_LARGE && !getenv("TYN_LONG")) {
            continue;
        }
        for (int j = 0; j < 2; j++) {
            render(*state, &(stress){.map = (map_kind)i,
                                     .sigma = j ? 20 : 2,
                                     .albedo = 0.95f,
                                     .g = j ? 0.3f : 0.9f,
                                     .grid = j == 1,
                                     .strength = 1});
        }
        render(*state,
               &(stress){.map = (map_kind)i, .sigma = 3, .albedo = 1, .g = 0.7f, .strength = 0});
    }
}

static void numbers(void **state)
{
    static const int counts[] = {1, 2, 3, 7, 64, 255, 256};
    for (int i = 0; i < 7; i++) {
        for (int j = 0; j < 4; j++) {
            render(*state,
                   &(stress){.map = (const map_kind[]){MAP_SKY, MAP_HOT, MAP_ONE, MAP_BLACK}[j],
                             .sigma = 4,
                             .albedo = 0.9f,
                             .g = 0.8f,
                             .two = j == 1,
                             .ordinates = counts[i],
                             .strength = 1});
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(media), cmocka_unit_test(maps),
                                       cmocka_unit_test(numbers)};
    cmocka_set_test_filter(getenv("TYN_TEST_FILTER"));
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
