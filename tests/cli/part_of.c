// part_of.c -- how far a part of a picture is off the whole one: part_of WHOLE.exr PART.exr. Prints the number of values of the
// part, how many are more than 1e-5 off, and the farthest: of themselves and a thousandth of the channel's mean. Exit 1: one
// cannot be read, the part is none of the whole, or it is black.
#include <math.h>
#include <stdio.h>
#include <tyndall/io.h>

typedef struct sums {
    unsigned count, off;
    double farthest, light;
} sums;

static double mean_of(const float *values, uint32_t count)
{
    double sum = 0;
    for (uint32_t i = 0; i < count; i++) {
        sum += (double)values[i];
    }
    return sum / count;
}

static bool add_channel(sums *s, const char *name, const tyn_image_file *whole,
                        const tyn_image_file *part)
{
    const float *of_whole = tyn_image_file_channel(whole, name),
                *of_part = tyn_image_file_channel(part, name);
    if (!of_whole || !of_part) {
        return false;
    }
    const double least = 1e-3 * fabs(mean_of(of_whole, whole->width * whole->height)) + 1e-30;
    for (uint32_t i = 0; i < part->width * part->height; i++) {
        const uint32_t x = (uint32_t)part->x + i % part->width,
                       y = (uint32_t)part->y + i / part->width;
        const double is = (double)of_part[i], right = (double)of_whole[y * whole->width + x];
        const double apart = fabs(is - right) / (fabs(right) + least);
        s->count++;
        s->off += !(apart <= 1e-5);
        s->farthest = apart <= s->farthest ? s->farthest : apart;
        s->light += fabs(is);
    }
    return true;
}

int main(int argc, char **argv)
{
    const tyn_log log = {0};
    tyn_image_file whole = {0}, part = {0};
    if (argc != 3 || tyn_exr_read(&whole, argv[1], &log) != TYN_OK ||
        tyn_exr_read(&part, argv[2], &log) != TYN_OK || part.x < 0 || part.y < 0 ||
        (uint32_t)part.x + part.width > whole.width ||
        (uint32_t)part.y + part.height > whole.height) {
        printf("no part of the picture\n");
        return 1;
    }
    sums s = {0};
    bool good = true;
    for (int c = 0; c < 3; c++) {
        good = add_channel(&s, (const char *[]){"R", "G", "B"}[c], &whole, &part) && good;
    }
    printf("%u %u %.2g\n", s.count, s.off, s.farthest);
    tyn_image_file_finish(&whole);
    tyn_image_file_finish(&part);
    return good && s.light > 0 ? 0 : 1;
}
