// stress_cases.c -- what the stress suite tries.
//
// A case says what differs from the usual: a cube of 1 m. Extinctions are given for that cube.
#include "stress_cases.h"

// What other scenes must look like.
static const stress_case usual = {.sigma = 4, .albedo = 0.9f, .g = 0.5f};
// What is opaque at 1e6 and at 1e4 is opaque alike, and haze is haze: paths that look for collisions in a brick at 1e6 times
// its density find none before they are ended.
#define OPAQUE(kind, haze)                                                                         \
    {                                                                                              \
        .sigma = 1e4f, .albedo = 0.9f, .g = 0.5f, .contrast = haze, .size = {16, 16, 16},          \
        .pattern = kind                                                                            \
    }
static const stress_case opaque_checkers = OPAQUE(STRESS_CHECKERS, 1e-4f);
static const stress_case opaque_half = OPAQUE(STRESS_HALF, 1e-4f);
static const stress_case usual_lamp = {.sigma = 4, .albedo = 0.9f, .g = 0.5f, .light = STRESS_LAMP};
static const stress_case waves = {
    .sigma = 4, .albedo = 0.9f, .g = 0.5f, .pattern = STRESS_WAVES, .size = {8, 8, 8}};

// The short run has every third case or so.
#define QUICK .quick = true
#define LONG .quick = false

#define SUN(s, ...)                                                                                \
    {                                                                                              \
        .axis = "sigma", .x = s, .sigma = (float)(s), .albedo = 0.9f, .g = 0.5f, __VA_ARGS__       \
    }
#define FURNACE(s, ...)                                                                            \
    {                                                                                              \
        .axis = "sigma, furnace", .x = s, .sigma = (float)(s), .albedo = 1, .g = 0.5f,             \
        .light = STRESS_AROUND, .answer = STRESS_BY_FURNACE, __VA_ARGS__                           \
    }
#define DEEP(s, ...)                                                                               \
    {                                                                                              \
        .axis = "sigma, half-space", .x = s, .sigma = (float)(s), .albedo = 1,                     \
        .answer = STRESS_BY_TABLE, __VA_ARGS__                                                     \
    }
#define ENERGY(s, ...)                                                                             \
    {                                                                                              \
        .axis = "sigma, energy", .x = s, .sigma = (float)(s), .albedo = 1, .g = 0.5f,              \
        .answer = STRESS_BY_IMBALANCE, __VA_ARGS__                                                 \
    }
#define ALBEDO(a, ...)                                                                             \
    {                                                                                              \
        .axis = "albedo", .x = a, .sigma = 10, .albedo = (float)(a), .g = 0.5f, __VA_ARGS__        \
    }
#define ALBEDO_DEEP(a, ...)                                                                        \
    {                                                                                              \
        .axis = "albedo, half-space", .x = a, .sigma = 1e4f, .albedo = (float)(a),                 \
        .answer = STRESS_BY_TABLE, __VA_ARGS__                                                     \
    }
#define G(mean, ...)                                                                               \
    {                                                                                              \
        .axis = "g", .x = mean, .sigma = 10, .albedo = 0.95f, .g = (float)(mean), __VA_ARGS__      \
    }
#define G_FURNACE(mean, s, ...)                                                                    \
    {                                                                                              \
        .axis = "g, furnace", .x = mean, .sigma = s, .albedo = 1, .g = (float)(mean),              \
        .light = STRESS_AROUND, .answer = STRESS_BY_FURNACE, __VA_ARGS__                           \
    }
// As many transport mean free paths, however narrow the lobe: under light from all around, for which `path`
// needs no luck.
#define G_DEEP(mean, s, ...)                                                                       \
    {                                                                                              \
        .axis = "g, transport", .x = mean, .sigma = s, .albedo = 0.999f, .g = (float)(mean),       \
        .light = STRESS_AROUND, __VA_ARGS__                                                        \
    }
#define CONTRAST(text, ratio, s, ...)                                                              \
    {                                                                                              \
        .axis = "contrast", .name = text, .x = ratio, .contrast = (float)(ratio), .sigma = s,      \
        .albedo = 0.9f, .g = 0.5f, .size = {16, 16, 16}, __VA_ARGS__                               \
    }
