// phase_table.c -- phase functions that are tables: their nodes, moments and forward lobes.
//
// Between nodes a table is linear in the cosine. Integrals over the sphere are sums over three points of Gauss in each
// interval, exact for polynomials of the fourth degree times the table.
#include "scene/phase_table.h"
#include <tyndall/extend/hash.h>
#include <math.h>

enum { POINTS = 3, INTERVALS = TYN_PHASE_NODES - 1 };

static const double gauss_x[POINTS] = {0.11270166537925831, 0.5, 0.88729833462074169};
static const double gauss_w[POINTS] = {5.0 / 18, 8.0 / 18, 5.0 / 18};

// tan(theta / 4) of a node.
static double quarter_tangent(uint32_t node)
{
    const double t = node / (double)INTERVALS;
    return t * t * t * t;
}

double tyn_phase_node_angle(uint32_t node)
{
    return 4 * atan(quarter_tangent(node));
}

double tyn_phase_node_away(uint32_t node)
{
    const double q = quarter_tangent(node), half_sine = 2 * q / (1 + q * q);
    return 2 * half_sine * half_sine;
}

// ---- integrals --------------------------------------------------------------------------------

// The points of an interval: 1 - mu, and what they hold of the scattering.
static void points_of(const tyn_phase_table *t, uint32_t interval, double y[POINTS],
                      double held[POINTS])
{
    const double from = tyn_phase_node_away(interval), to = tyn_phase_node_away(interval + 1);
    const double a = (double)t->values[interval], b = (double)t->values[interval + 1];
    for (int i = 0; i < POINTS; i++) {
        y[i] = from + gauss_x[i] * (to - from);
        held[i] = 2 * M_PI * gauss_w[i] * (to - from) * (a + gauss_x[i] * (b - a));
    }
}

// Of the interval below a node; linear, so the trapezium is exact.
static double held_below(const tyn_phase_table *t, uint32_t node)
{
    const double width = tyn_phase_node_away(node) - tyn_phase_node_away(node - 1);
    return M_PI * width * ((double)t->values[node - 1] + (double)t->values[node]);
}

double tyn_phase_table_integral(const tyn_phase_table *t)
{
    double sum = 0;
    for (uint32_t k = 1; k < TYN_PHASE_NODES; k++) {
        sum += held_below(t, k);
    }
    return sum;
}

void tyn_phase_table_rows(const tyn_phase_table *t, float rows[TYN_PHASE_NODES][4])
{
    const double all = tyn_phase_table_integral(t);
    double below = 0;
    for (uint32_t k = 0; k < TYN_PHASE_NODES; k++) {
        below += k > 0 ? held_below(t, k) : 0;
        rows[k][0] = (float)tyn_phase_node_away(k);
        rows[k][1] = t->values[k];
        rows[k][2] = (float)fmin(below / all, 1);
        rows[k][3] = 0;
    }
}

// h of the forward lobe: 1 inside theta_1 / 2, 0 outside 3 theta_1 / 2, smoothstep between; 1 without a window.
static double window(double theta_1, double y)
{
    if (theta_1 <= 0) {
        return 1;
    }
    const double theta = 2 * asin(fmin(sqrt(0.5 * y), 1));
    const double x = fmin(fmax(theta / theta_1 - 0.5, 0), 1);
    return 1 - x * x * (3 - 2 * x);
}

double tyn_phase_table_window(const tyn_phase_table *t, double f)
{
    double lo = 0, hi = M_PI / 1.5;
    for (int i = 0; i < 40; i++) { // the lobe grows with theta_1
        const double theta_1 = 0.5 * (lo + hi);
        double sum = 0, y[POINTS], held[POINTS];
        for (uint32_t k = 0; k < INTERVALS && tyn_phase_node_angle(k) < 1.5 * theta_1; k++) {
            points_of(t, k, y, held);
            for (int j = 0; j < POINTS; j++) {
                sum += held[j] * window(theta_1, y[j]);
            }
        }
        if (sum < f) {
            lo = theta_1;
        } else {
            hi = theta_1;
        }
    }
    return 0.5 * (lo + hi);
}

// P_l by its differences in y = 1 - mu, which keep their digits near y = 0 (scatter_lut_sum.comp).
void tyn_phase_table_moments(const tyn_phase_table *t, double theta_1, double *moments,
                             uint32_t terms)
{
    enum { AT_ONCE = 8 }; // intervals
    for (uint32_t first = 0; first < INTERVALS; first += AT_ONCE) {
        if (theta_1 > 0 && tyn_phase_node_angle(first) >= 1.5 * theta_1) {
            return;
        }
        double y[AT_ONCE * POINTS] = {0}, p[AT_ONCE * POINTS] = {0}, d[AT_ONCE * POINTS] = {0};
        for (uint32_t k = first; k < first + AT_ONCE && k < INTERVALS; k++) {
            const uint32_t at = (k - first) * POINTS;
            points_of(t, k, &y[at], &p[at]);
            for (int j = 0; j < POINTS; j++) {
                p[at + j] *= window(theta_1, y[at + j]);
            }
        }
        for (uint32_t l = 0; l < terms; l++) {
            const double a = l / (l + 1.0), b = (2 * l + 1) / (l + 1.0);
            double sum = 0;
            for (int i = 0; i < AT_ONCE * POINTS; i++) {
                sum += p[i];
                d[i] = a * d[i] - b * y[i] * p[i];
                p[i] += d[i];
            }
            moments[l] += sum;
        }
    }
}

// ---- what delta scaling knows of it -----------------------------------------------------------

// f. Of a Henyey-Greenstein lobe the second moment, g^2. Two other things add to the second moment that are no forward peak
// and are left out: what is broad adds next to nothing to the fourth, whose root is g^2 as well; and peaks straight back count
// against the odd moments, so half the sum with the mean of those beside it is what is forward. Of one lobe the last is not
// the least for g > 0, and below 0 for g < 0.
static double delta_of(const double chi[5])
{
    const double broad = sqrt(fmax(chi[4], 0)), forward = 0.5 * (chi[2] + 0.5 * (chi[1] + chi[3]));
    const double f = fmin(fmin(chi[2], broad), forward);
    return f > 1e-3 ? fmin(f, 0.9999) : 0; // less is next to no peak, or rounding
}

// g of a Henyey-Greenstein lobe that is as high at its peak: (1 + g) / (1 - g)^2 = 4 pi p.
static double lobe_as_high_as(double p)
{
    const double q = 4 * M_PI * p;
    return q > 1 ? fmin(1 - (sqrt(1 + 8 * q) - 1) / (2 * q), 0.9999) : 0;
}

tyn_phase tyn_phase_of_table(const tyn_phase_table *t, uint32_t index)
{
    double chi[5] = {0};
    tyn_phase_table_moments(t, 0, chi, 5);
    const uint64_t hash = tyn_hash_bytes(TYN_HASH_SEED, t->values, sizeof t->values);
    return (tyn_phase){.g = (float)chi[1],
                       .table = index + 1,
                       .delta = (float)delta_of(chi),
                       .forward = (float)lobe_as_high_as((double)t->values[0]),
                       .backward = (float)lobe_as_high_as((double)t->values[INTERVALS]),
                       .key = (uint32_t)(hash ^ hash >> 32)};
}
