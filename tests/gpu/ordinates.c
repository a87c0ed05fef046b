// ordinates.c -- principal ordinates of analytic maps: partitions of light and of the sphere, against a
// tree in double; fixed ones, and how they move when things change a little.
#include "bound.h"
#include "gpu_test.h"
#include "passes/env_importance/env_importance.h"
#include "passes/ordinates/ordinates.h"
#include "passes/sky_light/sky_light.h"
#include "scene/env_suns.h"
#include "shaders/common/scene_args.h"
#include "numbers.h"
#include "vector.h"
#include "random_unit.h"
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    W = 512,
    H = 256,
    COARSE_W = SKY_SUMS_WIDTH,
    COARSE_H = SKY_SUMS_HEIGHT,
    IMP_W = 32,
    IMP_H = 16
};

static const double weights[3] = {0.2126, 0.7152, 0.0722};
static float map[W * H * 3];

typedef enum map_kind { SKY, CONTRAST, WINDOWS, NOISE, BLACK, CONSTANT, NUM_MAPS } map_kind;
static const char *const map_names[] = {"sky", "contrast", "windows", "noise", "black", "constant"};

static void direction(double x, double y, double w, double h, double d[3])
{
    double azimuth = (x / w - 0.5) * 2 * M_PI, polar = y / h * M_PI;
    d[0] = sin(polar) * sin(azimuth);
    d[1] = cos(polar);
    d[2] = -sin(polar) * cos(azimuth);
}

static void fill_map(map_kind kind)
{
    static const double Z[3] = {0.25, 0.5, 1.0}, Y[3] = {0.9, 0.95, 1.0}, G[3] = {0.15, 0.12, 0.10};
    const double spots[4][3] = {{0.6, 0.64, -0.48}, {-0.8, 0, 0.6}, {0, -0.6, 0.8}, {0, 1, 0}};
    uint32_t seed = 5;
    for (int i = 0; i < W * H; i++) {
        double d[3];
        direction(i % W + 0.5, i / W + 0.5, W, H, d);
        for (int c = 0; c < 3; c++) {
            double sky = d[1] >= 0 ? Y[c] + (Z[c] - Y[c]) * sqrt(d[1])
                                   : Y[c] + (G[c] - Y[c]) * fmin(1, -5 * d[1]);
            double v = sky;
            if (kind == CONTRAST) { // a bright patch that is no sun
                v = 0.05 * sky + 40 * exp(30 * (vector_dot(d, spots[0]) - 1));
            } else if (kind == WINDOWS) {
                v = 0.02;
                for (int k = 0; k < 4; k++) {
                    v += vector_dot(d, spots[k]) > 0.97 - 0.02 * k ? 3 + k + c : 0;
                }
            } else if (kind == NOISE) {
                v = pow(random_unit(&seed), 4);
            } else if (kind == BLACK) {
                v = 0;
            }
            map[3 * i + c] = (float)v;
        }
    }
}

static void rotation(const double axis[3], double angle, double m[3][3])
{
    const double c = cos(angle), s = sin(angle);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            m[i][j] = (1 - c) * axis[i] * axis[j] + (i == j ? c : 0);
        }
    }
    m[0][1] -= s * axis[2];
    m[0][2] += s * axis[1];
    m[1][0] += s * axis[2];
    m[1][2] -= s * axis[0];
    m[2][0] -= s * axis[1];
    m[2][1] += s * axis[0];
}

typedef struct scene {
    tyn_map_light light;
    struct env_block env;
    const float *importance; // IMP_W x IMP_H, NULL = none
    bool constant;
} scene;

static scene make_scene(map_kind kind, double turn)
{
    scene s = {.constant = kind == CONSTANT};
    const float tint[3] = {2, 1.5f, 0.5f};
    const double axis[3] = {0.48, 0.6, 0.64};
    double m[3][3];
    rotation(axis, turn, m);
    fill_map(kind);
    if (!s.constant) {
        tyn_environment e = {.present = true, .size = {W, H}, .data = map};
        assert_true(tyn_map_light_find(&e, &s.light));
        assert_int_equal(s.light.num_suns, 0);
    }
    s.env.has_map = !s.constant;
    for (int r = 0; r < 3; r++) {
        for (int a = 0; a < 3; a++) {
            s.env.rows[r][a] = (float)m[r][a];
        }
        s.env.radiance[r] = tint[r];
        s.env.sky[r] = tint[r] * (s.constant ? 1.0f : (float)s.light.sky[r]);
    }
    return s;
}

