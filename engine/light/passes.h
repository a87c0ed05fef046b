// passes.h -- the passes of each kind of source, for methods' tables.
#pragma once
#include "passes/medium/medium.h"
#include "passes/beam/beam.h"
#include "passes/shadow_map/shadow_map.h"
#include "passes/light_cells/light_cells.h"
#include "passes/radial_beam/radial_beam.h"
#include "passes/rsm/rsm.h"
#include "passes/vpl/vpl.h"
#include "passes/env_importance/env_importance.h"
#include "passes/importance/importance.h"
#include "passes/ordinates/ordinates.h"
#include "passes/lattice_cells/lattice_cells.h"
#include "passes/walls/walls.h"
#include "passes/wall_light/wall_light.h"
#include "passes/rooms/rooms.h"
#include "passes/columns_average/columns_average.h"
#include "passes/columns/columns.h"
#include "passes/lattice_source/lattice_source.h"
#include "passes/lattice_ordinates/lattice_ordinates.h"
#include "passes/lattice_lamps/lattice_lamps.h"

#define TYN_MEDIUM_PASSES &tyn_pass_medium
#define TYN_SUN_PASSES &tyn_pass_beam, &tyn_pass_shadow_map, &tyn_pass_light_cells
#define TYN_LAMP_PASSES &tyn_pass_radial_beam
#define TYN_VIRTUAL_LIGHT_PASSES &tyn_pass_rsm, &tyn_pass_vpl
#define TYN_SKY_PASSES &tyn_pass_env_importance, &tyn_pass_importance, &tyn_pass_ordinates
#define TYN_CELL_PASSES                                                                            \
    &tyn_pass_lattice_cells, &tyn_pass_walls, &tyn_pass_wall_light, &tyn_pass_rooms,               \
        &tyn_pass_columns_average, &tyn_pass_columns, &tyn_pass_lattice_source,                    \
        &tyn_pass_lattice_ordinates, &tyn_pass_lattice_lamps
