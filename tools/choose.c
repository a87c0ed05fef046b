// choose.c -- method and settings for an error or a time asked for, from stored measurements.
#include "choose_predict.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct candidate {
    const fronts_run *run;
    uint32_t spp;
    prediction p;
    double ms; // on the device at hand
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
    double pixels, share; // of the light that errors are relative to, what the medium sends
} chooser;

static bool meets_error(const chooser *c, const candidate *k)
{
    return isnan(c->request->max_error) || k->p.error * error_margin(k) <= c->request->max_error;
}

static bool meets_budget(const chooser *c, const candidate *k)
{
    return isnan(c->request->budget_ms) || k->ms * ms_margin(k) <= c->request->budget_ms;
}

static double ms_of(const prediction *p, uint32_t spp, const paces *slowness)
{
    return p->fixed_ms * slowness->solve_ms +
           p->pixels_ms * (spp ? slowness->sample_ns : slowness->pixel_ns);
}

static bool predict_candidate(const chooser *c, candidate *k, uint32_t spp)
{
    k->spp = spp;
    if (!predict(&c->near, c->regime, k->run, spp, c->pixels, &k->p)) {
        return false;
    }
    k->p.error *= c->share;
    k->ms = ms_of(&k->p, spp, &c->request->slowness);
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

// Errors of up to so many times the least one are alike: of those the fastest is best.
static const double alike = 1.02;

static double bounded_error(const candidate *k)
{
    return k->p.error * error_margin(k);
}

static bool meets(const chooser *c, const candidate *k)
{
    return !isnan(c->request->budget_ms) ? meets_budget(c, k) : meets_error(c, k);
}

// Within the budget, or where no error is low enough.
static bool judged_by_error(const chooser *c, const candidate *k)
{
    return !isnan(c->request->budget_ms) == meets(c, k);
}

// Is `a` the better answer, where the least error is `least` (0: not known yet)?
static bool better(const chooser *c, const candidate *a, const candidate *b, double least)
{
    if (meets(c, a) != meets(c, b)) {
        return meets(c, a);
    }
    const double ea = bounded_error(a), eb = bounded_error(b);
    if (judged_by_error(c, a) && fmax(ea, eb) > alike * least) {
        return ea < eb;
    }
    return a->ms * ms_margin(a) < b->ms * ms_margin(b);
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

// The best of all runs, without those of a method (NULL: of all), as `better` has it. False: there is none, or no memory.
static bool look_for_best(const chooser *c, const char *without, double least, candidate *best)
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
                if (!margins_find(f, margins_of, c->request->by_pixel, &k.slopes)) {
                    return false;
                }
            }
            const bool known = k.run->spp ? set_samples(c, &k) : predict_candidate(c, &k, 0);
            if (known && (!best->run || better(c, &k, best, least))) {
                *best = k;
            }
        }
    }
    return best->run != NULL;
}

static bool best_of(const chooser *c, const char *without, candidate *best)
{
    return look_for_best(c, without, 0, best) &&
           (!judged_by_error(c, best) || look_for_best(c, without, bounded_error(best), best));
}

bool choose(const fronts *f, const regime *r, const choose_request *request, choice *out)
{
    chooser c = {.fronts = f,
                 .regime = r,
                 .request = request,
                 .pixels = (double)request->width * request->height,
                 .share = request->no_background ? 1 : share_of_medium(r)};
    *out = (choice){0};
    candidate best, other;
    bool found =
        neighbours_make(f, r, NULL, request->by_pixel, &c.near) && best_of(&c, NULL, &best);
    if (found) {
        out->run = best.run;
        out->spp = best.spp;
        out->error = best.p.error;
        out->ms = best.ms;
        out->limit = best.p.limit.key;
        out->error_margin = error_margin(&best);
        out->ms_margin = ms_margin(&best);
        out->error_met = meets_error(&c, &best);
        out->budget_met = meets_budget(&c, &best);
        for (uint32_t i = 0; i < c.near.count && out->num_nearest < CHOOSE_NEAREST; i++) {
            if (run_is_known(c.near.error[i].scene, best.run->key, best.spp, false)) {
                out->nearest[out->num_nearest] = c.near.error[i].scene;
                out->distance[out->num_nearest++] = c.near.error[i].distance;
            }
        }
        if (best_of(&c, best.run->method, &other)) {
            out->other = other.run;
            out->other_error = other.p.error;
            out->other_ms = other.ms;
            out->other_spp = other.spp;
            out->other_limit = other.p.limit.key;
        }
    }
    neighbours_finish(&c.near);
    return found;
}

bool choose_outlook(const fronts *f, const regime *r, const char *method, uint32_t spp,
                    uint32_t width, uint32_t height, double *error, double *ms)
{
    fronts_run as_it_is = {.key = (char *)method, .cells = REGIME_LATTICE_CELLS};
    snprintf(as_it_is.method, sizeof as_it_is.method, "%s", method);
    neighbours n;
    prediction p;
    const bool found = neighbours_make(f, r, NULL, false, &n) &&
                       predict(&n, r, &as_it_is, spp, (double)width * height, &p);
    neighbours_finish(&n);
    if (found) {
        *error = p.error * share_of_medium(r);
        *ms = p.fixed_ms + p.pixels_ms;
    }
    return found;
}
