// propagate_twin.c -- see propagate_twin.h.
#include "propagate_twin.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

double twin_hg_below(double mu, double g)
{
    if (fabs(g) < 1e-4) { // the formula divides by g
        return (1 + mu) / 2 - 0.75 * g * (1 - mu * mu);
    }
    return (1 - g * g) / (2 * g) * (1 / sqrt(1 + g * g - 2 * g * mu) - 1 / (1 + g));
}

double twin_hg(double mu, double g)
{
    return (1 - g * g) / (4 * PI * pow(1 + g * g - 2 * g * mu, 1.5));
}

static double clamp_lobe(double a)
{
    return fmin(fmax(a, -0.995), 0.995);
}

static double mean_exp(double tau)
{
    return tau < 1e-8 ? 1 : -expm1(-tau) / tau;
}

static double across(const twin_grid *t)
{
    return t->across > 0 ? t->across : t->dx;
}

// Fraction of a cell's light that goes `layers` steps along the light (Eqs 2 and 3).
static double fraction(const twin_grid *t, double a, int layers)
{
    double angle = t->cell_cones ? atan(across(t) / t->dx) : PI / 4;
    double front = a >= 1 ? 0 : twin_hg_below(cos(angle), a);
    double back = a >= 1 ? 0 : twin_hg_below(cos(PI - angle), a);
    return layers > 0 ? 1 - front : layers < 0 ? back : (front - back) / 4;
}

// Mean length of the half hops by which a cell hands on its light, in edges along the light.
static double way_out(const twin_grid *t, double a)
{
    double sideways = 4 * fraction(t, a, 0);
    return 0.5 * (1 - sideways + sideways * across(t) / t->dx);
}

static void start(const twin_grid *t, double *light, double *cosine, double *seen)
{
    int layer = t->n[0] * t->n[1];
    for (int column = 0; column < layer; column++) {
        double depth = 0, arrives = 1;
        for (int z = 0; z < t->n[2]; z++) {
            int q = z * layer + column;
            double sigma = t->sigma_a[q] + (t->init == TWIN_ABSORPTION ? 0 : t->sigma_s[q]);
            arrives *= t->lit ? t->lit[q] : 1;
            double beam = arrives * exp(-depth) * mean_exp(sigma * t->dx), g = t->g[q];
            depth += sigma * t->dx;
            cosine[q] = t->mean_cosine;
            seen[q] = 0;
            switch (t->init) {
            case TWIN_ENTRY:
                light[q] = z == 0 ? arrives : 0;
                break;
            case TWIN_FIRST_COLLISION:
                light[q] = beam * t->sigma_s[q] * t->dx;
                cosine[q] = g * t->mean_cosine;
                seen[q] = beam * twin_hg(t->mu[q], clamp_lobe(cosine[q])) +
                          way_out(t, cosine[q]) * light[q] *
                              twin_hg(t->mu[q], clamp_lobe(cosine[q] * (t->last_event ? g : 1)));
                break;
            default:
                light[q] = beam;
                break;
            }
        }
    }
}

static double decay(const twin_grid *t, double g, double tau)
{
    if (tau <= 0) {
        return 1;
    }
    return t->exact_rate || g < 0 ? exp(-(1 - g) * tau) : pow(g, tau);
}

// `way`: the light times the length of its half hops into the cell, in edges along the light.
static void gather(const twin_grid *t, int i, int j, int k, const double *light,
                   const double *cosine, double *sum, double *weighted, double *way)
{
    static const int step[6][3] = {{0, 0, -1}, {0, 0, 1},  {-1, 0, 0},
                                   {1, 0, 0},  {0, -1, 0}, {0, 1, 0}};
    int q = (k * t->n[1] + j) * t->n[0] + i;
    *sum = *weighted = *way = 0;
    for (int s = 0; s < 6; s++) {
        int x = i + step[s][0], y = j + step[s][1], z = k + step[s][2];
        if (x < 0 || y < 0 || z < 0 || x >= t->n[0] || y >= t->n[1] || z >= t->n[2]) {
            continue;
        }
        int p = (z * t->n[1] + y) * t->n[0] + x;
        double scattering = t->sigma_s[p] + t->sigma_s[q];
        double g =
            scattering > 0 ? (t->sigma_s[p] * t->g[p] + t->sigma_s[q] * t->g[q]) / scattering : 0;
        double hop = step[s][2] ? t->dx : across(t);
        double moved = light[p] * exp(-0.5 * (t->sigma_a[p] + t->sigma_a[q]) * hop) *
                       fraction(t, cosine[p], -step[s][2]);
        moved *= t->lit && step[s][2] < 0 ? t->lit[q] : 1;
        *sum += moved;
        *weighted += moved * cosine[p] * decay(t, g, 0.5 * scattering * hop);
        *way += 0.5 * moved * hop / t->dx;
    }
}

