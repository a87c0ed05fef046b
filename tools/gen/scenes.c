// scenes.c -- the sample scenes, as data.
#include "scenes.h"

#define PLUME                                                                                      \
    {                                                                                              \
        .uri = "smoke.raw", .type = "f16", .size = { 96, 160, 96 }                                 \
    }
#define CUMULUS                                                                                    \
    {                                                                                              \
        .uri = "cloud.raw", .type = "u8", .size = { 160, 112, 160 }                                \
    }
#define BLOBS                                                                                      \
    {                                                                                              \
        .uri = "blobs.raw", .type = "u8", .size = { 48, 48, 48 }                                   \
    }

#define HARE                                                                                       \
    {                                                                                              \
        .uri = "hare.raw", .type = "u8", .size = { 72, 96, 84 }                                    \
    }

#define UNIT_CUBE                                                                                  \
    {                                                                                              \
        .name = "cube", .translation = {0.5f, 0.5f, 0.5f}, .scale = { 1, 1, 1 }                    \
    }

// Where the faces of the unit cube are looked at: across the light, against it, and along it. The
// half height 0.5 makes one face fill a square picture.
#define CUBE_CAMERAS                                                                               \
    {.name = "view", .from = {-1.8f, 1.7f, 3.2f}, .at = {0.5f, 0.45f, 0.5f}, .yfov = 0.48f},       \
        {.name = "side",                                                                           \
         .from = {0.5f, 2, 0.5f},                                                                  \
         .at = {0.5f, 0, 0.5f},                                                                    \
         .up = {0, 0, 1},                                                                          \
         .ymag = 0.5f},                                                                            \
        {.name = "exit",                                                                           \
         .from = {2, 0.5f, 0.5f},                                                                  \
         .at = {0, 0.5f, 0.5f},                                                                    \
         .up = {0, 0, 1},                                                                          \
         .ymag = 0.5f},                                                                            \
        {.name = "entry",                                                                          \
         .from = {-1, 0.5f, 0.5f},                                                                 \
         .at = {0, 0.5f, 0.5f},                                                                    \
         .up = {0, 0, 1},                                                                          \
         .ymag = 0.5f},                                                                            \
    {                                                                                              \
        .name = "oblique", .from = {1.5f, 2.5f, 1.2f}, .at = {0.5f, 0.5f, 0.5f}, .up = {0, 0, 1},  \
        .ymag = 0.9f                                                                               \
    }

// A slab of 1 m that goes on for ever along x and z, lit from above.
#define SLAB_MEDIUM                                                                                \
    {                                                                                              \
        {                                                                                          \
            .name = "slab", .scattering = { 4, 4, 4 }                                              \
        }                                                                                          \
    }
#define SLAB_SHAPE                                                                                 \
    {                                                                                              \
        {                                                                                          \
            .name = "slab", .translation = {0.5f, 0.5f, 0.5f}, .scale = {1, 1, 1}, .repeat = {     \
                true,                                                                              \
                false,                                                                             \
                true                                                                               \
            }                                                                                      \
        }                                                                                          \
    }
#define SLAB_CAMERAS                                                                               \
    {                                                                                              \
        {.name = "top", .from = {0.5f, 2, 0.5f}, .at = {0.5f, 0, 0.5f}, .ymag = 0.5f},             \
            {.name = "bottom", .from = {0.5f, -1, 0.5f}, .at = {0.5f, 0, 0.5f}, .ymag = 0.5f},     \
        {                                                                                          \
            .name = "edge", .from = {-3, 2.5f, 4}, .at = {0.5f, 0.5f, 0.5f}, .yfov = 0.6f          \
        }                                                                                          \
    }

