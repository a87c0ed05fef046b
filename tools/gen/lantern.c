// lantern.c -- a lantern at night, in smoke that creeps over the ground: its bars cast shadows into
// it.
#include "noise.h"
#include "portable.h"
#include "scenes.h"

enum { GROUND, IRON, WOOD, CLAY, STONE };

#define STAND 0.62f // height of what the lantern stands on
#define BARS 6
#define COUNT(profile) (int)(sizeof(profile) / sizeof(profile[0]))

static void add_lantern(gen_model *model)
{
    static const float base[][2] = {{0, -0.01f},     {0.2f, -0.01f}, {0.2f, 0.025f},
                                    {0.17f, 0.045f}, {0.06f, 0.05f}, {0, 0.05f}};
    static const float roof[][2] = {{0, 0.45f},      {0.19f, 0.45f}, {0.21f, 0.455f},
                                    {0.12f, 0.53f},  {0.05f, 0.57f}, {0.045f, 0.63f},
                                    {0.07f, 0.635f}, {0.07f, 0.65f}, {0, 0.66f}};
    // A ring: its profile comes back to where it started.
    static const float hoop[][2] = {
        {0.163f, 0.24f}, {0.181f, 0.24f}, {0.181f, 0.258f}, {0.163f, 0.258f}, {0.163f, 0.24f}};
    gen_mesh *iron = gen_mesh_new(model, "lantern", IRON);
    gen_add_lathe(iron, base, COUNT(base), 0, 0, 24, 1);
    gen_add_lathe(iron, roof, COUNT(roof), 0, 0, 24, 1);
    gen_add_lathe(iron, hoop, COUNT(hoop), 0, 0, 24, 1);
    static const float bar[][2] = {{0, 0.03f}, {0.011f, 0.03f}, {0.011f, 0.47f}, {0, 0.47f}};
    for (int i = 0; i < BARS; i++) {
        const double angle = 2 * GEN_PI * (i + 0.1) / BARS;
        gen_add_lathe(iron, bar, COUNT(bar), 0.172f * (float)gen_cos(angle),
                      0.172f * (float)gen_sin(angle), 8, 1);
    }
    gen_place(model, 0, STAND, 0, 0, 1);
    gen_add_lamp(model, &(gen_lamp){.position = {0, STAND + 0.22f, 0},
                                    .intensity = 22,
                                    .color = {1, 0.62f, 0.28f}});
}

static void add_crates(gen_model *model)
{
    gen_mesh *crate = gen_mesh_new(model, "crate", WOOD);
    gen_add_box(crate, (const float[3]){-0.3f, -0.01f, -0.3f}, (const float[3]){0.3f, STAND, 0.3f},
                1);
    for (int i = 0; i < 2; i++) { // laths around it, below and above
        const float y = i ? STAND - 0.14f : 0.05f;
        gen_add_box(crate, (const float[3]){-0.32f, y, -0.32f},
                    (const float[3]){0.32f, y + 0.08f, 0.32f}, 1);
    }
    gen_place(model, 0, 0, 0, 0.4f, 1);
    gen_place(model, -1.9f, 0, -0.9f, -0.3f, 1.3f);
}

static void build(gen_model *model)
{
    gen_mesh *ground = gen_mesh_new(model, "ground", GROUND);
    gen_add_box(ground, (const float[3]){-5, -0.3f, -5}, (const float[3]){5, 0, 5}, 2);
    gen_place_here(model);
    add_crates(model);
    add_lantern(model);

    static const float jug[][2] = {{0, -0.02f},     {0.13f, -0.02f}, {0.2f, 0.1f},   {0.24f, 0.24f},
                                   {0.22f, 0.36f},  {0.13f, 0.46f},  {0.09f, 0.52f}, {0.09f, 0.58f},
                                   {0.125f, 0.63f}, {0.1f, 0.63f},   {0.07f, 0.57f}, {0.06f, 0.45f},
                                   {0, 0.4f}};
    gen_add_lathe(gen_mesh_new(model, "jug", CLAY), jug, COUNT(jug), 0, 0, 28, 1);
    gen_place(model, 0.95f, 0, 0.55f, 0, 1);
    gen_place(model, 1.35f, 0, 0.1f, 1, 0.7f);

    static const float post[][2] = {
        {0, -0.1f}, {0.055f, -0.1f}, {0.05f, 0.95f}, {0.03f, 1.05f}, {0, 1.06f}};
    gen_add_lathe(gen_mesh_new(model, "post", WOOD), post, COUNT(post), 0, 0, 10, 1);
    for (int i = 0; i < 9; i++) {
        gen_place(model, -2.6f + 0.65f * (float)i, 0.08f * gen_random((uint32_t)i, 5),
                  -2.0f + 0.1f * gen_random((uint32_t)i, 6), (float)i, 1);
    }
    gen_mesh *rail = gen_mesh_new(model, "rail", WOOD);
    gen_add_box(rail, (const float[3]){-2.9f, 0.68f, -1.98f}, (const float[3]){2.9f, 0.75f, -1.93f},
                1);
    gen_place_here(model);

    gen_mesh *stone = gen_mesh_new(model, "stone", STONE);
    gen_add_ball(stone, (const float[3]){0, 0, 0}, 0.3f, 24);
    for (uint32_t i = 0; i < stone->num_vertices; i++) {
        float *p = stone->vertices[i].position;
        const float bump = 1 + 0.35f * gen_perlin(4 * p[0] + 9, 4 * p[1], 4 * p[2], 17);
        for (int k = 0; k < 3; k++) {
            p[k] *= bump * (k == 1 ? 0.7f : 1.0f);
        }
    }
    gen_smooth(stone);
    gen_place(model, -0.85f, 0.1f, 0.75f, 0, 1);
    gen_place(model, -1.2f, 0.08f, 0.35f, 2, 0.6f);
    gen_place(model, 2.1f, 0.15f, -0.8f, 4, 1.4f);
}

const gen_scene gen_lantern = {
    .name = "lantern",
    .about =
        "a lantern at night in creeping smoke, its bars, jugs and a fence before their shadows",
    .media = {{.name = "smoke",
               .scattering = {1.2f, 1.2f, 1.2f},
               .absorption = {0.06f, 0.06f, 0.06f},
               .anisotropy = 0.3f,
               .density = {.uri = "lantern.raw", .type = "u8", .size = {80, 40, 80}}}},
    .shapes = {{.name = "smoke", .translation = {0, 1.2f, 0}, .scale = {5.6f, 2.4f, 5.6f}}},
    .cameras = {{.name = "view", .from = {0.9f, 1.35f, 4.2f}, .at = {0, 0.72f, 0}, .yfov = 0.62f}},
    .environment = true,
    .environment_radiance = {0.006f, 0.01f, 0.02f},
    .materials = {{.name = "ground", .albedo = {0.8f, 0.75f, 0.7f}, .texture = "slabs.png"},
                  {.name = "iron", .albedo = {0.12f, 0.11f, 0.1f}},
                  {.name = "wood", .albedo = {0.42f, 0.27f, 0.15f}},
                  {.name = "clay", .albedo = {0.6f, 0.28f, 0.16f}},
                  {.name = "stone", .albedo = {0.45f, 0.45f, 0.42f}}},
    .build = build,
};
