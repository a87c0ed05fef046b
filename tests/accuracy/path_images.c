// path_images.c -- `path` against the reference images of cubes and blobs (pbrt-v3 in 64-bit).
//
// Asserted for every image: the mean is without bias beyond 3 combined standard errors, and z = difference /
// sqrt(se_ref^2 + se_path^2) of 8x8 blocks has an RMS below 1.5. TYN_LONG=N takes N times the samples.
#include "npy.h"
#include "numbers.h"
#include "path_scene.h"
#include "skip.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static uint32_t effort(uint32_t samples)
{
    const char *s = getenv("TYN_LONG");
    return s ? samples * (uint32_t)atoi(s) : samples;
}

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

// Compares with images/NAME.npy, shape (n, n, 2 k): means, then their standard errors.
static void compare(gpu_test *t, path_scene *s, const char *name, uint32_t samples)
{
    char file[128], path[512];
    snprintf(file, sizeof file, "reference/images/%s.npy", name);
    npy_array ref;
    if (!shared_path(path, sizeof path, file)) {
        skip_without(file);
    }
    assert_true(npy_read(&ref, path));
    uint32_t n = ref.shape[0], k = ref.shape[2] / 2;
    assert_int_equal(n, s->camera.size[0]);
    const float *radiance, *error;
    double start = seconds();
    path_scene_render(t, s, samples, &radiance, &error);
    double took = seconds() - start;
    for (uint32_t c = 0; c < k; c++) {
        double sum = 0, sum_ref = 0, var = 0, var_ref = 0, z2 = 0;
        uint32_t blocks = 0;
        for (uint32_t by = 0; by < n; by += 8) {
            for (uint32_t bx = 0; bx < n; bx += 8) {
                double a = 0, b = 0, va = 0, vb = 0;
                for (uint32_t i = 0; i < 64; i++) {
                    uint32_t pixel = (by + i / 8) * n + bx + i % 8;
                    double e = error[pixel * 4 + c], er = ref.data[pixel * 2 * k + k + c];
                    a += radiance[pixel * 4 + c];
                    b += ref.data[pixel * 2 * k + c];
                    va += e * e;
                    vb += er * er;
                }
                sum += a;
                sum_ref += b;
                var += va;
                var_ref += vb;
                if (va + vb > 1e-10 * b * b) {
                    z2 += (a - b) * (a - b) / (va + vb);
                    blocks++;
                } else { // background alone
                    assert_true(fabs(a - b) <= 1e-4 * b);
                }
            }
        }
        double bias = sum / sum_ref - 1, bias_se = sqrt(var + var_ref) / sum_ref;
        double z_rms = sqrt(z2 / blocks);
        printf("%-26s %u  mean %.6g  reference %.6g  bias %+.4f %% +- %.4f (z %+.2f)  z_rms %.2f  "
               "%.1f s  %.2f Mpaths/s\n",
               name, c, sum / (n * n), sum_ref / (n * n), 100 * bias, 100 * bias_se, bias / bias_se,
               z_rms, took, 1e-6 * n * n * samples / took);
        assert_true(fabs(bias) <= 3 * bias_se);
        assert_true(z_rms < 1.5);
    }
    npy_free(&ref);
}

static void cubes(void **state)
{
    static const struct {
        const char *name;
        float direction[3];
    } views[] = {{"side", {0, -1, 0}}, {"exit", {-1, 0, 0}}, {"entry", {1, 0, 0}}};
    static const float gs[] = {0, 0.5f, 0.9f};
    for (int i = 0; i < 9; i++) {
        float g = gs[i / 3];
        path_scene s;
        path_scene_box(&s, (float[]){1, 1, 1}, (float[]){4, 4, 4}, (float[]){0, 0, 0},
                       (float[]){g, g, g}, NULL, NULL);
        path_scene_sun(&s, (float[]){1, 0, 0}, (float[]){1, 1, 1});
        path_scene_orthographic(&s, (float[]){0.5f, 0.5f, 0.5f}, views[i % 3].direction,
                                (float[]){0, 0, 1}, 0.5f, 64);
        char name[64];
        snprintf(name, sizeof name, "cube_g%.2f_%s", (double)g, views[i % 3].name);
        s.samples = 64;
        s.params.seed = (uint32_t)i; // noise of its own for each image
        compare(*state, &s, name, effort(512));
    }
}

