// importance_twin.c -- see importance_twin.h. From the paper and the description of the pass; shares
// no source with its shaders.
#include "importance_twin.h"
#include "vector.h"
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846
enum { TEXELS = TWIN_WIDTH * TWIN_HEIGHT };

static double between(double x, double lo, double hi)
{
    return x < lo ? lo : x > hi ? hi : x;
}

// Trilinear between cell centres, constant outside the outermost ones. `at` in [0, 1]^3.
static double trilinear(double (*value)(const void *, int), const void *data, const int n[3],
                        const double at[3])
{
    int low[3];
    double f[3], sum = 0;
    for (int i = 0; i < 3; i++) {
        double x = between(at[i] * n[i] - 0.5, 0, n[i] - 1);
        low[i] = (int)fmin(floor(x), fmax(n[i] - 2, 0));
        f[i] = x - low[i];
    }
    for (int k = 0; k < 8; k++) {
        int c[3];
        double weight = 1;
        for (int i = 0; i < 3; i++) {
            int step = k >> i & 1;
            c[i] = low[i] + step < n[i] ? low[i] + step : low[i];
            weight *= step ? f[i] : 1 - f[i];
        }
        sum += weight > 0 ? weight * value(data, (c[2] * n[1] + c[1]) * n[0] + c[0]) : 0;
    }
    return sum;
}

static double voxel(const void *data, int i)
{
    return ((const float *)data)[i];
}

static double density_at(const twin_scene *s, const double p[3])
{
    double at[3];
    for (int i = 0; i < 3; i++) {
        at[i] = p[i] / s->extent[i];
        if (at[i] < 0 || at[i] > 1) {
            return 0;
        }
    }
    return trilinear(voxel, s->density, s->size, at);
}

static double hg(double g, double mu)
{
    return (1 - g * g) / (4 * PI * pow(1 + g * g - 2 * g * mu, 1.5));
}

// 2 pi times the integral of hg from -1 to mu; by its expansion near g = 0.
static double below(double g, double mu)
{
    if (fabs(g) < 1e-4) {
        return 0.5 * (1 + mu) - 0.75 * g * (1 - mu * mu);
    }
    if (1 - fabs(g) < 1e-12) {
        return g > 0 ? (mu >= 1) : 1;
    }
    return (1 - g * g) / (2 * g) * (1 / sqrt(1 + g * g - 2 * g * mu) - 1 / (1 + g));
}

// ---- the grid -------------------------------------------------------------------------------------

typedef struct frustum {
    double near, far, low[2], high[2], window[2][2];
    bool empty;
} frustum;

static void to_camera(const twin_scene *s, const double p[3], double q[3])
{
    double d[3] = {p[0] - s->origin[0], p[1] - s->origin[1], p[2] - s->origin[2]};
    q[0] = vector_dot(d, s->right);
    q[1] = vector_dot(d, s->up);
    q[2] = vector_dot(d, s->forward);
}

static double widening(const twin_scene *s, double z)
{
    return s->orthographic ? 1 : z;
}

