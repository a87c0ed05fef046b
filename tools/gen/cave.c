// cave.c -- a cave in a block of 20 m, the sun through a hole in its roof.
//
// The cave's wall is a sphere, moved along its rays by noise and cut off below by an uneven floor; it meets
// the block's upper face in a shaft, so that cave and block together are closed. The block is black
// outside, where the sun shines on it.
#include <math.h>

#include "noise.h"
#include "portable.h"
#include "scenes.h"

enum { ROCK, OUTSIDE };
enum { AROUND = 64, DOWN = 36 };

#define BLOCK 10.2f // half its size
#define FLOOR -5.5f // about
#define HOLE 1.8f   // radius

static float turbulence(const float p[3], float scale, uint32_t seed)
{
    float sum = 0, weight = 1;
    for (uint32_t octave = 0; octave < 4; octave++) {
        sum += weight * gen_perlin(p[0] * scale + 7, p[1] * scale, p[2] * scale, seed + octave);
        weight *= 0.48f;
        scale *= 2.1f;
    }
    return sum;
}

// The wall in a direction from the middle.
static void wall_point(const float w[3], float p[3])
{
    float r = 8.0f + 2.4f * turbulence(w, 1.5f, 120);
    r = r < 5 ? 5 : r > 9.7f ? 9.7f : r;
    const float ground = FLOOR + 0.7f * turbulence(w, 3.5f, 130);
    if (r * w[1] < ground) {
        r = ground / w[1];
    }
    for (int k = 0; k < 3; k++) {
        p[k] = r * w[k];
    }
}

static void direction(double theta, int s, float w[3])
{
    const double turn = 2 * GEN_PI * (s % AROUND) / AROUND;
    w[0] = (float)(gen_sin(theta) * gen_cos(turn));
    w[1] = (float)gen_cos(theta);
    w[2] = (float)(-gen_sin(theta) * gen_sin(turn));
}

static void hole_point(int s, float p[3])
{
    const double turn = 2 * GEN_PI * (s % AROUND) / AROUND;
    p[0] = HOLE * (float)gen_cos(turn);
    p[1] = BLOCK;
    p[2] = -HOLE * (float)gen_sin(turn);
}

// Rows of the wall from `first` to `last`, the front inside: row 0 is the hole's rim, row DOWN the lowest
// point.
static void add_rows(gen_mesh *mesh, int first, int last)
{
    static const float none[3] = {0, 0, 0};
    const double lip = 0.2; // angle of row 1 from above
    for (int row = first; row <= last; row++) {
        const double theta = lip + (GEN_PI - lip) * (row - 1) / (DOWN - 1);
        for (int s = 0; s < AROUND; s++) {
            float w[3] = {0, -1, 0}, p[3];
            if (row > 0 && row < DOWN) {
                direction(theta, s, w);
            }
            wall_point(w, p);
            if (row == 0) {
                hole_point(s, p);
            }
            gen_add_vertex(mesh, p, none, none);
        }
    }
    for (uint32_t row = 0; row < (uint32_t)(last - first); row++) {
        for (uint32_t s = 0; s < AROUND; s++) {
            const uint32_t a = row * AROUND + s, b = row * AROUND + (s + 1) % AROUND;
            gen_add_triangle(mesh, a, b, b + AROUND);
            gen_add_triangle(mesh, a, b + AROUND, a + AROUND);
        }
    }
    gen_smooth(mesh);
}

// A cube with a round hole in its upper face: every corner there sees a quarter of the rim.
static void add_block(gen_mesh *mesh)
{
    static const float b = BLOCK, up[3] = {0, 1, 0}, uv[2] = {0, 0};
    const float c[8][3] = {{b, -b, -b}, {-b, -b, -b}, {-b, -b, b}, {b, -b, b},
                           {b, b, -b},  {-b, b, -b},  {-b, b, b},  {b, b, b}};
    gen_add_quad(mesh, c[0], c[3], c[2], c[1], 1);
    for (int i = 0; i < 4; i++) {
        const int j = (i + 1) % 4;
        gen_add_quad(mesh, c[i], c[j], c[4 + j], c[4 + i], 1);
    }
    const uint32_t rim = mesh->num_vertices, corner = rim + AROUND;
    for (int s = 0; s < AROUND; s++) {
        float p[3];
        hole_point(s, p);
        gen_add_vertex(mesh, p, up, uv);
    }
    for (int i = 0; i < 4; i++) {
        gen_add_vertex(mesh, c[4 + i], up, uv);
    }
    for (uint32_t s = 0; s < AROUND; s++) {
        const uint32_t at = corner + s / (AROUND / 4), before = corner + (s / (AROUND / 4) + 3) % 4;
        gen_add_triangle(mesh, at, rim + (s + 1) % AROUND, rim + s);
        if (s % (AROUND / 4) == 0) {
            gen_add_triangle(mesh, before, at, rim + s);
        }
    }
}

