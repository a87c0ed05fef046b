// pop_walls.c -- `pop` and walls: darkness in what is sealed, and light that comes through what is open.
#include "bound.h"
#include "gpu_test.h"
#include "numbers.h"
#include "offline_frame.h"
#include "path_run.h"
#include "picture.h"
#include "skip.h"
#include "solids.h"
#include "todo.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char coarse_light[] = "pixels with two pieces of surface keep light and distance of "
                                   "each in 64 bits: .00511 with 12 bits a "
                                   "channel, .00503 and .00457 with 13 and fewer of the distance";
static const char white_boxes[] =
    "the sky comes by direction and from virtual lights on the surfaces, whose sums are not exact, "
    "as those along the lattice's lines are";

// A closed box in fog that is lit by a sky, or by a sun and a lamp; its walls are off the planes of the lattice and
// turned by 30 degrees. At points inside, and in pictures from there, is less than 1e-4 of what there is outside.
static void sealed(void **state)
{
    gpu_test *t = *state;
    enum { N = 4000 };
    static float points[N][3];
    const float lo[3] = {-0.41f, -0.37f, -0.44f}, hi[3] = {0.46f, 0.39f, 0.4f};
    const double angle = M_PI / 6;
    for (int i = 0; i < N; i++) {
        for (int a = 0; a < 3; a++) {
            points[i][a] = (float)(1.9 * rand() / RAND_MAX - 0.95);
        }
    }
    for (int k = 0; k < 6; k++) {
        tyn_scene scene;
        tyn_scene_init(&scene);
        float rho = k % 2 ? 1 : 0.75f;
        uint32_t wall = solids_material(&scene, (float[]){rho, rho, rho}, (float[]){0, 0, 0});
        solids_box(&scene, lo, hi, (float)angle, false, wall);
        tyn_medium m = grey_medium(k / 2 == 1 ? 8 : 1, 0, 0.5f);
        scene_add_box(&scene, &m, (float[]){-1, -1, -1}, (float[]){1, 1, 1}, NULL, NULL);
        if (k < 4) {
            scene_set_sky(&scene, 1);
        } else { // with shadow maps and virtual point lights
            solids_hierarchy(&scene, 2);
            scene_add_sun(&scene, 0.3f, -0.9f, 0.3f, 2, 2, 2);
            scene_add_lamp(&scene, (float[]){-0.8f, 0.1f, 0.3f}, 1);
        }
        tyn_offline *off = scene_open(t->dev, "pop", NULL);
        const tyn_probe_result *p = scene_probes(t->dev, off, &scene, (const float(*)[3])points, N);
        double inside = 0, outside = 0;
        int in = 0, dark = 0;
        for (int i = 0; i < N; i++) {
            // Into the box's own axes, whichever way it is turned.
            double depth = -1;
            for (int way = -1; way <= 1; way += 2) {
                double c = cos(angle), s = way * sin(angle),
                       x = points[i][0] - 0.5 * (lo[0] + hi[0]),
                       z = points[i][2] - 0.5 * (lo[2] + hi[2]);
                double u = c * x + s * z, v = -s * x + c * z,
                       y = points[i][1] - 0.5 * (lo[1] + hi[1]);
                double d =
                    fmin(0.5 * (hi[0] - lo[0]) - fabs(u),
                         fmin(0.5 * (hi[1] - lo[1]) - fabs(y), 0.5 * (hi[2] - lo[2]) - fabs(v)));
                depth = way < 0 ? d : fmin(depth, d);
            }
            if (depth > 1e-4) {
                inside = maximum(inside, p[i].fluence[1]);
                in++;
            } else if (fabs(points[i][0]) > 0.7 || fabs(points[i][2]) > 0.7) {
                outside += p[i].fluence[1] / (4 * M_PI);
                dark++;
            }
        }
        printf("albedo %g, sigma_s %g: %d points inside, most %.1e; mean outside %.4f\n",
               (double)rho, (double)m.sigma_s[0], in, inside, outside / dark);
        assert_true(in > 100 && inside < 1e-4 * outside / dark);

        // From inside nothing is to be seen; from outside, among uniform surroundings, a white box neither.
        tyn_view view = {0};
        picture p_inside, white;
        double brightest = 0, wrong = 0, mean_wrong = 0;
        static const float eyes[3][3] = {
            {0.2f, 0.1f, 0.25f}, {-0.3f, -0.3f, 0}, {0.02f, 0.3f, -0.02f}};
        for (int eye = 0; eye < 3; eye++) {
            view_perspective(&view, eyes[eye], (float[]){-0.2f, -0.05f, -0.2f}, 1, 40);
            picture_frame(&p_inside, t->dev, off, &scene, &view, false);
            for (int i = 0; i < 40 * 40 * 3; i++) {
                brightest = maximum(brightest, p_inside.rgb[i]);
            }
            picture_free(&p_inside);
        }
        tyn_offline_destroy(&off);
        printf("    brightest of %d pixels inside %.1e\n", 3 * 40 * 40, brightest);
        assert_true(brightest < 1e-4 * outside / dark);
        if (rho == 1 && k < 4) {
            view_perspective(&view, (float[]){0.2f, 0.8f, 2.5f}, (float[]){0, 0, 0}, 0.5f, 24);
            picture_render(&white, t->dev, "pop", &scene, &view, "lattice.sweeps=12", 0);
            for (int i = 0; i < 24 * 24 * 3; i++) {
                wrong = maximum(wrong, fabs(white.rgb[i] - 1.0));
                mean_wrong += (white.rgb[i] - 1.0) / (24 * 24 * 3);
            }
            picture_free(&white);
            printf("    outside off by %.1e, mean %.1e\n", wrong, mean_wrong);
            if (k == 1) {
                assert_true(within(wrong, 0.08, NULL, "white box %d, worst pixel", k));
            } else {
                assert_true(todo_if(true, wrong < 0.005, coarse_light,
                                    "white box %d, worst pixel: %.5f", k, wrong));
                // A tenth above what is seen.
                assert_true(within(wrong, 0.0055, NULL, "white box %d, worst pixel", k));
            }
            assert_true(
                within(fabs(mean_wrong), k == 1 ? 1.5e-4 : 0.002, NULL, "white box %d, mean", k));
            assert_true(todo_if(true, wrong < 5e-5 && fabs(mean_wrong) < 1e-5, white_boxes,
                                "sealed: a white box is not to be seen"));
        }
        tyn_scene_finish(&scene);
    }
}

