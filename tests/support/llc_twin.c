// llc_twin.c -- transport on the 14 lattice lines, and the iteration around it.
#include "llc_twin.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double four_pi = 12.566370614359172;

static int num_cells(const llc_twin *t)
{
    return t->n[0] * t->n[1] * t->n[2];
}

void llc_twin_init(llc_twin *t, int nx, int ny, int nz, double dx)
{
    int longest = nx > ny ? nx : ny;
    size_t n = (size_t)nx * ny * nz;
    longest = longest > nz ? longest : nz;
    *t = (llc_twin){
        .n = {nx, ny, nz},
        .dx = dx,
        .longest = longest * dx,
        .sigma_s = calloc(n, sizeof(double)),
        .sigma_a = calloc(n, sizeof(double)),
        .g = calloc(n, sizeof(double)),
        .emission = calloc(n, sizeof(double)),
        .beam = calloc(n, sizeof *t->beam),
        .m = calloc(n, sizeof *t->m),
        .cycles = 2,
        .anderson = true,
        .dense_term = 0.2,
    };
}

void llc_twin_finish(llc_twin *t)
{
    free(t->sigma_s);
    free(t->sigma_a);
    free(t->g);
    free(t->emission);
    free(t->beam);
    free(t->m);
    memset(t, 0, sizeof *t);
}

// psi_out = psi_in E + Q (s A0 + slope W1), psi_avg = psi_in A0 + Q (s A1 + slope B1): exact for a
// source that is linear along the line.
typedef struct weights {
    double e, a0, a1, w1, b1;
} weights;

static weights weights_of(double tau)
{
    if (tau < 1e-3) {
        return (weights){exp(-tau), 1 - tau / 2 + tau * tau / 6, 0.5 - tau / 6 + tau * tau / 24,
                         tau * (1. / 12 - tau / 24 + tau * tau / 80),
                         -(1. / 12 - tau / 24 + tau * tau / 80)};
    }
    weights w = {.e = exp(-tau)};
    w.a0 = (1 - w.e) / tau;
    w.a1 = (1 - w.a0) / tau;
    w.w1 = w.a1 - 0.5 * w.a0;
    w.b1 = -w.w1 / tau;
    return w;
}

static double source_along(const llc_twin *t, const double (*m)[4], int id, const double d[3])
{
    double phi = m[id][0] + t->beam[id][0], flux = 0;
    for (int a = 0; a < 3; a++) {
        flux += d[a] * (m[id][a + 1] + t->beam[id][a + 1]);
    }
    return (phi + 3 * t->g[id] * flux) / four_pi;
}

static double sweep_direction(const llc_twin *t, const double (*in)[4], double (*out)[4],
                              const int o[3], double *psi_out)
{
    const int *n = t->n;
    int steps = abs(o[0]) + abs(o[1]) + abs(o[2]);
    double length = t->dx * sqrt(steps), norm = 1 / sqrt(steps), leak = 0;
    double weight = steps == 1 ? 0.30 / 6 : 0.70 / 8; // of the direction; all 14 sum to 1
    double tube = t->dx * t->dx * t->dx / length * four_pi * weight;
    double d[3] = {o[0] * norm, o[1] * norm, o[2] * norm};
    int step = (o[2] * n[1] + o[1]) * n[0] + o[0];
    for (int kk = 0; kk < n[2]; kk++) {
        for (int jj = 0; jj < n[1]; jj++) {
            for (int ii = 0; ii < n[0]; ii++) {
                int c[3] = {o[0] < 0 ? n[0] - 1 - ii : ii, o[1] < 0 ? n[1] - 1 - jj : jj,
                            o[2] < 0 ? n[2] - 1 - kk : kk};
                int id = (c[2] * n[1] + c[1]) * n[0] + c[0];
                bool up = true, down = true; // is there a cell before, behind?
                for (int a = 0; a < 3; a++) {
                    up = up && c[a] - o[a] >= 0 && c[a] - o[a] < n[a];
                    down = down && c[a] + o[a] >= 0 && c[a] + o[a] < n[a];
                }
                double psi = up ? psi_out[id - step] : t->boundary;
                leak -= up ? 0 : psi * tube;
                double s = source_along(t, in, id, d);
                double before = up ? source_along(t, in, id - step, d) : s;
                double behind = down ? source_along(t, in, id + step, d) : s;
                double slope = (behind - before) / (up && down ? 2 : 1), limit = 2 * fabs(s);
                slope = fmin(fmax(slope, -limit), limit);
                weights w = weights_of((t->sigma_s[id] + t->sigma_a[id]) * length);
                double q = length * t->sigma_s[id], je = length * t->emission[id];
                double avg = psi * w.a0 + q * (s * w.a1 + slope * w.b1) + je * w.a1;
                psi_out[id] = psi * w.e + q * (s * w.a0 + slope * w.w1) + je * w.a0;
                out[id][0] += four_pi * weight * avg;
                for (int a = 0; a < 3; a++) {
                    out[id][a + 1] += four_pi * weight * avg * d[a];
                }
                if (!down) {
                    leak += psi_out[id] * tube;
                }
            }
        }
    }
    return leak;
}