static frustum frustum_of(const twin_scene *s)
{
    frustum f = {.near = 1e30, .far = -1e30, .low = {1e30, 1e30}, .high = {-1e30, -1e30}};
    double corner[8][3];
    for (int i = 0; i < 8; i++) {
        double p[3] = {(i & 1) * s->extent[0], (i >> 1 & 1) * s->extent[1],
                       (i >> 2) * s->extent[2]};
        to_camera(s, p, corner[i]);
        f.near = fmin(f.near, corner[i][2]);
        f.far = fmax(f.far, corner[i][2]);
    }
    f.near = fmax(f.near, s->orthographic ? 0 : fmax(f.far, 0) / 32);
    f.empty = f.far <= f.near;
    // All pairs of corners: the hull of the cut box has the same bounds as that of its edges and of
    // the box's diagonals.
    for (int i = 0; i < 8 && !f.empty; i++) {
        for (int j = 0; j < 8; j++) {
            double q[3];
            memcpy(q, corner[i], sizeof q);
            if (q[2] < f.near) {
                if (corner[j][2] <= f.near) {
                    continue;
                }
                double t = (f.near - q[2]) / (corner[j][2] - q[2]);
                for (int c = 0; c < 3; c++) {
                    q[c] += t * (corner[j][c] - corner[i][c]);
                }
            }
            for (int c = 0; c < 2; c++) {
                double x = q[c] / widening(s, fmax(q[2], f.near));
                f.low[c] = fmin(f.low[c], x);
                f.high[c] = fmax(f.high[c], x);
            }
        }
    }
    for (int c = 0; c < 2; c++) {
        f.window[0][c] = (s->shift[c] - 1) * s->half[c];
        f.window[1][c] = (s->shift[c] + 1) * s->half[c];
        if (!s->orthographic) {
            f.low[c] = fmax(f.low[c], fmin(f.window[0][c], -2));
            f.high[c] = fmin(f.high[c], fmax(f.window[1][c], 2));
        }
        f.empty |= fmin(f.high[c], f.window[1][c]) <= fmax(f.low[c], f.window[0][c]);
    }
    return f;
}

static double depth(const twin_scene *s, const frustum *f, double layer)
{
    return s->orthographic ? f->near + layer * (f->far - f->near)
                           : exp(log(f->near) + layer * (log(f->far) - log(f->near)));
}

typedef struct cell {
    double sigma_s, sigma_t, sigma_a, g, decay, along, across, volume;
    double power, cosine, next_power, next_cosine, track, turned;
} cell;

static cell cell_of(const twin_scene *s, const frustum *f, int x, int y, int z)
{
    enum { EACH = 3 };
    const int at[3] = {x, y, z}, n = s->cells;
    double mean = 0;
    for (int k = 0; k < EACH * EACH * EACH; k++) {
        int sub[3] = {k % EACH, k / EACH % EACH, k / (EACH * EACH)};
        double u[3], p[3];
        for (int i = 0; i < 3; i++) {
            u[i] = (at[i] + (sub[i] + 0.5) / EACH) / n;
        }
        double d = depth(s, f, u[2]), wide = widening(s, d);
        for (int i = 0; i < 3; i++) {
            p[i] = s->origin[i] + s->forward[i] * d +
                   wide * (s->right[i] * (f->low[0] + u[0] * (f->high[0] - f->low[0])) +
                           s->up[i] * (f->low[1] + u[1] * (f->high[1] - f->low[1])));
        }
        mean += density_at(s, p) / (EACH * EACH * EACH);
    }
    cell c = {.sigma_a = mean * s->sigma_a, .decay = mean * s->sigma_s * (1 - s->g)};
    double removed = s->scaled && s->g > 0 ? s->g * s->g : 0;
    c.sigma_s = mean * s->sigma_s * (1 - removed);
    c.sigma_t = c.sigma_s + c.sigma_a;
    c.g = (s->g - removed) / (1 - removed);

    double step[2], centre2 = 0, covered = 1;
    for (int i = 0; i < 2; i++) {
        step[i] = (f->high[i] - f->low[i]) / n;
        double lo = f->low[i] + at[i] * step[i], hi = lo + step[i];
        centre2 += s->orthographic ? 0 : 0.25 * (lo + hi) * (lo + hi);
        double common = fmin(hi, f->window[1][i]) - fmax(lo, f->window[0][i]);
        covered *= fmax(common, 0) / (f->window[1][i] - f->window[0][i]);
    }
    double near = depth(s, f, (double)z / n), far = depth(s, f, (z + 1.0) / n);
    double area = step[0] * step[1] *
                  (s->orthographic ? 1 : (pow(far, 3) - pow(near, 3)) / (3 * (far - near)));
    c.along = (far - near) * sqrt(1 + centre2);
    c.across = sqrt(area);
    c.volume = area * (far - near);
    c.power = z == 0 ? covered : 0;
    c.cosine = 1;
    c.track = c.power * c.along;
    c.turned = c.track;
    return c;
}

