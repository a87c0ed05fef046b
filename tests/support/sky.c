// sky.c -- skies for tests, light that crosses a scene without scattering, and tables of references.
#include "sky.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

static const double pi = 3.14159265358979323846;

// ---- skies ------------------------------------------------------------------------------------

static void part_of_reference(const double w[3], sky_part part, double out[3])
{
    static const double zenith[3] = {0.25, 0.5, 1.0}, horizon[3] = {0.9, 0.95, 1.0};
    static const double ground[3] = {0.15, 0.12, 0.10}, sun[3] = {60, 54, 45};
    double to_sun = (0.5 * w[0] + 0.6 * w[1] - 0.4 * w[2]) / sqrt(0.25 + 0.36 + 0.16);
    for (int c = 0; c < 3; c++) {
        double sky = w[1] >= 0 ? horizon[c] + (zenith[c] - horizon[c]) * sqrt(w[1])
                               : horizon[c] + (ground[c] - horizon[c]) * fmin(1, -5 * w[1]);
        double disc = sun[c] * exp(200 * (to_sun - 1));
        out[c] = (part == SKY_SUN ? 0 : sky) + (part == SKY_WITHOUT_SUN ? 0 : disc);
    }
}

// At the horizon the sky has a vertical tangent, and the references' camera looks 1e-5 beside it, half
// of it on either side.
static void near_horizon(const double w[3], sky_part part, double out[3])
{
    double above[3] = {w[0], 9.4e-6, w[2]}, below[3] = {w[0], -9.4e-6, w[2]}, l[2][3];
    part_of_reference(above, part, l[0]);
    part_of_reference(below, part, l[1]);
    for (int c = 0; c < 3; c++) {
        out[c] = 0.5 * (l[0][c] + l[1][c]);
    }
}

void sky_of_references(const double w[3], double out[3])
{
    if (fabs(w[1]) < 1e-5) {
        near_horizon(w, SKY_WHOLE, out);
    } else {
        part_of_reference(w, SKY_WHOLE, out);
    }
}

// Direction of a point of a map, u and v in [0, 1].
static void map_direction(double u, double v, double w[3])
{
    double phi = 2 * pi * (u - 0.5), theta = pi * v;
    w[0] = sin(theta) * sin(phi);
    w[1] = cos(theta);
    w[2] = -sin(theta) * cos(phi);
}

void sky_reference_map(tyn_environment *map, sky_part what)
{
    enum { W = 2048, H = 1023, SUB = 2 };
    float *data = malloc((size_t)W * H * 3 * sizeof *data);
    for (int i = 0; i < W * H; i++) {
        double sum[3] = {0};
        for (int k = 0; k < SUB * SUB; k++) {
            double w[3], l[3];
            map_direction((i % W + (k % SUB + 0.5) / SUB) / W, (i / W + (k / SUB + 0.5) / SUB) / H,
                          w);
            // Its neighbours too: the background behind a pixel is blended over half a texel.
            if (abs(i / W - H / 2) <= 1) {
                near_horizon(w, what, l);
            } else {
                part_of_reference(w, what, l);
            }
            for (int c = 0; c < 3; c++) {
                sum[c] += l[c] / (SUB * SUB);
            }
        }
        for (int c = 0; c < 3; c++) {
            data[3 * i + c] = (float)sum[c];
        }
    }
    *map = (tyn_environment){.present = true,
                             .size = {W, H},
                             .data = data,
                             .radiance = {1, 1, 1},
                             .strength = 1,
                             .hash = 11 + (uint64_t)what};
}

void sky_constant_map(tyn_environment *map, uint32_t width, uint32_t height, float radiance)
{
    size_t count = (size_t)width * height * 3;
    float *data = malloc(count * sizeof *data);
    for (size_t i = 0; i < count; i++) {
        data[i] = radiance;
    }
    *map = (tyn_environment){.present = true,
                             .size = {width, height},
                             .data = data,
                             .radiance = {1, 1, 1},
                             .strength = 1,
                             .hash = 7919u * width + height};
}

