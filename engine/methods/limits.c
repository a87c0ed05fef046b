// limits.c -- where methods are known to lose accuracy. The thresholds are where `tyndall bench --stress` finds
// errors of 10 %.
#include "methods/limits.h"
#include "methods/nodes.h"
#include <math.h>
#include <stdio.h>

static const float cell_depth_limit = 1.8f;    // scaled depths of a cell
static const float thin_side_limit = 3;        // cells across a side
static const float backward_limit = -0.75f;    // g
static const float narrow_limit = 0.995f;      // g, as HG_MAX of shaders/phase/hg.glsl
static const float float_depth_limit = 3e6f;   // depths of the box
static const float multiple_limit = 0.3f;      // scaled scattering depths
static const float unsettled_limit = 0.02f;    // of the scattered light
static const float astray_limit = 0.05f;       // of what virtual lights send to walls
static const float sampled_depth_limit = 1e5f; // depths of the box where nothing is absorbed

// The medium where it matters: in a grid at the density of the average particle of the medium; where several media
// overlap, the sum of their largest values. Largest channel.
typedef struct dense {
    float extinction; // 1/m
    float scaled;     // delta scaled
    float transport;  // sigma_a + (1 - g) sigma_s
    float scattering; // delta scaled
    float absorption;
    float least_g, most_g; // of what scatters
} dense;

static void add_channel(dense *d, float s, float a, float g, float density)
{
    const float forward = fmaxf(g, 0), f = forward * forward;
    s *= density;
    a *= density;
    d->extinction = fmaxf(d->extinction, s + a);
    d->scaled = fmaxf(d->scaled, (1 - f) * s + a);
    d->transport = fmaxf(d->transport, (1 - g) * s + a);
    d->scattering = fmaxf(d->scattering, (1 - f) * s);
    d->absorption = fmaxf(d->absorption, a);
    if (s > 0) {
        d->least_g = fminf(d->least_g, g);
        d->most_g = fmaxf(d->most_g, g);
    }
}

static dense dense_of(const tyn_job *job)
{
    const tyn_frame_scene *frame = job->frame;
    const struct medium_block *m = &frame->medium;
    dense sum = {.least_g = 1, .most_g = -1};
    if (m->mode == TYN_MEDIUM_DENSITY) {
        float density = frame->typical_density > 0 ? frame->typical_density : m->max_density;
        for (int c = 0; c < 3; c++) {
            add_channel(&sum, m->sigma_s[c], m->sigma_a[c], m->g[c], density);
        }
        return sum;
    }
    for (uint32_t i = 0; i < m->num_shapes; i++) {
        const tyn_scene *scene = job->scene;
        const int32_t volume = scene->media[scene->shapes[i].medium].volume;
        const float density = volume < 0 ? 1 : scene->volumes[volume].max_density;
        const struct shape_block *s = &frame->shapes[i];
        dense one = {.least_g = sum.least_g, .most_g = sum.most_g};
        for (int c = 0; c < 3; c++) {
            add_channel(&one, s->sigma_s[c], s->sigma_a[c], s->g[c], density);
        }
        sum.extinction += one.extinction;
        sum.scaled += one.scaled;
        sum.transport += one.transport;
        sum.scattering += one.scattering;
        sum.absorption += one.absorption;
        sum.least_g = one.least_g;
        sum.most_g = one.most_g;
    }
    return sum;
}

static float longest_side(const tyn_job *job)
{
    const float *e = job->frame->medium.extent;
    return fmaxf(e[0], fmaxf(e[1], e[2]));
}

static float shortest_side(const tyn_job *job)
{
    const struct medium_block *m = &job->frame->medium;
    float shortest = INFINITY;
    for (int a = 0; a < 3; a++) {
        shortest = m->repeat[a] ? shortest : fminf(shortest, m->extent[a]);
    }
    return shortest;
}

