// choose_predict.c -- error and time of a run in a scene, from the stored scenes of the most similar regimes.
#include "choose_predict.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

// Four in five predictions stay below the margin; with fewer than so many there is no telling.
static const double quantile = 0.8, margin_unknown = 2;
enum { FEWEST_RESIDUALS = 8 };

// ---- how alike two scenes are -----------------------------------------------------------------

// One figure in which regimes differ: its difference over the one that matters.
static double apart(double a, double b, double scale)
{
    return (a - b) * (a - b) / (scale * scale);
}

static double whiteness(const regime *r) // 1.7 at albedo 1, 0.9 at 0.9, 0.3 at 0.5
{
    return -log10(1.02 - r->albedo);
}

static double lights_apart(const regime *a, const regime *b)
{
    double sum = 0;
    for (int i = 0; i < REGIME_NUM_LIGHTS; i++) {
        sum += 0.5 * fabs(a->share[i] - b->share[i]);
    }
    return sum;
}

static bool solids(const regime *r)
{
    return r->num_triangles > 0;
}

double choose_distance(const regime *a, const regime *b)
{
    double sum = 0;
    sum += apart(log10(a->optical_depth + 0.1), log10(b->optical_depth + 0.1), 0.6);
    sum += apart(log10(a->view_depth + 0.1), log10(b->view_depth + 0.1), 1);
    sum += apart(log10(a->cell_depth_max + 0.05), log10(b->cell_depth_max + 0.05), 0.5);
    sum += apart(whiteness(a), whiteness(b), 0.7);
    sum += apart(a->g, b->g, 0.3);
    sum += apart(lights_apart(a, b), 0, 0.5);
    sum += apart(log10(a->contrast + 1), log10(b->contrast + 1), 0.7);
    sum += apart(log10(a->num_lamps + 1.0), log10(b->num_lamps + 1.0), 1);
    sum += apart(solids(a), solids(b), 0.4);
    sum += apart(a->camera_inside, b->camera_inside, 1);
    sum += apart(a->periodic, b->periodic, 1);
    return sqrt(sum);
}

// The same for what a frame costs.
static double cost_distance(const regime *a, const regime *b)
{
    double sum = 0;
    sum += apart(solids(a), solids(b), 0.3);
    sum += apart(log10(a->num_lamps + 1.0), log10(b->num_lamps + 1.0), 0.4);
    sum += apart(a->num_suns > 0, b->num_suns > 0, 0.7);
    sum += apart(a->share[REGIME_MAP] > 0, b->share[REGIME_MAP] > 0, 0.7);
    sum += apart(a->share[REGIME_SURFACES] > 0, b->share[REGIME_SURFACES] > 0, 0.7);
    sum += apart(log10((double)a->voxels + 3e4), log10((double)b->voxels + 3e4), 1);
    sum += apart(log10(a->view_depth + 0.3), log10(b->view_depth + 0.3), 0.5);
    sum += apart(regime_multiple(a), regime_multiple(b), 0.3);
    sum += apart(log10(a->num_triangles + 100.0), log10(b->num_triangles + 100.0), 1);
    sum += apart(a->fill, b->fill, 0.7);
    return sqrt(sum);
}

// A sky that is seen beside the medium and through it is right in every method. What the medium sends is as bright as
// the sky where it scatters all that it gets, brighter where suns shine as well. (Shares of sample scenes, estimated
// and measured: smoke-sky 0.42, 0.39; cloud-sunset 0.34, 0.32; plume-contrast 0.08, 0.07; milk 0.37, 0.47.)
double share_of_medium(const regime *r)
{
    const double sky = r->share[REGIME_SKY] + r->share[REGIME_MAP];
    if (r->num_triangles || !(sky > 0)) {
        return 1;
    }
    const double opaque = r->view_fill * (1 - exp(-r->view_depth));
    const double brightness = r->albedo * r->albedo * r->albedo / sqrt(sky);
    return fmax(opaque * brightness / (opaque * brightness + 1 - opaque), 0.01);
}

// What a frame costs whatever its pixels: of methods that do not sample a solve on a lattice, about, besides the
// settings.
static double fixed_work(const regime *r, uint32_t spp)
{
    return spp ? 1 : 0.5 + r->channels * r->box_share;
}

// The part of the picture that costs. Surfaces are everywhere.
static double costly(const regime *r)
{
    return r->num_triangles ? 1 : fmax(r->view_fill, 0.05);
}

// Scatterings of a path, about: 1 / (1 - the chance of another one).
static double scatterings(const regime *r)
{
    return 1 / (1 - fmin(regime_multiple(r), 0.999));
}