void sky_turn(tyn_environment *map, float x, float y, float z, float angle)
{
    float s = sinf(0.5f * angle) / sqrtf(x * x + y * y + z * z);
    const float q[4] = {s * x, s * y, s * z, cosf(0.5f * angle)};
    memcpy(map->rotation, q, sizeof q);
}

// conjugate(q) applied to w.
static void turn_back(const float q[4], const double w[3], double out[3])
{
    memcpy(out, w, 3 * sizeof *out);
    double n =
        (double)q[0] * q[0] + (double)q[1] * q[1] + (double)q[2] * q[2] + (double)q[3] * q[3];
    if (n == 0) {
        return;
    }
    double x = -q[0], y = -q[1], z = -q[2], s = q[3];
    double t[3] = {2 * (y * w[2] - z * w[1]) / n, 2 * (z * w[0] - x * w[2]) / n,
                   2 * (x * w[1] - y * w[0]) / n};
    out[0] += s * t[0] + y * t[2] - z * t[1];
    out[1] += s * t[1] + z * t[0] - x * t[2];
    out[2] += s * t[2] + x * t[1] - y * t[0];
}

void sky_look(const tyn_environment *map, const double w[3], double out[3])
{
    for (int c = 0; c < 3; c++) {
        out[c] = map->present ? (double)map->radiance[c] * map->strength : 0;
    }
    if (!map->present || !map->data) {
        return;
    }
    double d[3];
    turn_back(map->rotation, w, d);
    long width = map->size[0], height = map->size[1];
    double x = (0.5 + atan2(d[0], -d[2]) / (2 * pi)) * (double)width - 0.5;
    double y = acos(fmax(-1, fmin(1, d[1]))) / pi * (double)height - 0.5;
    long x0 = (long)floor(x), y0 = (long)floor(y);
    double sum[3] = {0};
    for (int k = 0; k < 4; k++) {
        long i = (x0 + k % 2 + width) % width, j = y0 + k / 2;
        j = j < 0 ? 0 : j >= height ? height - 1 : j;
        double a = x - (double)x0, b = y - (double)y0;
        double weight = (k % 2 ? a : 1 - a) * (k / 2 ? b : 1 - b);
        for (int c = 0; c < 3; c++) {
            sum[c] += weight * map->data[3 * (j * width + i) + c];
        }
    }
    for (int c = 0; c < 3; c++) {
        out[c] *= sum[c];
    }
}

// ---- what is seen without scattering ------------------------------------------------------------

static double determinant(const double a[3], const double b[3], const double c[3])
{
    return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
}

// Solves m x = v for the upper 3 x 3 of a column-major matrix.
static void solve(const float m[16], const double v[3], double x[3])
{
    double column[3][3];
    for (int i = 0; i < 9; i++) {
        column[i / 3][i % 3] = m[4 * (i / 3) + i % 3];
    }
    double whole = determinant(column[0], column[1], column[2]);
    x[0] = determinant(v, column[1], column[2]) / whole;
    x[1] = determinant(column[0], v, column[2]) / whole;
    x[2] = determinant(column[0], column[1], v) / whole;
}

// Trilinear, clamped in the outer half voxel; p in the unit box about the origin.
static double density(const tyn_volume *v, const double p[3])
{
    long at[3][2];
    double f[3];
    for (int a = 0; a < 3; a++) {
        double x = (p[a] + 0.5) * v->size[a] - 0.5, top = v->size[a] - 1.0;
        x = fmax(0, fmin(top, x));
        at[a][0] = (long)x;
        at[a][1] = at[a][0] + 1 > (long)top ? (long)top : at[a][0] + 1;
        f[a] = x - (double)at[a][0];
    }
    double sum = 0;
    for (int k = 0; k < 8; k++) {
        int i = k & 1, j = k >> 1 & 1, l = k >> 2;
        sum += (i ? f[0] : 1 - f[0]) * (j ? f[1] : 1 - f[1]) * (l ? f[2] : 1 - f[2]) *
               v->data[(at[2][l] * v->size[1] + at[1][j]) * v->size[0] + at[0][i]];
    }
    return sum;
}

