// front.c -- what points of error against time say: the Pareto front, the time for an error, who is fastest.
#include "front.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool counts(const front_point *p)
{
    return isfinite(p->ms) && p->ms > 0 && isfinite(p->error) && p->error >= 0;
}

// ---- the front --------------------------------------------------------------------------------

typedef struct ranked {
    double ms, error;
    uint32_t index;
    bool bound;
} ranked;

static int by_time(const void *a, const void *b)
{
    const ranked *x = a, *y = b;
    if (x->ms != y->ms) {
        return x->ms < y->ms ? -1 : 1;
    }
    if (x->error != y->error) {
        return x->error < y->error ? -1 : 1;
    }
    return (x->index > y->index) - (x->index < y->index);
}

// Those of `line` (-1: of all), by time; only what is better than everything faster. NULL: out of memory.
static ranked *envelope(const front_point *points, uint32_t count, int64_t line, uint32_t *num)
{
    ranked *rank = malloc((count ? count : 1) * sizeof *rank);
    uint32_t used = 0, kept = 0;
    for (uint32_t i = 0; rank && i < count; i++) {
        if (counts(&points[i]) && (line < 0 || points[i].line == line)) {
            rank[used++] = (ranked){points[i].ms, points[i].error, i, points[i].bound};
        }
    }
    if (used) {
        qsort(rank, used, sizeof *rank, by_time);
    }
    for (uint32_t i = 0; i < used; i++) {
        if (kept == 0 || rank[i].error < rank[kept - 1].error) {
            rank[kept++] = rank[i];
        }
    }
    *num = kept;
    return rank;
}

uint32_t front_pareto(const front_point *points, uint32_t count, uint32_t *indices)
{
    uint32_t num = 0;
    ranked *front = envelope(points, count, -1, &num);
    for (uint32_t i = 0; i < num; i++) {
        indices[i] = front[i].index;
    }
    free(front);
    return num;
}

// ---- the time for an error --------------------------------------------------------------------

// Noise falls as 1 / sqrt(samples), time grows with samples.
static double by_the_rule(const ranked *p, double error)
{
    return p->ms * (p->error / error) * (p->error / error);
}

static front_time time_of_samples(const ranked *curve, uint32_t num, double error)
{
    if (!(error > 0)) {
        return (front_time){NAN, -1, false};
    }
    if (error > curve[0].error) {
        return (front_time){by_the_rule(&curve[0], error), -1, false};
    }
    for (uint32_t i = 0; i < num; i++) {
        if (curve[i].error > error) {
            continue;
        }
        if (i == 0 || curve[i].error == error || !(curve[i].error > 0)) {
            return (front_time){curve[i].ms, (int32_t)curve[i].index, true};
        }
        const ranked *a = &curve[i - 1], *b = &curve[i];
        if (b->bound) {
            return (front_time){fmin(by_the_rule(a, error), b->ms), -1, true};
        }
        const double share = log(a->error / error) / log(a->error / b->error);
        return (front_time){a->ms * pow(b->ms / a->ms, share), -1, true};
    }
    const ranked *last = &curve[num - 1];
    return (front_time){last->bound ? NAN : by_the_rule(last, error), -1, false};
}

front_time front_time_at(const front_point *points, uint32_t count, uint32_t line, double error)
{
    uint32_t num = 0;
    ranked *curve = envelope(points, count, line, &num);
    front_time time = {NAN, -1, false};
    if (num && points[curve[0].index].sampling) {
        time = time_of_samples(curve, num, error);
    } else {
        for (uint32_t i = 0; i < num && time.point < 0; i++) {
            if (curve[i].error <= error) {
                time = (front_time){curve[i].ms, (int32_t)curve[i].index, true};
            }
        }
    }
    free(curve);
    return time;
}