// The brightest pixel of a lamp in fog 1 m above a floor, in a sealed box of the edge `box` about it, or in none.
static double brightest_of_lamp(gpu_test *t, float floor, float box)
{
    tyn_scene scene;
    tyn_scene_init(&scene);
    uint32_t m = solids_material(&scene, (float[]){0.5f, 0.5f, 0.5f}, (float[]){0, 0, 0});
    solids_quad(&scene, (float[]){-0.5f * floor, 0, -0.5f * floor}, (float[]){0, 0, floor},
                (float[]){floor, 0, 0}, m);
    if (box > 0) {
        const float h = 0.5f * box;
        solids_box(&scene, (float[]){-h, 1 - h, -h}, (float[]){h, 1 + h, h}, 0, false, m);
    }
    solids_hierarchy(&scene, 4);
    tyn_medium fog = grey_medium(0.1f, 0.01f, 0);
    scene_add_box(&scene, &fog, (float[]){-3, 0, -3}, (float[]){3, 3, 3}, NULL, NULL);
    scene_add_lamp(&scene, (float[]){0, 1, 0}, 10);
    tyn_view view = {0};
    view_perspective(&view, (float[]){0, 2, 4}, (float[]){0, 0.3f, 0}, 0.7f, 32);
    picture p;
    picture_render(&p, t->dev, "pop", &scene, &view, NULL, 0);
    double brightest = 0;
    for (int i = 0; i < 32 * 32 * 3; i++) {
        brightest = maximum(brightest, p.rgb[i]);
    }
    picture_free(&p);
    tyn_scene_finish(&scene);
    return brightest;
}

// A lamp in a sealed box of 10 cm above 1 km of ground: nearness is no matter of the scene's size. And in one of 1 m,
// which is five cells of the lattice: there virtual lights stand on the walls' insides.
static void sealed_lamp(void **state)
{
    static const float floors[2] = {1000, 10}, boxes[2] = {0.1f, 1};
    for (int k = 0; k < 2; k++) {
        const double open = brightest_of_lamp(*state, floors[k], 0);
        const double sealed = brightest_of_lamp(*state, floors[k], boxes[k]);
        printf("sealed lamp: box of %g m, brightest pixel %.1e, without the box %.3f\n",
               (double)boxes[k], sealed, open);
        assert_true(sealed < 1e-4 * open);
    }
}

