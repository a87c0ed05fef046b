// regime_advice.c -- which assumptions of which method hold in a regime.
//
// The thresholds are those of the measurements in docs/choosing.md and the pages that are named.
#include "regime_advice.h"
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

static void lattice_cells(advisor *to)
{
    static const char source[] = "docs/choosing.md, \"Thick cells\"";
    const double depth = to->r->cell_depth_max;
    const double needed = ceil(REGIME_LATTICE_CELLS * depth);
    if (depth <= 0.5) {
        say(to, ADVICE_HOLDS, source,
            "lattice: %.2g transport mean free paths across its densest cell (0.5: within 1 %%)",
            depth);
    } else if (depth <= 1) {
        say(to, ADVICE_HOLDS, source,
            "lattice: %.2g transport mean free paths across its densest cell (0.5: within 1 %%; 1: "
            "2 %%)",
            depth);
    } else {
        char help[96] = "more cells do not reach one";
        if (needed <= 64) {
            snprintf(help, sizeof help, "-D lattice.cells=%.0f brings them to one", needed);
        }
        say(to, depth <= 2 ? ADVICE_STRAINED : ADVICE_BREAKS, source,
            "lattice: %.2g transport mean free paths across its densest cell; what comes out of "
            "the "
            "lit side is too bright (1: 2 %%; 2: 6 %%; 4: 14 %%; 8: 16 %%); %s",
            depth, help);
    }
}

static void forward_lobe(advisor *to)
{
    const regime *r = to->r;
    if (r->g >= 0.98) {
        say(to, ADVICE_BREAKS, "docs/choosing.md, \"Forward scattering\"",
            "forward lobe: g %.3g is narrower than its tables follow (a cube of depth 4 at g "
            "0.995: "
            "38 %% off)",
            r->g);
    } else if (r->g >= 0.75 && r->optical_depth > 1) {
        say(to, ADVICE_STRAINED, "docs/choosing.md, \"Forward scattering\"",
            "forward lobe: it does not spread sideways (a cube of depth 4: 2.5 %% off at g 0.5, "
            "9.5 "
            "%% at 0.8, 12 %% at 0.9)%s",
            r->albedo < 0.7 ? "; dark smoke shows it most" : "");
    } else if (r->g <= -0.5 && r->optical_depth > 10) {
        say(to, ADVICE_STRAINED, "docs/accuracy-of-skies.md",
            "backward peak: four moments a cell do not hold it (depth 30, g -0.9: 7 %% under a "
            "sky, "
            "46 %% under a sun)");
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
        say(to, ADVICE_STRAINED, "README.md, \"How right it is\"",
            "surfaces: virtual lights and voxels of walls (sample scenes 4 to 11 %% off, vpl-cave "
            "21 %%)");
    }
    if (r->num_triangles && r->share[REGIME_MAP] + r->share[REGIME_SKY] > 0.05) {
        say(to, ADVICE_STRAINED, "README.md, \"Not yet\"",
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
        say(to, ADVICE_REFUSED, "docs/walls.md, \"Periodic media\"",
            "lamps and maps in media that repeat: refused");
        return;
    }
    if (to->r->optical_depth > 0) {
        lattice_cells(to);
        forward_lobe(to);
    }
    lights_of_pop(to);
}

// ---- the others -------------------------------------------------------------------------------

static void advise_paper(advisor *to)
{
    static const char source[] = "docs/method.md, \"pop-paper\"";
    to->method = "pop-paper";
    if (to->r->periodic) {
        say(to, ADVICE_REFUSED, source, "media that repeat: refused");
    } else if (to->r->optical_depth > 0) {
        say(to, ADVICE_BREAKS, source,
            "propagation as published: light that is moved without being lost adds up (cubes of "
            "depth "
            "0.1 to 10: 28 to 79 %% off); it is here to be compared with");
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
        const advice_level level = missing < 0.03   ? ADVICE_HOLDS
                                   : missing < 0.15 ? ADVICE_STRAINED
                                                    : ADVICE_BREAKS;
        say(to, level, source,
            "one scattering: about %.2g %% of the scattered light has scattered again (albedo "
            "%.3g, "
            "depth %.3g) and is missing",
            100 * missing, to->r->albedo, to->r->optical_depth);
    }
    if (to->r->num_triangles) {
        say(to, ADVICE_BREAKS, "README.md, \"Not yet\"", "surfaces: their shadows alone are drawn");
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
            "unbiased, but light scatters hundreds of times (albedo %.4g, %.3g transport mean free "
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
