// many_lights.c -- thirty coloured lamps, a third of them spots, among columns and balls in a thin haze.
#include "noise.h"
#include "portable.h"
#include "scenes.h"

enum { GROUND, WHITE, DARK };
enum { POINTS = 20, SPOTS = 10 };

#define COUNT(profile) (int)(sizeof(profile) / sizeof(profile[0]))

// A colour of the wheel, its brightest channel 1.
static void hue(float turn, float rgb[3])
{
    for (int k = 0; k < 3; k++) {
        float d = turn - (float)k / 3;
        d -= (float)(int)(d + (d < 0 ? -0.5f : 0.5f)); // nearest way round
        d = d < 0 ? -d : d;
        const float v = 2 - 6 * d;
        rgb[k] = v < 0.04f ? 0.04f : v > 1 ? 1 : v;
    }
}

static void add_lamps(gen_model *model)
{
    for (uint32_t i = 0; i < POINTS; i++) { // on three rings, at different heights
        const uint32_t ring = i < 5 ? 0 : i < 11 ? 1 : 2;
        const uint32_t first[] = {0, 5, 11}, count[] = {5, 6, 9};
        const double turn =
            2 * GEN_PI * ((double)(i - first[ring]) + 0.6 * gen_random(i, 200)) / count[ring];
        const float radius = 2.2f + 3.2f * (float)ring + 0.6f * gen_random(i, 201);
        gen_lamp lamp = {.position = {radius * (float)gen_cos(turn),
                                      0.35f + 1.2f * gen_random(i, 202),
                                      -radius * (float)gen_sin(turn)},
                         .intensity = 2.2f + 2 * gen_random(i, 203)};
        hue(gen_random(i, 204), lamp.color);
        gen_add_lamp(model, &lamp);
    }
    for (uint32_t i = 0; i < SPOTS; i++) { // from above, some of them slanting
        const double turn = 2 * GEN_PI * ((double)i + 0.5 * gen_random(i, 210)) / SPOTS;
        const float radius = 3 + 4.5f * gen_random(i, 211);
        const float x = radius * (float)gen_cos(turn), z = -radius * (float)gen_sin(turn);
        gen_lamp lamp = {.position = {x, 3.4f + 0.5f * gen_random(i, 212), z},
                         .direction = {0.6f * (gen_random(i, 213) - 0.5f) * 2, -1,
                                       0.6f * (gen_random(i, 214) - 0.5f) * 2},
                         .intensity = 40 + 25 * gen_random(i, 215),
                         .inner = 0.2f,
                         .outer = 0.28f};
        hue(gen_random(i, 216), lamp.color);
        gen_add_lamp(model, &lamp);
    }
}

static void build(gen_model *model)
{
    gen_mesh *ground = gen_mesh_new(model, "ground", GROUND);
    gen_add_box(ground, (const float[3]){-12, -0.4f, -12}, (const float[3]){12, 0, 12}, 2);
    gen_place_here(model);

    static const float column[][2] = {{0, -0.1f},     {0.3f, -0.1f},  {0.3f, 0.12f},
                                      {0.22f, 0.18f}, {0.2f, 1.2f},   {0.17f, 2.1f},
                                      {0.26f, 2.2f},  {0.26f, 2.32f}, {0, 2.32f}};
    gen_add_lathe(gen_mesh_new(model, "column", WHITE), column, COUNT(column), 0, 0, 20, 1);
    for (int i = 0; i < 12; i++) {
        const double turn = 2 * GEN_PI * (i + 0.5) / 12;
        gen_place(model, 7 * (float)gen_cos(turn), 0, -7 * (float)gen_sin(turn), 0, 1);
    }
    gen_mesh *ball = gen_mesh_new(model, "ball", WHITE);
    gen_add_ball(ball, (const float[3]){0, 0.96f, 0}, 1, 32);
    static const float balls[][3] = {// x, z, radius
                                     {0, 0, 1.1f},       {-2.3f, 1.9f, 0.55f}, {2.6f, 1.3f, 0.7f},
                                     {1.2f, 3.6f, 0.4f}, {-4.4f, -1.2f, 0.8f}, {3.4f, -3.3f, 0.9f},
                                     {-1.6f, 5, 0.35f},  {4.6f, 3.4f, 0.45f}};
    for (int i = 0; i < COUNT(balls); i++) {
        gen_place(model, balls[i][0], 0, balls[i][1], (float)i, balls[i][2]);
    }
    gen_mesh *block = gen_mesh_new(model, "block", DARK);
    gen_add_box(block, (const float[3]){-0.5f, -0.05f, -0.5f}, (const float[3]){0.5f, 1, 0.5f}, 1);
    static const float blocks[][4] = {// x, z, turn, size
                                      {-3.4f, 3.6f, 0.5f, 0.9f},
                                      {-0.9f, -3.4f, 0.2f, 1.4f},
                                      {4.9f, -0.4f, 1, 1.1f},
                                      {-5.3f, 2.2f, 0.8f, 0.7f},
                                      {2.4f, 5.6f, 0.3f, 0.6f}};
    for (int i = 0; i < COUNT(blocks); i++) {
        const float *b = blocks[i];
        gen_place(model, b[0], 0, b[1], b[2], b[3]);
    }
    add_lamps(model);
}

const gen_scene gen_many_lights = {
    .name = "many-lights",
    .about = "twenty coloured lamps and ten coloured spot lights in the haze over a ground with "
             "columns, balls and blocks",
    .media = {{.name = "haze",
               .scattering = {0.22f, 0.22f, 0.22f},
               .absorption = {0.01f, 0.01f, 0.01f},
               .anisotropy = 0.4f,
               .density = {.uri = "haze.raw", .type = "u8", .size = {72, 16, 72}}}},
    .shapes = {{.name = "haze", .translation = {0, 2, 0}, .scale = {22, 4, 22}}},
    .cameras = {{.name = "view", .from = {0.8f, 4.6f, 12.5f}, .at = {0, 0.7f, 0}, .yfov = 0.72f}},
    .environment = true,
    .environment_radiance = {0.004f, 0.005f, 0.009f},
    .materials = {{.name = "ground", .albedo = {1, 1, 1}, .texture = "slabs.png"},
                  {.name = "white", .albedo = {0.75f, 0.75f, 0.75f}},
                  {.name = "dark", .albedo = {0.3f, 0.3f, 0.32f}}},
    .build = build,
};