static struct ordinates_block run(gpu_test *t, const scene *s, const tyn_ordinates_params *params)
{
    static float rgba[W * H * 4];
    tyn_graph_begin(t->graph);
    tyn_ref env[ENV_IMPORTANCE_NUM_PORTS] = {{0}}, refs[ORDINATES_NUM_PORTS] = {{0}};
    if (!s->constant) {
        for (int i = 0; i < W * H; i++) {
            memcpy(rgba + 4 * i, map + 3 * i, 12);
        }
        env[ENV_IMPORTANCE_PORT_ENV_MAP] =
            gpu_image(t, "map", TYN_IMAGE_2D, (tyn_extent){W, H, 1}, 4, rgba);
        const tyn_env_importance_params none = {0};
        assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_env_importance, &none, env), TYN_OK);
        refs[ORDINATES_PORT_SKY] = env[ENV_IMPORTANCE_PORT_SKY];
        refs[ORDINATES_PORT_SUMS] = env[ENV_IMPORTANCE_PORT_SUMS];
    }
    if (s->importance) {
        refs[ORDINATES_PORT_IMPORTANCE] = gpu_image(
            t, "importance", TYN_IMAGE_2D, (tyn_extent){IMP_W, IMP_H, 1}, 1, s->importance);
    }
    tyn_ordinates_params dark = *params;
    memcpy(dark.rows, s->env.rows, sizeof dark.rows);
    tyn_sky_light_params light = {.split = params->split, .num_fixed = params->num_fixed};
    memcpy(light.fixed, params->fixed, sizeof light.fixed);
    for (uint32_t i = 0; i < dark.num_fixed; i++) {
        memset(dark.fixed[i].irradiance, 0, sizeof dark.fixed[i].irradiance);
    }
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_ordinates, &dark, refs), TYN_OK);
    tyn_ref lit[SKY_LIGHT_NUM_PORTS] = {
        [SKY_LIGHT_PORT_ENVIRONMENT] = gpu_buffer(t, "environment", &s->env, sizeof s->env),
        [SKY_LIGHT_PORT_ORDINATES] = refs[ORDINATES_PORT_ORDINATES]};
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_sky_light, &light, lit), TYN_OK);
    tyn_graph_output(t->graph, "lit", lit[SKY_LIGHT_PORT_LIT], true);
    gpu_run(t);
    struct ordinates_block block;
    memcpy(&block, gpu_map(t, "lit"), sizeof block);
    return block;
}

static tyn_ordinates_params defaults(int count, bool split)
{
    static tyn_ordinates_params p;
    tyn_pass_defaults(&tyn_pass_ordinates, &p);
    p.count = count;
    p.split = split;
    return p;
}

// ---- sums -------------------------------------------------------------------------------------

// Integral of the light, and of its absolute value, over the sphere.
static void integrals(const scene *s, bool split, double sum[3], double size[3])
{
    for (int c = 0; c < 3; c++) {
        sum[c] = size[c] = 0;
        for (int i = 0; i < W * H; i++) {
            double share = (cos(M_PI * (i / W) / H) - cos(M_PI * (i / W + 1) / H)) * 2 * M_PI / W;
            double l = s->env.radiance[c] * (s->constant ? 1 : (double)map[3 * i + c]);
            l -= split ? s->env.sky[c] : 0;
            sum[c] += l * share;
            size[c] += fabs(l) * share;
        }
    }
}

