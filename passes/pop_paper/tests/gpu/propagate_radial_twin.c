// propagate_radial_twin.c -- see propagate_radial_twin.h. Scatters where the kernel gathers.
#include "propagate_radial_twin.h"
#include "propagate_twin.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

void radial_twin_beside(int n, int i, int j, int dx, int dy, int out[2])
{
    out[0] = i + dx;
    out[1] = j + dy;
    if (out[0] < 0 || out[0] >= n) { // the edge is folded in its middle
        out[0] = i;
        out[1] = n - 1 - j;
    }
    if (out[1] < 0 || out[1] >= n) {
        out[0] = n - 1 - i;
        out[1] = j;
    }
}

// Of the direction of a texel's centre: the texel of the opposite one.
static int opposite(int n, int q)
{
    double u = (2.0 * (q % n) + 1) / n - 1, v = (2.0 * (q / n) + 1) / n - 1;
    // (x, y, z) -> (-x, -y, -z): the sheets above and below exchange, each point mirrored at |u| + |v| = 1.
    double a = copysign(1 - fabs(v), -u), b = copysign(1 - fabs(u), -v);
    return (int)lround((b + 1) / 2 * n - 0.5) * n + (int)lround((a + 1) / 2 * n - 0.5);
}

typedef struct arrival {
    double *light, *weighted; // power, power times mean cosine
    radial_twin_sums *sums;
    const radial_twin *t;
} arrival;

// What half a cell leaves of the light and of its mean cosine.
static double kept(const radial_twin *t, int q)
{
    return exp(-0.5 * t->tau_a[q]);
}

static double kept_cosine(const radial_twin *t, int q)
{
    double tau = 0.5 * t->tau_s[q], g = t->g[q];
    return tau <= 0 ? 1 : t->exact_rate || g < 0 ? exp(-(1 - g) * tau) : pow(g, tau);
}

// Power that leaves the middle of cell `from` of mean cosine `a` for the middle of `target` (-1: none).
// `factor`: of the power on arrival; `wider`: of 1 - a at the face between them.
static void move(arrival *to, int from, int target, double power, double a, double wider,
                 double factor)
{
    const radial_twin *t = to->t;
    double out = power * kept(t, from);
    to->sums->absorbed += power - out;
    if (target < 0 || !t->cell[target]) {
        to->sums->escaped += out;
        return;
    }
    double in = out * kept(t, target);
    to->sums->absorbed += out - in;
    in *= factor;
    a = fmax(1 - (1 - a * kept_cosine(t, from)) * wider, -1);
    to->light[target] += in;
    to->weighted[target] += in * a * kept_cosine(t, target);
}

static void scatter(arrival *to, int q, double power, double a)
{
    const radial_twin *t = to->t;
    int n = t->n, layer = n * n, texel = q % layer, k = q / layer;
    double front = a >= 1 ? 0 : twin_hg_below(cos(PI / 4), a);
    double behind = a >= 1 ? 0 : twin_hg_below(cos(3 * PI / 4), a), side = (front - behind) / 4;
    bool spacing = t->scale == RADIAL_TWIN_SPACING;
    double rho2 = t->growth * t->growth,
           inwards = t->scale == RADIAL_TWIN_RECIPROCAL ? 1 / rho2 : 1;
    if (k == 0) {
        move(to, q, t->layers > 1 ? q + layer : -1, power, a, 1,
             t->lit && t->layers > 1 ? t->lit[q + layer] : 1);
        return;
    }
    double wider = t->narrowing ? rho2 : 1;
    move(to, q, k + 1 < t->layers ? q + layer : -1, power * (1 - front), a, 1 / wider,
         (spacing ? t->growth : 1) * (t->lit && k + 1 < t->layers ? t->lit[q + layer] : 1));
    if (k == 1) {
        // Through the ball: its near half, then up to its middle is all that a hop does.
        int near = q - layer, far = opposite(n, texel);
        double go = power * behind * inwards, out = go * kept(t, q);
        double in = out * kept(t, near);
        to->sums->absorbed += go - in;
        if (t->cell[far]) {
            to->light[far] += in;
            to->weighted[far] += in * fabs(a) * kept_cosine(t, q) * kept_cosine(t, near);
        } else {
            to->sums->escaped += in;
        }
    } else {
        move(to, q, q - layer, power * behind * inwards, a, wider, spacing ? 1 / t->growth : 1);
    }
    move(to, q, q, power * behind * (1 - inwards), a, 1, 1);
    for (int s = 0; s < 4; s++) {
        static const int step[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
        int at[2];
        radial_twin_beside(n, texel % n, texel / n, step[s][0], step[s][1], at);
        int other = at[1] * n + at[0];
        double ratio = t->solid_angle[other] / t->solid_angle[texel];
        double share = spacing ? 1 : fmin(ratio, 1);
        move(to, q, k * layer + other, power * side * share, a, 1, spacing ? ratio : 1);
        move(to, q, q, power * side * (1 - share), a, 1, 1);
    }
}

radial_twin_sums radial_twin_run(const radial_twin *t, int iterations, double *light,
                                 double *cosine, double *seen)
{
    int layer = t->n * t->n, total = layer * t->layers;
    double *next = malloc((size_t)total * sizeof *next);
    double *weighted = malloc((size_t)total * sizeof *weighted);
    radial_twin_sums sums = {0};
    for (int q = 0; q < total; q++) {
        bool starts = t->cell[q] && t->first[q % layer] == q / layer;
        light[q] = starts ? t->start[q % layer] : 0;
        for (int p = q % layer; t->lit && p <= q; p += layer) {
            light[q] *= t->lit[p];
        }
        cosine[q] = t->mean_cosine;
        sums.injected += light[q];
        double lobe = fmin(fmax(t->last_event ? t->g[q] * cosine[q] : cosine[q], -0.995), 0.995);
        seen[q] = q < layer ? light[q] / t->solid_angle[q] * twin_hg(t->mu[q], lobe) : 0;
    }
    for (int m = 0; m < iterations; m++) {
        arrival to = {next, weighted, &sums, t};
        memset(next, 0, (size_t)total * sizeof *next);
        memset(weighted, 0, (size_t)total * sizeof *weighted);
        for (int q = 0; q < total; q++) {
            if (t->cell[q]) {
                scatter(&to, q, light[q], cosine[q]);
            }
        }
        for (int q = 0; q < total; q++) {
            light[q] = next[q];
            cosine[q] = next[q] > 0 ? weighted[q] / next[q] : 0;
            double lobe =
                fmin(fmax(t->last_event ? t->g[q] * cosine[q] : cosine[q], -0.995), 0.995);
            seen[q] += (q < layer ? 2 : 1) * light[q] / t->solid_angle[q % layer] *
                       twin_hg(t->mu[q], lobe);
        }
    }
    for (int q = 0; q < total; q++) {
        sums.held += light[q];
    }
    free(next);
    free(weighted);
    return sums;
}
