// phase.c -- the parameters of the phase function, its mean cosine, its forward part and its Legendre moments.
#include "scene/phase.h"
#include "scene/phase_table.h"
#include <math.h>
#include <string.h>

static const double g_min = 1e-3; // below it there is no lobe worth splitting off

// ---- parameters -----------------------------------------------------------------------------------

const tyn_phase_parameter *tyn_phase_parameters(void)
{
    static const float limit = 0.99999994f; // the largest float below 1
    static const tyn_phase_parameter list[] = {
        {"g", "anisotropy", "mean cosine", "between -1 and 1, both excluded", -limit, limit,
         offsetof(tyn_phase, g)},
        {NULL},
    };
    return list;
}

void tyn_phase_get(const tyn_phase phase[3], const tyn_phase_parameter *p, float values[3])
{
    for (int c = 0; phase && p && values && c < 3; c++) {
        memcpy(&values[c], (const char *)&phase[c] + p->offset, sizeof values[c]);
    }
}

void tyn_phase_set(tyn_phase phase[3], const tyn_phase_parameter *p, const float values[3])
{
    for (int c = 0; phase && p && values && c < 3; c++) {
        phase[c] = phase[c].table ? (tyn_phase){.g = phase[c].g} : phase[c]; // a lobe from now on
        memcpy((char *)&phase[c] + p->offset, &values[c], sizeof values[c]);
    }
}

tyn_result tyn_phase_check(const tyn_phase phase[3], const char *of, const tyn_log *log)
{
    for (const tyn_phase_parameter *p = tyn_phase_parameters(); p->name; p++) {
        float values[3];
        tyn_phase_get(phase, p, values);
        for (int c = 0; c < 3; c++) {
            if (!(values[c] >= p->lo && values[c] <= p->hi)) {
                return TYN_FAULT(log, TYN_ERR_PARAMS, "%s.%s[%d] = %g: must be %s", of, p->name, c,
                                 values[c], p->right);
            }
        }
    }
    return TYN_OK;
}

bool tyn_phase_equal(tyn_phase a, tyn_phase b)
{
    return a.g == b.g && a.table == b.table && a.key == b.key;
}

bool tyn_phase_is_grey(const tyn_phase phase[3])
{
    return tyn_phase_equal(phase[0], phase[1]) && tyn_phase_equal(phase[1], phase[2]);
}

// ---- mean cosine and delta scaling ----------------------------------------------------------------

tyn_phase tyn_phase_of_mean_cosine(float g)
{
    return (tyn_phase){.g = g};
}

double tyn_phase_mean_cosine(tyn_phase phase)
{
    return phase.g;
}

double tyn_phase_delta_fraction(tyn_phase phase)
{
    const double g = phase.g;
    return phase.table ? (double)phase.delta : g > 0 ? g * g : 0;
}

double tyn_phase_narrowness(tyn_phase phase)
{
    const double forward = (double)phase.forward, backward = (double)phase.backward;
    return phase.table ? fmax(forward, backward) : fabs(phase.g);
}

bool tyn_phase_has_lobe(tyn_phase phase)
{
    return phase.table ? (double)phase.delta > g_min * g_min : phase.g > g_min;
}

tyn_phase tyn_phase_resolved(tyn_phase phase)
{
    return phase.table ? phase : (tyn_phase){.g = fminf(phase.g, (float)TYN_PHASE_NARROWEST)};
}

// ---- the forward lobe -----------------------------------------------------------------------------
//
// The lobe is p h with the window h(theta) = 1 inside theta_1 / 2, 0 outside 3 theta_1 / 2, smoothstep between; theta_1
// is such that it holds the part f of the scattering.

enum { POINTS = 8 };

// Gauss-Legendre points and weights on [-1, 1] by Newton's method.
static void gauss_legendre(double x[POINTS], double w[POINTS])
{
    for (int i = 0; i < POINTS; i++) {
        double z = cos(M_PI * (i + 0.75) / (POINTS + 0.5)), slope = 1;
        for (int newton = 0; newton < 8; newton++) {
            double p = 1, before = 0;
            for (int l = 0; l < POINTS; l++) {
                double next = ((2 * l + 1) * z * p - l * before) / (l + 1);
                before = p;
                p = next;
            }
            slope = POINTS * (before - z * p) / (1 - z * z);
            z -= p / slope;
        }
        x[i] = z;
        w[i] = 2 / ((1 - z * z) * slope * slope);
    }
}

// Fraction of the phase function within theta of the forward direction.
static double fraction_within(double g, double theta)
{
    double s1 = sin(0.5 * theta), one_minus_mu = 2 * s1 * s1;
    double s = sqrt((1 - g) * (1 - g) + 2 * g * one_minus_mu);
    return (1 + g) * one_minus_mu / (s * (s + 1 - g));
}

// theta_1 such that the lobe p h holds the fraction g^2. By parts, int p h = int -h' fraction_within,
// with -h' = 6 x (1 - x), x = theta / theta_1 - 1/2; bisection, as it grows with theta_1.
static double find_theta_1(double g, const double x[POINTS], const double w[POINTS])
{
    double lo = 0, hi = M_PI / 1.5;
    for (int i = 0; i < 50; i++) {
        double theta_1 = 0.5 * (lo + hi), sum = 0;
        for (int panel = 0; panel < 4; panel++) {
            for (int q = 0; q < POINTS; q++) {
                double t = (panel + 0.5 + 0.5 * x[q]) / 4;
                sum += w[q] / 8 * 6 * t * (1 - t) * fraction_within(g, (t + 0.5) * theta_1);
            }
        }
        if (sum < g * g) {
            lo = theta_1;
        } else {
            hi = theta_1;
        }
    }
    return 0.5 * (lo + hi);
}

