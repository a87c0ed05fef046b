// main.c -- `tyndall-scenes FOLDER`: writes the sample scenes, the same bytes on every machine.
//
// The arithmetic is + - * / and sqrt, which IEEE 754 rounds exactly; there is no call into the
// transcendental half of libm, whose last digit is the platform's (see portable.h), and no
// contraction to fused multiply-add (see meson.build).
#include <stdio.h>
#include <stdlib.h>

#include "maps.h"
#include "scenes.h"
#include "textures.h"

// A painted sky without a sun: radiance from the zenith over the horizon to the ground.
static bool write_sky(const char *folder)
{
    enum { WIDTH = 64, HEIGHT = 32 };
    static float rgb[HEIGHT * WIDTH * 3];
    const float zenith[3] = {0.03f, 0.08f, 0.24f}, horizon[3] = {0.2f, 0.29f, 0.4f};
    const float ground[3] = {0.05f, 0.045f, 0.04f};
    for (int y = 0; y < HEIGHT; y++) {
        // From +1 at the zenith to -1 at the nadir, linear in the polar angle.
        const float h = 1.0f - 2.0f * ((float)y + 0.5f) / HEIGHT;
        const float up = 1.0f - (1.0f - h) * (1.0f - h), down = h < -0.2f ? 1.0f : -5.0f * h;
        for (int x = 0; x < WIDTH; x++) {
            for (int k = 0; k < 3; k++) {
                rgb[(y * WIDTH + x) * 3 + k] = h >= 0
                                                   ? horizon[k] + (zenith[k] - horizon[k]) * up
                                                   : horizon[k] + (ground[k] - horizon[k]) * down;
            }
        }
    }
    return gen_write_hdr(folder, "sky.hdr", WIDTH, HEIGHT, rgb);
}

static bool write_map(const char *folder, const char *file, gen_map map)
{
    const bool ok = gen_write_exr(folder, file, &map);
    gen_map_free(&map);
    return ok;
}

static bool write_maps(const char *folder)
{
    enum { WIDTH = 512, HEIGHT = 256 };
    const gen_sky clear = {.elevation = 35,
                           .azimuth = 75,
                           .turbidity = 2.2,
                           .albedo = {0.12, 0.11, 0.09},
                           .irradiance = 12,
                           .observer = 200};
    const gen_sky sunset = {.elevation = 5,
                            .azimuth = 75,
                            .turbidity = 2.5,
                            .albedo = {0.12, 0.11, 0.09},
                            .irradiance = 25,
                            .observer = 200};
    bool ok = write_map(folder, "clear-sky.exr", gen_clear_sky(&clear, WIDTH, HEIGHT));
    ok = write_map(folder, "sunset-sky.exr", gen_clear_sky(&sunset, WIDTH, HEIGHT)) && ok;
    return write_map(folder, "courtyard.exr", gen_courtyard(WIDTH, HEIGHT)) && ok;
}

// Writes a volume and frees it.
static bool write_grid(const char *folder, const char *file, gen_grid grid,
                       bool (*write)(const char *, const char *, const gen_grid *))
{
    const bool ok = write(folder, file, &grid);
    gen_grid_free(&grid);
    return ok;
}

static bool write_grids(const char *folder)
{
    bool ok = write_grid(folder, "blobs.raw", gen_blobs(), gen_write_u8);
    ok = write_grid(folder, "cloud.raw", gen_cumulus(), gen_write_u8) && ok;
    ok = write_grid(folder, "smoke.raw", gen_plume(), gen_write_f16) && ok;
    ok = write_grid(folder, "hare.raw", gen_hare(), gen_write_u8) && ok;
    ok = write_grid(folder, "lantern.raw", gen_lantern_smoke(), gen_write_u8) && ok;
    ok = write_grid(folder, "cave.raw", gen_cave_dust(), gen_write_f16) && ok;
    return write_grid(folder, "haze.raw", gen_haze(), gen_write_u8) && ok;
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "usage: tyndall-scenes FOLDER    writes the sample scenes there\n");
        return 2;
    }
    const char *folder = argv[1];
    bool ok = write_sky(folder);
    ok = write_maps(folder) && ok;
    ok = gen_write_textures(folder) && ok;
    for (int i = 0; i < gen_num_scenes; i++) {
        ok = gen_write_gltf(folder, &gen_scenes[i]) && ok;
    }
    static const gen_scene *const with_walls[] = {&gen_room,     &gen_fog_hall,
                                                  &gen_lantern,  &gen_cornell_smoke,
                                                  &gen_vpl_cave, &gen_many_lights};
    for (size_t i = 0; i < sizeof(with_walls) / sizeof(with_walls[0]); i++) {
        ok = gen_write_gltf(folder, with_walls[i]) && ok;
    }
    ok = write_grids(folder) && ok;
    return ok ? EXIT_SUCCESS : EXIT_FAILURE;
}