void twin_propagate(const twin_grid *t, int iterations, double *light, double *cosine, double *seen)
{
    size_t total = (size_t)t->n[0] * (size_t)t->n[1] * (size_t)t->n[2];
    double *old_light = malloc(total * sizeof *old_light);
    double *old_cosine = malloc(total * sizeof *old_cosine);
    start(t, light, cosine, seen);
    for (int m = 0; m < iterations; m++) {
        memcpy(old_light, light, total * sizeof *light);
        memcpy(old_cosine, cosine, total * sizeof *cosine);
        for (int k = 0, q = 0; k < t->n[2]; k++) {
            for (int j = 0; j < t->n[1]; j++) {
                for (int i = 0; i < t->n[0]; i++, q++) {
                    double sum, weighted, way;
                    gather(t, i, j, k, old_light, old_cosine, &sum, &weighted, &way);
                    light[q] = sum;
                    cosine[q] = sum > 0 ? weighted / sum : 0;
                    double lobe = t->last_event ? t->g[q] * cosine[q] : cosine[q];
                    way += sum * way_out(t, cosine[q]);
                    seen[q] += way * twin_hg(t->mu[q], clamp_lobe(lobe));
                }
            }
        }
    }
    free(old_light);
    free(old_cosine);
}

// ---- reference states ---------------------------------------------------------------------------

static bool read_header(FILE *file, state_record *records, int first[], int layers[], int *num)
{
    char line[256];
    *num = 0;
    if (!fgets(line, sizeof line, file) ||
        strcmp(line, "propagate_rect reference states 1\n") != 0) {
        return false;
    }
    while (fgets(line, sizeof line, file)) {
        state_record *r = &records[*num];
        if (strcmp(line, "end\n") == 0) {
            return true;
        }
        if (line[0] == '#') {
            continue;
        }
        if (*num == STATE_MAX || sscanf(line, "%15s %15s %d %d %d", r->kind, r->name, &r->iteration,
                                        &first[*num], &layers[*num]) != 5) {
            return false;
        }
        r->g = atoi(r->name + strlen(r->name) - 2) / 100.0;
        r->sigma_t = strncmp(r->name, "hom4", 4) == 0 ? 4 : -1;
        ++*num;
    }
    return false;
}

int states_load(state_record **out)
{
    const char *folder = getenv("TYN_TEST_DATA"); // of a tree that was carried elsewhere
    char path[512];
    snprintf(path, sizeof path, "%s/propagate_rect_states.bin", folder ? folder : TYN_TEST_DATA);
    int first[STATE_MAX], layers[STATE_MAX], num = 0;
    state_record *records = calloc(STATE_MAX, sizeof *records);
    FILE *file = fopen(path, "rb");
    bool good = file && records && read_header(file, records, first, layers, &num);
    for (int i = 0; good && i < num; i++) {
        int parts = strcmp(records[i].kind, "state") == 0 ? 2 : 1;
        size_t layer = STATE_CELLS * STATE_CELLS, count = (size_t)layers[i] * layer;
        for (int p = 0; p < parts; p++) {
            good = good &&
                   fread(records[i].values[p] + (size_t)first[i] * layer, 4, count, file) == count;
        }
    }
    if (file) {
        fclose(file);
    }
    if (!good) {
        fprintf(stderr, "%s: not a file of reference states\n", path);
        free(records);
        records = NULL;
        num = 0;
    }
    *out = records;
    return num;
}

const state_record *states_find(const state_record *records, int num, const char *kind,
                                const char *name, int iteration)
{
    for (int i = 0; i < num; i++) {
        if (strcmp(records[i].kind, kind) == 0 && strcmp(records[i].name, name) == 0 &&
            records[i].iteration == iteration) {
            return &records[i];
        }
    }
    return NULL;
}