// What a sample of a path costs grows with them, though less than in proportion: paths that scatter often do so in
// a few pixels. (Power by trial: of stored times predicted from other scenes the fewest are off by more than twice.)
static double work_of_pixels(const regime *r, uint32_t spp)
{
    return costly(r) * (spp ? pow(scatterings(r), 0.7) : 1);
}

// Its noise grows with them and with the narrowness of the lobe, which few scatterings point at a light. (Powers by
// trial: of sixteen scenes and `milk`, each predicted from the others, RMS of logarithms 0.39, and 0.62 without. Of
// backward peaks: cubes of depth 1 to 10, g -0.7 to -0.99.)
static double noise_of(const regime *r, uint32_t spp)
{
    const double lobe = fmax(1 - fabs(r->g), 1e-3);
    return spp ? pow(scatterings(r), 1.0 / 3) * pow(lobe, r->g < 0 ? -0.8 : -2.0 / 3) : 1;
}

// By how much more noise is left in blocks of 8x8 pixels, as blocks at the edges of what is seen are not full: a
// square of that area lies in blocks that are together about 8 pixels longer and wider.
static double noise_of_edges(const regime *r, uint32_t spp, double pixels, bool by_pixel)
{
    const double side = sqrt(costly(r) * pixels);
    return spp && !by_pixel ? (side + 8) / side : 1;
}

// ---- a run in a scene -------------------------------------------------------------------------

typedef struct figures {
    double error, fixed_ms, pixel_ms; // logarithms
} figures;

static double error_of(const fronts_run *run, bool by_pixel)
{
    return by_pixel ? run->error_pixel : run->error;
}

static figures figures_of(const fronts_run *run, bool by_pixel)
{
    return (figures){log(error_of(run, by_pixel)), log(run->fixed_ms + 1e-3),
                     log(run->pixel_ms + 1e-9)};
}

// Of a method that samples: between two of its runs on a straight line of logarithms, beyond them by the
// rule: noise falls with the root of the samples, time grows with them.
static figures between(const fronts_run *a, const fronts_run *b, double spp, bool by_pixel)
{
    if (!b) {
        const double by = log(spp / a->spp);
        figures v = figures_of(a, by_pixel);
        v.error -= 0.5 * by;
        v.pixel_ms += by;
        return v;
    }
    const double t = log(spp / a->spp) / log((double)b->spp / a->spp);
    const figures u = figures_of(a, by_pixel), v = figures_of(b, by_pixel);
    return (figures){u.error + t * (v.error - u.error), u.fixed_ms + t * (v.fixed_ms - u.fixed_ms),
                     u.pixel_ms + t * (v.pixel_ms - u.pixel_ms)};
}

// False: the scene has no such run.
static bool find(const fronts_scene *scene, const char *key, uint32_t spp, bool by_pixel,
                 figures *out)
{
    const fronts_run *below = NULL, *above = NULL;
    for (uint32_t i = 0; i < scene->num_runs; i++) {
        const fronts_run *run = &scene->runs[i];
        if (strcmp(run->key, key) != 0 || (run->spp > 0) != (spp > 0) ||
            !(error_of(run, by_pixel) > 0)) {
            continue;
        }
        if (run->spp <= spp && (!below || run->spp > below->spp)) {
            below = run;
        }
        if (run->spp > spp && (!above || run->spp < above->spp)) {
            above = run;
        }
    }
    if (!below && !above) {
        return false;
    }
    *out = spp ? between(below ? below : above, below ? above : NULL, spp, by_pixel)
               : figures_of(below, by_pixel);
    return true;
}

// ---- predictions ------------------------------------------------------------------------------

static int by_distance(const void *a, const void *b)
{
    const neighbour *x = a, *y = b;
    return (x->distance > y->distance) - (x->distance < y->distance);
}

bool neighbours_make(const fronts *f, const regime *r, const fronts_scene *without, bool by_pixel,
                     neighbours *n)
{
    const size_t count = f->num_scenes ? f->num_scenes : 1;
    *n = (neighbours){calloc(count, sizeof *n->error), calloc(count, sizeof *n->cost), 0, by_pixel};
    if (!n->error || !n->cost) {
        return false;
    }
    for (uint32_t i = 0; i < f->num_scenes; i++) {
        const fronts_scene *s = &f->scenes[i];
        if (s != without) {
            n->error[n->count] = (neighbour){s, choose_distance(r, &s->regime)};
            n->cost[n->count++] = (neighbour){s, cost_distance(r, &s->regime)};
        }
    }
    qsort(n->error, n->count, sizeof *n->error, by_distance);
    qsort(n->cost, n->count, sizeof *n->cost, by_distance);
    return true;
}