// How far a point is within the box that solids_box makes, turned by 30 degrees this or that way; < 0: outside.
static double depth_in_box(const float p[3], const float lo[3], const float hi[3], int way)
{
    const double c = cos(M_PI / 6), s = way * sin(M_PI / 6);
    const double x = p[0] - 0.5 * (lo[0] + hi[0]), z = p[2] - 0.5 * (lo[2] + hi[2]);
    const double u = 0.5 * (hi[0] - lo[0]) - fabs(c * x + s * z);
    const double v = 0.5 * (hi[1] - lo[1]) - fabs(p[1] - 0.5 * (lo[1] + hi[1]));
    const double w = 0.5 * (hi[2] - lo[2]) - fabs(-s * x + c * z);
    return fmin(u, fmin(v, w));
}

// A lamp and a sealed box above a floor, the lamp beside the box or in it: virtual lights stand on the floor and on the
// walls' either sides. All light stays on its side: at points, and in pictures from the dark side. In the small
// medium the floor is outside the lattice, and virtual lights carry all reflections; in the large one the lattice
// has the second and further ones.
static void sealed_from_virtual_lights(void **state)
{
    gpu_test *t = *state;
    enum { N = 2000, SIDE = 64 };
    static float points[N][3];
    const float lo[3] = {-0.41f, -0.37f, -0.44f}, hi[3] = {0.46f, 0.39f, 0.4f};
    srand(1);
    for (int k = 0; k < 4; k++) {
        const bool lamp_inside = k & 1, large = k & 2;
        const float reach[3] = {large ? 2 : 1, large ? 1.5f : 1, large ? 2 : 1};
        tyn_scene scene;
        tyn_scene_init(&scene);
        uint32_t wall = solids_material(&scene, (float[]){0.7f, 0.7f, 0.7f}, (float[]){0, 0, 0});
        solids_box(&scene, lo, hi, (float)(M_PI / 6), false, wall);
        solids_quad(&scene, (float[]){-2, -1.4f, -2}, (float[]){0, 0, 4}, (float[]){4, 0, 0}, wall);
        solids_hierarchy(&scene, 2);
        tyn_medium m = grey_medium(0.5f, 0.02f, 0.3f);
        scene_add_box(&scene, &m, (float[]){-reach[0], -reach[1], -reach[2]}, reach, NULL, NULL);
        scene_add_lamp(&scene,
                       lamp_inside ? (float[]){0.02f, 0.01f, 0}
                       : large     ? (float[]){1.2f, 0.7f, 0.4f}
                                   : (float[]){-0.8f, 0.1f, 0.3f},
                       10);
        for (int i = 0; i < N; i++) {
            for (int a = 0; a < 3; a++) { // most of them near the box
                points[i][a] = (float)(1.9 * rand() / RAND_MAX - 0.95);
            }
        }
        tyn_offline *off = scene_open(t->dev, "pop", NULL);
        const tyn_probe_result *p = scene_probes(t->dev, off, &scene, (const float(*)[3])points, N);
        double sums[2] = {0, 0}, most[2] = {0, 0}; // outside and inside
        int counts[2] = {0, 0};
        for (int i = 0; i < N; i++) {
            const double a = depth_in_box(points[i], lo, hi, 1),
                         b = depth_in_box(points[i], lo, hi, -1);
            const bool in = fmin(a, b) > 1e-4;
            if (in || fmax(a, b) < -1e-4) {
                sums[in] += p[i].fluence[1];
                most[in] = maximum(most[in], p[i].fluence[1]);
                counts[in]++;
            }
        }
        const double lit = sums[lamp_inside] / counts[lamp_inside], dark = most[!lamp_inside];
        printf("sealed, lamp %s, box of %g m: %d points in, %d out; lit %.3f, most in the dark "
               "%.1e\n",
               lamp_inside ? "inside" : "beside", 2.0 * (double)reach[0], counts[1], counts[0], lit,
               dark);
        assert_true(counts[1] > 50 && counts[0] > 500 && dark == 0);

        static const float eyes[2][3][3] = {
            {{0, 0, 0.05f}, {-0.2f, 0.1f, 0}, {0.2f, -0.1f, 0.1f}},
            {{0, 0, 3.5f}, {-0.9f, 0.6f, 0.8f}, {0.7f, -0.6f, 0.75f}},
        };
        double brightest = 0, mean = 0;
        int shining = 0; // pixels
        for (int eye = 0; eye < 3; eye++) {
            tyn_view view = {0};
            view_perspective(&view, eyes[lamp_inside][eye],
                             lamp_inside ? (float[]){0, -0.1f, 0} : (float[]){0.1f, -0.2f, -0.9f},
                             1.2f, SIDE);
            picture dark_side;
            picture_frame(&dark_side, t->dev, off, &scene, &view, false);
            for (int i = 0; i < SIDE * SIDE; i++) {
                const double light = dark_side.rgb[3 * i + 1];
                brightest = maximum(brightest, light);
                mean += light / (3 * SIDE * SIDE);
                shining += light >= 1e-4 * lit / (4 * M_PI);
            }
            picture_free(&dark_side);
        }
        tyn_offline_destroy(&off);
        printf("    %d pixels on the dark side: mean %.1e, brightest %.1e, %d shine\n",
               3 * SIDE * SIDE, mean, brightest, shining);
        assert_true(mean < 1e-4 * lit / (4 * M_PI));
        assert_true(shining == 0);
        tyn_scene_finish(&scene);
    }
}