// Adds 2 pi int p h P_l dmu over [from, to] to moments[l]. Panels are half a lobe's width: the last P_l
// turns about once in one.
static void add_moments(double g, double theta_1, double from, double to, const double x[POINTS],
                        const double w[POINTS], double *moments, uint32_t terms)
{
    uint32_t panels = (uint32_t)ceil((to - from) / fmin(0.5 * (1 - g), 0.25 * (to - from)));
    double half = 0.5 * (to - from) / panels;
    for (uint32_t panel = 0; panel < panels; panel++) {
        double y[POINTS], p[POINTS], d[POINTS] = {0}; // 1 - mu, weight P_l, weight (P_l - P_{l-1})
        for (int q = 0; q < POINTS; q++) {
            double theta = from + half * (2 * panel + 1 + x[q]), s1 = sin(0.5 * theta);
            y[q] = 2 * s1 * s1;
            double s2 = (1 - g) * (1 - g) + 2 * g * y[q];
            double t = fmin(fmax(theta / theta_1 - 0.5, 0), 1), h = 1 - t * t * (3 - 2 * t);
            p[q] = w[q] * half * h * sin(theta) * 0.5 * (1 - g * g) / (s2 * sqrt(s2));
        }
        for (uint32_t l = 0; l < terms; l++) {
            double a = l / (l + 1.0), b = (2 * l + 1) / (l + 1.0), sum = 0;
            for (int q = 0; q < POINTS; q++) {
                sum += p[q];
                d[q] = a * d[q] - b * y[q] * p[q];
                p[q] += d[q];
            }
            moments[l] += sum;
        }
    }
}

double tyn_phase_lobe_moments(const tyn_phase_table *tables, tyn_phase phase, double narrowest,
                              double *moments, uint32_t terms)
{
    double x[POINTS], w[POINTS], g = fmin(phase.g, narrowest);
    for (uint32_t l = 0; l < terms; l++) {
        moments[l] = 0;
    }
    if (phase.table) {
        const tyn_phase_table *table = &tables[phase.table - 1];
        const double window = tyn_phase_table_window(table, (double)phase.delta);
        tyn_phase_table_moments(table, window, moments, terms);
        return window;
    }
    gauss_legendre(x, w);
    double theta_1 = find_theta_1(g, x, w);
    add_moments(g, theta_1, 0, 0.5 * theta_1, x, w, moments, terms);
    add_moments(g, theta_1, 0.5 * theta_1, 1.5 * theta_1, x, w, moments, terms);
    return theta_1;
}

void tyn_phase_moments(const tyn_phase_table *tables, tyn_phase phase, double *moments,
                       uint32_t terms)
{
    double power = 1;
    if (phase.table) {
        memset(moments, 0, terms * sizeof *moments);
        tyn_phase_table_moments(&tables[phase.table - 1], 0, moments, terms);
        return;
    }
    for (uint32_t l = 0; l < terms; l++, power *= fabs(phase.g)) {
        moments[l] = power;
    }
}

// ---- tables ---------------------------------------------------------------------------------------

static tyn_result check_table(const tyn_phase_table *table, uint32_t index, const tyn_log *log)
{
    for (uint32_t k = 0; k < TYN_PHASE_NODES; k++) {
        if (!(table->values[k] >= 0 && table->values[k] <= 1e12f)) {
            return TYN_FAULT(log, TYN_ERR_PARAMS,
                             "phase_tables[%u].values[%u] = %g: must be >= 0 and finite", index, k,
                             table->values[k]);
        }
    }
    const double integral = tyn_phase_table_integral(table);
    if (!(fabs(integral - 1) < 1e-4)) {
        return TYN_FAULT(log, TYN_ERR_PARAMS,
                         "phase_tables[%u]: its integral over the sphere is %.6g: must be 1", index,
                         integral);
    }
    return TYN_OK;
}

tyn_result tyn_phase_check_tables(const tyn_scene *scene, const tyn_log *log)
{
    tyn_phase right[TYN_MAX_PHASE_TABLES];
    for (uint32_t i = 0; i < scene->num_phase_tables; i++) {
        if (check_table(&scene->phase_tables[i], i, log)) {
            return TYN_ERR_PARAMS;
        }
        right[i] = tyn_phase_of_table(&scene->phase_tables[i], i);
    }
    for (uint32_t i = 0; i < 3 * scene->num_media; i++) {
        const tyn_phase *p = &scene->media[i / 3].phase[i % 3];
        const tyn_phase *r = p->table ? &right[p->table - 1] : p;
        if (!(p->g == r->g && p->delta == r->delta && p->forward == r->forward &&
              p->backward == r->backward && p->key == r->key)) {
            return TYN_FAULT(log, TYN_ERR_PARAMS,
                             "media[%u].phase[%u]: not what tyn_scene_add_phase makes of table %u",
                             i / 3, i % 3, p->table);
        }
    }
    return TYN_OK;
}
