// room.c -- closed rooms: the reference's foggy room with a hole in its ceiling, and the Cornell box.
#include "noise.h"
#include "portable.h"
#include "scenes.h"

// A horizontal rectangle with a rectangular hole, as four trapezoids: no corner lies on another's edge.
// Seen from its front, counter-clockwise from the same corner.
static void add_frame(gen_mesh *mesh, const float outer[4][3], const float inner[4][3], float tile)
{
    for (int i = 0; i < 4; i++) {
        const int j = (i + 1) % 4;
        gen_add_quad(mesh, outer[i], outer[j], inner[j], inner[i], tile);
    }
}

enum { PLASTER, RED };

static void build_room(gen_model *model)
{
    static const float p[8][3] = {{0, 0, 0}, {4, 0, 0}, {4, 0, 4}, {0, 0, 4},
                                  {0, 3, 0}, {4, 3, 0}, {4, 3, 4}, {0, 3, 4}};
    static const float hole[4][3] = {
        {1.5f, 3, 1.75f}, {2, 3, 1.75f}, {2, 3, 2.25f}, {1.5f, 3, 2.25f}};
    gen_mesh *walls = gen_mesh_new(model, "walls", PLASTER);
    gen_add_quad(walls, p[0], p[3], p[2], p[1], 1);
    gen_add_quad(walls, p[0], p[1], p[5], p[4], 1);
    gen_add_quad(walls, p[1], p[2], p[6], p[5], 1);
    gen_add_quad(walls, p[2], p[3], p[7], p[6], 1);
    add_frame(walls, p + 4, hole, 1);
    gen_place_here(model);
    gen_mesh *red = gen_mesh_new(model, "red wall", RED);
    gen_add_quad(red, p[3], p[0], p[4], p[7], 1);
    gen_place_here(model);
    gen_add_lamp(model, &(gen_lamp){.position = {1.2f, 4.5f, 2},
                                    .direction = {0.55f, -1.5f, 0},
                                    .intensity = 40,
                                    .color = {1, 1, 1},
                                    .inner = 20 * (float)GEN_PI / 180,
                                    .outer = 20 * (float)GEN_PI / 180});
}

const gen_scene gen_room = {
    .name = "room",
    .about = "a closed room full of fog, a spot light above the hole in its ceiling: the "
             "reference picture of that name, whose columns run from right to left",
    .media = {{.name = "fog",
               .scattering = {0.3f, 0.3f, 0.3f},
               .absorption = {0.02f, 0.02f, 0.02f},
               .anisotropy = 0.6f}},
    .shapes = {{.name = "fog", .translation = {2, 1.5f, 2}, .scale = {4, 3, 4}}},
    .cameras = {{.name = "view",
                 .from = {3.6f, 1.5f, 3.8f},
                 .at = {1.8f, 1.3f, 1.6f},
                 .yfov = 60 * (float)GEN_PI / 180}},
    .materials = {{.name = "plaster", .albedo = {0.75f, 0.75f, 0.75f}},
                  {.name = "red", .albedo = {0.75f, 0.15f, 0.1f}}},
    .build = build_room,
};

// ---- the Cornell box -----------------------------------------------------------------------------

enum { WHITE, LEFT, RIGHT, LIGHT };

// The measured room, mm (Cornell University Program of Computer Graphics, "Cornell box data"): its
// walls are not quite square.
static const float cornell[8][3] = {
    {552.8f, 0, 0},   {0, 0, 0},      {0, 0, 559.2f},      {549.6f, 0, 559.2f},
    {556, 548.8f, 0}, {0, 548.8f, 0}, {0, 548.8f, 559.2f}, {556, 548.8f, 559.2f}};
static const float cornell_light[4][3] = {
    {343, 548.8f, 227}, {213, 548.8f, 227}, {213, 548.8f, 332}, {343, 548.8f, 332}};
