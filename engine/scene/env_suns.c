// env_suns.c -- finds the suns of an environment map.
//
// Candidates are the brightest cells of a reduced map. Around each, the disc is found at which the
// radiance stops falling; its excess over the ring around it is a sun if it is compact and holds a
// fair share of all light. What the reduced map accepts is measured again on the map itself.
#include "scene/env_suns.h"
#include "scene/matrix.h"
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { REDUCED_WIDTH = 512, REDUCED_HEIGHT = 256, MAX_RINGS = 64, MAX_CANDIDATES = 64 };

static const double min_share = 0.05;        // of the map's power
static const double min_mean_cosine = 0.993; // an angular spread of 6.8 degrees RMS
static const double max_radius = 0.45;       // rad
// What a disc leaves out: how much darker the next ring is, over the disc, as a part of its excess.
// The disc ends where that is `small_rest`; one that ends before `large_rest` cuts through its spot.
static const double small_rest = 0.003, large_rest = 0.03;
static const double visited_radius = 0.14; // rad: nothing else is looked for so near to a failure

static double luminance(const double rgb[3])
{
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

// ---- latitude-longitude images ----------------------------------------------------------------

typedef struct latlong {
    uint32_t width, height;
    const float *rgb;
    const tyn_map_sun *suns; // that have been taken out
    uint32_t num_suns;
    double *sin_azimuth, *cos_azimuth; // of texel centres
    double *tables;
} latlong;

static bool make_tables(latlong *m)
{
    m->tables = malloc(2 * (size_t)m->width * sizeof *m->tables);
    if (!m->tables) {
        return false;
    }
    m->sin_azimuth = m->tables;
    m->cos_azimuth = m->tables + m->width;
    for (uint32_t x = 0; x < m->width; x++) {
        double azimuth = ((x + 0.5) / m->width - 0.5) * 2 * M_PI;
        m->sin_azimuth[x] = sin(azimuth);
        m->cos_azimuth[x] = cos(azimuth);
    }
    return true;
}

typedef struct row_geometry {
    double sin_polar, cos_polar;
    double solid_angle; // of one texel
    double level,
        upright; // integral of the direction over a texel: level * (azimuth's unit vector)
                 // + upright * Y
} row_geometry;

static row_geometry row_at(const latlong *m, uint32_t y)
{
    double top = M_PI * y / m->height, bottom = M_PI * (y + 1) / m->height;
    double step = 2 * M_PI / m->width;
    double st = sin(top), sb = sin(bottom), ct = cos(top), cb = cos(bottom);
    return (row_geometry){
        .sin_polar = sin(M_PI * (y + 0.5) / m->height),
        .cos_polar = cos(M_PI * (y + 0.5) / m->height),
        .solid_angle = (ct - cb) * step,
        .level = 0.5 * ((bottom - sb * cb) - (top - st * ct)) * 2 * sin(0.5 * step),
        .upright = 0.5 * (sb * sb - st * st) * step,
    };
}

static void centre_of(const latlong *m, const row_geometry *row, uint32_t x, double d[3])
{
    d[0] = row->sin_polar * m->sin_azimuth[x];
    d[1] = row->cos_polar;
    d[2] = -row->sin_polar * m->cos_azimuth[x];
}

static double dot_sun(const double a[3], const tyn_map_sun *sun)
{
    return a[0] * sun->direction[0] + a[1] * sun->direction[1] + a[2] * sun->direction[2];
}

// The residual map's texel, whose centre is d.
static void residual(const latlong *m, const double d[3], size_t index, double rgb[3])
{
    for (int c = 0; c < 3; c++) {
        float v = m->rgb[3 * index + (size_t)c];
        rgb[c] = v > 0 && v <= FLT_MAX ? v : 0;
    }
    for (uint32_t i = 0; i < m->num_suns; i++) {
        const tyn_map_sun *sun = &m->suns[i];
        for (int c = 0; dot_sun(d, sun) >= sun->cos_radius && c < 3; c++) {
            rgb[c] = fmin(rgb[c], sun->around[c]);
        }
    }
}

// Rows that a cap touches, and the texels of a row whose centres may lie in it.
static void cap_rows(const latlong *m, const double centre[3], double radius, uint32_t rows[2])
{
    double polar = acos(fmax(-1, fmin(1, centre[1])));
    double first = floor((polar - radius) / M_PI * m->height - 0.5);
    double end = ceil((polar + radius) / M_PI * m->height + 0.5) + 1;
    rows[0] = (uint32_t)fmax(first, 0);
    rows[1] = (uint32_t)fmin(end, m->height);
}

static void cap_columns(const latlong *m, const row_geometry *row, const double centre[3],
                        double cos_radius, uint32_t *first, uint32_t *count)
{
    double level = sqrt(centre[0] * centre[0] + centre[2] * centre[2]) * row->sin_polar;
    double lift = cos_radius - centre[1] * row->cos_polar;
    *first = 0;
    *count = lift <= -level ? m->width : 0;
    if (lift > -level && lift <= level) {
        double half = acos(lift / level) / (2 * M_PI) * m->width + 1;
        double middle = (atan2(centre[0], -centre[2]) / (2 * M_PI) + 0.5) * m->width;
        if (2 * half + 1 >= m->width) {
            *count = m->width;
            return;
        }
        double from = floor(middle - half);
        *first = (uint32_t)(from < 0 ? from + m->width : from) % m->width;
        *count = (uint32_t)(2 * half) + 1;
    }
}

// Calls visit for every texel whose centre lies within the cap.
typedef void (*visit_fn)(void *user, const latlong *m, const row_geometry *row, uint32_t x,
                         size_t index, const double d[3], double cosine);

static void visit_cap(const latlong *m, const double centre[3], double radius, visit_fn visit,
                      void *user)
{
    uint32_t rows[2];
    cap_rows(m, centre, radius, rows);
    double cos_radius = cos(radius);
    for (uint32_t y = rows[0]; y < rows[1]; y++) {
        row_geometry row = row_at(m, y);
        uint32_t first, count;
        cap_columns(m, &row, centre, cos_radius, &first, &count);
        for (uint32_t i = 0; i < count; i++) {
            uint32_t x = (first + i) % m->width;
            double d[3];
            centre_of(m, &row, x, d);
            double cosine = vec_dot(d, centre);
            if (cosine >= cos_radius) {
                visit(user, m, &row, x, (size_t)y * m->width + x, d, cosine);
            }
        }
    }
}

// ---- one sun ----------------------------------------------------------------------------------

typedef struct rings {
    uint32_t count;
    double cos_edges[MAX_RINGS], radius[MAX_RINGS]; // outer
    double power[MAX_RINGS][3];
    double solid_angle[MAX_RINGS];
    double power_cos[MAX_RINGS], solid_angle_cos[MAX_RINGS];
} rings;

static void add_to_ring(void *user, const latlong *m, const row_geometry *row, uint32_t x,
                        size_t index, const double d[3], double cosine)
{
    (void)x;
    rings *r = user;
    uint32_t low = 0, high = r->count - 1; // the first ring that reaches as far
    while (low < high) {
        uint32_t middle = (low + high) / 2;
        if (cosine >= r->cos_edges[middle]) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    double rgb[3];
    residual(m, d, index, rgb);
    for (int c = 0; c < 3; c++) {
        r->power[low][c] += rgb[c] * row->solid_angle;
    }
    r->power_cos[low] += luminance(rgb) * row->solid_angle * cosine;
    r->solid_angle[low] += row->solid_angle;
    r->solid_angle_cos[low] += row->solid_angle * cosine;
}

// Radiance by distance from a centre.
static void fill_rings(const latlong *m, const double centre[3], rings *r)
{
    memset(r, 0, sizeof *r);
    double texel = fmax(M_PI / m->height, 2 * M_PI / m->width);
    for (double radius = 1.2 * texel; r->count < MAX_RINGS;
         radius = fmax(radius + texel, 1.15 * radius)) {
        r->radius[r->count] = fmin(radius, M_PI);
        r->cos_edges[r->count++] = cos(fmin(radius, M_PI));
        if (radius > 1.5 * max_radius) {
            break;
        }
    }
    visit_cap(m, centre, r->radius[r->count - 1], add_to_ring, r);
}

typedef struct spot {
    double centre[3];
    double radius;
    double around[3];
    double power; // luminance of the excess
} spot;

// The smallest disc beyond which the radiance hardly falls any further, else the largest that is
// compact. Radius 0 if no disc is compact, holds `least` power and takes in its spot.
static void choose_disc(const rings *r, double least, spot *s)
{
    double power = 0, solid_angle = 0, power_cos = 0, solid_angle_cos = 0;
    s->radius = 0;
    for (uint32_t k = 0; k + 2 < r->count && r->radius[k] <= max_radius; k++) {
        power += luminance(r->power[k]);
        solid_angle += r->solid_angle[k];
        power_cos += r->power_cos[k];
        solid_angle_cos += r->solid_angle_cos[k];
        if (r->solid_angle[k + 1] <= 0 || r->solid_angle[k + 2] <= 0) {
            continue;
        }
        double around = luminance(r->power[k + 1]) / r->solid_angle[k + 1];
        double beyond = luminance(r->power[k + 2]) / r->solid_angle[k + 2];
        double excess = power - around * solid_angle;
        double excess_cos = power_cos - around * solid_angle_cos;
        double left_out = (around - beyond) * solid_angle;
        if (excess < least || excess_cos < min_mean_cosine * excess ||
            left_out > large_rest * excess) {
            continue;
        }
        s->radius = r->radius[k];
        s->power = excess;
        for (int c = 0; c < 3; c++) {
            s->around[c] = r->power[k + 1][c] / r->solid_angle[k + 1];
        }
        if (left_out < small_rest * excess) {
            return;
        }
    }
}

typedef struct excess_sum {
    const double *around;
    double power[3], vector[3]; // vector: integral of luminance times direction
    double inside, outside;     // cosines of the texel centres next to the disc's edge
    double cos_radius;
} excess_sum;

static void add_excess(void *user, const latlong *m, const row_geometry *row, uint32_t x,
                       size_t index, const double d[3], double cosine)
{
    excess_sum *sum = user;
    if (cosine < sum->cos_radius) {
        sum->outside = fmax(sum->outside, cosine);
        return;
    }
    sum->inside = fmin(sum->inside, cosine);
    double rgb[3];
    residual(m, d, index, rgb);
    for (int c = 0; c < 3; c++) {
        rgb[c] -= fmin(rgb[c], sum->around[c]);
        sum->power[c] += rgb[c] * row->solid_angle;
    }
    double weight = luminance(rgb);
    sum->vector[0] += weight * row->level * m->sin_azimuth[x];
    sum->vector[1] += weight * row->upright;
    sum->vector[2] -= weight * row->level * m->cos_azimuth[x];
}

// Excess of the disc, over the texels whose centres lie in it.
static excess_sum sum_excess(const latlong *m, const double centre[3], double radius,
                             double cos_radius, const double around[3])
{
    excess_sum sum = {
        .around = around, .inside = 1, .outside = cos(radius * 1.1), .cos_radius = cos_radius};
    visit_cap(m, centre, radius * 1.1, add_excess, &sum);
    return sum;
}

// Moves s->centre to the spot's middle; false if there is no sun.
static bool find_spot(const latlong *m, double least, int rounds, spot *s)
{
    for (int round = 0; round < rounds; round++) {
        rings r;
        fill_rings(m, s->centre, &r);
        choose_disc(&r, least, s);
        if (s->radius <= 0) {
            return false;
        }
        excess_sum sum = sum_excess(m, s->centre, s->radius, cos(s->radius), s->around);
        double length = sqrt(vec_dot(sum.vector, sum.vector));
        if (length <= 0) {
            return false;
        }
        for (int a = 0; a < 3; a++) {
            s->centre[a] = sum.vector[a] / length;
        }
    }
    return true;
}

// The sun as everybody will see it: rounded first, then summed, so that sums agree with the rule.
static bool measure_sun(const latlong *m, const spot *s, tyn_map_sun *sun)
{
    double centre[3], around[3];
    for (int a = 0; a < 3; a++) {
        centre[a] = sun->direction[a] = (float)s->centre[a];
        around[a] = sun->around[a] = (float)s->around[a];
    }
    // The edge runs between texel centres, clear of rounding.
    excess_sum sum = sum_excess(m, centre, s->radius, cos(s->radius), around);
    sun->cos_radius = (float)(0.5 * (sum.inside + sum.outside));
    sum = sum_excess(m, centre, s->radius, sun->cos_radius, around);
    double weight = luminance(sum.power);
    double cosine = weight > 0 ? vec_dot(sum.vector, centre) / weight : 0;
    memcpy(sun->irradiance, sum.power, sizeof sun->irradiance);
    sun->mean_cosine = (float)fmin(cosine, 1);
    return cosine >= min_mean_cosine;
}

// ---- the reduced map --------------------------------------------------------------------------

typedef struct reduced {
    latlong map;
    float *rgb;
    double *bright;  // luminance; -1 where nothing more is to be found
    double *columns; // scratch: one row of sums
} reduced;

static void mark_visited(void *user, const latlong *m, const row_geometry *row, uint32_t x,
                         size_t index, const double d[3], double cosine)
{
    (void)m, (void)row, (void)x, (void)d, (void)cosine;
    ((double *)user)[index] = -1;
}

// Rows [first, end) of the reduced map: means over the texels whose centres a cell holds. Adds the
// power of the whole rows to `power`.
static void reduce_rows(const latlong *full, reduced *r, uint32_t first, uint32_t end,
                        double power[3])
{
    const uint32_t w = r->map.width, h = r->map.height;
    for (uint32_t j = first; j < end; j++) {
        uint32_t y0 = (uint32_t)((uint64_t)j * full->height / h);
        uint32_t y1 = (uint32_t)((uint64_t)(j + 1) * full->height / h);
        memset(r->columns, 0, 3 * (size_t)w * sizeof *r->columns);
        double solid_angle = 0;
        for (uint32_t y = y0; y < y1; y++) {
            row_geometry row = row_at(full, y);
            solid_angle += row.solid_angle;
            for (uint32_t i = 0; i < w; i++) {
                uint32_t x0 = (uint32_t)((uint64_t)i * full->width / w);
                uint32_t x1 = (uint32_t)((uint64_t)(i + 1) * full->width / w);
                double sum[3] = {0, 0, 0};
                for (uint32_t x = x0; x < x1; x++) {
                    double d[3], rgb[3];
                    if (full->num_suns) {
                        centre_of(full, &row, x, d);
                    }
                    residual(full, d, (size_t)y * full->width + x, rgb);
                    for (int c = 0; c < 3; c++) {
                        sum[c] += rgb[c];
                    }
                }
                for (int c = 0; c < 3; c++) {
                    r->columns[3 * i + (uint32_t)c] += sum[c] * row.solid_angle;
                    power[c] += sum[c] * row.solid_angle;
                }
            }
        }
        for (uint32_t i = 0; i < w; i++) {
            uint64_t texels = (uint64_t)(i + 1) * full->width / w - (uint64_t)i * full->width / w;
            double mean[3];
            for (uint32_t c = 0; c < 3; c++) {
                mean[c] = r->columns[3 * i + c] / (solid_angle * (double)texels);
                r->rgb[3 * ((size_t)j * w + i) + c] = (float)fmin(mean[c], FLT_MAX);
            }
            double *bright = &r->bright[(size_t)j * w + i];
            *bright = *bright < 0 ? -1 : luminance(mean);
        }
    }
}

static size_t brightest(const reduced *r)
{
    size_t best = 0;
    for (size_t i = 1; i < (size_t)r->map.width * r->map.height; i++) {
        best = r->bright[i] > r->bright[best] ? i : best;
    }
    return best;
}

static void search(latlong *full, reduced *r, tyn_map_light *out)
{
    const double mean = luminance(out->mean), least = min_share * mean * 4 * M_PI;
    // A compact spot of the least share is this many times brighter than the mean.
    const double dimmest = min_share / (1 - min_mean_cosine) * 0.8;
    for (int i = 0; i < MAX_CANDIDATES && out->num_suns < TYN_MAP_SUNS_MAX; i++) {
        size_t cell = brightest(r);
        if (!(mean > 0) || r->bright[cell] < dimmest * mean) {
            return;
        }
        row_geometry row = row_at(&r->map, (uint32_t)(cell / r->map.width));
        double candidate[3];
        centre_of(&r->map, &row, (uint32_t)(cell % r->map.width), candidate);
        spot s;
        memcpy(s.centre, candidate, sizeof s.centre);
        tyn_map_sun *sun = &out->suns[out->num_suns];
        if (find_spot(&r->map, least, 4, &s) && find_spot(full, least, 2, &s) &&
            measure_sun(full, &s, sun)) {
            full->num_suns = ++out->num_suns;
            uint32_t rows[2];
            double power[3] = {0, 0, 0};
            cap_rows(&r->map, s.centre, s.radius, rows);
            reduce_rows(full, r, rows[0], rows[1], power);
        } else {
            visit_cap(&r->map, candidate, visited_radius, mark_visited, r->bright);
            r->bright[cell] = -1;
        }
    }
}

bool tyn_map_light_find(const tyn_environment *env, tyn_map_light *out)
{
    memset(out, 0, sizeof *out);
    if (!env->present || !env->data || !env->size[0] || !env->size[1]) {
        return true;
    }
    latlong full = {env->size[0], env->size[1], env->data, out->suns, 0};
    reduced r = {{env->size[0] < REDUCED_WIDTH ? env->size[0] : REDUCED_WIDTH,
                  env->size[1] < REDUCED_HEIGHT ? env->size[1] : REDUCED_HEIGHT}};
    const size_t cells = (size_t)r.map.width * r.map.height;
    r.rgb = malloc(3 * cells * sizeof *r.rgb);
    r.bright = calloc(cells, sizeof *r.bright);
    r.columns = malloc(3 * (size_t)r.map.width * sizeof *r.columns);
    r.map.rgb = r.rgb;
    bool made = r.rgb && r.bright && r.columns && make_tables(&full) && make_tables(&r.map);
    if (made) {
        double power[3] = {0, 0, 0};
        reduce_rows(&full, &r, 0, r.map.height, power);
        for (int c = 0; c < 3; c++) {
            out->mean[c] = power[c] / (4 * M_PI);
        }
        search(&full, &r, out);
        for (int c = 0; c < 3; c++) {
            double suns = 0;
            for (uint32_t i = 0; i < out->num_suns; i++) {
                suns += out->suns[i].irradiance[c];
            }
            out->sky[c] = fmax(0, out->mean[c] - suns / (4 * M_PI));
        }
    }
    free(full.tables);
    free(r.map.tables);
    free(r.rgb);
    free(r.bright);
    free(r.columns);
    return made;
}
