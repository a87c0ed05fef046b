// doubling.c -- see doubling.h.
#include "doubling.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846
enum { N = DOUBLING_POINTS, SIZE = N + 1 }; // the last row and column: the beam

// Radiance that leaves at the cosine mu[i] per radiance that comes in at mu[j] and unit of it; azimuths are averaged over.
typedef double matrix[SIZE][SIZE];

typedef struct slab {
    double mu[SIZE], weight[SIZE]; // the beam's is 0
    double direct[SIZE];           // transmittance
    matrix r, t;                   // reflection and diffuse transmission
} slab;

// Gauss-Legendre points on (0, 1) by Newton's method.
static void gauss(double x[N], double w[N])
{
    for (int i = 0; i < N; i++) {
        double z = cos(PI * (i + 0.75) / (N + 0.5)), slope = 1;
        for (int step = 0; step < 20; step++) {
            double p = 1, before = 0;
            for (int l = 0; l < N; l++) {
                const double next = ((2 * l + 1) * z * p - l * before) / (l + 1);
                before = p;
                p = next;
            }
            slope = N * (before - z * p) / (1 - z * z);
            z -= p / slope;
        }
        x[i] = 0.5 * (1 + z);
        w[i] = 1 / ((1 - z * z) * slope * slope);
    }
}

// The phase function averaged over azimuth, from mu to nu; its mean over nu is 1.
static double redistribution(const double chi[], double mu, double nu)
{
    double sum = 0, p = 1, p_before = 0, q = 1, q_before = 0;
    for (int l = 0; l < DOUBLING_ORDER; l++) {
        sum += (2 * l + 1) * chi[l] * p * q;
        double next = ((2 * l + 1) * mu * p - l * p_before) / (l + 1);
        p_before = p;
        p = next;
        next = ((2 * l + 1) * nu * q - l * q_before) / (l + 1);
        q_before = q;
        q = next;
    }
    return sum;
}

// One scattering alone, exact in depth.
static void make_thin(slab *s, const double chi[], double tau, double albedo)
{
    for (int i = 0; i < SIZE; i++) {
        s->direct[i] = exp(-tau / s->mu[i]);
        for (int j = 0; j < SIZE; j++) {
            const double a = s->mu[i], b = s->mu[j];
            const double forward = 0.5 * albedo * redistribution(chi, a, b);
            const double back = 0.5 * albedo * redistribution(chi, a, -b);
            s->r[i][j] = -back * b / (a + b) * expm1(-tau * (1 / a + 1 / b));
            const double x = tau * (1 / b - 1 / a); // e^-tau/a - e^-tau/b over a - b
            const double mean = fabs(x) > 1e-9 ? -expm1(-x) / x : 1;
            s->t[i][j] = forward * tau / a * exp(-tau / a) * mean;
        }
    }
}

// a b, with an integral over the cosine between them.
static void times(const slab *s, matrix a, matrix b, matrix out)
{
    for (int i = 0; i < SIZE; i++) {
        for (int j = 0; j < SIZE; j++) {
            double sum = 0;
            for (int k = 0; k < N; k++) {
                sum += a[i][k] * s->weight[k] * b[k][j];
            }
            out[i][j] = sum;
        }
    }
}

// sum_n q^n, n >= 1: solves (1 - q) x = q by elimination with pivots.
static void sum_of_powers(const slab *s, matrix q, matrix x)
{
    double a[SIZE][2 * SIZE];
    for (int i = 0; i < SIZE; i++) {
        for (int j = 0; j < SIZE; j++) {
            a[i][j] = (i == j) - q[i][j] * s->weight[j];
            a[i][SIZE + j] = q[i][j];
        }
    }
    for (int k = 0; k < SIZE; k++) {
        int pivot = k;
        for (int i = k + 1; i < SIZE; i++) {
            pivot = fabs(a[i][k]) > fabs(a[pivot][k]) ? i : pivot;
        }
        for (int j = 0; j < 2 * SIZE; j++) {
            const double held = a[k][j];
            a[k][j] = a[pivot][j];
            a[pivot][j] = held;
        }
        for (int i = 0; i < SIZE; i++) {
            const double factor = i == k ? 0 : a[i][k] / a[k][k];
            for (int j = k; j < 2 * SIZE; j++) {
                a[i][j] -= factor * a[k][j];
            }
        }
    }
    for (int i = 0; i < SIZE; i++) {
        for (int j = 0; j < SIZE; j++) {
            x[i][j] = a[i][SIZE + j] / a[i][i];
        }
    }
}