const gen_scene gen_scenes[] = {
    {
        .name = "cube",
        .about = "a unit cube of optical thickness 4 under a sun along +x",
        .media = {{.name = "cube", .scattering = {4, 4, 4}}},
        .shapes = {UNIT_CUBE},
        .suns = {{.direction = {1, 0, 0}, .irradiance = 1}},
        .cameras = {CUBE_CAMERAS},
    },
    {
        .name = "cube-oblique",
        .about = "the unit cube, coloured, under a sun that is aligned with none of its axes",
        .media = {{.name = "cube",
                   .scattering = {3, 4, 5},
                   .absorption = {0.4f, 0.2f, 0.1f},
                   .anisotropy = 0.75f}},
        .shapes = {UNIT_CUBE},
        .suns = {{.direction = {0.5f, -0.7f, -0.4f}, .irradiance = 1}},
        .cameras = {CUBE_CAMERAS},
    },
    {
        .name = "sphere",
        .about = "a ball of coloured milk under a low sun",
        .media = {{.name = "milk",
                   .scattering = {4, 5, 6.5f},
                   .absorption = {0.02f, 0.05f, 0.12f},
                   .anisotropy = 0.5f}},
        .shapes = {{.name = "ball", .sphere = true, .scale = {2, 2, 2}}},
        .suns = {{.direction = {-0.8f, -0.45f, -0.35f}, .irradiance = 4}},
        .cameras = {{.name = "view", .from = {0, 1, 4.4f}, .yfov = 0.55f}},
    },
    {
        .name = "slab",
        .about = "a slab of optical thickness 4 without end, the sun straight above",
        .media = SLAB_MEDIUM,
        .shapes = SLAB_SHAPE,
        .suns = {{.direction = {0, -1, 0}, .irradiance = 1}},
        .cameras = SLAB_CAMERAS,
    },
    {
        .name = "slab-60",
        .about = "the slab under a sun 60 degrees from the zenith, of the same horizontal flux",
        .media = SLAB_MEDIUM,
        .shapes = SLAB_SHAPE,
        .suns = {{.direction = {0.866025388f, -0.5f, 0}, .irradiance = 2}},
        .cameras = SLAB_CAMERAS,
    },
    {
        .name = "furnace",
        .about = "a cube that absorbs nothing in a uniform environment: radiance 1 everywhere",
        .media = {{.name = "cube", .scattering = {4, 4, 4}, .anisotropy = 0.5f}},
        .shapes = {UNIT_CUBE},
        .cameras = {CUBE_CAMERAS},
        .environment = true,
        .environment_radiance = {1, 1, 1},
    },
    {
        .name = "furnace-smoke",
        .about = "smoke that absorbs nothing in a uniform environment: radiance 1 everywhere",
        .media =
            {{.name = "smoke", .scattering = {26, 26, 26}, .anisotropy = 0.7f, .density = PLUME}},
        .shapes = {{.name = "smoke", .translation = {0, 1, 0}, .scale = {1.2f, 2, 1.2f}}},
        .cameras = {{.name = "view", .from = {0, 1.02f, 4.2f}, .at = {0, 1.02f, 0}, .yfov = 0.4f}},
        .environment = true,
        .environment_radiance = {1, 1, 1},
    },
    {
        .name = "empty",
        .about = "no medium: the environment is seen as it is",
        .suns = {{.direction = {0, -1, 0}, .irradiance = 1}},
        .cameras = {{.name = "view", .from = {0, 0, 4}, .yfov = 0.5f}},
        .environment = true,
        .environment_radiance = {0.25f, 0.5f, 1},
    },
    {
        .name = "smoke",
        .about = "a rising plume of smoke, of the same coefficients for all colours",
        .media = {{.name = "smoke",
                   .scattering = {26, 26, 26},
                   .absorption = {2.6f, 2.6f, 2.6f},
                   .anisotropy = 0.7f,
                   .density = PLUME}},
        .shapes = {{.name = "smoke", .translation = {0, 1, 0}, .scale = {1.2f, 2, 1.2f}}},
        .suns = {{.direction = {-0.85f, -0.5f, -0.1f}, .irradiance = 13}},
        .cameras = {{.name = "view", .from = {0, 1.02f, 4.2f}, .at = {0, 1.02f, 0}, .yfov = 0.4f}},
    },
    {
        .name = "cloud",
        .about = "a cumulus of 600 m under an afternoon sun",
        .media = {{.name = "cloud",
                   .scattering = {0.25f, 0.25f, 0.25f},
                   .anisotropy = 0.85f,
                   .density = CUMULUS}},
        .shapes = {{.name = "cloud", .translation = {0, 610, 0}, .scale = {600, 420, 600}}},
        .suns = {{.direction = {-0.7f, -0.55f, -0.3f}, .irradiance = 6}},
        .cameras = {{.name = "view", .from = {120, 300, 1300}, .at = {0, 565, 0}, .yfov = 0.4f}},
    },
    {
        .name = "two-media",
        .about = "a block of blue haze, turned, around and through a cluster of amber blobs",
        .media = {{.name = "amber",
                   .scattering = {9, 7, 4.5f},
                   .absorption = {0.1f, 0.5f, 1.5f},
                   .anisotropy = 0.75f,
                   .density = BLOBS},
                  {.name = "haze",
                   .scattering = {0.5f, 0.9f, 1.5f},
                   .absorption = {0.2f, 0.1f, 0.05f},
                   .anisotropy = 0.1f}},
        .shapes = {{.name = "blobs", .medium = 0, .scale = {2, 2, 2}},
                   // 35 degrees about (2, 3, 6) / 7
                   {.name = "block",
                    .medium = 1,
                    .translation = {0.4f, -0.2f, 0.1f},
                    .rotation = {0.0859162286f, 0.128874347f, 0.257748693f, 0.953716934f},
                    .scale = {1.3f, 0.9f, 1.2f}}},
        .suns = {{.direction = {-0.6f, -0.7f, -0.4f}, .irradiance = 12}},
        .cameras =
            {{.name = "view", .from = {0.8f, 1.2f, 5.2f}, .at = {0.32f, -0.1f, 0}, .yfov = 0.46f}},
    },
    {
        .name = "smoke-sky",
        .about = "the plume of smoke under a clear sky, the sun on the right",
        .media = {{.name = "smoke",
                   .scattering = {26, 26, 26},
                   .absorption = {2.6f, 2.6f, 2.6f},
                   .anisotropy = 0.7f,
                   .density = PLUME}},
        .shapes = {{.name = "smoke", .translation = {0, 1, 0}, .scale = {1.2f, 2, 1.2f}}},
        .cameras = {{.name = "view", .from = {0, 0.2f, 4.1f}, .at = {0, 1.03f, 0}, .yfov = 0.4f}},
        .environment = true,
        .environment_uri = "clear-sky.exr",
        .environment_radiance = {1, 1, 1},
    },
    {
        .name = "cloud-sunset",
        .about = "a cumulus of 600 m under the evening sky, the sun 5 degrees above the horizon",
        .media = {{.name = "cloud",
                   .scattering = {0.25f, 0.25f, 0.25f},
                   .anisotropy = 0.85f,
                   .density = CUMULUS}},
        .shapes = {{.name = "cloud", .translation = {0, 610, 0}, .scale = {600, 420, 600}}},
        .cameras = {{.name = "view", .from = {120, 300, 1300}, .at = {0, 565, 0}, .yfov = 0.4f}},
        .environment = true,
        .environment_uri = "sunset-sky.exr",
        .environment_radiance = {1, 1, 1},
    },
    {
        .name = "milk",
        .about =
            "a hare of milk, 0.7 m high, with the coefficients of Elek et al. 2014, figure 8, "
            "taken per mm; a density scale of 1/175 gives the optical size of their 4 m dragon",
        .media = {{.name = "milk",
                   .scattering = {910, 1070, 1250},
                   .absorption = {0.15f, 0.35f, 0.9f},
                   .anisotropy = 0.95f,
                   .density = HARE}},
        .shapes = {{.name = "hare",
                    .translation = {0, 0.35f, 0},
                    .scale = {0.525f, 0.7f, 0.6125f}}},
        .cameras =
            {{.name = "view", .from = {0.84f, 0.14f, 1.63f}, .at = {0, 0.36f, 0}, .yfov = 0.46f}},
        .environment = true,
        .environment_uri = "clear-sky.exr",
        .environment_radiance = {1, 1, 1},
    },
    {
        .name = "plume-contrast",
        .about = "a dark plume of 10 m in a courtyard, with the coefficients of Elek et al. 2014, "
                 "figure 11",
        .media = {{.name = "smoke",
                   .scattering = {2.9f, 3.6f, 4.2f},
                   .absorption = {3.4f, 3.35f, 3.4f},
                   .anisotropy = 0.9f,
                   .density = PLUME}},
        .shapes = {{.name = "smoke", .translation = {0, 5, 0}, .scale = {6, 10, 6}}},
        .cameras = {{.name = "view", .from = {0, 1.2f, 20.5f}, .at = {0, 5.1f, 0}, .yfov = 0.4f}},
        .environment = true,
        .environment_uri = "courtyard.exr",
        .environment_radiance = {1, 1, 1},
    },
};

const int gen_num_scenes = sizeof(gen_scenes) / sizeof(gen_scenes[0]);
