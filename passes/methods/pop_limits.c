// pop_limits.c -- what method "pop" is good and bad at.
//
// Errors are those of boxes in one sun against `path` (docs/choosing.md, docs/stress.md).
#include <tyndall/extend/limits.h>

#define COUNT(curve) (sizeof(curve) / sizeof(curve)[0])

// Half a per cent and less in thinner cells.
static double thick(const tyn_regime *r)
{
    static const tyn_limit_point curve[] = {{1, 0.02}, {2, 0.1}, {7, 0.2}, {24, 0.4}, {300, 1}};
    return r->scatterings > 0.05 ? tyn_limit_along(curve, COUNT(curve), r->cell_depth) : 0;
}

// By the cells through the box: a share of the light that has scattered more than once.
static double thin(const tyn_regime *r)
{
    static const tyn_limit_point curve[] = {{0.5, 1.2}, {1, 0.35}, {2, 0.3}, {3, 0.15},
                                            {4, 0.07},  {6, 0.04}, {8, 0.01}};
    const double cells = fmax(r->cells_through, curve[0].x);
    return fmin(1, tyn_limit_along(curve, COUNT(curve), cells) * r->again);
}

// At g -0.4, -0.5, -0.7, -0.8, -0.9, -0.99; from depth 1 on.
static double backward(const tyn_regime *r)
{
    static const tyn_limit_point curve[] = {{1 / 0.6, 0.015}, {2, 0.025}, {1 / 0.3, 0.09},
                                            {5, 0.2},         {10, 0.6},  {100, 10}};
    const double peak = 1 / (1 + fmax(r->least_g, -0.999));
    return tyn_limit_along(curve, COUNT(curve), peak) * fmin(1, pow(r->mean_depth, 0.7));
}

// At g 0.98 and 0.995.
static double forward(const tyn_regime *r)
{
    static const tyn_limit_point curve[] = {{50, 0.05}, {200, 0.4}};
    const double lobe = 1 / (1 - fmin(r->most_g, 0.9999));
    return tyn_limit_along(curve, COUNT(curve), lobe) * fmin(1, r->mean_depth);
}

// Models, courtyards and rooms with a window 1 to 4 %.
static double sky(const tyn_regime *r)
{
    return 0.04 * fmin(1, r->sky_on_surfaces);
}

// Before a window 36 %; about a floor 1 to 2 %.
static double glow(const tyn_regime *r)
{
    return 0.2 * fmin(1, r->glow_on_surfaces);
}

#define REFUSES(light)                                                                             \
    {                                                                                              \
        .key = "periodic media", .where = {TYN_ABOVE(repeats, 0), TYN_ABOVE(light, 0)},            \
        .level = TYN_LIMIT_REFUSED, .advice = {"lamps and maps in media that repeat: refused"},    \
        .source = "docs/method.md, \"Periodic media\""                                             \
    }

#define THICK                                                                                      \
    .key = "thick lattice cells", .error = thick, .source = "docs/choosing.md, \"Thick cells\"",   \
    .warned = {TYN_ABOVE(scatterings, 0.05), TYN_ABOVE(cell_depth, 1.8)},                          \
    .warning = {                                                                                   \
        "accuracy: where the medium is dense a lattice cell is %.3g mean free paths (delta "       \
        "scaled) wide; lit faces are off by about 10 %% at 2, 20 %% at 7, a factor of 2 from 30 "  \
        "on; dark ones are too bright, 4 times at 30, ever more beyond (-D lattice.cells)",        \
        {TYN_FIGURE(cell_depth)}}
#define TRANSPORT                                                                                  \
    "lattice: %.2g transport mean free paths across its densest cell; what comes out of its "      \
    "faces is off (1: 2 %%; 2: 6 to 10 %%; 7: 20 %%; 24: 40 %%); "
// A narrow lobe: long on the way to forgetting where it came from.
#define SCALED                                                                                     \
    "lattice: %.2g mean free paths (delta scaled) across a dense cell (1: 2 %%; 2: 10 %%; 7: 20 "  \
    "%%; 24: 40 %%); "
#define ENOUGH "-D lattice.cells=%.0f brings them to one"
#define TOO_FEW "more cells do not reach one (%.0f at most)"
#define SIDEWAYS                                                                                   \
    "forward lobe: it does not spread sideways (a cube of depth 4: 2.5 %% off at g 0.5, 9.5 %% "   \
    "at 0.8, 12 %% at 0.9)"