#define CONTRAST_FURNACE(text, ratio, s, ...)                                                      \
    {                                                                                              \
        .axis = "contrast, furnace", .name = text, .x = ratio, .contrast = (float)(ratio),         \
        .sigma = s, .albedo = 1, .g = 0.5f, .size = {16, 16, 16}, .light = STRESS_AROUND,          \
        .answer = STRESS_BY_FURNACE, __VA_ARGS__                                                   \
    }
#define CONTRAST_ENERGY(text, ratio, s, ...)                                                       \
    {                                                                                              \
        .axis = "contrast, energy", .name = text, .x = ratio, .contrast = (float)(ratio),          \
        .sigma = s, .albedo = 1, .g = 0.5f, .size = {16, 16, 16}, .answer = STRESS_BY_IMBALANCE,   \
        __VA_ARGS__                                                                                \
    }
#define SCALE(m, ...)                                                                              \
    {                                                                                              \
        .axis = "scale", .x = m, .sigma = (float)(4.0 / (m)), .albedo = 0.9f, .g = 0.5f,           \
        .sides = {(float)(m), (float)(m), (float)(m)}, .like = &usual, __VA_ARGS__                 \
    }
#define SCALE_LAMP(m, ...)                                                                         \
    {                                                                                              \
        .axis = "scale, lamp", .x = m, .sigma = (float)(4.0 / (m)), .albedo = 0.9f, .g = 0.5f,     \
        .sides = {(float)(m), (float)(m), (float)(m)}, .light = STRESS_LAMP, .like = &usual_lamp,  \
        __VA_ARGS__                                                                                \
    }
#define FAR(m, ...)                                                                                \
    {                                                                                              \
        .axis = "far from the origin", .x = m, .sigma = 4, .albedo = 0.9f, .g = 0.5f,              \
        .offset = (float)(m), .like = &usual, __VA_ARGS__                                          \
    }
#define FLAT(text, wide, high, s, ...)                                                             \
    {                                                                                              \
        .axis = "flat", .name = text, .x = (double)(high) / (wide), .sigma = s, .albedo = 0.9f,    \
        .g = 0.5f, .sides = {wide, high, wide}, __VA_ARGS__                                        \
    }
#define GRID(text, nx, ny, nz, ...)                                                                \
    {                                                                                              \
        .axis = "grid, constant", .name = text, .x = (double)(nx) * (ny) * (nz), .sigma = 4,       \
        .albedo = 0.9f, .g = 0.5f, .pattern = STRESS_CONSTANT, .size = {nx, ny, nz},               \
        .like = &usual, __VA_ARGS__                                                                \
    }
#define GRID_WAVES(text, nx, ny, nz, ...)                                                          \
    {                                                                                              \
        .axis = "grid, waves", .name = text, .x = (double)(nx) * (ny) * (nz), .sigma = 4,          \
        .albedo = 0.9f, .g = 0.5f, .pattern = STRESS_WAVES, .size = {nx, ny, nz}, __VA_ARGS__      \
    }
#define STORAGE(kind, u, ...)                                                                      \
    {                                                                                              \
        .axis = "storage, " kind, .x = u, .sigma = 4, .albedo = 0.9f, .g = 0.5f,                   \
        .pattern = STRESS_WAVES, .size = {8, 8, 8}, .unit = (float)(u), .storage = kind,           \
        .like = &waves, __VA_ARGS__                                                                \
    }