double llc_twin_sweep(const llc_twin *t, const double (*in)[4], double (*out)[4])
{
    double *psi_out = malloc(num_cells(t) * sizeof(double)), leak = 0;
    memset(out, 0, num_cells(t) * sizeof *out);
    for (int z = -1; z <= 1; z++) {
        for (int y = -1; y <= 1; y++) {
            for (int x = -1; x <= 1; x++) {
                int steps = abs(x) + abs(y) + abs(z);
                if (steps == 1 || steps == 3) {
                    leak += sweep_direction(t, in, out, (int[3]){x, y, z}, psi_out);
                }
            }
        }
    }
    free(psi_out);
    return leak;
}

static double dot(double (*a)[4], double (*b)[4], int n)
{
    double sum = 0;
    for (int i = 0; i < n; i++) {
        sum += a[i][0] * b[i][0];
        for (int k = 1; k < 4; k++) {
            sum += 3 * a[i][k] * b[i][k];
        }
    }
    return sum;
}

// Anderson mixing: from up to three pairs (result x of an iteration, change r it made), newest
// first, the combination of results whose combined change is least.
static void mix(double (*const x[3])[4], double (*const r[3])[4], int pairs, int n,
                double (*out)[4])
{
    double g[2] = {0, 0};
    double(*d[2])[4] = {calloc(n, sizeof *d[0]), calloc(n, sizeof *d[1])};
    for (int p = 1; p < pairs; p++) {
        for (int i = 0; i < n; i++) {
            for (int k = 0; k < 4; k++) {
                d[p - 1][i][k] = r[p][i][k] - r[0][i][k];
            }
        }
    }
    double a00 = dot(d[0], d[0], n) * (1 + 1e-6), a11 = dot(d[1], d[1], n) * (1 + 1e-6);
    double a01 = dot(d[0], d[1], n), b0 = -dot(d[0], r[0], n), b1 = -dot(d[1], r[0], n);
    double det = a00 * a11 - a01 * a01;
    if (pairs == 3 && det > 1e-6 * a00 * a11) {
        g[0] = (b0 * a11 - b1 * a01) / det;
        g[1] = (a00 * b1 - a01 * b0) / det;
    } else if (pairs > 1 && a00 > 0) {
        g[0] = b0 / a00;
    }
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < 4; k++) {
            out[i][k] = x[0][i][k];
            for (int p = 1; p < pairs; p++) {
                out[i][k] += g[p - 1] * (x[p][i][k] - x[0][i][k]);
            }
        }
    }
    free(d[0]);
    free(d[1]);
}

void llc_twin_solve(llc_twin *t, int sweeps)
{
    int n = num_cells(t);
    double volume = t->dx * t->dx * t->dx;
    double(*x[3])[4], (*r[3])[4];
    double *b = malloc(n * sizeof *b), *e = malloc(n * sizeof *e);
    for (int p = 0; p < 3; p++) {
        x[p] = calloc(n, sizeof *x[p]);
        r[p] = calloc(n, sizeof *r[p]);
    }
    for (int i = 0; i < n; i++) {
        t->m[i][0] = four_pi * t->boundary;
        t->m[i][1] = t->m[i][2] = t->m[i][3] = 0;
    }
    for (int sweep = 0; sweep < sweeps; sweep++) {
        double(*oldest_x)[4] = x[2], (*oldest_r)[4] = r[2];
        x[2] = x[1], r[2] = r[1];
        x[1] = x[0], r[1] = r[0];
        x[0] = oldest_x, r[0] = oldest_r;
        t->leak = llc_twin_sweep(t, (const double(*)[4])t->m, x[0]);
        if (t->cycles > 0) {
            for (int i = 0; i < n; i++) {
                b[i] = volume * t->sigma_s[i] * (x[0][i][0] - t->m[i][0]);
            }
            llc_twin_diffusion(t, b, t->cycles, e);
            for (int i = 0; i < n; i++) {
                x[0][i][0] += e[i];
            }
        }
        for (int i = 0; i < n; i++) {
            for (int k = 0; k < 4; k++) {
                r[0][i][k] = x[0][i][k] - t->m[i][k];
            }
        }
        mix(x, r, t->anderson ? (sweep < 2 ? sweep + 1 : 3) : 1, n, t->m);
    }
    for (int p = 0; p < 3; p++) {
        free(x[p]);
        free(r[p]);
    }
    free(b);
    free(e);
}

double llc_twin_imbalance(const llc_twin *t)
{
    const int *n = t->n;
    double area = 2.0 * t->dx * t->dx * (n[0] * n[1] + n[1] * n[2] + n[2] * n[0]);
    double made = 0, absorbed = 0, volume = t->dx * t->dx * t->dx;
    for (int i = 0; i < num_cells(t); i++) {
        made += volume * (t->sigma_s[i] * t->beam[i][0] + four_pi * t->emission[i]);
        absorbed += volume * t->sigma_a[i] * t->m[i][0];
    }
    double in = made + t->boundary * four_pi / 4 * area;
    return in != 0 ? (t->leak + absorbed - made) / in : t->leak + absorbed;
}