static void partitions(void **state)
{
    gpu_test *t = *state;
    const int counts[] = {1, 2, 3, 7, 16, 64, 255, 256};
    for (int kind = 0; kind < NUM_MAPS; kind++) {
        const scene s = make_scene(kind, 0.7);
        double worst = 0;
        for (int k = 0; k < 16; k++) {
            const bool split = k & 1;
            const int n = counts[k / 2];
            tyn_ordinates_params params = defaults(n, split);
            const struct ordinates_block b = run(t, &s, &params);
            double sum[3], size[3], solid_angle = 0, got[3] = {0, 0, 0};
            integrals(&s, split, sum, size);
            for (uint32_t i = 0; i < b.count; i++) {
                const struct ordinate *o = &b.list[i];
                solid_angle += o->solid_angle;
                double length = 0;
                for (int c = 0; c < 3; c++) {
                    got[c] += o->irradiance[c];
                    length += o->direction[c] * o->direction[c];
                    assert_true(split || o->irradiance[c] >= 0);
                }
                assert_true(fabs(length - 1) < 1e-5);
                assert_true(o->solid_angle > 0);
                assert_true(fabs(o->mean_cosine - (1 - o->solid_angle / (4 * M_PI))) < 1e-6);
            }
            for (uint32_t i = b.count; i < TYN_ORDINATES_MAX; i++) {
                assert_true(b.list[i].solid_angle == 0 && b.list[i].irradiance[0] == 0);
            }
            bool dark = kind == BLACK || (kind == CONSTANT && split);
            if (dark) { // nothing to carry
                for (int c = 0; c < 3; c++) {
                    assert_true(fabs(got[c]) < 1e-4);
                }
                continue;
            }
            assert_int_equal(b.count, n);
            assert_true(fabs(solid_angle / (4 * M_PI) - 1) < 1e-5);
            for (int c = 0; c < 3; c++) {
                double error = fabs(got[c] - sum[c]) / size[c];
                worst = maximum(worst, error);
                if (!(error < 1e-4)) {
                    fail_msg("%s, %d, split %d: %g, should be %g", map_names[kind], n, split,
                             got[c], sum[c]);
                }
            }
        }
        printf("%s: sums off by %.1e of all light at most\n", map_names[kind], worst);
    }
}

// ---- the tree in double -----------------------------------------------------------------------

typedef struct region {
    double x0, y0, x1, y1; // texels of the coarse map; y advances with the solid angle within a row
} region;

typedef struct twin {
    double light[COARSE_H][COARSE_W]; // what is shared out, without the even part
    double power[COARSE_H][COARSE_W][3];
    double moment[COARSE_H][COARSE_W][3];
    double even; // per sr
} twin;

static double row_solid_angle(int y)
{
    return (cos(M_PI * y / COARSE_H) - cos(M_PI * (y + 1) / COARSE_H)) * 2 * M_PI / COARSE_W;
}

static double overlap(double a0, double a1, int cell)
{
    return fmax(0, fmin(a1, cell + 1) - fmax(a0, cell));
}

// Sum over a region of field[y][x][stride], of `count` numbers.
static void sum_region(const double *field, int count, region r, double *out)
{
    memset(out, 0, (size_t)count * sizeof *out);
    for (int y = (int)r.y0; y < COARSE_H && y < r.y1; y++) {
        for (int x = (int)r.x0; x < COARSE_W && x < r.x1; x++) {
            double share = overlap(r.x0, r.x1, x) * overlap(r.y0, r.y1, y);
            for (int c = 0; c < count; c++) {
                out[c] += share * field[(y * COARSE_W + x) * count + c];
            }
        }
    }
}

static double region_solid_angle(region r)
{
    double sum = 0;
    for (int y = 0; y < COARSE_H; y++) {
        sum += overlap(r.y0, r.y1, y) * row_solid_angle(y) * (r.x1 - r.x0);
    }
    return sum;
}

static double polar_of(double y)
{
    int row = y < COARSE_H ? (int)y : COARSE_H - 1;
    double a = cos(M_PI * row / COARSE_H), b = cos(M_PI * (row + 1) / COARSE_H);
    return acos(fmax(-1, fmin(1, a + (b - a) * (y - row))));
}

static double mass(const twin *w, region r)
{
    double light;
    sum_region(&w->light[0][0], 1, r, &light);
    return light + w->even * region_solid_angle(r);
}

