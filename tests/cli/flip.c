// flip.c -- FLIP: known values, symmetry, what is not finite, the tone map and the exposures, and recorded values of a
// pair that is drawn here. The values of the authors' program are held by flip_values.sh.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>
#include "numbers.h"
#include "flip.h"

enum { WIDTH = 61, HEIGHT = 47, NUM = WIDTH * HEIGHT };

typedef struct picture {
    float rgb[3][NUM];
    metrics_image image;
} picture;

static void fill(picture *p, float r, float g, float b)
{
    const float rgb[3] = {r, g, b};
    p->image = (metrics_image){WIDTH, HEIGHT, {p->rgb[0], p->rgb[1], p->rgb[2]}, {0}};
    for (int c = 0; c < 3; c++) {
        for (int i = 0; i < NUM; i++) {
            p->rgb[c][i] = rgb[c];
        }
    }
}

// A slope, a disc with a sharp rim, and lines; `moved` shifts the disc, tints the slope and adds noise.
static void draw(picture *p, int moved)
{
    fill(p, 0, 0, 0);
    uint32_t state = 1;
    for (int i = 0; i < NUM; i++) {
        const float x = (float)(i % WIDTH), y = (float)(i / WIDTH);
        const bool disc = hypotf(x - 30 - 2 * (float)moved, y - 20) < 12;
        const bool line = i % WIDTH % 9 == 0 && y > 35;
        state = state * 1664525u + 1013904223u;
        const float noise = moved ? 0.1f * (float)(state >> 8) / 16777216.0f : 0;
        p->rgb[0][i] = x / WIDTH * (moved ? 0.8f : 1) + noise;
        p->rgb[1][i] = disc ? 1.5f : y / HEIGHT;
        p->rgb[2][i] = line ? 0.9f : 0.2f + 0.3f * x / WIDTH;
    }
}

static double ldr(const picture *a, const picture *b)
{
    double mean;
    assert_true(flip_ldr(&a->image, &b->image, 1, NULL, &mean));
    return mean;
}

static double hdr(const picture *a, const picture *b)
{
    flip_exposures exposures;
    double mean;
    assert_true(flip_find_exposures(&b->image, &exposures));
    assert_true(flip_hdr(&a->image, &b->image, &exposures, NULL, &mean));
    return mean;
}

static void nothing_where_equal(void **state)
{
    static picture a, b;
    (void)state;
    draw(&a, 0);
    draw(&b, 0);
    static float map[NUM];
    double mean;
    assert_true(flip_ldr(&a.image, &b.image, 1, map, &mean));
    assert_true(mean == 0);
    for (int i = 0; i < NUM; i++) {
        assert_true(map[i] == 0);
    }
    assert_true(hdr(&a, &b) == 0);
}

// L* and the Hunt-adjusted a* and b* of green and blue, worked out from CIE's definitions: how far apart the two are.
static double green_from_blue(void)
{
    static const double columns[2][3] = {{0.3575843394, 0.7151686788, 0.1191947798},
                                         {0.1804807884, 0.0721923154, 0.9505321522}};
    static const double white[3] = {0.9504559271, 1, 1.0890577507};
    double lab[2][3];
    for (int k = 0; k < 2; k++) {
        double f[3];
        for (int c = 0; c < 3; c++) {
            f[c] = cbrt(columns[k][c] / white[c]);
        }
        lab[k][0] = 116 * f[1] - 16;
        lab[k][1] = lab[k][0] / 100 * 500 * (f[0] - f[1]);
        lab[k][2] = lab[k][0] / 100 * 200 * (f[1] - f[2]);
    }
    return fabs(lab[0][0] - lab[1][0]) + hypot(lab[0][1] - lab[1][1], lab[0][2] - lab[1][2]);
}

static void uniform_pictures(void **state)
{
    static picture a, b;
    (void)state;
    fill(&a, 0, 1, 0);
    fill(&b, 0, 0, 1);
    assert_near(ldr(&a, &b), 1, 1e-5); // no two colours are farther apart
    // Black and white differ by an L* of 100, and in no edge.
    const double part = pow(100, 0.7) / pow(green_from_blue(), 0.7);
    fill(&a, 0, 0, 0);
    fill(&b, 1, 1, 1);
    assert_true(part > 0.4);
    assert_near(ldr(&a, &b), 0.95 + (part - 0.4) / 0.6 * 0.05, 1e-5);
    // Two greys an L* of 10 apart: below the knee, in proportion.
    fill(&a, 0.1841865f, 0.1841865f, 0.1841865f); // L* 50
    fill(&b, 0.2812334f, 0.2812334f, 0.2812334f); // L* 60
    const double grey = pow(10, 0.7) / pow(green_from_blue(), 0.7);
    assert_near(ldr(&a, &b), 0.95 * grey / 0.4, 1e-4);
    // What a display cannot show is cut.
    fill(&a, -3, -1, -0.5f);
    fill(&b, 0, 0, 0);
    assert_near(ldr(&a, &b), 0, 0);
    fill(&a, 1, 1, 1);
    fill(&b, 5, 1e30f, 2);
    assert_near(ldr(&a, &b), 0, 0);
}