// ---- blobs ------------------------------------------------------------------------------------

// The references' sky, y up.
static void sky(const double w[3], float out[3])
{
    static const double zenith[3] = {0.25, 0.5, 1.0}, horizon[3] = {0.9, 0.95, 1.0};
    static const double ground[3] = {0.15, 0.12, 0.10}, sun[3] = {60, 54, 45};
    double to_sun = (0.5 * w[0] + 0.6 * w[1] - 0.4 * w[2]) / sqrt(0.25 + 0.36 + 0.16);
    for (int c = 0; c < 3; c++) {
        double l = w[1] >= 0 ? horizon[c] + (zenith[c] - horizon[c]) * sqrt(w[1])
                             : horizon[c] + (ground[c] - horizon[c]) * fmin(1, -5 * w[1]);
        out[c] = (float)(l + sun[c] * exp(200 * (to_sun - 1)));
    }
}

static void add_sky(path_scene *s)
{
    enum { W = 2048, H = 1023 }; // odd: the horizon is a row
    static float *texels;
    if (!texels) {
        texels = malloc((size_t)W * H * 3 * sizeof(float));
        for (int y = 0; y < H; y++) {
            double theta = M_PI * (y + 0.5) / H;
            for (int x = 0; x < W; x++) {
                double phi = 2 * M_PI * ((x + 0.5) / W - 0.5);
                float *texel = texels + 3 * ((size_t)y * W + (size_t)x), below[3];
                double w[3] = {sin(theta) * sin(phi), cos(theta), -sin(theta) * cos(phi)};
                if (y == H / 2) {
                    // Straight at the horizon the sky has a vertical tangent, and the reference's camera has it
                    // 1e-5 off on either side.
                    w[1] = -9.4e-6;
                    sky(w, below);
                    w[1] = 9.4e-6;
                }
                sky(w, texel);
                for (int c = 0; c < 3 && y == H / 2; c++) {
                    texel[c] = 0.5f * (texel[c] + below[c]);
                }
            }
        }
    }
    s->map = (tyn_environment){.present = true, .size = {W, H}, .data = texels, .hash = 1};
    path_scene_sky(s, 1);
    s->params.environment = TYN_PATH_ENV_MAP;
}

static bool read_blobs(float grid[64 * 64 * 64])
{
    char path[512];
    if (!shared_path(path, sizeof path, "reference/images/blobs64.f32")) {
        return false;
    }
    FILE *f = fopen(path, "rb");
    size_t got = f ? fread(grid, sizeof(float), 64 * 64 * 64, f) : 0;
    if (f) {
        fclose(f);
    }
    return got == 64 * 64 * 64;
}

static void blobs(void **state)
{
    static float grid[64 * 64 * 64];
    static const struct {
        const char *name;
        bool thin, lit_by_sky;
        float direction[3], half;
        uint32_t samples;
    } images[] = {
        {"blobs_dir_toward", false, false, {0.5f, 0.3f, -0.5f}, 7, 512},
        {"blobs_sky_front", false, true, {0, 0, 1}, 5, 512},
        {"blobsthin_sky_front", true, true, {0, 0, 1}, 5, 512},
    };
    if (!read_blobs(grid)) {
        skip_without("reference/images/blobs64.f32");
    }
    for (size_t i = 0; i < sizeof images / sizeof images[0]; i++) {
        bool thin = images[i].thin;
        float g = thin ? 0.5f : 0.9f;
        path_scene s;
        path_scene_box(&s, (float[]){10, 10, 10},
                       thin ? (float[]){0.29f, 0.36f, 0.42f} : (float[]){2.9f, 3.6f, 4.2f},
                       thin ? (float[]){0.034f, 0.0335f, 0.034f} : (float[]){3.4f, 3.35f, 3.4f},
                       (float[]){g, g, g}, grid, (uint32_t[]){64, 64, 64});
        if (images[i].lit_by_sky) {
            add_sky(&s);
        } else {
            path_scene_sun(&s, (float[]){-0.5f, -0.6f, 0.4f}, (float[]){1, 1, 1});
        }
        path_scene_orthographic(&s, (float[]){5, 5, 5}, images[i].direction, (float[]){0, 1, 0},
                                images[i].half, 32);
        s.samples = 64;
        s.params.seed = 100 + (uint32_t)i;
        compare(*state, &s, images[i].name, effort(images[i].samples));
    }
}

