// regime_advice.c -- which assumptions of which method hold in a regime.
//
// The thresholds are those of the measurements in docs/choosing.md and the pages that are named; what is known of
// errors is in regime_limits.c.
#include "regime_advice.h"
#include "regime_limits.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>

const char *const advice_level_names[] = {"holds", "strained", "breaks", "refused"};

typedef struct advisor {
    const regime *r;
    advice *list;
    uint32_t count;
    const char *method;
} advisor;

static void say(advisor *to, advice_level level, const char *source, const char *format, ...)
    TYN_PRINTF(4, 5);
static void say(advisor *to, advice_level level, const char *source, const char *format, ...)
{
    if (to->count < REGIME_MAX_ADVICE) {
        advice *a = &to->list[to->count++];
        *a = (advice){.method = to->method, .level = level, .source = source};
        va_list arguments;
        va_start(arguments, format);
        vsnprintf(a->text, sizeof a->text, format, arguments);
        va_end(arguments);
    }
}

// ---- pop --------------------------------------------------------------------------------------

static advice_level level_of(double error)
{
    return error < 0.03 ? ADVICE_HOLDS : error < 0.15 ? ADVICE_STRAINED : ADVICE_BREAKS;
}

// How many cells it takes for a cell to be one mean free path, in words.
static void more_cells(const regime *r, double needed, char help[96])
{
    needed = ceil(needed - 1e-6);
    if (regime_cells(r, needed) >= needed) {
        snprintf(help, 96, "-D lattice.cells=%.0f brings them to one", needed);
    } else {
        snprintf(help, 96, "more cells do not reach one (%.0f at most)", regime_cells(r, 1e4));
    }
}

static void lattice_cells(advisor *to)
{
    static const char source[] = "docs/choosing.md, \"Thick cells\"";
    const regime *r = to->r;
    const double most = regime_cells(r, REGIME_LATTICE_CELLS);
    const double depth = r->cell_depth_max * REGIME_LATTICE_CELLS / most;
    const double error = regime_thick_error(r, most);
    char help[96];
    if (depth <= 1 && error < 0.03) {
        say(to, ADVICE_HOLDS, source,
            "lattice: %.2g transport mean free paths across its densest cell (0.5: within 1 %%; 1: "
            "2 %%)",
            depth);
    } else if (depth <= 1) { // a narrow lobe: long on the way to forgetting where it came from
        more_cells(r, most * regime_cell_depth(r, most), help);
        say(to, level_of(error), source,
            "lattice: %.2g mean free paths (delta scaled) across a dense cell (1: 2 %%; 2: 10 %%; "
            "7: 20 %%; 24: 40 %%); %s",
            regime_cell_depth(r, most), help);
    } else {
        more_cells(r, most * depth, help);
        say(to, level_of(fmax(error, 0.03)), source,
            "lattice: %.2g transport mean free paths across its densest cell; what comes out of "
            "its faces is off (1: 2 %%; 2: 6 to 10 %%; 7: 20 %%; 24: 40 %%); %s",
            depth, help);
    }
}

static void thin_box(advisor *to)
{
    const regime *r = to->r;
    const double error = regime_thin_error(r, REGIME_LATTICE_CELLS);
    if (error > 0) {
        say(to, level_of(error), "docs/choosing.md, \"Flat boxes and poles\"",
            "thickness: %.2g lattice cells through the box; light along its longer sides is not "
            "resolved (about %.0f %% off; below one cell all that scatters twice is lost); more "
            "cells help (-D lattice.cells=%.0f at most)",
            regime_cells_thick(r, REGIME_LATTICE_CELLS), 100 * error, regime_cells(r, 1e4));
    }
}

static void backward_peak(advisor *to)
{
    const double error = regime_backward_error(to->r);
    if (error > 0.01) {
        say(to, level_of(error), "docs/choosing.md, \"Backward scattering\"",
            "backward peak: four moments a cell do not hold it (depth 4: 2 %% off at g -0.5, 6 %% "
            "at -0.7, 40 %% at -0.9, a factor of 8 at -0.99)");
    }
}

static void forward_lobe(advisor *to)
{
    static const char source[] = "docs/choosing.md, \"Forward scattering\"";
    const regime *r = to->r;
    if (r->most_g >= 0.98) {
        say(to, ADVICE_BREAKS, source,
            "forward lobe: g %.3g is narrower than its tables follow (a cube of depth 4 at g "
            "0.995: 38 %% off)",
            r->most_g);
    } else if (r->g >= 0.75 && r->optical_depth > 1) {
        say(to, ADVICE_STRAINED, source,
            "forward lobe: it does not spread sideways (a cube of depth 4: 2.5 %% off at g 0.5, "
            "9.5 %% at 0.8, 12 %% at 0.9)%s",
            r->albedo < 0.7 ? "; dark smoke shows it most" : "");
    }
}