// Integral of the density of a shape along o + t d, t > 0, d of unit length in the world.
static double column(const tyn_scene *scene, const tyn_shape *s, const double o[3],
                     const double d[3])
{
    double from[3], p[3], q[3], t0 = 0, t1 = INFINITY;
    for (int i = 0; i < 3; i++) {
        from[i] = o[i] - s->to_world[12 + i];
    }
    solve(s->to_world, from, p);
    solve(s->to_world, d, q);
    if (s->kind == TYN_SHAPE_SPHERE) {
        double a = q[0] * q[0] + q[1] * q[1] + q[2] * q[2];
        double b = p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
        double h = b * b - a * (p[0] * p[0] + p[1] * p[1] + p[2] * p[2] - 0.25);
        if (h <= 0) {
            return 0;
        }
        t0 = fmax(0, (-b - sqrt(h)) / a);
        t1 = (-b + sqrt(h)) / a;
    } else {
        for (int i = 0; i < 3; i++) {
            double a = (-0.5 - p[i]) / q[i], b = (0.5 - p[i]) / q[i];
            t0 = fmax(t0, fmin(a, b));
            t1 = fmin(t1, fmax(a, b));
        }
    }
    if (!(t1 > t0)) {
        return 0;
    }
    int32_t volume = scene->media[s->medium].volume;
    if (volume < 0) {
        return t1 - t0;
    }
    const tyn_volume *v = &scene->volumes[volume];
    double voxels = 0;
    for (int i = 0; i < 3; i++) {
        voxels = fmax(voxels, fabs(q[i]) * v->size[i]);
    }
    long steps = (long)ceil(2 * voxels * (t1 - t0));
    double sum = 0, dt = (t1 - t0) / (double)steps;
    for (long k = 0; k < steps; k++) {
        double t = t0 + ((double)k + 0.5) * dt;
        sum += density(v, (double[]){p[0] + t * q[0], p[1] + t * q[1], p[2] + t * q[2]}) * dt;
    }
    return sum;
}

static void transmittance(const tyn_scene *scene, const double o[3], const double d[3],
                          double out[3])
{
    double tau[3] = {0};
    for (uint32_t i = 0; i < scene->num_shapes; i++) {
        const tyn_medium *m = &scene->media[scene->shapes[i].medium];
        double amount = tyn_medium_scale(m) * column(scene, &scene->shapes[i], o, d);
        for (int c = 0; c < 3; c++) {
            tau[c] += amount * ((double)m->sigma_s[c] + m->sigma_a[c]);
        }
    }
    for (int c = 0; c < 3; c++) {
        out[c] = exp(-tau[c]);
    }
}

// Ray through image position s, t in [-1, 1], t up.
static void camera_ray(const tyn_view *view, double s, double t, double o[3], double d[3])
{
    const tyn_camera *c = &view->camera;
    bool parallel = c->projection == TYN_ORTHOGRAPHIC;
    double half = parallel ? c->ymag : tan(0.5 * c->yfov);
    double x = s * half * view->width / view->height, y = t * half, length = 0;
    for (int i = 0; i < 3; i++) {
        double aside = x * c->right[i] + y * c->up[i];
        o[i] = c->position[i] + (parallel ? aside : 0);
        d[i] = -c->back[i] + (parallel ? 0 : aside);
        length += d[i] * d[i];
    }
    for (int i = 0; i < 3; i++) {
        d[i] /= sqrt(length);
    }
}

void picture_unscattered(picture *p, const tyn_scene *scene, const tyn_view *view, sky_fn sky)
{
    enum { RAYS = 2, LOOKS = 4 }; // along a side: rays through a pixel, looks at the sky for each
    *p = (picture){.width = view->width, .height = view->height};
    p->rgb = calloc((size_t)p->width * p->height * 3, sizeof *p->rgb);
    for (uint32_t i = 0; i < p->width * p->height; i++) {
        double sum[3] = {0};
        for (int k = 0; k < RAYS * RAYS; k++) {
            double seen[3] = {0}, through[3], o[3], d[3];
            double x = i % p->width + (double)(k % RAYS) / RAYS;
            double y = i / p->width + (double)(k / RAYS) / RAYS;
            for (int l = 0; l < LOOKS * LOOKS; l++) {
                double w[3];
                camera_ray(view, 2 * (x + (l % LOOKS + 0.5) / (RAYS * LOOKS)) / p->width - 1,
                           1 - 2 * (y + (l / LOOKS + 0.5) / (RAYS * LOOKS)) / p->height, o, d);
                if (sky) {
                    sky(d, w);
                } else {
                    sky_look(&scene->environment, d, w);
                }
                for (int c = 0; c < 3; c++) {
                    seen[c] += w[c] / (RAYS * RAYS * LOOKS * LOOKS);
                }
            }
            camera_ray(view, 2 * (x + 0.5 / RAYS) / p->width - 1,
                       1 - 2 * (y + 0.5 / RAYS) / p->height, o, d);
            transmittance(scene, o, d, through);
            for (int c = 0; c < 3; c++) {
                sum[c] += through[c] * seen[c];
            }
        }
        for (int c = 0; c < 3; c++) {
            p->rgb[3 * i + (uint32_t)c] = (float)sum[c];
        }
    }
}