static float uniform(float least, float most)
{
    return least + (most - least) * (float)rand() / (float)RAND_MAX;
}

// What shines outside a sealed room does not change what is in it: the mean fluence about a weak lamp in a box, with a sun outside
// over that without, also where the solve has not come to its end.
static void rooms_apart(void **state)
{
    gpu_test *t = *state;
    enum { N = 200 };
    static const char *const steps =
        "Anderson mixing's weights and the scales of the diffusion correction's steps are of all "
        "the lattice: most of its light decides them";
    static const char *const lights = "virtual lights go where power is: none is left for the room";
    static const struct {
        const char *settings, *todo;
        double off;
    } cases[] = {
        {"vpl.count=0 lattice.anderson=1 lattice.sweeps=4", steps, 1e-3},
        {"vpl.count=0 lattice.anderson=1 lattice.sweeps=32", NULL, 1e-3},
        {"vpl.count=0 lattice.anderson=0 lattice.cycles=0", NULL, 1e-4},
        {"vpl.count=128 lattice.anderson=1 lattice.sweeps=32", lights, 1e-3},
    };
    static float points[N][3];
    srand(3);
    for (int i = 0; i < N; i++) {
        for (int a = 0; a < 3; a++) {
            points[i][a] = uniform(-0.3f, 0.3f);
        }
    }
    bool good = true;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        double mean[2] = {0, 0};
        for (int sun = 0; sun < 2; sun++) {
            tyn_scene scene;
            tyn_scene_init(&scene);
            const uint32_t wall =
                solids_material(&scene, (float[]){0.8f, 0.8f, 0.8f}, (float[]){0, 0, 0});
            solids_box(&scene, (float[]){-0.5f, -0.5f, -0.5f}, (float[]){0.5f, 0.5f, 0.5f}, 0.4f,
                       false, wall);
            solids_quad(&scene, (float[]){-2, -1, -2}, (float[]){0, 0, 4}, (float[]){4, 0, 0},
                        wall);
            solids_hierarchy(&scene, 2);
            const tyn_medium m = grey_medium(0.5f, 0.02f, 0.3f);
            scene_add_box(&scene, &m, (float[]){-1.5f, -1.2f, -1.5f}, (float[]){1.5f, 1.2f, 1.5f},
                          NULL, NULL);
            scene_add_lamp(&scene, (float[]){0.02f, 0.01f, 0}, 1e-3f);
            if (sun) {
                scene_add_sun(&scene, 0.3f, -0.9f, 0.3f, 100, 100, 100);
            }
            tyn_offline *off = scene_open(t->dev, "pop", cases[k].settings);
            const tyn_probe_result *p =
                scene_probes(t->dev, off, &scene, (const float(*)[3])points, N);
            for (int i = 0; i < N; i++) {
                mean[sun] += p[i].fluence[1] / N;
            }
            tyn_offline_destroy(&off);
            tyn_scene_finish(&scene);
        }
        const double off = mean[1] / mean[0] - 1;
        printf("sealed room, %s: a sun outside changes its light by %+.2f %%\n", cases[k].settings,
               100 * off);
        good = todo_if(cases[k].todo,
                       within(fabs(off), cases[k].off, cases[k].off > 1e-4 ? NULL : BOUND_ROUNDING,
                              "sealed room, %s", cases[k].settings),
                       cases[k].todo, "sealed room, %s", cases[k].settings) &&
               good;
    }
    assert_true(good);
}

typedef struct random_boxes {
    const char *name, *settings;
    float sigma_s;
    bool lamp_inside;
    int boxes;
    const char *todo;
} random_boxes;

