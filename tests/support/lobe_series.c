// lobe_series.c -- forward scattering as series of Legendre polynomials, straight from its definition.
#include "lobe_series.h"
#include <math.h>
#include <stddef.h>

#define PI 3.14159265358979323846

static double phase(double g, double theta)
{
    double s = sin(0.5 * theta);
    return (1 - g * g) / (4 * PI * pow((1 - g) * (1 - g) + 4 * g * s * s, 1.5));
}

static double window(double theta_1, double theta)
{
    double x = theta / theta_1 - 0.5;
    return x <= 0 ? 1 : x >= 1 ? 0 : 1 - x * x * (3 - 2 * x);
}

// sum = 2 pi int p h dmu; with `s` also the moments. Simpson in theta^(1/2), even over peak and tail.
static double integrate_lobe(double g, double theta_1, lobe_series *s)
{
    const int n = 6000;
    double total = 0, end = sqrt(1.5 * theta_1);
    for (int q = 1; q <= n; q++) {
        double root = end * q / n, theta = root * root, mu = cos(theta);
        double w = (q == n  ? 1
                    : q % 2 ? 4
                            : 2) *
                   end / n / 3 * 2 * root * 2 * PI * phase(g, theta) * window(theta_1, theta) *
                   sin(theta);
        total += w;
        double before = 1, p = mu;
        for (int l = 0; s && l < s->terms; l++) {
            s->lobe[l] += w * before;
            double next = ((2 * l + 3) * mu * p - (l + 1) * before) / (l + 2);
            before = p;
            p = next;
        }
    }
    return total;
}

void lobe_series_make(lobe_series *s, double g)
{
    *s = (lobe_series){.g = g, .f = g > 0 ? g * g : 0, .terms = (int)(12 / (1 - fabs(g))) + 64};
    if (s->f > 0) {
        double lo = 0, hi = 2;
        for (int i = 0; i < 45; i++) { // half width that holds the fraction f
            double middle = 0.5 * (lo + hi);
            *(integrate_lobe(g, middle, NULL) < s->f ? &lo : &hi) = middle;
        }
        integrate_lobe(g, lo, s);
    }
    double power = 1;
    for (int l = 0; l < s->terms; l++, power *= g) {
        s->rest[l] = power - s->lobe[l];
    }
}

void lobe_cone(double part, int terms, double *c)
{
    double x = 1 - 2 * part, before = 1, p = x;
    c[0] = 1;
    for (int l = 1; l < terms; l++) {
        double next = ((2 * l + 1) * x * p - l * before) / (l + 1);
        c[l] = part > 0 ? (before - next) / ((2 * l + 1) * (1 - x)) : 1;
        before = p;
        p = next;
    }
}

double lobe_kernel(const lobe_series *s, const double *c, double tau, double mu)
{
    double before = 1, p = mu, sum = 0;
    for (int l = 0; l < s->terms; l++) {
        sum +=
            (2 * l + 1) / (4 * PI) * before * c[l] * s->rest[l] * exp(-tau * (s->f - s->lobe[l]));
        double next = ((2 * l + 3) * mu * p - (l + 1) * before) / (l + 2);
        before = p;
        p = next;
    }
    return sum / (1 - s->f);
}