const stress_case stress_cases[] = {
    SUN(1e-6, QUICK),
    SUN(1e-4, LONG),
    SUN(1e-2, LONG),
    SUN(0.3, LONG),
    SUN(1, LONG),
    SUN(4, QUICK),
    SUN(10, LONG),
    SUN(30, LONG),
    SUN(100, QUICK),
    SUN(300, LONG),
    SUN(1e3, LONG),
    SUN(1e4, LONG),
    SUN(1e6, LONG),
    SUN(1e8, QUICK),
    FURNACE(1e-6, LONG),
    FURNACE(1e-2, LONG),
    FURNACE(1, LONG),
    FURNACE(10, QUICK),
    FURNACE(100, LONG),
    FURNACE(1e3, LONG),
    FURNACE(1e5, LONG),
    FURNACE(1e8, QUICK),
    DEEP(1e3, LONG),
    DEEP(1e4, QUICK),
    DEEP(1e6, LONG),
    DEEP(1e8, LONG),
    ENERGY(1e-6, LONG),
    ENERGY(1, LONG),
    ENERGY(100, LONG),
    ENERGY(1e3, LONG),
    ENERGY(1e5, QUICK),
    ENERGY(1e8, LONG),

    ALBEDO(0, QUICK),
    ALBEDO(1e-6, LONG),
    ALBEDO(0.01, LONG),
    ALBEDO(0.1, LONG),
    ALBEDO(0.5, QUICK),
    ALBEDO(0.9, LONG),
    ALBEDO(0.99, LONG),
    ALBEDO(0.999, LONG),
    ALBEDO(0.9999, LONG),
    ALBEDO(1, QUICK),
    ALBEDO_DEEP(0.1, LONG),
    ALBEDO_DEEP(0.5, LONG),
    ALBEDO_DEEP(0.9, QUICK),
    ALBEDO_DEEP(0.99, LONG),
    ALBEDO_DEEP(0.999, LONG),
    ALBEDO_DEEP(0.99999, LONG),

    G(-0.99, QUICK),
    G(-0.9, LONG),
    G(-0.7, LONG),
    G(-0.5, LONG),
    G(-0.2, LONG),
    G(0, LONG),
    G(1e-8, QUICK),
    G(0.2, LONG),
    G(0.5, LONG),
    G(0.7, LONG),
    G(0.85, QUICK),
    G(0.9, LONG),
    G(0.95, LONG),
    G(0.98, LONG),
    G(0.99, LONG),
    G(0.995, LONG),
    G(0.999, LONG),
    G(0.9999, QUICK),
    G_FURNACE(-0.99, 10, LONG),
    G_FURNACE(-0.5, 10, LONG),
    G_FURNACE(0, 10, LONG),
    G_FURNACE(0.9, 30, LONG),
    G_FURNACE(0.99, 300, QUICK),
    G_FURNACE(0.9999, 3e4f, LONG),
    G_DEEP(0, 2, LONG),
    G_DEEP(0.5, 4, LONG),
    G_DEEP(0.9, 20, LONG),
    G_DEEP(0.99, 200, QUICK),
    G_DEEP(0.999, 2e3f, LONG),

    CONTRAST("checkers", 1e-1, 40, .pattern = STRESS_CHECKERS),
    CONTRAST("checkers", 1e-3, 40, .pattern = STRESS_CHECKERS, QUICK),
    CONTRAST("checkers", 1e-6, 40, .pattern = STRESS_CHECKERS),
    CONTRAST("checkers", 0, 1e3f, .pattern = STRESS_CHECKERS),
    CONTRAST("checkers", 1e-6, 1e6f, .pattern = STRESS_CHECKERS, .like = &opaque_checkers, QUICK),
    CONTRAST("voxel in vacuum", 0, 10, .pattern = STRESS_VOXEL),
    CONTRAST("voxel in vacuum", 0, 1e3f, .pattern = STRESS_VOXEL),
    CONTRAST("voxel in vacuum", 0, 1e6f, .pattern = STRESS_VOXEL, QUICK),
    CONTRAST("voxel in haze", 1e-6, 1e6f, .pattern = STRESS_VOXEL),
    CONTRAST("half", 1e-3, 100, .pattern = STRESS_HALF),
    CONTRAST("half", 1e-6, 1e6f, .pattern = STRESS_HALF, .like = &opaque_half, QUICK),
    CONTRAST("decades", 1e-2, 20, .pattern = STRESS_DECADES),
    CONTRAST("decades", 1e-6, 1e3f, .pattern = STRESS_DECADES),
    CONTRAST("decades", 1e-6, 1e6f, .pattern = STRESS_DECADES),
    CONTRAST("shell", 0, 60, .pattern = STRESS_SHELL),
    CONTRAST("channels", 1, 1, .coloured = true, .pattern = STRESS_HOMOGENEOUS),
    CONTRAST("channels", 1, 1e3f, .coloured = true, .pattern = STRESS_HOMOGENEOUS),
    CONTRAST("two media", 1, 4, .pattern = STRESS_TWO_MEDIA),
    CONTRAST("two media", 1e3, 1, .pattern = STRESS_TWO_MEDIA, QUICK),
    CONTRAST("two media", 1e6, 1, .pattern = STRESS_TWO_MEDIA),
    CONTRAST_FURNACE("checkers", 1e-6, 1e3f, .pattern = STRESS_CHECKERS, QUICK),
    CONTRAST_FURNACE("voxel in vacuum", 0, 1e6f, .pattern = STRESS_VOXEL),
    CONTRAST_FURNACE("half", 1e-6, 1e6f, .pattern = STRESS_HALF),
    CONTRAST_FURNACE("decades", 1e-6, 1e4f, .pattern = STRESS_DECADES),
    CONTRAST_FURNACE("channels", 1, 10, .coloured = true, .pattern = STRESS_HOMOGENEOUS),
    CONTRAST_FURNACE("two media", 1e3, 1, .pattern = STRESS_TWO_MEDIA),
    CONTRAST_ENERGY("checkers", 0, 1e4f, .pattern = STRESS_CHECKERS, QUICK),
    CONTRAST_ENERGY("voxel in vacuum", 0, 1e6f, .pattern = STRESS_VOXEL),
    CONTRAST_ENERGY("half", 1e-4, 1e3f, .pattern = STRESS_HALF),
    CONTRAST_ENERGY("decades", 1e-6, 1e6f, .pattern = STRESS_DECADES),

    SCALE(1e-3, QUICK),
    SCALE(1e-2, LONG),
    SCALE(1, LONG),
    SCALE(100, LONG),
    SCALE(1e4, LONG),
    SCALE(1e5, QUICK),
    SCALE_LAMP(1e-3, LONG),
    SCALE_LAMP(1, LONG),
    SCALE_LAMP(100, LONG),
    SCALE_LAMP(1e5, QUICK),
    FAR(10, LONG),
    FAR(1e3, QUICK),
    FAR(1e5, LONG),
    FLAT("1 : 4", 1, 0.25f, 8, LONG),
    FLAT("1 : 30", 1, 1.0f / 30, 30, LONG),
    FLAT("100 km : 1 km", 1e5f, 1e3f, 4e-3f, QUICK),
    FLAT("100 km : 10 m", 1e5f, 10, 0.1f, LONG),
    FLAT("a pole", 0.01f, 1, 100, LONG),

    GRID("1x1x1", 1, 1, 1, QUICK),
    GRID("2x2x2", 2, 2, 2, LONG),
    GRID("1x1x64", 1, 1, 64, LONG),
    GRID("512x1x1", 512, 1, 1, LONG),
    GRID("3x200x7", 3, 200, 7, QUICK),
    GRID("65x33x17", 65, 33, 17, LONG),
    GRID_WAVES("1x1x64", 1, 1, 64, LONG),
    GRID_WAVES("5x5x5", 5, 5, 5, LONG),
    GRID_WAVES("3x200x7", 3, 200, 7, QUICK),
    GRID_WAVES("200x7x3", 200, 7, 3, LONG),
    GRID_WAVES("65x33x17", 65, 33, 17, LONG),

    STORAGE("float", 1e-30, LONG),
    STORAGE("float", 1e-6, QUICK),
    STORAGE("float", 1, LONG),
    STORAGE("float", 1e6, LONG),
    STORAGE("float", 1e30, QUICK),
    STORAGE("half", 1e-30, LONG),
    STORAGE("half", 1e-6, QUICK),
    STORAGE("half", 1, LONG),
    STORAGE("half", 3e4, LONG),
    STORAGE("half", 1e6, LONG),
};
const uint32_t stress_num_cases = sizeof stress_cases / sizeof stress_cases[0];
