// registry.c -- the passes and methods of the library: one line each.
#include "registry/registry.h"
#include "passes/beam/beam.h"
#include "passes/columns/columns.h"
#include "passes/columns_average/columns_average.h"
#include "passes/composite/composite.h"
#include "passes/env_glow/env_glow.h"
#include "passes/env_importance/env_importance.h"
#include "passes/gbuffer/gbuffer.h"
#include "passes/importance/importance.h"
#include "passes/lattice_cells/lattice_cells.h"
#include "passes/lattice_source/lattice_source.h"
#include "passes/lattice_ordinates/lattice_ordinates.h"
#include "passes/lattice_lamps/lattice_lamps.h"
#include "passes/lattice/lattice.h"
#include "passes/lattice_keep/lattice_keep.h"
#include "passes/lattice_recall/lattice_recall.h"
#include "passes/medium/medium.h"
#include "passes/ordinates/ordinates.h"
#include "passes/path/path.h"
#include "passes/path_probe/path_probe.h"
#include "passes/path_balance/path_balance.h"
#include "passes/path_fluxes/path_fluxes.h"
#include "passes/path_distance/path_distance.h"
#include "passes/merge/merge.h"
#include "passes/merge_grids/merge_grids.h"
#include "passes/probe/probe.h"
#include "passes/balance/balance.h"
#include "passes/propagate_radial/propagate_radial.h"
#include "passes/propagate_rect/propagate_rect.h"
#include "passes/radial_beam/radial_beam.h"
#include "passes/raymarch/raymarch.h"
#include "passes/residuum/residuum.h"
#include "passes/rsm/rsm.h"
#include "passes/scatter_lut/scatter_lut.h"
#include "passes/shade/shade.h"
#include "passes/light_cells/light_cells.h"
#include "passes/shadow_map/shadow_map.h"
#include "passes/tonemap/tonemap.h"
#include "passes/upsample/upsample.h"
#include "passes/vpl/vpl.h"
#include "passes/walls/walls.h"
#include "passes/wall_light/wall_light.h"
#include "passes/rooms/rooms.h"
#include <stdio.h>
#include <string.h>

static const tyn_pass_desc *const passes[] = {
    // clang-format off
    &tyn_pass_medium,
    &tyn_pass_beam,
    &tyn_pass_columns_average,
    &tyn_pass_columns,
    &tyn_pass_radial_beam,
    &tyn_pass_scatter_lut,
    &tyn_pass_walls,
    &tyn_pass_wall_light,
    &tyn_pass_rooms,
    &tyn_pass_lattice_cells,
    &tyn_pass_lattice_source,
    &tyn_pass_lattice_ordinates,
    &tyn_pass_lattice_lamps,
    &tyn_pass_lattice_recall,
    &tyn_pass_lattice,
    &tyn_pass_lattice_keep,
    &tyn_pass_merge,
    &tyn_pass_probe,
    &tyn_pass_balance,
    &tyn_pass_propagate_rect,
    &tyn_pass_propagate_radial,
    &tyn_pass_merge_grids,
    &tyn_pass_residuum,
    &tyn_pass_upsample,
    &tyn_pass_env_importance,
    &tyn_pass_ordinates,
    &tyn_pass_importance,
    &tyn_pass_env_glow,
    &tyn_pass_gbuffer,
    &tyn_pass_rsm,
    &tyn_pass_shadow_map,
    &tyn_pass_light_cells,
    &tyn_pass_vpl,
    &tyn_pass_shade,
    &tyn_pass_raymarch,
    &tyn_pass_path,
    &tyn_pass_path_probe,
    &tyn_pass_path_balance,
    &tyn_pass_path_fluxes,
    &tyn_pass_path_distance,
    &tyn_pass_composite,
    &tyn_pass_tonemap,
    // clang-format on
};
enum { NUM_PASSES = sizeof passes / sizeof passes[0] };

static const tyn_method *const methods[] = {
    &tyn_method_pop,
    &tyn_method_pop_paper,
    &tyn_method_single,
    &tyn_method_path,
};
enum { NUM_METHODS = sizeof methods / sizeof methods[0] };

uint32_t tyn_num_passes(void)
{
    return NUM_PASSES;
}

const tyn_pass_desc *tyn_pass_at(uint32_t index)
{
    return index < NUM_PASSES ? passes[index] : NULL;
}

const tyn_pass_desc *tyn_pass_find(const char *name)
{
    for (uint32_t i = 0; i < NUM_PASSES; i++) {
        if (!strcmp(passes[i]->name, name)) {
            return passes[i];
        }
    }
    return NULL;
}

uint32_t tyn_num_methods(void)
{
    return NUM_METHODS;
}

void tyn_method_at(uint32_t index, tyn_method_info *info)
{
    *info = index < NUM_METHODS ? methods[index]->info : (tyn_method_info){0};
}

const tyn_method *tyn_method_find(const char *name)
{
    for (uint32_t i = 0; i < NUM_METHODS; i++) {
        if (!strcmp(methods[i]->info.name, name ? name : tyn_method_default())) {
            return methods[i];
        }
    }
    return NULL;
}

bool tyn_method_named(const char *name, tyn_method_info *info)
{
    const tyn_method *method = tyn_method_find(name);
    *info = method ? method->info : (tyn_method_info){0};
    return method != NULL;
}

const char *tyn_method_default(void)
{
    return methods[0]->info.name;
}

const char *tyn_method_reference(void)
{
    uint32_t i = 0;
    while (!methods[i]->info.reference) {
        i++;
    }
    return methods[i]->info.name;
}

void tyn_method_names(char *text, size_t size)
{
    size_t at = 0;
    for (uint32_t i = 0; i < NUM_METHODS && at < size; i++) {
        at += (size_t)snprintf(text + at, size - at, "%s%s", i ? ", " : "", methods[i]->info.name);
    }
}
