// passes.h -- the passes of each kind of source, by their params and ports.
#pragma once
#include "passes/medium/medium.h"
#include "passes/beam/beam.h"
#include "passes/shadow_map/shadow_map.h"
#include "passes/light_cells/light_cells.h"
#include "passes/radial_beam/radial_beam.h"
#include "passes/radial_lights/radial_lights.h"
#include "passes/rsm/rsm.h"
#include "passes/vpl/vpl.h"
#include "passes/env_importance/env_importance.h"
#include "passes/importance/importance.h"
#include "passes/ordinates/ordinates.h"
#include "passes/sky_shadows/sky_shadows.h"
#include "passes/lattice_cells/lattice_cells.h"
#include "passes/walls/walls.h"
#include "passes/wall_light/wall_light.h"
#include "passes/walls_beyond/walls_beyond.h"
#include "passes/rooms/rooms.h"
#include "passes/columns_average/columns_average.h"
#include "passes/columns/columns.h"
#include "passes/sky_seen/sky_seen.h"
#include "passes/lattice_source/lattice_source.h"
#include "passes/lattice_ordinates/lattice_ordinates.h"
#include "passes/lattice_lamps/lattice_lamps.h"

// For the tables of methods: TYN_SUN_PASSES(TYN_PASS_ADDRESS).
#define TYN_PASS_ADDRESS(name) &tyn_pass_##name