const tyn_limit tyn_limits_pop[] = {
    REFUSES(lamps),
    REFUSES(map),
    {THICK, .where = {TYN_ABOVE(cell_transport, 1), TYN_ABOVE(cells_spare, -0.5)},
     .level = TYN_LIMIT_STRAINED,
     .advice = {TRANSPORT ENOUGH, {TYN_FIGURE(cell_transport), TYN_FIGURE(cells_needed)}}},
    {THICK, .where = {TYN_ABOVE(cell_transport, 1)}, .level = TYN_LIMIT_STRAINED,
     .advice = {TRANSPORT TOO_FEW, {TYN_FIGURE(cell_transport), TYN_FIGURE(cells_most)}}},
    {THICK,
     .where = {TYN_ABOVE(cell_depth, 1.1908), TYN_ABOVE(scatterings, 0.05),
               TYN_ABOVE(cells_spare, -0.5)},
     .advice = {SCALED ENOUGH, {TYN_FIGURE(cell_depth), TYN_FIGURE(cells_needed)}}},
    {THICK, .where = {TYN_ABOVE(cell_depth, 1.1908), TYN_ABOVE(scatterings, 0.05)},
     .advice = {SCALED TOO_FEW, {TYN_FIGURE(cell_depth), TYN_FIGURE(cells_most)}}},
    {THICK, .where = {TYN_ABOVE(mean_depth, 0)},
     .advice = {"lattice: %.2g transport mean free paths across its densest cell (0.5: within 1 "
                "%%; 1: 2 %%)",
                {TYN_FIGURE(cell_transport)}}},
    {.key = "few lattice cells through the box",
     .where = {TYN_BELOW(cells_through, 8), TYN_ABOVE(thickness, 0.1),
               TYN_ABOVE(scatterings, 0.05)},
     .error = thin,
     .advice = {"thickness: %.2g lattice cells through the box; light along its longer sides is "
                "not resolved (about %g %% off; below one cell all that scatters twice is lost); "
                "more cells help (-D lattice.cells=%.0f at most)",
                {TYN_FIGURE(cells_through), TYN_LIMIT_ERROR, TYN_FIGURE(cells_most)}},
     .source = "docs/choosing.md, \"Flat boxes and poles\"",
     .warned = {TYN_BELOW(cells_through, 3)},
     .warning = {"accuracy: the medium's box is %.2g lattice cells thick along its shortest side; "
                 "light along the others is not resolved (-D lattice.cells)",
                 {TYN_FIGURE(cells_through)}}},
    {.key = "a narrow forward lobe",
     .where = {TYN_ABOVE(most_g, 0.9799), TYN_ABOVE(mean_depth, 0)},
     .error = forward,
     .level = TYN_LIMIT_BREAKS,
     .advice = {"forward lobe: g %.3g is narrower than its tables follow (a cube of depth 4 at g "
                "0.995: 38 %% off)",
                {TYN_FIGURE(most_g)}},
     .source = "docs/choosing.md, \"Forward scattering\""},
    {.key = "a narrow forward lobe",
     .where = {TYN_ABOVE(g, 0.7499), TYN_ABOVE(mean_depth, 1), TYN_BELOW(albedo, 0.7)},
     .level = TYN_LIMIT_STRAINED,
     .advice = {SIDEWAYS "; dark smoke shows it most"},
     .source = "docs/choosing.md, \"Forward scattering\""},
    {.key = "a narrow forward lobe",
     .where = {TYN_ABOVE(g, 0.7499), TYN_ABOVE(mean_depth, 1)},
     .level = TYN_LIMIT_STRAINED,
     .advice = {SIDEWAYS},
     .source = "docs/choosing.md, \"Forward scattering\""},
    {.key = "a backward peak",
     .where = {TYN_BELOW(least_g, -0.399), TYN_ABOVE(mean_depth, 0), TYN_ABOVE(scatterings, 0.05)},
     .error = backward,
     .advice = {"backward peak: four moments a cell do not hold it (depth 4: 2 %% off at g -0.5, "
                "6 %% at -0.7, 40 %% at -0.9, a factor of 8 at -0.99)"},
     .source = "docs/choosing.md, \"Backward scattering\"",
     .warned = {TYN_BELOW(least_g, -0.75)},
     .warning = {"accuracy: a backward peak as high as that of g %.3g; four moments a lattice cell "
                 "do not hold it: 9 %% off at -0.7, 60 %% at -0.9, far more beyond",
                 {TYN_FIGURE(least_g)}}},
    {.key = "lamps in the medium",
     .where = {TYN_ABOVE(lamps, 0.05), TYN_ABOVE(mean_depth, 1)},
     .level = TYN_LIMIT_STRAINED,
     .advice = {"lamps in the medium: right in the mean of directions, not in each (pictures of a "
                "cube about a lamp: 3 %% off at depth 1, 6 %% at 4, 3 to 14 %% at 10)"},
     .source = "docs/method.md, \"Lamps in media\""},
    {.key = "surfaces",
     .where = {TYN_ABOVE(surfaces, 0)},
     .level = TYN_LIMIT_STRAINED,
     .advice =
         {"surfaces: virtual lights and voxels of walls (sample scenes 3 to 11 %% off; a room "
          "behind a door 11 %%; walls far outside the medium 15 %%; vpl-cave 27 %%)"},
     .source = "docs/accuracy.md, \"Lamps and walls\""},
    {.key = "the sky among surfaces",
     .where = {TYN_ABOVE(sky_on_surfaces, 0.05)},
     .error = sky,
     .level = TYN_LIMIT_STRAINED,
     .advice = {"sky among surfaces: its shadows are those of 256 directions (about %g %% off, "
                "rooms with a window too)",
                {TYN_LIMIT_ERROR}},
     .source = "docs/accuracy-of-skies.md, \"Among surfaces\""},
    {.key = "media that glow among surfaces",
     .where = {TYN_ABOVE(glow_on_surfaces, 0.05)},
     .error = glow,
     .level = TYN_LIMIT_STRAINED,
     .advice = {"glowing medium among surfaces: its light goes along the lattice's fourteen lines "
                "(a floor below it 1 to 2 %% off; a room with a window towards it 36 %%)"},
     .source = "docs/surfaces.md, \"Limits\""},
    TYN_LIMIT_FLOATS,
    {NULL},
};
