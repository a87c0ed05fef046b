// selftest_files.c -- pictures and volumes go to a file and come back as they were.
#include "selftest.h"
#include "selftest_volume.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tyndall/io.h>
#include <unistd.h>

// A name for a file that nobody else uses, below $TMPDIR or /tmp; NULL: there is no place.
static char *temporary(const char *suffix)
{
    const char *folder = getenv("TMPDIR");
    char *path = text_format("%s/tyndall-selftest-XXXXXX%s", folder ? folder : "/tmp", suffix);
    const int file = path ? mkstemps(path, (int)strlen(suffix)) : -1;
    if (file < 0) {
        free(path);
        return NULL;
    }
    close(file);
    return path;
}

// What is exact in 16 bits and what is not: from far below 1 to far above.
static float pattern(uint32_t i)
{
    return ldexpf((float)(i * 2654435761u >> 21) / 2048 + 0.5f, (int)(i % 23) - 11);
}

// Largest relative difference after a round trip; NaN: it failed.
static double exr_difference(const char *path, bool full_float)
{
    enum { WIDTH = 37, HEIGHT = 23 };
    tyn_channel channels[3] = {{.name = "R"}, {.name = "G"}, {.name = "transmittance.R"}};
    static float data[3][WIDTH * HEIGHT];
    double worst = 0;
    for (uint32_t c = 0; c < 3; c++) {
        channels[c].data = data[c];
        for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
            data[c][i] = pattern(i + 1000 * c);
        }
    }
    tyn_image_file image = {WIDTH, HEIGHT, 3, channels}, back = {0};
    const bool done = tyn_exr_write(&image, path, full_float, NULL) == TYN_OK &&
                      tyn_exr_read(&back, path, NULL) == TYN_OK && back.width == WIDTH &&
                      back.height == HEIGHT;
    for (uint32_t c = 0; c < 3 && done; c++) {
        const float *read = tyn_image_file_channel(&back, channels[c].name);
        for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
            const double off = read ? fabs(read[i] / data[c][i] - 1.0) : NAN;
            worst = isnan(worst) || off <= worst ? worst : off;
        }
    }
    tyn_image_file_finish(&back);
    return done ? worst : NAN;
}

static double volume_difference(const char *path)
{
    tyn_volume v = {0};
    double worst = 0;
    const bool done =
        tyn_file_write(path, selftest_volume, sizeof selftest_volume, NULL) == TYN_OK &&
        tyn_volume_load(&v, path, "density", NULL, NULL) == TYN_OK && v.size[0] == 8 &&
        v.size[1] == 8 && v.size[2] == 8;
    for (uint32_t i = 0; i < 512 && done; i++) {
        const uint32_t x = i % 8, y = i / 8 % 8, z = i / 64;
        const double off = fabs(v.data[i] - (double)((7 * x + 3 * y + z) % 11) / 8);
        worst = isnan(worst) || off <= worst ? worst : off;
    }
    tyn_volume_finish(&v);
    return done ? worst : NAN;
}

int selftest_files(selftest *t)
{
    static const char source[] = "exact";
    char *exr = temporary(".exr"), *nvdb = temporary(".nvdb");
    if (exr && nvdb) {
        selftest_check(t, "files, EXR of floats: relative difference", exr_difference(exr, true), 0,
                       0, source);
        selftest_check(t, "files, EXR of halves: relative difference", exr_difference(exr, false),
                       0, 1.0 / 2048, "11 bits");
        selftest_check(t, "files, NanoVDB: difference", volume_difference(nvdb), 0, 0, source);
    } else {
        selftest_skip(t, "files", "no place for a temporary file");
    }
    if (exr) {
        unlink(exr);
    }
    if (nvdb) {
        unlink(nvdb);
    }
    free(exr);
    free(nvdb);
    return EXIT_DONE;
}