static void lights_of_pop(advisor *to)
{
    const regime *r = to->r;
    if (r->share[REGIME_LAMPS] > 0.05 && r->optical_depth > 1) {
        say(to, ADVICE_STRAINED, "docs/method.md, \"Lamps in media\"",
            "lamps in the medium: right in the mean of directions, not in each (pictures of a cube "
            "about a lamp: 3 %% off at depth 1, 6 %% at 4, 3 to 14 %% at 10)");
    }
    if (r->num_triangles) {
        say(to, ADVICE_STRAINED, "docs/accuracy.md, \"Lamps and walls\"",
            "surfaces: virtual lights and voxels of walls (sample scenes 4 to 11 %% off, vpl-cave "
            "21 %%)");
    }
    if (r->num_triangles && r->share[REGIME_MAP] + r->share[REGIME_SKY] > 0.05) {
        say(to, ADVICE_STRAINED, "docs/surfaces.md, \"Limits\"",
            "sky among surfaces: it lights the medium by its mean and suns alone, and surfaces "
            "beyond the medium's box without shadows");
    }
}

static bool pop_refuses(const regime *r)
{
    return r->periodic && (r->share[REGIME_LAMPS] > 0 || r->share[REGIME_MAP] > 0);
}

static void advise_pop(advisor *to)
{
    to->method = "pop";
    if (pop_refuses(to->r)) {
        say(to, ADVICE_REFUSED, "docs/method.md, \"Periodic media\"",
            "lamps and maps in media that repeat: refused");
        return;
    }
    if (to->r->optical_depth > 0) {
        lattice_cells(to);
        thin_box(to);
        forward_lobe(to);
        backward_peak(to);
    }
    lights_of_pop(to);
}

// ---- the others -------------------------------------------------------------------------------

static void advise_paper(advisor *to)
{
    static const char source[] = "docs/pop-paper.md, \"Measured\"";
    to->method = "pop-paper";
    if (to->r->periodic) {
        say(to, ADVICE_REFUSED, source, "media that repeat: refused");
    } else if (to->r->optical_depth > 0) {
        say(to, ADVICE_BREAKS, source,
            "propagation as published: light that is moved without being lost adds up (cubes of "
            "depth 0.1 to 10: 28 to 79 %% off); it is here to be compared with");
    }
}

static void advise_single(advisor *to)
{
    static const char source[] = "docs/choosing.md, \"Single scattering\"";
    const double missing = regime_multiple(to->r);
    to->method = "single";
    if (to->r->periodic) {
        say(to, ADVICE_REFUSED, "docs/method.md", "media that repeat: refused");
        return;
    }
    if (to->r->optical_depth > 0) {
        say(to, level_of(missing), source,
            "one scattering: about %.*f %% of the scattered light has scattered again (albedo "
            "%.3g, depth %.4g) and is missing",
            missing < 0.1, 100 * missing, to->r->albedo, to->r->optical_depth);
    }
    if (to->r->num_triangles) {
        say(to, ADVICE_BREAKS, "docs/method.md, \"single\"",
            "surfaces: their shadows alone are drawn");
    }
}

static void advise_path(advisor *to)
{
    static const char source[] = "docs/choosing.md, \"Samples\"";
    const regime *r = to->r;
    to->method = "path";
    const double white = 1 - r->albedo, transport = r->optical_depth * (1 - fmax(r->g, 0));
    if (white < 0.01 && transport >= 10) {
        say(to, ADVICE_STRAINED, source,
            "unbiased, but light scatters hundreds of times (albedo %.4g, %.4g transport mean free "
            "paths deep): samples are dear, and rare long paths make bright pixels",
            r->albedo, transport);
    } else {
        say(to, ADVICE_HOLDS, source, "unbiased: only the number of samples decides");
    }
}

uint32_t regime_advise(const regime *r, advice list[REGIME_MAX_ADVICE])
{
    advisor to = {.r = r, .list = list};
    advise_pop(&to);
    advise_paper(&to);
    advise_single(&to);
    advise_path(&to);
    return to.count;
}

const char *regime_refused(const regime *r)
{
    if (r->periodic) {
        return pop_refuses(r) ? " pop pop-paper single " : " pop-paper single ";
    }
    return " ";
}