static double cut(const twin *w, region r, bool across, double part)
{
    double low = across ? r.x0 : r.y0, high = across ? r.x1 : r.y1, target = part * mass(w, r);
    for (int i = 0; i < 45; i++) {
        double middle = 0.5 * (low + high);
        region lower = r;
        *(across ? &lower.x1 : &lower.y1) = middle;
        *(mass(w, lower) < target ? &low : &high) = middle;
    }
    return low;
}

static void divide(region r, bool across, double at, region *lower, region *upper)
{
    *lower = *upper = r;
    *(across ? &lower->x1 : &lower->y1) = *(across ? &upper->x0 : &upper->y0) = at;
}

// Solid angle less the length of the integral of the direction.
static double width(region r)
{
    double t[2] = {polar_of(r.y0), polar_of(r.y1)}, a = (r.x1 - r.x0) / COARSE_W * M_PI;
    double level = (t[1] - 0.5 * sin(2 * t[1]) - t[0] + 0.5 * sin(2 * t[0])) * sin(a);
    double upright = (sin(t[1]) * sin(t[1]) - sin(t[0]) * sin(t[0])) * a;
    return region_solid_angle(r) - sqrt(level * level + upright * upright);
}

static void grow(const twin *base, const twin *w, region base_r, region r, int n, region *out)
{
    if (n == 1) {
        *out = r;
        return;
    }
    const double part = (double)(n / 2) / n;
    double at[2], widths[2];
    region lower[2], upper[2];
    for (int k = 0; k < 2; k++) {
        at[k] = cut(base, base_r, k == 0, part);
        divide(base_r, k == 0, at[k], &lower[0], &upper[0]);
        widths[k] = width(lower[0]) + width(upper[0]);
    }
    const bool across = widths[1] >= 0.9995 * widths[0];
    divide(base_r, across, at[!across], &lower[0], &upper[0]);
    divide(r, across, base == w ? at[!across] : cut(w, r, across, part), &lower[1], &upper[1]);
    grow(base, w, lower[0], lower[1], n / 2, out);
    grow(base, w, upper[0], upper[1], n - n / 2, out + n / 2);
}

static double importance_at(const float *importance, const double d[3])
{
    double u = (0.5 + atan2(d[0], -d[2]) / (2 * M_PI)) * IMP_W - 0.5;
    double v = acos(fmax(-1, fmin(1, d[1]))) / M_PI * IMP_H - 0.5;
    int x = (int)floor(u), y = (int)floor(v);
    double fx = u - x, fy = v - y, sum = 0;
    for (int k = 0; k < 4; k++) {
        int i = (x + (k & 1) + IMP_W) % IMP_W, j = y + (k >> 1);
        j = j < 0 ? 0 : j >= IMP_H ? IMP_H - 1 : j;
        sum += ((k & 1) ? fx : 1 - fx) * ((k >> 1) ? fy : 1 - fy) * importance[j * IMP_W + i];
    }
    return sum;
}

static void make_twin(const scene *s, double spread, bool weighted, twin *w)
{
    memset(w, 0, sizeof *w);
    double total = 0;
    for (int i = 0; i < W * H; i++) {
        int y = i / W * COARSE_H / H, x = i % W * COARSE_W / W;
        double share = (cos(M_PI * (i / W) / H) - cos(M_PI * (i / W + 1) / H)) * 2 * M_PI / W;
        double d[3], l = 0;
        direction(i % W + 0.5, i / W + 0.5, W, H, d);
        for (int c = 0; c < 3; c++) {
            w->power[y][x][c] += share * map[3 * i + c];
            l += weights[c] * share * map[3 * i + c];
        }
        for (int c = 0; c < 3; c++) {
            w->moment[y][x][c] += l * d[c];
        }
        w->light[y][x] += l;
    }
    for (int y = 0; y < COARSE_H; y++) {
        for (int x = 0; x < COARSE_W; x++) {
            double d[3], m[3];
            direction(x + 0.5, y + 0.5, COARSE_W, COARSE_H, d);
            for (int a = 0; a < 3; a++) {
                m[a] =
                    s->env.rows[0][a] * d[0] + s->env.rows[1][a] * d[1] + s->env.rows[2][a] * d[2];
            }
            w->light[y][x] *= weighted ? importance_at(s->importance, m) : 1;
            total += w->light[y][x];
        }
    }
    w->even = spread * total / (4 * M_PI);
}