static void hop(cell *cells, int n, int x, int y, int z)
{
    static const int step[6][3] = {{0, 0, -1}, {0, 0, 1},  {-1, 0, 0},
                                   {1, 0, 0},  {0, -1, 0}, {0, 1, 0}};
    cell *to = &cells[(z * n + y) * n + x];
    double power = 0, cosine = 0;
    for (int i = 0; i < 6; i++) {
        int c[3] = {x + step[i][0], y + step[i][1], z + step[i][2]};
        if (c[0] < 0 || c[1] < 0 || c[2] < 0 || c[0] >= n || c[1] >= n || c[2] >= n) {
            continue;
        }
        const cell *from = &cells[(c[2] * n + c[1]) * n + c[0]];
        double behind = below(from->cosine, -sqrt(0.5)), ahead = 1 - below(from->cosine, sqrt(0.5));
        double part = i == 0 ? ahead : i == 1 ? behind : 0.25 * (1 - ahead - behind);
        double there = 0.5 * (i < 2 ? from->along : from->across);
        double here = 0.5 * (i < 2 ? to->along : to->across);
        double moved = from->power * part * exp(-from->sigma_a * there - to->sigma_a * here);
        power += moved;
        cosine += moved * from->cosine * exp(-from->decay * there - to->decay * here);
    }
    to->next_power = power;
    to->next_cosine = power > 0 ? cosine / power : 0;
}

static void propagate(const twin_scene *s, cell *cells)
{
    const int n = s->cells;
    for (int m = 0; m < s->iterations; m++) {
        for (int q = 0; q < n * n * n; q++) {
            hop(cells, n, q % n, q / n % n, q / (n * n));
        }
        for (int q = 0; q < n * n * n; q++) {
            cell *c = &cells[q];
            c->power = c->next_power;
            c->cosine = c->next_cosine;
            double sides = below(c->cosine, sqrt(0.5)) - below(c->cosine, -sqrt(0.5));
            double way = c->power * ((1 - sides) * c->along + sides * c->across);
            c->track += way;
            c->turned += way * c->cosine;
        }
    }
}

// ---- the map --------------------------------------------------------------------------------------

void twin_direction(int texel, double w[3])
{
    double azimuth = ((texel % TWIN_WIDTH + 0.5) / TWIN_WIDTH - 0.5) * 2 * PI;
    double polar = (texel / TWIN_WIDTH + 0.5) / TWIN_HEIGHT * PI;
    w[0] = sin(polar) * sin(azimuth);
    w[1] = cos(polar);
    w[2] = -sin(polar) * cos(azimuth);
}

typedef struct grid_field {
    double (*texel)[3];
    int component;
} grid_field;

static double field_value(const void *data, int i)
{
    const grid_field *f = data;
    return f->texel[i][f->component];
}