// Pictures smaller than the filters: beyond the edges are the values at the edges.
static void tiny_pictures(void **state)
{
    static const uint32_t sizes[][2] = {{1, 1}, {2, 1}, {1, 3}, {5, 4}, {17, 2}};
    static picture a, b;
    (void)state;
    fill(&a, 0, 1, 0);
    fill(&b, 0, 0, 1);
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        a.image.width = b.image.width = sizes[i][0];
        a.image.height = b.image.height = sizes[i][1];
        assert_near(ldr(&a, &b), 1, 1e-5);
        assert_near(ldr(&a, &a), 0, 0);
    }
}

static void is_symmetric(void **state)
{
    static picture a, b;
    (void)state;
    draw(&a, 0);
    draw(&b, 1);
    assert_true(ldr(&a, &b) > 0.01);
    assert_near(ldr(&a, &b), ldr(&b, &a), 1e-7);
}

static void recorded_values(void **state)
{
    static picture a, b;
    (void)state;
    draw(&a, 1);
    draw(&b, 0);
    assert_near(ldr(&a, &b), 0.212775, 5e-6);
    assert_near(hdr(&a, &b), 0.159466, 5e-6);
    // Exposures follow the reference.
    for (int c = 0; c < 3; c++) {
        for (int i = 0; i < NUM; i++) {
            a.rgb[c][i] *= 1024;
            b.rgb[c][i] *= 1024;
        }
    }
    assert_near(hdr(&a, &b), 0.159466, 5e-6);
}

static void not_finite(void **state)
{
    static const float wrong[] = {NAN, INFINITY, -INFINITY};
    static picture a, b;
    static float map[NUM];
    (void)state;
    for (int i = 0; i < 6; i++) {
        draw(&a, 1);
        draw(&b, 0);
        picture *p = i % 2 ? &a : &b;
        p->rgb[i / 2][20 * WIDTH + 7] = wrong[i / 2];
        double mean;
        assert_true(flip_ldr(&a.image, &b.image, 1, map, &mean));
        assert_true(isnan(mean));
        assert_true(isnan(map[20 * WIDTH + 7]));
        assert_true(map[20 * WIDTH + 30] >= 0 && map[20 * WIDTH + 30] <= 1); // farther than filters
        assert_true(isnan(hdr(&a, &b)));
    }
}

static void finds_scale(void **state)
{
    static picture p;
    float scale;
    (void)state;
    fill(&p, 0, 0, 0);
    assert_true(flip_scale(&p.image, &scale));
    assert_true(scale == 1);
    // Of 8601 values 44 may be above: 0.5 % are 43.005.
    fill(&p, 0.5f, 0.5f, 0.5f);
    for (int i = 0; i < 43; i++) {
        p.rgb[i % 3][60 * i] = 8;
    }
    assert_true(flip_scale(&p.image, &scale));
    assert_near(scale, 2, 0);
    p.rgb[0][1] = 4;
    assert_true(flip_scale(&p.image, &scale));
    assert_near(scale, 0.25, 0);
    // Nearly all is black.
    fill(&p, 0, 0, 0);
    p.rgb[1][5] = 16;
    p.rgb[2][5] = NAN;
    assert_true(flip_scale(&p.image, &scale));
    assert_near(scale, 1.0 / 16, 0);
}

static void finds_exposures(void **state)
{
    static picture p;
    flip_exposures e;
    (void)state;
    // The curve is 0.85 where 0.36 (2.51 - 0.85 2.43) x^2 + 0.6 (0.03 - 0.85 0.59) x = 0.85 0.14.
    const double a = 0.36 * (2.51 - 0.85 * 2.43), b = 0.6 * (0.03 - 0.85 * 0.59), c = -0.85 * 0.14;
    const double shown = (-b + sqrt(b * b - 4 * a * c)) / (2 * a);
    fill(&p, 0, 0, 0);
    assert_true(flip_find_exposures(&p.image, &e));
    assert_true(e.start == 0 && e.stop == 0 && e.count == 2);
    for (int k = 0; k < 3; k++) {
        p.rgb[k][3] = 0.5f;
        p.rgb[k][4] = 0.25f;
        p.rgb[k][5] = 40;
        p.rgb[k][6] = 0.125f;
        p.rgb[k][7] = 0.0625f;
    }
    assert_true(flip_find_exposures(&p.image, &e));
    assert_near(e.start, log2(shown / 40), 1e-5);
    assert_near(e.stop, log2(shown / 0.25), 1e-5);
    assert_int_equal(e.count, 8); // of log2(160) = 7.3 stops
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_where_equal), cmocka_unit_test(uniform_pictures),
        cmocka_unit_test(tiny_pictures),       cmocka_unit_test(is_symmetric),
        cmocka_unit_test(recorded_values),     cmocka_unit_test(not_finite),
        cmocka_unit_test(finds_scale),         cmocka_unit_test(finds_exposures),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