static void twice(slab *s)
{
    static matrix q, sum, down, up, product, r, t;
    const double *e = s->direct;
    times(s, s->r, s->r, q);
    sum_of_powers(s, q, sum);
    times(s, sum, s->t, product);
    for (int i = 0; i < SIZE; i++) {
        for (int j = 0; j < SIZE; j++) {
            down[i][j] = s->t[i][j] + sum[i][j] * e[j] + product[i][j];
        }
    }
    times(s, s->r, down, product);
    for (int i = 0; i < SIZE; i++) {
        for (int j = 0; j < SIZE; j++) {
            up[i][j] = s->r[i][j] * e[j] + product[i][j];
        }
    }
    times(s, s->t, up, r);
    times(s, s->t, down, t);
    for (int i = 0; i < SIZE; i++) {
        for (int j = 0; j < SIZE; j++) {
            s->r[i][j] += e[i] * up[i][j] + r[i][j];
            s->t[i][j] = e[i] * down[i][j] + s->t[i][j] * e[j] + t[i][j];
        }
    }
    for (int i = 0; i < SIZE; i++) {
        s->direct[i] *= s->direct[i];
    }
}

void doubling_fluxes(const double chi[DOUBLING_ORDER + 1], double tau, double albedo, double mu0,
                     double *reflected, double *transmitted)
{
    static slab s;
    const double f = chi[DOUBLING_ORDER];
    double scaled[DOUBLING_ORDER];
    for (int l = 0; l < DOUBLING_ORDER; l++) {
        scaled[l] = (chi[l] - f) / (1 - f);
    }
    tau *= 1 - albedo * f;
    albedo *= (1 - f) / (1 - albedo * f);
    gauss(s.mu, s.weight);
    s.mu[N] = mu0;
    s.weight[N] = 0;
    int doublings = 0;
    while (ldexp(tau, -doublings) > 1e-7) {
        doublings++;
    }
    make_thin(&s, scaled, ldexp(tau, -doublings), albedo);
    for (int i = 0; i < doublings; i++) {
        twice(&s);
    }
    *reflected = 0;
    *transmitted = s.direct[N];
    for (int i = 0; i < N; i++) {
        *reflected += s.weight[i] * s.mu[i] * s.r[i][N] / mu0;
        *transmitted += s.weight[i] * s.mu[i] * s.t[i][N] / mu0;
    }
}

void doubling_moments(double (*phase)(double theta, const void *user), const void *user,
                      double chi[DOUBLING_ORDER + 1])
{
    const int n = 40000;
    const double end = sqrt(PI);
    memset(chi, 0, (DOUBLING_ORDER + 1) * sizeof *chi);
    for (int i = 1; i <= n; i++) {
        const double root = end * i / n, theta = root * root, mu = cos(theta);
        const int part = i == n ? 1 : i % 2 ? 4 : 2;
        const double w = part * end / n / 3 * 2 * root * 2 * PI * phase(theta, user) * sin(theta);
        double p = 1, before = 0;
        for (int l = 0; l <= DOUBLING_ORDER; l++) {
            chi[l] += w * p;
            const double next = ((2 * l + 1) * mu * p - l * before) / (l + 1);
            before = p;
            p = next;
        }
    }
}