// ---- blocks and tables --------------------------------------------------------------------------

void picture_blocks(picture *blocks, const picture *p, uint32_t block)
{
    uint32_t w = p->width / block, h = p->height / block;
    *blocks = (picture){.width = w, .height = h};
    blocks->rgb = malloc((size_t)w * h * 3 * sizeof *blocks->rgb);
    blocks->se = p->se ? malloc((size_t)w * h * 3 * sizeof *blocks->se) : NULL;
    for (uint32_t i = 0; i < w * h * 3; i++) {
        double sum = 0, squares = 0;
        for (uint32_t k = 0; k < block * block; k++) {
            uint32_t x = i / 3 % w * block + k % block, y = i / 3 / w * block + k / block;
            uint32_t at = 3 * (y * p->width + x) + i % 3;
            sum += p->rgb[at];
            squares += p->se ? (double)p->se[at] * p->se[at] : 0;
        }
        blocks->rgb[i] = (float)(sum / (block * block));
        if (p->se) {
            blocks->se[i] = (float)(sqrt(squares) / (block * block));
        }
    }
}

void picture_subtract(picture *p, const picture *q)
{
    assert_true(p->width == q->width && p->height == q->height);
    for (size_t i = 0; i < (size_t)p->width * p->height * 3; i++) {
        p->rgb[i] -= q->rgb[i];
    }
}

bool picture_read_table(picture *p, const char *path)
{
    FILE *file = fopen(path, "r");
    if (!file) {
        return false;
    }
    enum { MOST = 64 * 64 };
    static float rows[MOST][6];
    char line[512];
    uint32_t count = 0;
    *p = (picture){0};
    while (fgets(line, sizeof line, file)) {
        unsigned x, y;
        float v[6];
        if (line[0] == '#') {
            continue;
        }
        assert_int_equal(sscanf(line, "%u,%u,%f,%f,%f,%f,%f,%f", &x, &y, &v[0], &v[1], &v[2], &v[3],
                                &v[4], &v[5]),
                         8);
        assert_true(count < MOST);
        memcpy(rows[count++], v, sizeof v);
        p->width = x + 1 > p->width ? x + 1 : p->width;
        p->height = y + 1 > p->height ? y + 1 : p->height;
    }
    fclose(file);
    assert_int_equal(count, p->width * p->height);
    p->rgb = malloc(3 * count * sizeof *p->rgb);
    p->se = malloc(3 * count * sizeof *p->se);
    for (uint32_t i = 0; i < 3 * count; i++) {
        p->rgb[i] = rows[i / 3][i % 3];
        p->se[i] = rows[i / 3][3 + i % 3];
    }
    return true;
}

void picture_write_table(const picture *p, const char *path, const char *comment)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fprintf(file, "# %s\n# x,y,r,g,b,se_r,se_g,se_b\n", comment);
    for (uint32_t i = 0; i < p->width * p->height; i++) {
        const float *v = p->rgb + 3 * i, *se = p->se + 3 * i;
        fprintf(file, "%u,%u,%.6g,%.6g,%.6g,%.3g,%.3g,%.3g\n", i % p->width, i / p->width,
                (double)v[0], (double)v[1], (double)v[2], (double)se[0], (double)se[1],
                (double)se[2]);
    }
    assert_int_equal(fclose(file), 0);
}