static double march(const twin_scene *s, const frustum *f, double (*field)[3], const double from[3],
                    const double w[3])
{
    enum { STEPS = 12 };
    double enter = -1e30, leave = 1e30, sum = 0, tau = 0;
    for (int i = 0; i < 3; i++) {
        double d = fabs(w[i]) < 1e-15 ? 1e-15 : w[i];
        double a = -from[i] / d, b = (s->extent[i] - from[i]) / d;
        enter = fmax(enter, fmin(a, b));
        leave = fmin(leave, fmax(a, b));
    }
    double way = fmax(leave - enter, 0) / STEPS;
    double w_camera[3] = {vector_dot(w, s->right), vector_dot(w, s->up), vector_dot(w, s->forward)};
    for (int i = 0; i < STEPS && way > 0; i++) {
        double p[3], q[3], at[3], value[3];
        for (int c = 0; c < 3; c++) {
            p[c] = from[c] + w[c] * (leave - (i + 0.5) * way);
        }
        to_camera(s, p, q);
        double z = fmax(q[2], f->near);
        bool inside = q[2] >= f->near;
        for (int c = 0; c < 2; c++) {
            at[c] = (q[c] / widening(s, z) - f->low[c]) / (f->high[c] - f->low[c]);
            inside = inside && at[c] >= 0 && at[c] <= 1;
        }
        at[2] = s->orthographic ? (z - f->near) / (f->far - f->near)
                                : log(z / f->near) / log(f->far / f->near);
        for (int c = 0; c < 3; c++) {
            const int n[3] = {s->cells, s->cells, s->cells};
            value[c] = trilinear(field_value, &(grid_field){field, c}, n, at);
        }
        double mu =
            s->orthographic ? w_camera[2] : vector_dot(q, w_camera) / sqrt(vector_dot(q, q));
        double x = value[2] * way;
        if (inside && value[0] > 0) {
            double cosine = between(value[1] / value[0], -0.9, 0.9);
            sum += exp(-tau) * (x > 1e-9 ? -expm1(-x) / x : 1) * value[0] * hg(cosine, mu);
        }
        tau += x;
    }
    return sum * way;
}

static double sent_along(const twin_scene *s, const frustum *f, double (*field)[3],
                         const double w[3])
{
    enum { RAYS = 6 };
    // The frame of parallel rays is the pass's: rays of another frame give another 36-point mean.
    double up[3] = {fabs(w[1]) < 0.7 ? 0 : 1, fabs(w[1]) < 0.7 ? 1 : 0, 0};
    double u[3], v[3], side[2] = {0, 0}, sum = 0;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        u[i] = up[j] * w[k] - up[k] * w[j];
    }
    double length = sqrt(vector_dot(u, u));
    for (int i = 0; i < 3; i++) {
        u[i] /= length;
    }
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        v[i] = w[j] * u[k] - w[k] * u[j];
        side[0] += fabs(u[i]) * s->extent[i];
        side[1] += fabs(v[i]) * s->extent[i];
    }
    for (int r = 0; r < RAYS * RAYS; r++) {
        double a = ((r % RAYS + 0.5) / RAYS - 0.5) * side[0], p[3];
        double b = ((r / RAYS + 0.5) / RAYS - 0.5) * side[1];
        for (int i = 0; i < 3; i++) {
            p[i] = 0.5 * s->extent[i] + a * u[i] + b * v[i];
        }
        sum += march(s, f, field, p, w);
    }
    return sum * side[0] * side[1] / (RAYS * RAYS);
}

static double share(int texel)
{
    int row = texel / TWIN_WIDTH;
    return (cos(PI * row / TWIN_HEIGHT) - cos(PI * (row + 1) / TWIN_HEIGHT)) / (2 * TWIN_WIDTH);
}

// Filtered over the sphere, mean 1.
static void finish(const double *sent, double *map)
{
    double mean = 0;
    for (int i = 0; i < TEXELS; i++) {
        double sum = 0, weights = 0, w[3], other[3];
        twin_direction(i, w);
        for (int j = 0; j < TEXELS; j++) {
            if (abs(i / TWIN_WIDTH - j / TWIN_WIDTH) <= 2) {
                twin_direction(j, other);
                double weight = share(j) * exp(-36 * (1 - vector_dot(w, other)));
                sum += weight * sent[j];
                weights += weight;
            }
        }
        map[i] = sum / weights;
        mean += map[i] * share(i);
    }
    for (int i = 0; i < TEXELS; i++) {
        map[i] = mean > 0 ? map[i] / mean : 1;
    }
}

