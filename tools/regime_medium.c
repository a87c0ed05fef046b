// regime_medium.c -- depths, albedo and mean free paths of what is in a box: sums over samples of it.
#include "regime_parts.h"
#include <stdlib.h>

// Samples along the longest side, and the fewest along any.
enum { SAMPLES = 64, MIN_SAMPLES = 8 };

// One column along each axis for every pair of indices along the two others.
typedef struct columns {
    double tau[3][SAMPLES * SAMPLES][3];
    double transport[SAMPLES * SAMPLES * SAMPLES]; // at every point, mean over channels, 1/m
} columns;

typedef struct sums {
    int n[3]; // samples along each axis
    columns *columns;
    double sigma_s[3], sigma_t[3], g[3], emission[3];
    double collisions;         // of the mean over channels, as those below
    double squared, transport; // weighted by extinction
    double scaled[3];          // weighted by the channel's extinction
    double least_g, most_g;
    double densest;
    size_t inside, all;
} sums;

// ---- sampling ---------------------------------------------------------------------------------

// Gives the extinction and the transport extinction of the mean over channels.
static void add_point(const regime_coefficients *k, sums *s, double *transport)
{
    double sigma_t[3], sigma_tr[3];
    for (int c = 0; c < 3; c++) {
        sigma_t[c] = k->sigma_s[c] + k->sigma_a[c];
        sigma_tr[c] = sigma_t[c] - k->g_sigma_s[c];
        s->sigma_s[c] += k->sigma_s[c];
        s->sigma_t[c] += sigma_t[c];
        s->g[c] += k->g_sigma_s[c];
        s->scaled[c] += sigma_t[c] * k->scaled[c];
        s->emission[c] += k->emission[c];
    }
    const double extinction = regime_mean(sigma_t);
    *transport = regime_mean(sigma_tr);
    s->collisions += extinction;
    s->squared += extinction * extinction;
    s->transport += extinction * *transport;
    s->least_g = fmin(s->least_g, k->least_g);
    s->most_g = fmax(s->most_g, k->most_g);
    s->densest = fmax(s->densest, extinction);
    s->inside += extinction > 0;
}

static void sample_point(const regime_media *m, const regime_box *b, const int at[3], sums *s)
{
    double world[3], transport;
    regime_coefficients k;
    for (int a = 0; a < 3; a++) {
        world[a] = b->origin[a];
        for (int i = 0; i < 3; i++) {
            world[a] += (at[i] + 0.5) / s->n[i] * b->edge[i][a];
        }
    }
    s->all++;
    if (!regime_media_at(m, world, &k)) {
        return;
    }
    add_point(&k, s, &transport);
    s->columns->transport[(at[2] * SAMPLES + at[1]) * SAMPLES + at[0]] = transport;
    const int column[3] = {at[2] * SAMPLES + at[1], at[2] * SAMPLES + at[0],
                           at[1] * SAMPLES + at[0]};
    for (int a = 0; a < 3; a++) {
        for (int c = 0; c < 3; c++) {
            s->columns->tau[a][column[a]][c] +=
                (k.sigma_s[c] + k.sigma_a[c]) * b->length[a] / s->n[a];
        }
    }
}

static void sample_box(const regime_media *m, const regime_box *b, sums *s)
{
    const double longest = regime_box_longest(b);
    for (int a = 0; a < 3; a++) {
        const double share = longest > 0 ? b->length[a] / longest : 0;
        s->n[a] = (int)fmin(fmax(round(SAMPLES * share), MIN_SAMPLES), SAMPLES);
    }
    int at[3];
    for (at[2] = 0; at[2] < s->n[2]; at[2]++) {
        for (at[1] = 0; at[1] < s->n[1]; at[1]++) {
            for (at[0] = 0; at[0] < s->n[0]; at[0]++) {
                sample_point(m, b, at, s);
            }
        }
    }
}

// ---- figures ----------------------------------------------------------------------------------

// What a column along an axis has of the box's cross-section.
static double column_area(const regime_box *b, const sums *s, int axis)
{
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    return b->length[u] / s->n[u] * (b->length[v] / s->n[v]);
}

