// regime_limits.c -- what the methods' tables say of a regime.
#include "regime_limits.h"
#include <math.h>

// Of `length`, in the shorter of scaled and transport mean free paths.
static double depth_of(const regime *r, double length)
{
    const double scaled = r->scaled_mean_free_path, transport = r->transport_mean_free_path;
    return fmax(scaled > 0 ? length / scaled : 0, transport > 0 ? length / transport : 0);
}

void regime_figures(const regime *r, double cells, tyn_regime *out)
{
    const double longest = regime_longest(r), along = regime_cells(r, cells);
    const double sky = r->share[REGIME_SKY] + r->share[REGIME_MAP];
    *out = (tyn_regime){
        .depth = r->mean_free_path > 0 ? longest / r->mean_free_path : 0,
        .mean_free_path = r->mean_free_path / longest,
        .mean_depth = r->optical_depth,
        .transport_depth = r->optical_depth * (1 - fmax(r->g, 0)),
        .scatterings = r->albedo * depth_of(r, longest),
        .all_scatterings = r->mean_free_path > 0 ? r->albedo * longest / r->mean_free_path : 0,
        .thickness = depth_of(r, r->thickness),
        .albedo = r->albedo,
        .scaled_albedo = r->mean_free_path > 0
                             ? 1 - (1 - r->albedo) * r->scaled_mean_free_path / r->mean_free_path
                             : 0,
        .g = r->g,
        .least_g = r->least_g,
        .most_g = r->most_g,
        .again = regime_multiple(r),
        .cell_depth = depth_of(r, longest / along),
        .cell_transport = r->cell_depth_max * REGIME_LATTICE_CELLS / along,
        .cells_through = longest > 0 ? r->thickness / longest * along : cells,
        .cells_most = regime_cells(r, 1e4),
        .lamps = r->share[REGIME_LAMPS],
        .map = r->share[REGIME_MAP],
        .sky_on_surfaces = r->num_triangles ? sky : 0,
        .glow_on_surfaces = r->num_triangles ? r->share[REGIME_EMISSION] : 0,
        .surfaces = r->num_triangles > 0,
        .repeats = r->periodic,
    };
    const double paths = out->cell_transport > 1 ? out->cell_transport : out->cell_depth;
    out->cells_needed = ceil(along * paths - 1e-6);
    out->cells_spare = out->cells_most - out->cells_needed;
}

regime_limit regime_limit_of(const regime *r, const char *method, double cells)
{
    regime_limit worst = {NULL, 0};
    double squares = 0;
    tyn_method_info info;
    tyn_regime figures;
    regime_figures(r, cells, &figures);
    tyn_method_named(method, &info);
    const tyn_limit *row = NULL;
    while ((row = tyn_limit_next(info.limits, row, &figures)) != NULL) {
        const double error = tyn_limit_error(row, &figures);
        worst = error > worst.error ? (regime_limit){row->key, error} : worst;
        squares += error * error;
    }
    worst.error = sqrt(squares);
    return worst;
}

bool regime_refused(const regime *r, const tyn_method_info *method)
{
    tyn_regime figures;
    regime_figures(r, REGIME_LATTICE_CELLS, &figures);
    const tyn_limit *first = tyn_limit_next(method->limits, NULL, &figures);
    return first && first->level == TYN_LIMIT_REFUSED;
}

const char *const advice_level_names[] = {"holds", "strained", "breaks", "refused"};

static tyn_limit_level level_of(const tyn_limit *row, double error)
{
    const tyn_limit_level by_error = error < 0.03   ? TYN_LIMIT_HOLDS
                                     : error < 0.15 ? TYN_LIMIT_STRAINED
                                                    : TYN_LIMIT_BREAKS;
    return row->level > by_error ? row->level : by_error;
}

uint32_t regime_advise(const regime *r, advice list[REGIME_MAX_ADVICE])
{
    uint32_t count = 0;
    tyn_regime figures;
    regime_figures(r, REGIME_LATTICE_CELLS, &figures);
    for (uint32_t i = 0; i < tyn_num_methods(); i++) {
        tyn_method_info info;
        tyn_method_at(i, &info);
        const tyn_limit *row = NULL;
        while ((row = tyn_limit_next(info.limits, row, &figures)) != NULL) {
            if (row->advice.format && count < REGIME_MAX_ADVICE) {
                advice *a = &list[count++];
                *a = (advice){.method = info.name,
                              .level = level_of(row, tyn_limit_error(row, &figures)),
                              .source = row->source};
                tyn_limit_say(row, &row->advice, &figures, a->text, sizeof a->text);
            }
        }
    }
    return count;
}
