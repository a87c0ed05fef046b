// llc_twin_diffusion.c -- the diffusion correction: -div D grad e + sigma_a e = r, D de/dn = -e/2.
//
// Finite volumes: between neighbours the conductance area / distance times the harmonic mean of D;
// at the box the half cell and the Robin condition in series. Cell-centred multigrid: residuals are
// summed over 2x2x2 cells, corrections interpolated trilinearly, coarse conductances are what
// coarse cells with the mean D of their faces would have.
#include "llc_twin.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_LEVELS = 8, COARSEST_SWEEPS = 8, MOST_SCALED = 4096 };

static const double coarsest_omega = 1.5;

typedef struct level {
    int n[3];
    double (*k)[6]; // conductance to -x, +x, -y, +y, -z, +z; at the box to the outside
    double *diagonal, *sigma, *x, *b;
} level;

static int count(const level *l)
{
    return l->n[0] * l->n[1] * l->n[2];
}

static void level_alloc(level *l, const int n[3])
{
    memcpy(l->n, n, sizeof l->n);
    l->k = calloc(count(l), sizeof *l->k);
    l->diagonal = calloc(count(l), sizeof(double));
    l->sigma = calloc(count(l), sizeof(double));
    l->x = calloc(count(l), sizeof(double));
    l->b = calloc(count(l), sizeof(double));
}

static void level_free(level *l)
{
    free(l->k);
    free(l->diagonal);
    free(l->sigma);
    free(l->x);
    free(l->b);
}

// Neighbour of cell c in direction face (0..5), or -1.
static int neighbour(const level *l, const int c[3], int face)
{
    int q[3] = {c[0], c[1], c[2]};
    q[face / 2] += face % 2 ? 1 : -1;
    if (q[face / 2] < 0 || q[face / 2] >= l->n[face / 2]) {
        return -1;
    }
    return (q[2] * l->n[1] + q[1]) * l->n[0] + q[0];
}

#define FOR_CELLS(l, c, id)                                                                        \
    for (int c[3] = {0}, id = 0; id < count(l); id++, c[0] = id % (l)->n[0],                       \
             c[1] = id / (l)->n[0] % (l)->n[1], c[2] = id / (l)->n[0] / (l)->n[1])

static void finest(const llc_twin *t, level *l)
{
    double dx = t->dx;
    level_alloc(l, t->n);
    double *d = malloc(count(l) * sizeof *d);
    for (int i = 0; i < count(l); i++) {
        double tau = (t->sigma_s[i] + t->sigma_a[i]) * dx;
        double transport = t->sigma_s[i] + t->sigma_a[i] - t->g[i] * t->sigma_s[i];
        d[i] =
            1 / (3 * fmax(transport, 0.3 / t->longest)) + t->dense_term * dx * fmin(1, tau * tau);
        l->sigma[i] = t->sigma_a[i] * dx * dx * dx;
    }
    FOR_CELLS(l, c, id)
    {
        l->diagonal[id] = l->sigma[id];
        for (int f = 0; f < 6; f++) {
            int q = neighbour(l, c, f);
            l->k[id][f] =
                q >= 0 ? dx * 2 * d[id] * d[q] / (d[id] + d[q]) : dx * dx / (2 + dx / (2 * d[id]));
            l->diagonal[id] += l->k[id][f];
        }
    }
    free(d);
}

static void coarsen(const level *f, double fine_dx, level *l)
{
    double area = fine_dx * fine_dx;
    level_alloc(l, (int[3]){(f->n[0] + 1) / 2, (f->n[1] + 1) / 2, (f->n[2] + 1) / 2});
    FOR_CELLS(f, c, id)
    {
        int q = (c[2] / 2 * l->n[1] + c[1] / 2) * l->n[0] + c[0] / 2;
        l->sigma[q] += f->sigma[id];
        for (int face = 0; face < 6; face++) {
            int axis = face / 2;
            if (neighbour(f, c, face) < 0) {
                // The half cell at the box becomes twice as long; where the coarse cell reaches
                // beyond the box its centre is on it, and only the Robin condition is left.
                bool beyond = face % 2 && f->n[axis] % 2;
                l->k[q][face] += area / (beyond ? 2 : 2 * (area / f->k[id][face]) - 2);
            } else if (c[axis] % 2 == face % 2) {
                l->k[q][face] += 0.5 * f->k[id][face];
            }
        }
    }
    for (int q = 0; q < count(l); q++) {
        l->diagonal[q] = l->sigma[q];
        for (int face = 0; face < 6; face++) {
            l->diagonal[q] += l->k[q][face];
        }
    }
}

