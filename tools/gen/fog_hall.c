// fog_hall.c -- a hall of two colonnades in fog; the sun shines in through the windows of one side.
//
// The hall reaches from -12 m to 12 m along z, from -5 m to 5 m along x. Walls, roof and floor are solid and
// reach into each other. What the sun sees from outside is black, so that it sends no light anywhere.
#include "scenes.h"

enum { STONE, SLABS, TIMBER, OUTSIDE };

#define HALF_LENGTH 12.0f
#define BAY 4.0f
#define BAYS 6
#define COLONNADE 2.4f // x of the columns' axes
#define CEILING 7.0f

static void add_box(gen_model *model, const char *name, uint32_t material, float x0, float y0,
                    float z0, float x1, float y1, float z1)
{
    gen_mesh *mesh = gen_mesh_new(model, name, material);
    gen_add_box(mesh, (const float[3]){x0, y0, z0}, (const float[3]){x1, y1, z1}, 2);
    gen_place_here(model);
}

static void add_columns(gen_model *model)
{
    // Upwards: torus and hollow of the base, the shaft with its entasis, astragal and capital.
    static const float profile[][2] = {
        {0, 0.2f},      {0.5f, 0.2f},   {0.54f, 0.27f}, {0.54f, 0.33f}, {0.48f, 0.4f},
        {0.42f, 0.43f}, {0.4f, 0.5f},   {0.4f, 1.4f},   {0.37f, 2.1f},  {0.34f, 2.62f},
        {0.4f, 2.66f},  {0.4f, 2.71f},  {0.35f, 2.75f}, {0.38f, 2.84f}, {0.45f, 2.93f},
        {0.53f, 2.99f}, {0.53f, 3.06f}, {0, 3.06f}};
    gen_mesh *column = gen_mesh_new(model, "column", STONE);
    gen_add_lathe(column, profile, sizeof(profile) / sizeof(profile[0]), 0, 0, 20, 2);
    gen_add_box(column, (const float[3]){-0.6f, -0.1f, -0.6f}, (const float[3]){0.6f, 0.24f, 0.6f},
                2);
    gen_add_box(column, (const float[3]){-0.58f, 3.02f, -0.58f},
                (const float[3]){0.58f, 3.2f, 0.58f}, 2);
    for (int i = 0; i <= BAYS; i++) {
        for (int side = -1; side <= 1; side += 2) {
            gen_place(model, (float)side * COLONNADE, 0, HALF_LENGTH - BAY * (float)i, 0, 1);
        }
    }
}

static void build(gen_model *model)
{
    const gen_arches windows = {.bays = BAYS,
                                .bay = BAY,
                                .bottom = -0.2f,
                                .top = CEILING + 0.2f,
                                .sill = 1.5f,
                                .spring = 4.3f,
                                .half = 0.8f,
                                .inside = 5,
                                .outside = 5.6f,
                                .from = HALF_LENGTH,
                                .steps = 8,
                                .tile = 2};
    const gen_arches arcade = {.bays = BAYS,
                               .bay = BAY,
                               .bottom = 3.15f,
                               .top = CEILING + 0.2f,
                               .sill = 3.15f,
                               .spring = 3.4f,
                               .half = 1.55f,
                               .inside = -0.28f,
                               .outside = 0.28f,
                               .from = HALF_LENGTH,
                               .steps = 12,
                               .tile = 2};
    gen_mesh *wall = gen_mesh_new(model, "wall with windows", STONE);
    gen_place_here(model);
    gen_mesh *outside = gen_mesh_new(model, "wall from outside", OUTSIDE);
    gen_place_here(model);
    gen_add_arches(wall, outside, &windows);
    gen_add_arches(gen_mesh_new(model, "arcade", STONE), NULL, &arcade);
    gen_place(model, COLONNADE, 0, 0, 0, 1);
    gen_place(model, -COLONNADE, 0, 0, 0, 1);
    add_columns(model);

    const float z = HALF_LENGTH;
    add_box(model, "wall", STONE, -5.6f, -0.21f, -z - 0.2f, -5, CEILING + 0.21f, z + 0.2f);
    add_box(model, "end wall", STONE, -5.3f, -0.22f, -z - 0.4f, 5.3f, CEILING + 0.22f, -z + 0.05f);
    add_box(model, "end wall", STONE, -5.3f, -0.22f, z - 0.05f, 5.3f, CEILING + 0.22f, z + 0.4f);
    add_box(model, "end wall from outside", OUTSIDE, -5.7f, -0.23f, -z - 0.7f, 5.7f, CEILING + 0.3f,
            -z - 0.1f);
    add_box(model, "end wall from outside", OUTSIDE, -5.7f, -0.23f, z + 0.1f, 5.7f, CEILING + 0.3f,
            z + 0.7f);
    add_box(model, "ceiling", TIMBER, -5.4f, CEILING, -z - 0.3f, 5.4f, CEILING + 0.4f, z + 0.3f);
    add_box(model, "roof", OUTSIDE, -5.8f, CEILING + 0.25f, -z - 0.8f, 5.8f, CEILING + 0.6f,
            z + 0.8f);
    add_box(model, "floor", SLABS, -5.75f, -0.4f, -z - 0.75f, 5.75f, 0, z + 0.75f);
    gen_mesh *beam = gen_mesh_new(model, "beam", TIMBER);
    gen_add_box(beam, (const float[3]){-5.2f, CEILING - 0.3f, -0.12f},
                (const float[3]){5.2f, CEILING + 0.1f, 0.12f}, 2);
    for (int i = 0; i < 2 * BAYS; i++) {
        gen_place(model, 0, 0, z - 0.5f * BAY * ((float)i + 0.5f), 0, 1);
    }
}

const gen_scene gen_fog_hall = {
    .name = "fog-hall",
    .about = "a hall of two colonnades in fog, the sun through the windows of its right side",
    .media = {{.name = "fog",
               .scattering = {0.05f, 0.05f, 0.05f},
               .absorption = {0.004f, 0.004f, 0.004f},
               .anisotropy = 0.6f}},
    .shapes = {{.name = "fog", .translation = {0, 3.5f, 0}, .scale = {10.6f, 7.4f, 24.4f}}},
    .suns = {{.direction = {-0.78f, -0.5f, 0.42f}, .irradiance = 40, .color = {1, 0.88f, 0.7f}}},
    .cameras =
        {{.name = "view", .from = {-1.7f, 1.7f, 10.6f}, .at = {2.6f, 2.9f, 0}, .yfov = 0.95f}},
    .environment = true,
    .environment_radiance = {0.5f, 0.7f, 1},
    .materials = {{.name = "stone", .albedo = {1, 1, 1}, .texture = "stone.png"},
                  {.name = "slabs", .albedo = {1, 1, 1}, .texture = "slabs.png"},
                  {.name = "timber", .albedo = {0.3f, 0.2f, 0.12f}},
                  {.name = "outside", .albedo = {0, 0, 0}}},
    .build = build,
};