// Boxes of random sizes, turned at random, above a floor, in media of random sizes, a lamp beside or in them, seen
// from the dark side: every pixel is to be black. Their edges come to lie anyhow among the lattice's cells, and small
// ones have few or none without walls. Without virtual lights, in a medium that hardly scatters, the lamp's own map is
// looked at alone; where that lets nothing through no pixel shines with virtual lights and fog either.
static void sealed_boxes_at_random(void **state)
{
    gpu_test *t = *state;
    enum { VIEWS = 4, SIDE = 64, LIT_SIDE = 32 };
    static const char *const rooms =
        "rooms are looked for where virtual lights are: without, what the camera sees of the "
        "lattice in an edge may be of cells beyond it (2e-7 of what is lit)";
    const random_boxes sets[] = {
        {"lamp beside, alone", "vpl.count=0", 1e-6f, false, 4, rooms},
        {"lamp beside", NULL, 0.5f, false, 4, NULL},
        {"lamp beside, 24 cells", "lattice.cells=24", 0.5f, false, 3, NULL},
        {"lamp inside", NULL, 0.5f, true, 3, NULL},
    };
    int by_map[4][VIEWS + 1] = {0};
    bool good = true;
    for (uint32_t k = 0; k < sizeof sets / sizeof *sets; k++) {
        const random_boxes *set = &sets[k];
        int pixels = 0, shining = 0;
        double brightest = 0, mean = 0; // of what is lit
        for (int box = 0; box < set->boxes; box++) {
            srand((unsigned)box + 1);
            tyn_scene scene;
            tyn_scene_init(&scene);
            const uint32_t wall =
                solids_material(&scene, (float[]){0.7f, 0.7f, 0.7f}, (float[]){0, 0, 0});
            const float angle = uniform(0, 1.57f);
            float lo[3], hi[3], lamp[3];
            for (int a = 0; a < 3; a++) {
                lo[a] = -uniform(0.3f, 0.6f);
                hi[a] = uniform(0.3f, 0.6f);
            }
            solids_box(&scene, lo, hi, angle, false, wall);
            solids_quad(&scene, (float[]){-2, -1, -2}, (float[]){0, 0, 4}, (float[]){4, 0, 0},
                        wall);
            solids_hierarchy(&scene, 2);
            const tyn_medium m = grey_medium(set->sigma_s, 0.02f, 0.3f);
            const float r = uniform(1.2f, 3);
            scene_add_box(&scene, &m, (float[]){-r, -r, -r}, (float[]){r, r, r}, NULL, NULL);
            for (int a = 0; a < 3; a++) {
                static const float least[3] = {-1.2f, -0.5f, -1}, most[3] = {-0.9f, 0.9f, 1};
                lamp[a] = set->lamp_inside ? uniform(-0.1f, 0.1f) : uniform(least[a], most[a]);
            }
            scene_add_lamp(&scene, lamp, 10);
            double lit = 0;
            tyn_offline *off = scene_open(t->dev, "pop", set->settings);
            for (int eye = 0; eye <= VIEWS; eye++) { // the first one is on the lit side
                const float turn = uniform(0, 6.28f), away = uniform(1.05f, 1.15f);
                float from[3] = {away * cosf(turn), 0, away * sinf(turn)}, at[3] = {0, 0, 0};
                from[1] = uniform(-0.5f, 0.7f);
                at[1] = uniform(-0.3f, 0);
                for (int a = 0; a < 3 && (eye == 0) == set->lamp_inside; a++) {
                    from[a] = uniform(-0.1f, 0.1f);
                    at[a] = uniform(-1, 1);
                }
                tyn_view view = {0};
                view_perspective(&view, from, at, 1.2f, eye == 0 ? LIT_SIDE : SIDE);
                picture p;
                picture_frame(&p, t->dev, off, &scene, &view, false);
                const int count = (int)(p.width * p.height);
                double most = 0, sum = 0;
                int here = 0;
                for (int i = 0; i < count; i++) {
                    const double light = p.rgb[3 * i + 1];
                    most = maximum(most, light);
                    sum += light;
                    here += light != 0;
                }
                picture_free(&p);
                if (eye == 0) {
                    lit = sum / count;
                    assert_true(lit > 0);
                    continue;
                }
                if (here > 0) {
                    printf("    box %d, view %d: %d shine, brightest %.1e of what is lit\n", box,
                           eye, here, most / lit);
                }
                if (k == 0) {
                    by_map[box][eye] = here;
                }
                good = good && (set->lamp_inside || here <= by_map[box][eye]);
                pixels += count;
                shining += here;
                mean += sum / lit;
                brightest = maximum(brightest, most / lit);
            }
            tyn_offline_destroy(&off);
            tyn_scene_finish(&scene);
        }
        printf("boxes at random, %s: %d pixels on the dark side, %d shine, mean %.1e and brightest "
               "%.1e of what is lit\n",
               set->name, pixels, shining, mean / pixels, brightest);
        good =
            todo_if(set->todo, shining == 0, set->todo, "boxes at random, %s", set->name) && good;
    }
    assert_true(good);
}