// Means over columns that meet the medium, by their areas: of a convex homogeneous body that is the mean over all
// straight ways through it along the axes, as light from everywhere goes.
static void depths(const regime_box *b, const sums *s, regime *r)
{
    double all[3] = {0}, areas = 0;
    for (int a = 0; a < 3; a++) {
        const double area = column_area(b, s, a);
        double sum[3] = {0};
        size_t num = 0;
        for (int i = 0; i < SAMPLES * SAMPLES && !b->repeat[a]; i++) {
            const double *tau = s->columns->tau[a][i], mean = regime_mean(tau);
            for (int c = 0; c < 3; c++) {
                sum[c] += tau[c];
            }
            num += mean > 0;
            r->depth_deepest = fmax(r->depth_deepest, mean);
        }
        r->depth_axis[a] = num ? regime_mean(sum) / (double)num : 0;
        r->depth_densest = fmax(r->depth_densest, r->depth_axis[a]);
        for (int c = 0; c < 3; c++) {
            all[c] += area * sum[c];
        }
        areas += area * (double)num;
    }
    for (int c = 0; c < 3; c++) {
        r->depth_rgb[c] = areas > 0 ? all[c] / areas : 0;
    }
    r->optical_depth = regime_mean(r->depth_rgb);
}

// Mean transport extinction of the samples from `at` on that are in one lattice cell.
static double of_cell(const sums *s, const int at[3], const int step[3])
{
    double sum = 0;
    int num = 0;
    for (int z = at[2]; z < at[2] + step[2] && z < s->n[2]; z++) {
        for (int y = at[1]; y < at[1] + step[1] && y < s->n[1]; y++) {
            for (int x = at[0]; x < at[0] + step[0] && x < s->n[0]; x++) {
                sum += s->columns->transport[(z * SAMPLES + y) * SAMPLES + x];
                num++;
            }
        }
    }
    return sum / num;
}

// Transport extinction of the densest lattice cell.
static double densest_cell(const regime_box *b, const sums *s, double cell)
{
    int step[3], at[3];
    for (int a = 0; a < 3; a++) {
        const double samples = b->length[a] > 0 ? s->n[a] * cell / b->length[a] : 1;
        step[a] = (int)fmin(fmax(round(samples), 1), s->n[a]);
    }
    double densest = 0;
    for (at[2] = 0; at[2] < s->n[2]; at[2] += step[2]) {
        for (at[1] = 0; at[1] < s->n[1]; at[1] += step[1]) {
            for (at[0] = 0; at[0] < s->n[0]; at[0] += step[0]) {
                densest = fmax(densest, of_cell(s, at, step));
            }
        }
    }
    return densest;
}

static void box_figures(const regime_box *b, regime *r)
{
    const double longest = regime_box_longest(b);
    double thickness = INFINITY;
    r->cell = longest / REGIME_LATTICE_CELLS;
    r->box_share = 1;
    for (int a = 0; a < 3; a++) {
        r->sides[a] = b->length[a];
        thickness = b->repeat[a] ? thickness : fmin(thickness, b->length[a]);
        r->box_share *= b->length[a] > 0 ? b->length[a] / longest : 1;
    }
    r->thickness = isfinite(thickness) ? thickness : longest;
}

static void medium_figures(const regime_box *b, const sums *s, regime *r)
{
    depths(b, s, r);
    for (int c = 0; c < 3; c++) {
        r->albedo_rgb[c] = s->sigma_t[c] > 0 ? s->sigma_s[c] / s->sigma_t[c] : 0;
        r->g_rgb[c] = s->sigma_s[c] > 0 ? s->g[c] / s->sigma_s[c] : 0;
    }
    const double scattering = regime_mean(s->sigma_s), extinction = regime_mean(s->sigma_t);
    r->albedo = extinction > 0 ? scattering / extinction : 0;
    r->g = scattering > 0 ? regime_mean(s->g) / scattering : 0;
    r->fill = (double)s->inside / (double)s->all;
    if (s->collisions > 0) {
        const double transport = s->transport / s->collisions;
        double scaled = 0;
        for (int c = 0; c < 3; c++) {
            scaled = s->sigma_t[c] > 0 ? fmax(scaled, s->scaled[c] / s->sigma_t[c]) : scaled;
        }
        r->mean_free_path = s->collisions / s->squared;
        r->transport_mean_free_path = transport > 0 ? 1 / transport : 0;
        r->scaled_mean_free_path = scaled > 0 ? 1 / scaled : 0;
        r->cell_depth = r->cell * transport;
        r->cell_depth_max = r->cell * densest_cell(b, s, r->cell);
        r->contrast = s->densest * (double)s->inside / s->collisions;
    }
    if (scattering > 0) {
        r->least_g = s->least_g;
        r->most_g = s->most_g;
    }
}

bool regime_of_medium(const regime_media *m, const regime_box *b, regime *r, double emitted[3])
{
    sums s = {.columns = calloc(1, sizeof *s.columns), .least_g = 1, .most_g = -1};
    if (!s.columns) {
        return false;
    }
    sample_box(m, b, &s);
    box_figures(b, r);
    medium_figures(b, &s, r);
    for (int c = 0; c < 3; c++) {
        emitted[c] = s.emission[c] / (double)s.all;
    }
    free(s.columns);
    return true;
}