static void make_importance(float *out, double peak)
{
    const double towards[3] = {0.36, 0.48, 0.8};
    double sum = 0, area = 0;
    for (int i = 0; i < IMP_W * IMP_H; i++) {
        double d[3], share = sin((i / IMP_W + 0.5) / IMP_H * M_PI);
        direction(i % IMP_W + 0.5, i / IMP_W + 0.5, IMP_W, IMP_H, d);
        out[i] = (float)(0.2 + peak * exp(3 * (vector_dot(d, towards) - 1)));
        sum += share * out[i];
        area += share;
    }
    for (int i = 0; i < IMP_W * IMP_H; i++) {
        out[i] *= (float)(area / sum);
    }
}

static double luminance_of(const double rgb[3])
{
    return weights[0] * rgb[0] + weights[1] * rgb[1] + weights[2] * rgb[2];
}

// Where a region's light comes from: the mean direction of all light, or, less the mean, the first
// moment as far as it has one sign.
static void middle_of(const twin *w, region r, bool split, double mean, double d[3])
{
    double light, moment[3], t[2] = {polar_of(r.y0), polar_of(r.y1)}, length = 0;
    double azimuth[2] = {(r.x0 / COARSE_W - 0.5) * 2 * M_PI, (r.x1 / COARSE_W - 0.5) * 2 * M_PI};
    double level = (t[1] - 0.5 * sin(2 * t[1]) - t[0] + 0.5 * sin(2 * t[0])) / 2;
    const double outwards[3] = {level * (cos(azimuth[0]) - cos(azimuth[1])),
                                (sin(t[1]) * sin(t[1]) - sin(t[0]) * sin(t[0])) / 2 *
                                    (azimuth[1] - azimuth[0]),
                                level * (sin(azimuth[0]) - sin(azimuth[1]))};
    sum_region(&w->light[0][0], 1, r, &light);
    sum_region(&w->moment[0][0][0], 3, r, moment);
    double even = mean * region_solid_angle(r), sign = (light - even) / (light + even);
    for (int a = 0; a < 3; a++) {
        double carried = moment[a] - mean * outwards[a], both = moment[a] + mean * outwards[a];
        d[a] = split ? sign * carried + (1 - sign * sign) * both
                     : moment[a] + 1e-3 * mean * outwards[a];
        length += d[a] * d[a];
    }
    for (int a = 0; a < 3; a++) {
        d[a] /= sqrt(length);
    }
}