// A sealed, turned box in fog under a sun, a dim lamp in it, so that the lattice is not dark there: the sun adds nothing to
// pictures from inside. They may be darker with it: virtual lights stand where most light arrives, and what the lamp sends
// has fewer of them.
static void sun_on_a_sealed_box(void **state)
{
    gpu_test *t = *state;
    enum { SIDE = 48, PIXELS = SIDE * SIDE };
    static const struct {
        float lo[3], hi[3], angle, reach, at[3];
    } boxes[3] = {
        {{-0.41f, -0.37f, -0.44f}, {0.46f, 0.39f, 0.4f}, 0.52f, 1, {1, 0.3f, 0.2f}},
        {{-0.56f, -0.33f, -0.5f}, {0.35f, 0.58f, 0.44f}, 1.1f, 1.7f, {-0.3f, -1, 0.5f}},
        {{-0.31f, -0.52f, -0.38f}, {0.57f, 0.36f, 0.55f}, 0.2f, 2.4f, {0.4f, 0.1f, -1}},
    };
    for (int k = 0; k < 3; k++) {
        picture p[2];
        for (int sun = 0; sun < 2; sun++) {
            tyn_scene scene;
            tyn_scene_init(&scene);
            uint32_t wall =
                solids_material(&scene, (float[]){0.7f, 0.7f, 0.7f}, (float[]){0, 0, 0});
            solids_box(&scene, boxes[k].lo, boxes[k].hi, boxes[k].angle, false, wall);
            solids_hierarchy(&scene, 2);
            tyn_medium m = grey_medium(1, 0.02f, 0.7f);
            const float r = boxes[k].reach, e = sun ? 100 : 1e-6f;
            scene_add_box(&scene, &m, (float[]){-r, -r, -r}, (float[]){r, r, r}, NULL, NULL);
            scene_add_lamp(&scene, (float[]){0.02f, 0.03f, 0.01f}, 1e-3f);
            scene_add_sun(&scene, 0.3f, -0.9f, 0.3f, e, e, e);
            tyn_view view = {0};
            view_perspective(&view, (float[]){0.05f, -0.03f, 0.04f}, boxes[k].at, 1.2f, SIDE);
            picture_render(&p[sun], t->dev, "pop", &scene, &view, NULL, 0);
            tyn_scene_finish(&scene);
        }
        double most = 0, lamp = 0;
        for (int i = 0; i < PIXELS; i++) {
            most = maximum(most, (double)p[1].rgb[3 * i + 1] - (double)p[0].rgb[3 * i + 1]);
            lamp += p[0].rgb[3 * i + 1] / (double)PIXELS;
        }
        printf("sealed box in a medium of %g m: lamp's mean %.1e; a sun of 100 W/m^2 adds %.1e at "
               "most\n",
               2.0 * (double)boxes[k].reach, lamp, most);
        assert_true(lamp > 1e-4 && most < 1e-4 * lamp);
        picture_free(&p[0]);
        picture_free(&p[1]);
    }
}

// Floor, ceiling and three walls of a room from -1 to 1, open towards +z.
static void three_sides(tyn_scene *scene, uint32_t wall)
{
    const float x[3] = {2, 0, 0}, y[3] = {0, 2, 0}, z[3] = {0, 0, 2}, corner[3] = {-1, -1, -1};
    solids_quad(scene, corner, z, x, wall);
    solids_quad(scene, (float[]){-1, 1, -1}, z, x, wall);
    solids_quad(scene, corner, z, y, wall);
    solids_quad(scene, (float[]){1, -1, -1}, z, y, wall);
    solids_quad(scene, corner, x, y, wall);
}