void twin_importance(const twin_scene *s, double map[TEXELS], double (*field)[3])
{
    const int n = s->cells;
    frustum f = frustum_of(s);
    cell *cells = calloc((size_t)(n * n * n), sizeof *cells);
    double sent[TEXELS];
    for (int q = 0; q < n * n * n; q++) {
        cells[q] = cell_of(s, &f, q % n, q / n % n, q / (n * n));
    }
    propagate(s, cells);
    for (int q = 0; q < n * n * n; q++) {
        const cell *c = &cells[q];
        field[q][0] = c->track / c->volume * c->sigma_s;
        field[q][1] = c->turned / c->volume * c->sigma_s * c->g;
        field[q][2] = c->sigma_t;
    }
    for (int i = 0; i < TEXELS; i++) {
        double w[3];
        twin_direction(i, w);
        sent[i] = sent_along(s, &f, field, w);
    }
    finish(sent, map);
    free(cells);
}

// ---- photons --------------------------------------------------------------------------------------

static double uniform(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return ((double)(*state >> 33) + 0.5) / 2147483648.0;
}

// Turns w by an angle of cosine mu drawn from hg.
static void scatter(uint64_t *seed, double g, double w[3])
{
    double u = uniform(seed), phi = 2 * PI * uniform(seed);
    double q = (1 - g * g) / (1 - g + 2 * g * u);
    double mu = fabs(g) < 1e-4 ? 2 * u - 1 : (1 + g * g - q * q) / (2 * g);
    double s = sqrt(fmax(1 - mu * mu, 0));
    double a[3] = {fabs(w[0]) < 0.7, fabs(w[0]) >= 0.7, 0}, t[3], b[3];
    double along = vector_dot(a, w), length = sqrt(1 - along * along);
    for (int i = 0; i < 3; i++) {
        t[i] = (a[i] - along * w[i]) / length;
    }
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        b[i] = w[j] * t[k] - w[k] * t[j];
    }
    for (int i = 0; i < 3; i++) {
        w[i] = mu * w[i] + s * (cos(phi) * t[i] + sin(phi) * b[i]);
    }
}

void twin_photons(const twin_scene *s, int count, double map[TEXELS])
{
    double sent[TEXELS] = {0};
    uint64_t seed = 11;
    for (int n = 0; n < count; n++) {
        double p[3], w[3], at[2];
        for (int i = 0; i < 2; i++) {
            at[i] = (2 * uniform(&seed) - 1 + s->shift[i]) * s->half[i];
        }
        for (int i = 0; i < 3; i++) {
            p[i] = s->origin[i];
            w[i] = s->forward[i] + at[0] * s->right[i] + at[1] * s->up[i];
        }
        double length = sqrt(vector_dot(w, w)), enter = 0, leave = 1e30;
        for (int i = 0; i < 3; i++) {
            w[i] /= length;
            double a = -p[i] / w[i], b = (s->extent[i] - p[i]) / w[i];
            enter = fmax(enter, fmin(a, b));
            leave = fmin(leave, fmax(a, b));
        }
        if (enter >= leave) {
            continue;
        }
        // Forced to scatter once, with that weight.
        double weight = -expm1(-s->sigma_s * (leave - enter));
        double t = enter - log1p(-uniform(&seed) * weight) / s->sigma_s;
        for (bool inside = true; inside;) {
            for (int i = 0; i < 3; i++) {
                p[i] += t * w[i];
                inside = inside && p[i] > 0 && p[i] < s->extent[i];
            }
            if (inside) {
                scatter(&seed, s->g, w);
                t = -log(uniform(&seed)) / s->sigma_s;
            }
        }
        int x = (int)((0.5 + atan2(w[0], -w[2]) / (2 * PI)) * TWIN_WIDTH);
        int y = (int)(acos(between(w[1], -1, 1)) / PI * TWIN_HEIGHT);
        int texel = (y < TWIN_HEIGHT ? y : TWIN_HEIGHT - 1) * TWIN_WIDTH + x % TWIN_WIDTH;
        sent[texel] += weight / share(texel);
    }
    finish(sent, map);
}