void neighbours_finish(neighbours *n)
{
    free(n->error);
    free(n->cost);
}

// The nearest that have the run, weighted with the inverse square of their distance; errors of paths of one
// scattering, times of a lattice and of pixels with something in them. Gives the distance of the nearest, or a
// negative number if none has it.
static double mean_of(const neighbours *n, bool cost, const char *key, uint32_t spp, figures *mean)
{
    const neighbour *list = cost ? n->cost : n->error;
    double weights = 0, nearest = -1;
    uint32_t used = 0;
    *mean = (figures){0};
    for (uint32_t i = 0; i < n->count && used < CHOOSE_NEAREST; i++) {
        figures v;
        if (find(list[i].scene, key, spp, n->by_pixel, &v)) {
            const double weight = 1 / (list[i].distance * list[i].distance + 0.01);
            const regime *r = &list[i].scene->regime;
            const double shown = (double)list[i].scene->width * list[i].scene->height;
            mean->error += weight * (v.error - log(noise_of(r, spp)) -
                                     log(noise_of_edges(r, spp, shown, n->by_pixel)));
            mean->fixed_ms += weight * (v.fixed_ms - log(fixed_work(r, spp)));
            mean->pixel_ms += weight * (v.pixel_ms - log(work_of_pixels(r, spp)));
            weights += weight;
            nearest = used++ ? nearest : list[i].distance;
        }
    }
    mean->error /= weights;
    mean->fixed_ms /= weights;
    mean->pixel_ms /= weights;
    return nearest;
}

bool predict(const neighbours *n, const regime *r, const fronts_run *run, uint32_t spp,
             double pixels, prediction *p)
{
    figures error, cost;
    p->error_distance = mean_of(n, false, run->key, spp, &error);
    p->ms_distance = mean_of(n, true, run->key, spp, &cost);
    p->error = exp(error.error) * noise_of(r, spp) * noise_of_edges(r, spp, pixels, n->by_pixel);
    p->fixed_ms = exp(cost.fixed_ms) * fixed_work(r, spp);
    p->pixels_ms = exp(cost.pixel_ms) * work_of_pixels(r, spp) * pixels;
    p->limit = regime_limit_of(r, run->method, run->cells);
    if (p->limit.error > p->error) {
        p->error = p->limit.error;
    } else {
        p->limit = (regime_limit){NULL, 0};
    }
    return p->error_distance >= 0;
}

bool run_is_known(const fronts_scene *scene, const char *key, uint32_t spp, bool by_pixel)
{
    figures unused;
    return find(scene, key, spp, by_pixel, &unused);
}

// ---- how far predictions are off --------------------------------------------------------------

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

// Even the nearest scene is not this one: what a distance of 0 counts as.
static const double closest = 0.3;

static double slope_of(double *slopes, size_t count)
{
    if (count < FEWEST_RESIDUALS) {
        return log(margin_unknown);
    }
    qsort(slopes, count, sizeof *slopes, by_value);
    return fmax(0, slopes[(size_t)(quantile * (double)(count - 1))]);
}

double margin_at(double slope, double distance)
{
    return exp(slope * (closest + distance));
}

static size_t num_runs(const fronts *f)
{
    size_t count = 0;
    for (uint32_t i = 0; i < f->num_scenes; i++) {
        count += f->scenes[i].num_runs;
    }
    return count;
}

bool margins_find(const fronts *f, const char *method, bool by_pixel, margin_slopes *m)
{
    double *error = calloc(2 * num_runs(f) + 2, sizeof *error);
    double *ms = error ? error + num_runs(f) + 1 : NULL;
    size_t count = 0;
    bool fine = error != NULL;
    for (uint32_t i = 0; i < f->num_scenes && fine; i++) {
        const fronts_scene *s = &f->scenes[i];
        neighbours n;
        fine = neighbours_make(f, &s->regime, s, by_pixel, &n);
        for (uint32_t k = 0; k < s->num_runs && fine; k++) {
            const fronts_run *run = &s->runs[k];
            const double pixels = (double)s->width * s->height;
            prediction p;
            if (strcmp(run->method, method) == 0 &&
                predict(&n, &s->regime, run, run->spp, pixels, &p)) {
                const double took = run->fixed_ms + run->pixel_ms * pixels;
                error[count] =
                    log(error_of(run, by_pixel) / p.error) / (closest + p.error_distance);
                ms[count++] = log(took / (p.fixed_ms + p.pixels_ms)) / (closest + p.ms_distance);
            }
        }
        neighbours_finish(&n);
    }
    if (fine) {
        *m = (margin_slopes){slope_of(error, count), slope_of(ms, count)};
    }
    free(error);
    return fine;
}