// A room with one side open, away from the sun, in fog that scatters forward: the sun reaches its walls by what comes round
// through the open side, not through the roof.
static void room_open_on_one_side(void **state)
{
    gpu_test *t = *state;
    enum { SIDE = 48 };
    static const float kinds[3][2] = {{0.5f, 0.7f}, {1, 0.85f}, {0.15f, 0}}; // sigma_s, g
    static const double biases[3] = {0.012, 0.05, 0.06};
    path_run runs;
    path_run_open(&runs, t->dev);
    for (int k = 0; k < 3; k++) {
        tyn_scene scene;
        tyn_scene_init(&scene);
        uint32_t wall = solids_material(&scene, (float[]){0.5f, 0.5f, 0.5f}, (float[]){0, 0, 0});
        three_sides(&scene, wall);
        solids_hierarchy(&scene, 2);
        tyn_medium m = grey_medium(kinds[k][0], 0.02f, kinds[k][1]);
        scene_add_box(&scene, &m, (float[]){-2, -1, -2}, (float[]){2, 3, 3}, NULL, NULL);
        scene_add_sun(&scene, 0.1f, -1, 0.15f, 10, 10, 10);
        tyn_view view = {0};
        view_perspective(&view, (float[]){0, 0, 0.9f}, (float[]){0, -0.3f, -1}, 1.2f, SIDE);
        picture p, reference = {0};
        picture_render(&p, t->dev, "pop", &scene, &view, NULL, 0);
        path_run_picture(&runs, &reference, &scene, &view, 128);
        picture_error e = picture_compare(&p, &reference, 8);
        printf("open room, sigma_s %g, g %g: rel_l1 %.1f %% (noise %.1f), bias %+.1f %%\n",
               (double)kinds[k][0], (double)kinds[k][1], 100 * e.rel_l1, 100 * e.noise,
               100 * e.bias);
        // Shadows of the roof's edge are as fine as the lattice, 0.16 m.
        assert_true(within(e.reported, 0.15, NULL, "open room %d, error", k));
        assert_true(within(fabs(e.bias), biases[k], NULL, "open room %d, bias", k));
        picture_free(&p);
        picture_free(&reference);
        tyn_scene_finish(&scene);
    }
    path_run_close(&runs);
}

// A ball in a sealed box under a sun or a lamp. What of a curved surface may be off its triangle's plane must not reach to
// the roof.
static void ball_in_a_sealed_box(void **state)
{
    gpu_test *t = *state;
    enum { SIDE = 64 };
    static const float gaps[3] = {0.02f, 0.05f, 0.1f};
    int shining = 0;
    for (int k = 0; k < 6; k++) {
        const float gap = gaps[k / 2];
        tyn_scene scene;
        tyn_scene_init(&scene);
        uint32_t wall = solids_material(&scene, (float[]){0.5f, 0.5f, 0.5f}, (float[]){0, 0, 0});
        solids_box(&scene, (float[]){-2, -1, -2}, (float[]){2, 1, 2}, 0, true, wall);
        solids_sphere(&scene, (float[]){0, 0.5f - gap, 0}, 0.5f, 16, false, wall);
        solids_hierarchy(&scene, 4);
        if (k % 2) {
            scene_add_sun(&scene, 0.3f, -1, 0.1f, 1, 1, 1);
        } else {
            scene_add_lamp(&scene, (float[]){0.3f, 3, 0.2f}, 1);
        }
        tyn_view view = {0};
        view_perspective(&view, (float[]){0, 0.3f, 1.8f}, (float[]){0, 0.3f, 0}, 0.6f, SIDE);
        picture p;
        picture_render(&p, t->dev, "pop", &scene, &view, "vpl.count=0", 0);
        for (int i = 0; i < SIDE * SIDE; i++) {
            shining += p.rgb[3 * i + 1] > 0;
        }
        picture_free(&p);
        tyn_scene_finish(&scene);
    }
    printf("ball in a sealed box: %d of %d pixels shine\n", shining, 6 * SIDE * SIDE);
    assert_int_equal(shining, 0);
}

// An emitter at the beginning of a corridor, and behind a door across it. Maps of virtual lights have few rays.
static void door_of_a_corridor(void **state)
{
    gpu_test *t = *state;
    enum { SIDE = 32 };
    static const float ats[3] = {3, 10, 20};
    bool good = true;
    for (int k = 0; k < 3; k++) {
        const float at = ats[k], end = at + 3;
        const float along[3] = {0, 0, end}, across[3] = {1, 0, 0}, up[3] = {0, 1, 0};
        tyn_scene scene;
        tyn_scene_init(&scene);
        uint32_t black =
            solids_material(&scene, (float[]){1e-3f, 1e-3f, 1e-3f}, (float[]){0, 0, 0});
        uint32_t bright = solids_material(&scene, (float[]){0, 0, 0}, (float[]){1, 1, 1});
        solids_quad(&scene, (float[]){-0.5f, 0, -end}, along, across, black);
        solids_quad(&scene, (float[]){-0.5f, 1, -end}, along, across, black);
        solids_quad(&scene, (float[]){-0.5f, 0, -end}, along, up, black);
        solids_quad(&scene, (float[]){0.5f, 0, -end}, along, up, black);
        solids_quad(&scene, (float[]){-0.5f, 0, -end}, across, up, black);
        solids_quad(&scene, (float[]){-0.5f, 0, -at}, across, up, black);
        solids_quad(&scene, (float[]){-0.5f, 0, 0}, across, up, black);
        solids_quad(&scene, (float[]){-0.25f, 0.25f, -0.01f}, (float[]){0, 0.5f, 0},
                    (float[]){0.5f, 0, 0}, bright);
        solids_hierarchy(&scene, 4);
        tyn_view view = {0};
        view_perspective(&view, (float[]){0, 0.5f, -at - 0.3f}, (float[]){0, 0.4f, -at - 3}, 0.6f,
                         SIDE);
        picture p;
        picture_render(&p, t->dev, "pop", &scene, &view, "shade.pattern=1", 0);
        double mean = 0;
        for (int i = 0; i < SIDE * SIDE; i++) {
            mean += p.rgb[3 * i + 1] / (SIDE * SIDE);
        }
        // What an emitter of .25 m^2 sends to so black an end of the corridor, were there no door.
        const double open = 1e-3 / 3.14159265 * 0.25 / (double)(end * end);
        printf("door at %g m: %.1e of what its end would have without it\n", (double)at,
               mean / open);
        good = todo_if(true, mean < 1e-4 * open,
                       "a virtual light's map has 16 x 16 rays, which a corridor's walls stop "
                       "before the door",
                       "door at %g m", (double)at) &&
               good;
        picture_free(&p);
        tyn_scene_finish(&scene);
    }
    assert_true(good);
}