// ---- furnace ----------------------------------------------------------------------------------

// Albedo 1 under a radiance of 1 from everywhere looks like nothing at all, in every pixel.
static void check_furnace(gpu_test *t, path_scene *s, const char *name, uint32_t samples)
{
    const float *radiance, *error;
    path_scene_orthographic(s,
                            (float[]){0.5f * s->medium.extent[0], 0.5f * s->medium.extent[1],
                                      0.5f * s->medium.extent[2]},
                            (float[]){-1, -2, -0.7f}, (float[]){0, 1, 0},
                            0.9f * s->medium.extent[0], 32);
    s->samples = samples < 64 ? samples : 64;
    path_scene_render(t, s, samples, &radiance, &error);
    for (int c = 0; c < 3; c++) {
        double sum = 0, var = 0, worst = 0;
        for (int i = 0; i < 32 * 32; i++) {
            sum += radiance[4 * i + c];
            var += (double)error[4 * i + c] * error[4 * i + c];
            worst = maximum(worst, fabs((double)radiance[4 * i + c] - 1));
        }
        double mean = sum / 1024, se = sqrt(var) / 1024;
        printf("furnace %-28s %d  mean %.6f +- %.6f  worst pixel %.6f off\n", name, c, mean, se,
               worst);
        assert_true(fabs(mean - 1) <= 3 * se + 2e-6);
    }
}

static void furnaces(void **state)
{
    static float grid[64 * 64 * 64];
    static float white[16 * 8 * 3];
    for (int i = 0; i < 16 * 8 * 3; i++) {
        white[i] = 1;
    }
    for (int i = 0; i < 3; i++) {
        const float g = (const float[]){0, 0.5f, 0.9f}[i];
        char name[32];
        path_scene s;
        path_scene_box(&s, (float[]){1, 1, 1}, (float[]){4, 4, 4}, (float[]){0, 0, 0},
                       (float[]){g, g, g}, NULL, NULL);
        path_scene_sky(&s, 1);
        snprintf(name, sizeof name, "g %.1f", (double)g);
        check_furnace(*state, &s, name, 16);
        // The same sky as a map: next-event estimation, lobes and their weights.
        s.map = (tyn_environment){.present = true, .size = {16, 8}, .data = white, .hash = 2};
        strcat(name, ", map");
        check_furnace(*state, &s, name, 64);
    }
    if (!read_blobs(grid)) {
        for (int i = 0; i < 64 * 64 * 64; i++) {
            grid[i] = i / 4096 % 2 && i / 64 % 3 ? 0.8f : 0.05f;
        }
    }
    path_scene s;
    path_scene_box(&s, (float[]){10, 10, 10}, (float[]){3, 2, 0.5f}, (float[]){0, 0, 0},
                   (float[]){0.8f, 0.5f, 0.1f}, grid, (uint32_t[]){64, 64, 64});
    path_scene_sky(&s, 1);
    check_furnace(*state, &s, "coloured blobs", 64);
    s.map = (tyn_environment){.present = true, .size = {16, 8}, .data = white, .hash = 2};
    check_furnace(*state, &s, "coloured blobs, map", 128);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(furnaces),
        cmocka_unit_test(cubes),
        cmocka_unit_test(blobs),
    };
    setvbuf(stdout, NULL, _IOLBF, 0);
    cmocka_set_test_filter(getenv("TYN_TEST_FILTER"));
    return run_cases(tests, gpu_setup, gpu_teardown);
}