static void add_dripstone(gen_model *model)
{
    static const float cone[][2] = {{0, -1},        {0.62f, -1}, {0.5f, -0.2f}, {0.36f, 0.3f},
                                    {0.31f, 0.42f}, {0.2f, 1},   {0.16f, 1.1f}, {0.08f, 1.6f},
                                    {0.03f, 1.8f},  {0, 1.82f}};
    gen_mesh *stone = gen_mesh_new(model, "stalagmite", ROCK);
    gen_add_lathe(stone, cone, sizeof(cone) / sizeof(cone[0]), 0, 0, 14, 1);
    static const float floor[][4] = {// direction, scale
                                     {-2.2f, -5.5f, -5.2f, 1.35f}, {-1.3f, -5.5f, -5.6f, 0.8f},
                                     {3.9f, -5.5f, -3.4f, 1.6f},   {3.2f, -5.5f, -2.3f, 0.7f},
                                     {-5.6f, -5.5f, 1.2f, 1.5f},   {-4.6f, -5.5f, 2.2f, 0.75f},
                                     {1.1f, -5.5f, -6.6f, 1.1f},   {0.3f, -5.5f, 0.6f, 0.55f}};
    for (uint32_t i = 0; i < sizeof(floor) / sizeof(floor[0]); i++) {
        const float *f = floor[i], n = sqrtf(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]);
        float p[3];
        wall_point((const float[3]){f[0] / n, f[1] / n, f[2] / n}, p);
        gen_place(model, p[0], p[1], p[2], 1.3f * (float)i, f[3]);
    }
    float drop[10][2]; // the same, hanging
    for (int i = 0; i < 10; i++) {
        drop[i][0] = 0.7f * cone[9 - i][0];
        drop[i][1] = -1.1f * cone[9 - i][1];
    }
    gen_add_lathe(gen_mesh_new(model, "stalactite", ROCK), (const float(*)[2])drop, 10, 0, 0, 14,
                  1);
    static const float roof[][4] = {{-4.2f, 7, -3, 1.3f},   {-2.4f, 7, -4.5f, 1.7f},
                                    {2.6f, 7, -4, 1.5f},    {4.6f, 7, -1.5f, 1.2f},
                                    {-4.8f, 7, 0.5f, 1.0f}, {0.8f, 7, -5.5f, 1.9f},
                                    {3.6f, 7, 1.8f, 1.4f}};
    for (uint32_t i = 0; i < sizeof(roof) / sizeof(roof[0]); i++) {
        const float *f = roof[i], n = sqrtf(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]);
        float p[3];
        wall_point((const float[3]){f[0] / n, f[1] / n, f[2] / n}, p);
        gen_place(model, p[0], p[1] + 0.3f, p[2], 0.7f * (float)i, f[3]);
    }
}

static void build(gen_model *model)
{
    add_rows(gen_mesh_new(model, "shaft", ROCK), 0, 1);
    gen_place_here(model);
    add_rows(gen_mesh_new(model, "cave", ROCK), 1, DOWN);
    gen_place_here(model);
    add_block(gen_mesh_new(model, "block", OUTSIDE));
    gen_place_here(model);
    add_dripstone(model);
}

const gen_scene gen_vpl_cave = {
    .name = "vpl-cave",
    .about = "a cave of 20 m full of dusty air, the sun through a hole in its roof: the medium has "
             "the coefficients of Elek et al. 2014, figure 17",
    .media = {{.name = "dust",
               .scattering = {3.2f, 3.3f, 3.4f},
               .absorption = {1.15f, 1.2f, 1.3f},
               .anisotropy = 0.7f,
               .density = {.uri = "cave.raw", .type = "f16", .size = {72, 72, 72}}}},
    .shapes = {{.name = "dust", .scale = {20, 20, 20}}},
    .suns = {{.direction = {-0.3f, -1, -0.18f}, .irradiance = 220, .color = {1, 0.93f, 0.8f}}},
    .cameras =
        {{.name = "view", .from = {4.1f, -1.7f, 5.1f}, .at = {-1.7f, -1.6f, -2.2f}, .yfov = 1.15f}},
    .materials = {{.name = "rock", .albedo = {0.5f, 0.42f, 0.34f}},
                  {.name = "outside", .albedo = {0, 0, 0}}},
    .build = build,
};
