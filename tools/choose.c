// choose.c -- method and settings for an error or a time asked for, from stored measurements.
#include "choose.h"
#include <math.h>
#include <stdio.h>
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

// The part of the picture's light that the medium sends, about: a sky that is seen beside it and through it is
// right in every method, and counts in what errors are relative to.
static double of_medium(const regime *r)
{
    const double sky = r->share[REGIME_SKY] + r->share[REGIME_MAP];
    if (r->num_triangles || !(sky > 0)) {
        return 1;
    }
    const double opaque = r->view_fill * (1 - exp(-r->view_depth));
    const double brightness = r->albedo * r->albedo * r->albedo;
    return fmax(opaque * brightness / (opaque * brightness + 1 - opaque), 0.01);
}

// What the solve on a lattice costs, about, besides the settings.
static double lattice_work(const regime *r)
{
    return 0.5 + r->channels * r->box_share;
}

// The part of the picture that costs. Surfaces are everywhere.
static double costly(const regime *r)
{
    return r->num_triangles ? 1 : fmax(r->view_fill, 0.05);
}

// What a sample of a path costs grows with its scatterings, 1 / (1 - the chance of another one), though less than
// in proportion: paths that scatter often do so in a few pixels. (Power by trial: of stored times predicted from
// other scenes the fewest are off by more than twice.)
static double work_of_pixels(const regime *r, uint32_t spp)
{
    const double scatterings = 1 / (1 - fmin(regime_multiple(r), 0.99));
    return costly(r) * (spp ? pow(scatterings, 0.7) : 1);
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

typedef struct neighbour {
    const fronts_scene *scene;
    double distance;
} neighbour;

// Every stored scene by its distance from a regime, in error and in cost.
typedef struct neighbours {
    neighbour *error, *cost;
    uint32_t count;
    bool by_pixel;
} neighbours;

static int by_distance(const void *a, const void *b)
{
    const neighbour *x = a, *y = b;
    return (x->distance > y->distance) - (x->distance < y->distance);
}

static bool neighbours_make(const fronts *f, const regime *r, const fronts_scene *without,
                            bool by_pixel, neighbours *n)
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

static void neighbours_finish(neighbours *n)
{
    free(n->error);
    free(n->cost);
}

// The nearest that have the run, weighted with the inverse square of their distance; errors of the medium's light,
// times of a lattice and of pixels with something in them. Gives the distance of the
// nearest, or a negative number if none has it.
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
            mean->error += weight * (v.error - log(of_medium(r)));
            mean->fixed_ms += weight * (v.fixed_ms - log(lattice_work(r)));
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

typedef struct prediction {
    double error, ms;
    double error_distance, ms_distance; // of the nearest scene it is taken from
} prediction;

static bool predict(const neighbours *n, const regime *r, const char *key, uint32_t spp,
                    double pixels, prediction *p)
{
    figures error, cost;
    p->error_distance = mean_of(n, false, key, spp, &error);
    p->ms_distance = mean_of(n, true, key, spp, &cost);
    p->error = exp(error.error) * of_medium(r);
    p->ms =
        exp(cost.fixed_ms) * lattice_work(r) + exp(cost.pixel_ms) * work_of_pixels(r, spp) * pixels;
    return p->error_distance >= 0;
}

// ---- how far predictions are off --------------------------------------------------------------

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

// Even the nearest scene is not this one: what a distance of 0 counts as.
static const double closest = 0.3;

// How the logarithm of the margin grows with the distance.
typedef struct margin_slopes {
    double error, ms;
} margin_slopes;

static double slope_of(double *slopes, size_t count)
{
    if (count < FEWEST_RESIDUALS) {
        return log(margin_unknown);
    }
    qsort(slopes, count, sizeof *slopes, by_value);
    return fmax(0, slopes[(size_t)(quantile * (double)(count - 1))]);
}

static double margin_at(double slope, double distance)
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

// Each stored run of a method predicted from the other scenes. False: out of memory.
static bool find_margins(const fronts *f, const char *method, bool by_pixel, margin_slopes *m)
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
                predict(&n, &s->regime, run->key, run->spp, pixels, &p)) {
                const double took = run->fixed_ms + run->pixel_ms * pixels;
                error[count] =
                    log(error_of(run, by_pixel) / p.error) / (closest + p.error_distance);
                ms[count++] = log(took / p.ms) / (closest + p.ms_distance);
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

// ---- choosing ---------------------------------------------------------------------------------

typedef struct candidate {
    const fronts_run *run;
    uint32_t spp;
    prediction p;
    margin_slopes slopes;
} candidate;

static double error_margin(const candidate *k)
{
    return margin_at(k->slopes.error, k->p.error_distance);
}

static double ms_margin(const candidate *k)
{
    return margin_at(k->slopes.ms, k->p.ms_distance);
}

typedef struct chooser {
    const fronts *fronts;
    const regime *regime;
    const choose_request *request;
    neighbours near;
    double pixels;
} chooser;

static bool meets_error(const chooser *c, const candidate *k)
{
    return isnan(c->request->max_error) || k->p.error * error_margin(k) <= c->request->max_error;
}

static bool meets_budget(const chooser *c, const candidate *k)
{
    return isnan(c->request->budget_ms) || k->p.ms * ms_margin(k) <= c->request->budget_ms;
}

static bool predict_candidate(const chooser *c, candidate *k, uint32_t spp)
{
    k->spp = spp;
    if (!predict(&c->near, c->regime, k->run->key, spp, c->pixels, &k->p)) {
        return false;
    }
    k->p.ms *= c->request->slowness;
    return true;
}

// As many samples as the budget allows, else as few as the error needs.
static bool set_samples(const chooser *c, candidate *k)
{
    const bool budget = !isnan(c->request->budget_ms);
    uint32_t lo = 1, hi = CHOOSE_MAX_SPP; // lo is within the budget, or too noisy
    bool known = predict_candidate(c, k, hi);
    if (!known || (budget ? meets_budget(c, k) : !meets_error(c, k))) {
        return known;
    }
    known = predict_candidate(c, k, lo);
    if (!known || (budget ? !meets_budget(c, k) : meets_error(c, k))) {
        return known;
    }
    while (hi - lo > 1) {
        const uint32_t middle = lo + (hi - lo) / 2;
        predict_candidate(c, k, middle);
        const bool up = budget ? meets_budget(c, k) : !meets_error(c, k);
        lo = up ? middle : lo;
        hi = up ? hi : middle;
    }
    return predict_candidate(c, k, budget ? lo : hi);
}

// Errors closer than this are alike: then the faster one is better.
static const double alike = 1.02;

// Is `a` the better answer?
static bool better(const chooser *c, const candidate *a, const candidate *b)
{
    const bool budget = !isnan(c->request->budget_ms);
    const bool a_meets = budget ? meets_budget(c, a) : meets_error(c, a);
    const bool b_meets = budget ? meets_budget(c, b) : meets_error(c, b);
    if (a_meets != b_meets) {
        return a_meets;
    }
    const bool by_error = budget == a_meets; // within the budget, or where no error is low enough
    const double ea = a->p.error * error_margin(a), eb = b->p.error * error_margin(b);
    if (by_error && (ea > alike * eb || eb > alike * ea)) {
        return ea < eb;
    }
    return a->p.ms * ms_margin(a) < b->p.ms * ms_margin(b);
}

static bool seen_before(const fronts *f, uint32_t scene, uint32_t run)
{
    for (uint32_t i = 0; i <= scene; i++) {
        const uint32_t end = i < scene ? f->scenes[i].num_runs : run;
        for (uint32_t k = 0; k < end; k++) {
            if (strcmp(f->scenes[i].runs[k].key, f->scenes[scene].runs[run].key) == 0) {
                return true;
            }
        }
    }
    return false;
}

static bool is_allowed(const choose_request *request, const char *method)
{
    char word[32];
    snprintf(word, sizeof word, " %s ", method);
    return (!request->method || strcmp(request->method, method) == 0) &&
           !(request->without && strstr(request->without, word));
}

// The best of all runs, without those of a method (NULL: of all). False: there is none, or no memory.
static bool best_of(const chooser *c, const char *without, candidate *best)
{
    const fronts *f = c->fronts;
    *best = (candidate){0};
    candidate k = {0};
    const char *margins_of = "";
    for (uint32_t i = 0; i < f->num_scenes; i++) {
        for (uint32_t j = 0; j < f->scenes[i].num_runs; j++) {
            k.run = &f->scenes[i].runs[j];
            if (seen_before(f, i, j) || !is_allowed(c->request, k.run->method) ||
                (without && strcmp(k.run->method, without) == 0)) {
                continue;
            }
            if (strcmp(margins_of, k.run->method) != 0) {
                margins_of = k.run->method;
                if (!find_margins(f, margins_of, c->request->by_pixel, &k.slopes)) {
                    return false;
                }
            }
            const bool known = k.run->spp ? set_samples(c, &k) : predict_candidate(c, &k, 0);
            if (known && (!best->run || better(c, &k, best))) {
                *best = k;
            }
        }
    }
    return best->run != NULL;
}

bool choose(const fronts *f, const regime *r, const choose_request *request, choice *out)
{
    chooser c = {.fronts = f,
                 .regime = r,
                 .request = request,
                 .pixels = (double)request->width * request->height};
    *out = (choice){0};
    candidate best, other;
    bool found =
        neighbours_make(f, r, NULL, request->by_pixel, &c.near) && best_of(&c, NULL, &best);
    if (found) {
        out->run = best.run;
        out->spp = best.spp;
        out->error = best.p.error;
        out->ms = best.p.ms;
        out->error_margin = error_margin(&best);
        out->ms_margin = ms_margin(&best);
        out->error_met = meets_error(&c, &best);
        out->budget_met = meets_budget(&c, &best);
        for (uint32_t i = 0; i < c.near.count && out->num_nearest < CHOOSE_NEAREST; i++) {
            figures unused;
            if (find(c.near.error[i].scene, best.run->key, best.spp, false, &unused)) {
                out->nearest[out->num_nearest] = c.near.error[i].scene;
                out->distance[out->num_nearest++] = c.near.error[i].distance;
            }
        }
        if (best_of(&c, best.run->method, &other)) {
            out->other = other.run;
            out->other_error = other.p.error;
            out->other_ms = other.p.ms;
            out->other_spp = other.spp;
        }
    }
    neighbours_finish(&c.near);
    return found;
}

bool choose_outlook(const fronts *f, const regime *r, const char *method, uint32_t spp,
                    uint32_t width, uint32_t height, double *error, double *ms)
{
    neighbours n;
    prediction p;
    const bool found = neighbours_make(f, r, NULL, false, &n) &&
                       predict(&n, r, method, spp, (double)width * height, &p);
    neighbours_finish(&n);
    if (found) {
        *error = p.error;
        *ms = p.ms;
    }
    return found;
}