void tyn_limits_lattice(const tyn_job *job, float cell)
{
    const dense d = dense_of(job);
    const float depth = d.scaled * cell, side = shortest_side(job);
    if (!(d.scattering * longest_side(job) > 0.05f)) {
        return; // next to nothing scatters twice
    }
    if (depth > cell_depth_limit) {
        tyn_method_warn(
            job,
            "accuracy: where the medium is dense a lattice cell is %.3g mean free paths (delta "
            "scaled) wide; what comes out of its faces is off by about 10 %% at 2, 20 %% at 7 and "
            "a factor of 2 from 30 on (-D lattice.cells)",
            (double)depth);
    }
    if (side < thin_side_limit * cell && d.scaled * side > 0.1f) {
        tyn_method_warn(
            job,
            "accuracy: the medium's box is %.2g lattice cells thick along its shortest side; "
            "light along the others is not resolved (-D lattice.cells)",
            (double)(side / cell));
    }
    if (d.least_g < backward_limit) {
        tyn_method_warn(
            job,
            "accuracy: g is %.3g; four moments a lattice cell do not hold a backward peak: 9 %% "
            "off at -0.7, 60 %% at -0.9, far more beyond",
            (double)d.least_g);
    }
}

void tyn_limits_hops(const tyn_job *job, float hop)
{
    const dense d = dense_of(job);
    if (!((d.extinction - d.absorption) * longest_side(job) > 0.05f)) {
        return;
    }
    tyn_method_warn(
        job,
        "accuracy: the published propagation turns light at every hop whether it has scattered "
        "or not, as if a hop were 2 transport mean free paths; here it is %.2g: errors of tens "
        "of per cent and more",
        (double)(hop * d.transport));
}

void tyn_limits_single(const tyn_job *job)
{
    const dense d = dense_of(job);
    const float depth = d.scattering * longest_side(job);
    if (depth > multiple_limit) {
        tyn_method_warn(
            job,
            "accuracy: light that has scattered more than once is left out; the medium is up to "
            "%.3g scattering mean free paths (delta scaled) deep",
            (double)depth);
    }
    if (d.most_g > narrow_limit) {
        tyn_method_warn(
            job,
            "accuracy: g is %.6g; beyond 0.995 the medium counts as one of 0.995 that scatters "
            "less, so that what is scattered by hardly any angle is not lost",
            (double)d.most_g);
    }
}

void tyn_limits_sky(const tyn_job *job)
{
    tyn_method_warn(
        job, "accuracy: the environment's light comes between surfaces along the lattice's 14 "
             "directions: behind openings it falls in patches");
}

void tyn_limits_rays(const tyn_job *job)
{
    const float depth = dense_of(job).extinction * longest_side(job);
    if (depth > float_depth_limit) {
        tyn_method_warn(job,
                        "accuracy: a mean free path is %.2g of the medium's box; places are single "
                        "precision numbers, of which 1e-7 of the box is the finest",
                        (double)(1 / depth));
    }
}

void tyn_limits_paths(const tyn_job *job, uint32_t max_steps)
{
    const dense d = dense_of(job);
    const float depth = d.extinction * longest_side(job);
    if (depth > sampled_depth_limit && d.absorption * 1e4f < d.scattering) {
        tyn_method_warn(
            job,
            "accuracy: the medium is %.2g mean free paths deep and absorbs next to nothing; "
            "paths end after %u steps (-D path.max_steps), what is left of them is lost",
            (double)depth, max_steps);
    }
}

// In percent to one digit: no more is known, and frames of a film say the same line.
static double percent_of(float share)
{
    const double percent = 100 * fmin((double)share, 1), unit = pow(10, floor(log10(percent)));
    return unit * round(percent / unit);
}

void tyn_limits_walls(float astray, void (*warn)(void *user, const char *line), void *user)
{
    if (astray > astray_limit) {
        char line[256];
        snprintf(line, sizeof line,
                 "accuracy: the lattice's walls get too much or too little of the light that "
                 "virtual lights send to surfaces, about %g %% of it: rooms or walls of few cells "
                 "(-D lattice.cells)",
                 percent_of(astray));
        warn(user, line);
    }
}

void tyn_limits_solve(float unsettled, void (*warn)(void *user, const char *line), void *user)
{
    if (unsettled > unsettled_limit) {
        char line[256];
        snprintf(
            line, sizeof line,
            "accuracy: the lattice is not solved to the end: about %g %% of the scattered light "
            "would still change; more sweeps are needed (-D lattice.sweeps)",
            percent_of(unsettled));
        warn(user, line);
    }
}