static const float cornell_blocks[2][4][2] = {{{130, 65}, {82, 225}, {240, 272}, {290, 114}},
                                              {{423, 247}, {265, 296}, {314, 456}, {472, 406}}};

static void to_metres(const float (*mm)[3], int n, float (*out)[3])
{
    for (int i = 0; i < n * 3; i++) {
        out[i / 3][i % 3] = mm[i / 3][i % 3] * 0.001f;
    }
}

static void build_cornell(gen_model *model)
{
    float p[8][3], l[4][3];
    to_metres(cornell, 8, p);
    to_metres(cornell_light, 4, l);
    gen_mesh *white = gen_mesh_new(model, "white walls", WHITE);
    gen_add_quad(white, p[0], p[1], p[2], p[3], 1);
    gen_add_quad(white, p[3], p[2], p[6], p[7], 1);
    // The ceiling looks down; the light fills the hole in it.
    add_frame(white,
              (const float[4][3]){{p[4][0], p[4][1], p[4][2]},
                                  {p[7][0], p[7][1], p[7][2]},
                                  {p[6][0], p[6][1], p[6][2]},
                                  {p[5][0], p[5][1], p[5][2]}},
              (const float[4][3]){{l[0][0], l[0][1], l[0][2]},
                                  {l[3][0], l[3][1], l[3][2]},
                                  {l[2][0], l[2][1], l[2][2]},
                                  {l[1][0], l[1][1], l[1][2]}},
              1);
    gen_place_here(model);
    gen_add_quad(gen_mesh_new(model, "left wall", LEFT), p[0], p[3], p[7], p[4], 1);
    gen_place_here(model);
    gen_add_quad(gen_mesh_new(model, "right wall", RIGHT), p[2], p[1], p[5], p[6], 1);
    gen_place_here(model);
    gen_add_quad(gen_mesh_new(model, "light", LIGHT), l[0], l[3], l[2], l[1], 1);
    gen_place_here(model);
    for (int i = 0; i < 2; i++) {
        float corners[4][2];
        for (int k = 0; k < 8; k++) {
            corners[k / 2][k % 2] = cornell_blocks[i][k / 2][k % 2] * 0.001f;
        }
        // Their lower faces are below the floor.
        gen_add_prism(gen_mesh_new(model, i ? "tall block" : "short block", WHITE),
                      (const float(*)[2])corners, 4, -0.005f, i ? 0.33f : 0.165f, 1);
        gen_place_here(model);
    }
}

#define CORNELL_WHITE                                                                              \
    {                                                                                              \
        0.885809f, 0.698859f, 0.666422f                                                            \
    }

const gen_scene gen_cornell_smoke = {
    .name = "cornell-smoke",
    .about = "the Cornell box with its measured walls and blocks, in metres, and a plume of smoke "
             "that rises between them",
    .media = {{.name = "smoke",
               .scattering = {60, 60, 60},
               .absorption = {6, 6, 6},
               .anisotropy = 0.5f,
               .density = {.uri = "smoke.raw", .type = "f16", .size = {96, 160, 96}}}},
    .shapes = {{.name = "smoke",
                .translation = {0.2f, 0.265f, 0.19f},
                .scale = {0.32f, 0.53f, 0.32f}}},
    .cameras = {{.name = "view",
                 .from = {0.278f, 0.273f, -0.8f},
                 .at = {0.278f, 0.273f, 0},
                 .yfov = 0.686047f}}, // 25 mm of film behind a lens of 35 mm
    .materials = {{.name = "white", .albedo = CORNELL_WHITE},
                  {.name = "red", .albedo = {0.570068f, 0.0430135f, 0.0443706f}},
                  {.name = "green", .albedo = {0.105421f, 0.37798f, 0.076425f}},
                  {.name = "light",
                   .albedo = {0.78f, 0.78f, 0.78f},
                   .emission = {18.387f, 13.9873f, 6.75357f}}},
    .build = build_cornell,
};