static void against_twin(void **state)
{
    gpu_test *t = *state;
    static twin base, weighted;
    static float importance[IMP_W * IMP_H];
    make_importance(importance, 3);
    const int counts[] = {1, 3, 64, 100};
    // Relative, relative, degrees; largest over the maps.
    static const double most[16][3] = {
        {8e-7, 6e-8, 2e-3}, {8e-7, 6e-8, 2e-3},  {4e-7, 6e-8, 2e-3}, {4e-7, 6e-8, 2e-3},
        {3e-6, 2e-6, 2e-4}, {10e-5, 7e-5, 3e-3}, {2e-6, 9e-7, 2e-2}, {9e-6, 3e-5, 2e-2},
        {6e-4, 5e-5, 3e-2}, {3e-3, 3e-3, 3e-2},  {3e-5, 2e-5, 8e-2}, {6e-4, 8e-4, 8e-2},
        {2e-3, 6e-5, 4e-2}, {3e-3, 5e-3, 7e-2},  {6e-5, 2e-5, 9e-2}, {7e-4, 2e-3, 9e-2}};
    for (int kind = 0; kind < BLACK; kind++) {
        for (int k = 0; k < 16; k++) {
            scene s = make_scene(kind, 0.7);
            const int n = counts[k / 4];
            const bool split = k & 2;
            s.importance = k & 1 ? importance : NULL;
            const tyn_ordinates_params params = defaults(n, split);
            const struct ordinates_block b = run(t, &s, &params);
            const double spread = (split ? 1 : 0.25) * params.spread;
            make_twin(&s, spread, false, &base);
            make_twin(&s, spread, s.importance != NULL, &weighted);
            const twin *placing = s.importance ? &weighted : &base;
            region regions[TYN_ORDINATES_MAX], all = {0, 0, COARSE_W, COARSE_H};
            grow(&base, placing, all, all, n, regions);
            double worst_light = 0, worst_angle = 0, worst_turn = 0;
            for (int i = 0; i < n; i++) {
                double power[3], got[3] = {0, 0, 0};
                sum_region(&base.power[0][0][0], 3, regions[i], power);
                double solid_angle = region_solid_angle(regions[i]);
                for (int c = 0; c < 3; c++) {
                    double constant = s.env.sky[c] * solid_angle;
                    double whole = power[c] * s.env.radiance[c];
                    double error = b.list[i].irradiance[c] - (whole - (split ? constant : 0));
                    worst_light =
                        maximum(worst_light, fabs(error) / (whole + (split ? constant : 0)));
                    for (int r = 0; r < 3; r++) { // M -> map, against the travel
                        got[r] -= s.env.rows[r][c] * b.list[i].direction[c];
                    }
                }
                double middle[3];
                middle_of(&base, regions[i], split, luminance_of(s.light.sky), middle);
                worst_angle = maximum(worst_angle, fabs(b.list[i].solid_angle / solid_angle - 1));
                for (int a = 0; a < 3; a++) {
                    got[a] -= middle[a];
                }
                worst_turn = maximum(worst_turn, sqrt(vector_dot(got, got)) * 180 / M_PI);
            }
            printf("%s, %d%s%s: light off by %.1e, solid angle by %.1e, direction by %.2g degrees; "
                   "%.2f ms\n",
                   map_names[kind], n, split ? ", split" : "", s.importance ? ", importance" : "",
                   worst_light, worst_angle, worst_turn, gpu_ms(t, "ordinates"));
            const char *name = s.importance ? "with importance" : "without importance";
            // All of it is rounding where a quotient ends a region: as much more as quotients are worse.
            const double more = 1 + gpu_ulps(t, GPU_QUOTIENT) / (0.5 * (double)FLT_EPSILON);
            assert_true(within(worst_light, most[k][0] * more, BOUND_ROUNDING, "light of %d%s, %s",
                               n, split ? ", split" : "", name));
            assert_true(within(worst_angle, most[k][1] * more, BOUND_ROUNDING,
                               "solid angle of %d%s, %s", n, split ? ", split" : "", name));
            assert_true(within(worst_turn, most[k][2] * more, BOUND_ROUNDING,
                               "direction of %d%s, %s", n, split ? ", split" : "", name));
        }
    }
}

// ---- fixed ones -------------------------------------------------------------------------------

static double size_of(const struct ordinate *o)
{
    double size = 0;
    for (int c = 0; c < 3; c++) {
        size += weights[c] * fabs(o->irradiance[c]);
    }
    return size;
}

static double degrees_between(const struct ordinate *a, const struct ordinate *b)
{
    double dot = 0, cross = 0;
    for (int c = 0; c < 3; c++) {
        int d = (c + 1) % 3, e = (c + 2) % 3;
        double x =
            (double)a->direction[d] * b->direction[e] - (double)a->direction[e] * b->direction[d];
        dot += (double)a->direction[c] * b->direction[c];
        cross += x * x;
    }
    return atan2(sqrt(cross), dot) * 180 / M_PI;
}