static double residual(const level *l, const int c[3], int id)
{
    double r = l->b[id] - l->diagonal[id] * l->x[id];
    for (int f = 0; f < 6; f++) {
        int q = neighbour(l, c, f);
        if (q >= 0) {
            r += l->k[id][f] * l->x[q];
        }
    }
    return r;
}

static void relax(level *l, double omega)
{
    for (int colour = 0; colour < 2; colour++) {
        FOR_CELLS(l, c, id)
        {
            if ((c[0] + c[1] + c[2]) % 2 == colour) {
                l->x[id] += omega * residual(l, c, id) / l->diagonal[id];
            }
        }
    }
}

// By what the correction x of a level has the least energy x.A x / 2 - b.x. Only levels that one workgroup of the
// device solves are scaled.
static double step_length(const level *l)
{
    double along = 0, energy = 0;
    FOR_CELLS(l, c, id)
    {
        along += l->b[id] * l->x[id];
        energy += (l->b[id] - residual(l, c, id)) * l->x[id];
    }
    return count(l) > MOST_SCALED || energy <= 0 ? 1 : fmin(fmax(along / energy, 0), 4);
}

static void interpolate(level *f, const level *l)
{
    const double scale = step_length(l);
    FOR_CELLS(f, c, id)
    {
        for (int corner = 0; corner < 8; corner++) {
            double w = 1;
            int q[3];
            for (int a = 0; a < 3; a++) {
                bool far = corner >> a & 1;
                q[a] = c[a] / 2 + (far ? (c[a] % 2 ? 1 : -1) : 0);
                q[a] = q[a] < 0 || q[a] >= l->n[a] ? c[a] / 2 : q[a];
                w *= far ? 0.25 : 0.75;
            }
            f->x[id] += scale * w * l->x[(q[2] * l->n[1] + q[1]) * l->n[0] + q[0]];
        }
    }
}

static void cycle(level *l, int levels)
{
    if (levels == 1) {
        for (int i = 0; i < COARSEST_SWEEPS; i++) {
            relax(l, coarsest_omega);
        }
        return;
    }
    level *next = l + 1;
    relax(l, 1);
    memset(next->x, 0, count(next) * sizeof(double));
    memset(next->b, 0, count(next) * sizeof(double));
    FOR_CELLS(l, c, id)
    {
        next->b[(c[2] / 2 * next->n[1] + c[1] / 2) * next->n[0] + c[0] / 2] += residual(l, c, id);
    }
    cycle(next, levels - 1);
    interpolate(l, next);
    relax(l, 1);
}

void llc_twin_diffusion(const llc_twin *t, const double *b, int cycles, double *e)
{
    level levels[MAX_LEVELS];
    int num = 1;
    double dx = t->dx;
    finest(t, &levels[0]);
    for (; num < MAX_LEVELS; num++, dx *= 2) {
        const int *n = levels[num - 1].n;
        if (n[0] <= 4 && n[1] <= 4 && n[2] <= 4) {
            break;
        }
        coarsen(&levels[num - 1], dx, &levels[num]);
    }
    memcpy(levels[0].b, b, count(&levels[0]) * sizeof(double));
    for (int i = 0; i < cycles; i++) {
        cycle(levels, num);
    }
    memcpy(e, levels[0].x, count(&levels[0]) * sizeof(double));
    for (int i = 0; i < num; i++) {
        level_free(&levels[i]);
    }
}

static double norm_of_residual(const level *l)
{
    double sum = 0;
    FOR_CELLS(l, c, id)
    {
        double r = residual(l, c, id);
        sum += r * r;
    }
    return sqrt(sum);
}

int llc_twin_diffusion_sor(const llc_twin *t, const double *b, double tolerance, double *e)
{
    level l;
    int sweeps = 0;
    double omega = 2 / (1 + 3.14159265358979 * t->dx / t->longest);
    finest(t, &l);
    memcpy(l.b, b, count(&l) * sizeof(double));
    double start = norm_of_residual(&l);
    while (sweeps < 100000 && norm_of_residual(&l) > tolerance * start) {
        for (int i = 0; i < 16; i++, sweeps++) {
            relax(&l, omega);
        }
    }
    memcpy(e, l.x, count(&l) * sizeof(double));
    level_free(&l);
    return sweeps;
}