// Light of a sky through a window, on the walls away from it.
static void sky_through_a_window(void **state)
{
    gpu_test *t = *state;
    enum { SIDE = 48 };
    static const float windows[2] = {0.3f, 0.6f}; // half edges
    static const double errors[2] = {0.15, 0.06}, biases[2] = {0.05, 0.02};
    path_run runs;
    path_run_open(&runs, t->dev);
    bool good = true;
    for (int k = 0; k < 2; k++) {
        tyn_scene scene;
        tyn_scene_init(&scene);
        uint32_t wall = solids_material(&scene, (float[]){0.5f, 0.5f, 0.5f}, (float[]){0, 0, 0});
        three_sides(&scene, wall);
        const float w = windows[k], rest = 1 - w;
        const float across[3] = {2, 0, 0}, beside[3] = {rest, 0, 0}, high[3] = {0, rest, 0};
        solids_quad(&scene, (float[]){-1, -1, 1}, across, high, wall);
        solids_quad(&scene, (float[]){-1, w, 1}, across, high, wall);
        solids_quad(&scene, (float[]){-1, -w, 1}, beside, (float[]){0, 2 * w, 0}, wall);
        solids_quad(&scene, (float[]){w, -w, 1}, beside, (float[]){0, 2 * w, 0}, wall);
        solids_hierarchy(&scene, 2);
        tyn_medium m = grey_medium(0.15f, 0.01f, 0);
        scene_add_box(&scene, &m, (float[]){-1.3f, -1.3f, -1.3f}, (float[]){1.3f, 1.3f, 1.9f}, NULL,
                      NULL);
        scene_set_sky(&scene, 1);
        tyn_view view = {0};
        view_perspective(&view, (float[]){0, 0, 0.9f}, (float[]){0, -0.3f, -1}, 1.2f, SIDE);
        picture p, reference = {0};
        picture_render(&p, t->dev, "pop", &scene, &view, NULL, 0);
        path_run_picture(&runs, &reference, &scene, &view, 512);
        picture_error e = picture_compare(&p, &reference, 8);
        printf("window of %g m: rel_l1 %.1f %% (noise %.1f), bias %+.1f %%\n", 2 * (double)w,
               100 * e.rel_l1, 100 * e.noise, 100 * e.bias);
        good = within(e.reported, errors[k], NULL, "window of %g m, error", 2 * (double)w) && good;
        good = within(fabs(e.bias), biases[k], NULL, "window of %g m, bias", 2 * (double)w) && good;
        picture_free(&p);
        picture_free(&reference);
        tyn_scene_finish(&scene);
    }
    path_run_close(&runs);
    assert_true(good);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sealed),
        cmocka_unit_test(sealed_lamp),
        cmocka_unit_test(sealed_from_virtual_lights),
        cmocka_unit_test(sun_on_a_sealed_box),
        cmocka_unit_test(room_open_on_one_side),
        cmocka_unit_test(sky_through_a_window),
        cmocka_unit_test(rooms_apart),
        cmocka_unit_test(sealed_boxes_at_random),
        cmocka_unit_test(ball_in_a_sealed_box),
        cmocka_unit_test(door_of_a_corridor),
    };
    cmocka_set_test_filter(getenv("TYN_TEST_FILTER"));
    return run_cases(tests, gpu_setup, gpu_teardown);
}