static void fixed(void **state)
{
    gpu_test *t = *state;
    const scene s = make_scene(SKY, 0.3);
    tyn_ordinates_params params = defaults(256, true);
    for (int i = 0; i < TYN_ORDINATES_MAX_FIXED; i++) {
        params.fixed[i] = (struct ordinate){{(float)i, 1e-9f, 0}, 1, {0, 1, 0}, 0, 0, {0, 0, 0}};
    }
    for (uint32_t n = 0; n <= TYN_ORDINATES_MAX_FIXED; n += 34) {
        params.num_fixed = n;
        const struct ordinates_block b = run(t, &s, &params);
        assert_int_equal(b.num_fixed, n);
        assert_int_equal(b.count, 256);
        assert_memory_equal(b.list, params.fixed, n * sizeof b.list[0]);
        double solid_angle = 0, sum[3], size[3], got = 0;
        integrals(&s, true, sum, size);
        for (uint32_t i = n; i < b.count; i++) {
            solid_angle += b.list[i].solid_angle;
            got += b.list[i].irradiance[0];
        }
        assert_true(fabs(solid_angle / (4 * M_PI) - 1) < 1e-5);
        assert_true(fabs(got - sum[0]) < 1e-4 * size[0]);
    }
    // Suns alone, under a map that is not looked at.
    params.count = 0;
    scene dark = s;
    dark.constant = true; // connects nothing
    const struct ordinates_block b = run(t, &dark, &params);
    assert_int_equal(b.count, TYN_ORDINATES_MAX_FIXED);
    assert_memory_equal(b.list, params.fixed, sizeof params.fixed);
    assert_true(b.list[b.count].solid_angle == 0);
}

// ---- how they move ----------------------------------------------------------------------------

typedef struct moves {
    double most, mean; // degrees; mean weighted with light
} moves;

// No ordinate comes as near to another's place as to its own.
static moves compare(const struct ordinates_block *a, const struct ordinates_block *b)
{
    assert_int_equal(a->count, b->count);
    moves m = {0, 0};
    double total = 0;
    for (uint32_t i = 0; i < a->count; i++) {
        double move = degrees_between(&a->list[i], &b->list[i]), nearest = 180;
        m.most = maximum(m.most, move);
        m.mean += move * size_of(&a->list[i]);
        total += size_of(&a->list[i]);
        for (uint32_t k = 0; k < a->count; k++) {
            nearest = minimum(nearest, k == i ? 180 : degrees_between(&a->list[i], &b->list[k]));
        }
        assert_true(move < nearest);
    }
    m.mean /= total;
    return m;
}

static void moves_little(void **state)
{
    gpu_test *t = *state;
    static float importance[IMP_W * IMP_H], changed[IMP_W * IMP_H];
    make_importance(importance, 3);
    uint32_t seed = 3;
    for (int i = 0; i < IMP_W * IMP_H; i++) {
        changed[i] = importance[i] * (float)(1 + 0.02 * (random_unit(&seed) - 0.5));
    }
    for (int kind = 0; kind < BLACK; kind++) {
        for (int n = 16; n <= 256; n *= 4) {
            const tyn_ordinates_params params = defaults(n, true);
            scene s = make_scene(kind, 0.3), turned = make_scene(kind, 0.3 + 0.5 * M_PI / 180);
            const struct ordinates_block plain = run(t, &s, &params);
            const struct ordinates_block plain_turned = run(t, &turned, &params);
            s.importance = turned.importance = importance;
            const struct ordinates_block a = run(t, &s, &params);
            const struct ordinates_block b = run(t, &turned, &params);
            s.importance = changed;
            const struct ordinates_block c = run(t, &s, &params);
            moves rigid = compare(&plain, &plain_turned);
            moves turn = compare(&a, &b), noise = compare(&a, &c);
            printf("%s, %d: map turned by 0.5 degrees: %.2f degrees at most, with importance %.2f "
                   "(mean %.2f); importance changed by 1 %%: %.2f (mean %.2f)\n",
                   map_names[kind], n, rigid.most, turn.most, turn.mean, noise.most, noise.mean);
            assert_within(rigid.most, 0.51, NULL);
            assert_true(turn.most < 1);
            assert_true(within(noise.most,
                               n < 64    ? 0.06
                               : n < 256 ? 0.072
                                         : 0.11,
                               NULL, "%s, %d, importance changed", map_names[kind], n));
            for (int i = 0; i < n; i++) { // rigid: their light is the same
                assert_true(fabs(plain.list[i].irradiance[0] - plain_turned.list[i].irradiance[0]) <
                            1e-6);
            }
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(partitions),
        cmocka_unit_test(against_twin),
        cmocka_unit_test(fixed),
        cmocka_unit_test(moves_little),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