front_error front_error_at(const front_point *points, uint32_t count, uint32_t line, double ms)
{
    uint32_t num = 0;
    ranked *curve = envelope(points, count, line, &num);
    front_error found = {NAN, false};
    for (uint32_t i = 0; i < num && curve[i].ms <= ms; i++) {
        const ranked *a = &curve[i], *b = i + 1 < num ? a + 1 : NULL;
        if (b && b->ms > ms && a->error > 0 && b->error > 0) {
            const double share = log(ms / a->ms) / log(b->ms / a->ms);
            found = (front_error){a->error * pow(b->error / a->error, share), true};
        } else if (!b) {
            const double error = a->bound ? NAN : a->error * sqrt(a->ms / ms);
            found = a->ms == ms ? (front_error){a->error, true} : (front_error){error, false};
        }
    }
    free(curve);
    return found;
}

// ---- who is fastest ---------------------------------------------------------------------------

// Extrapolation would make a sampling line faster than a single sample of every pixel, or let it reach what
// nobody has seen it reach.
static double feasible_ms(const front_point *points, uint32_t count, uint32_t line, double error)
{
    const front_time time = front_time_at(points, count, line, error);
    if (time.measured || isnan(time.ms)) {
        return time.ms;
    }
    double fastest = INFINITY, least = INFINITY;
    for (uint32_t i = 0; i < count; i++) {
        if (points[i].line == line && counts(&points[i])) {
            fastest = fmin(fastest, points[i].ms);
            least = fmin(least, points[i].error);
        }
    }
    return error < least ? NAN : fastest;
}

static int64_t fastest_line(const front_point *points, uint32_t count, double error)
{
    int64_t best = -1;
    double best_ms = INFINITY;
    for (uint32_t i = 0; i < count; i++) {
        bool seen = false;
        for (uint32_t k = 0; k < i && !seen; k++) {
            seen = points[k].line == points[i].line;
        }
        const double ms = seen ? NAN : feasible_ms(points, count, points[i].line, error);
        if (ms < best_ms) {
            best_ms = ms;
            best = points[i].line;
        }
    }
    return best;
}

// What is narrower than 5 % is noise of times.
static bool is_sliver(const front_range *r)
{
    return !r->lowest && !r->highest && r->high < 1.05 * r->low;
}

// A sliver goes to the range below, the first to the one above.
static uint32_t without_slivers(front_range *ranges, uint32_t num)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < num; i++) {
        const front_range *r = &ranges[i];
        if (kept > 0 && (is_sliver(r) || ranges[kept - 1].line == r->line)) {
            ranges[kept - 1].high = r->high;
            ranges[kept - 1].highest = r->highest;
        } else {
            ranges[kept++] = *r;
        }
    }
    if (kept > 1 && is_sliver(&ranges[0])) {
        ranges[1].low = ranges[0].low;
        memmove(ranges, ranges + 1, --kept * sizeof *ranges);
    }
    return kept;
}

uint32_t front_ranges(const front_point *points, uint32_t count, front_range *ranges, uint32_t max)
{
    uint32_t num_front = 0;
    ranked *front = envelope(points, count, -1, &num_front);
    if (num_front == 0) {
        free(front);
        return 0;
    }
    // From its last point to its first; 1 ppm: rounding must not put them out of reach.
    const double low = fmax(front[num_front - 1].error, 1e-4) * (1 + 1e-6);
    const double high = fmax(front[0].error * (1 + 1e-6), low);
    const bool bound = front[num_front - 1].bound;
    free(front);
    uint32_t num = 0;
    for (double error = low;; error = fmin(1.01 * error, high)) {
        const int64_t line = fastest_line(points, count, error);
        if (line >= 0 && (num == 0 || line != ranges[num - 1].line)) {
            if (num > 0) {
                ranges[num - 1].high = error;
            }
            if (num == max) {
                break;
            }
            ranges[num] = (front_range){(uint32_t)line, error, error, num == 0 && !bound, false};
            num++;
        }
        if (error >= high) {
            ranges[num - 1].highest = true;
            break;
        }
    }
    return without_slivers(ranges, num);
}

double front_geometric_mean(const double *values, uint32_t count)
{
    double sum = 0;
    for (uint32_t i = 0; i < count; i++) {
        sum += isfinite(values[i]) && values[i] > 0 ? log(values[i]) : NAN;
    }
    return exp(sum / count);
}
