// sources.h -- what shines, and where its light first collides: what engine/light fills and solvers and views read.
//
// Each tyn_add_ function adds the passes of one kind of source, if the scene has it, and fills its part.
#pragma once
#include "job/job.h"
#include "scene/lattice_shape.h"
#include "shaders/light/rsm_args.h"

// Lamps and virtual point lights: the first num_fine lamps have grids as fine as the medium.
typedef struct tyn_lamps {
    tyn_radial_refs radials;
    uint32_t num_lamps, num_fine;
    bool vpls; // virtual point lights follow the lamps
} tyn_lamps;

typedef struct tyn_sky {
    tyn_ref map;       // the environment's without its suns; {0} if the environment is constant
    tyn_ref ordinates; // struct ordinates_block; {0} if nothing shines from ordinates
    uint32_t count;    // ordinates at most
    bool split; // they carry the map less its mean, env_block.sky, which comes in from all sides
    tyn_column_refs columns; // optical depths along them
} tyn_sky;

// What surfaces receive beyond direct light.
typedef struct tyn_surface_light {
    tyn_vpl_refs vpls; // {0} if surfaces send nothing on
    tyn_ref
        rooms; // cells of the lattice that are joined, and the VPLs in them; {0} without walls or VPLs
} tyn_surface_light;

// Surfaces as the lattice sees them; {0} without.
typedef struct tyn_walls {
    tyn_wall_refs cut;
    tyn_ref hits;        // the triangles that cut links meet
    tyn_ref light;       // what they reflect of light that is not the lattice's
    tyn_ref light_power; // of virtual point lights, for the balance
} tyn_walls;

// The cells of the lattice with their unscattered light.
typedef struct tyn_cells {
    tyn_lattice_shape shape;
    float side;                    // of a cell, m; 0: there is no lattice
    tyn_ref cells, source;         // the medium, and light that arrives unscattered
    tyn_ref sun_power, lamp_power; // for the balance
    tyn_ref vpl_light;             // what of `source` virtual point lights bring
} tyn_cells;

typedef struct tyn_sources {
    tyn_medium_refs medium;
    tyn_ref bricks, distance; // of the medium
    uint32_t num_suns;        // that have beams
    tyn_beam_refs beams;
    tyn_shadow_refs shadows;
    tyn_ref light_cells; // where looks at the shadow maps are needed (light_cells_args.h)
    tyn_lamps lamps;
    tyn_sky sky;
    bool mean_from_all_sides; // the mean of the environment enters the lattice
    tyn_surface_light surface_light;
    tyn_walls walls;
    tyn_cells lattice;
} tyn_sources;

void tyn_add_medium(tyn_graph *g, const tyn_job *job, tyn_sources *s);
void tyn_add_beams(tyn_graph *g, const tyn_job *job, tyn_sources *s);
// Shadow maps of the suns that have beams and of the lamps.
void tyn_add_shadows(tyn_graph *g, const tyn_job *job, tyn_sources *s);
// Optical depths around lamps and, if they are there, around virtual point lights.
void tyn_add_radials(tyn_graph *g, const tyn_job *job, tyn_sources *s);
// Virtual point lights of what surfaces reflect first and emit.
void tyn_add_vpls(tyn_graph *g, const tyn_job *job, tyn_sources *s);
// Principal ordinates of the environment and of suns from `first_sun` on, which have no beam. `can_split`: the method
// has a way for light that is equal from all sides.
void tyn_add_sky(tyn_graph *g, const tyn_job *job, uint32_t first_sun, bool can_split,
                 tyn_sources *s);
// The environment where a lattice carries on what it scatters: ordinates for all but the suns that have beams; among surfaces
// its mean alone, from all sides, with a warning. After suns, their beams and shadows.
void tyn_add_surroundings(tyn_graph *g, const tyn_job *job, bool can_split, tyn_sources *s);
static inline bool tyn_is_lit(const float radiance[3])
{
    return radiance[0] > 0.0f || radiance[1] > 0.0f || radiance[2] > 0.0f;
}
// Sums of the environment's map over rectangles (sky_args.h: struct sky_sum), its suns among them.
tyn_ref tyn_add_map_sums(tyn_graph *g, const tyn_job *job);
// The medium on the lattice, walls, and the unscattered light of all sources above. `cells` along the longest side, as
// the user's `setting` says.
void tyn_add_cells(tyn_graph *g, const tyn_job *job, int32_t cells, const char *setting,
                   tyn_sources *s);

// Cells of the lattice within which all lamps are followed by the march: beams of spots farther, until they are as
// wide.
#define TYN_LAMP_REACH 3.0f
// The environment, if its mean enters the lattice from all sides.
tyn_ref tyn_mean_environment(const tyn_job *job, const tyn_sources *s);
// Groups of local lights that the lattice keeps apart (lattice_lamps).
uint32_t tyn_radial_groups(const tyn_lamps *lamps);
// Do VPLs carry all reflections between surfaces? So they do where surfaces reach far beyond the medium's box, which
// the lattice fills; else they carry the first, and the lattice's walls the others.
bool tyn_vpls_bounce(const tyn_job *job);

// What the lights shine on: reflective shadow maps of the same lights as tyn_add_shadows.
typedef struct tyn_rsm {
    tyn_rsm_refs maps;
    uint32_t num_tiles;
    struct rsm_tile tiles[TYN_RSM_MAX_TILES];
} tyn_rsm;
void tyn_add_rsm(tyn_graph *g, const tyn_job *job, tyn_rsm *rsm);

// The passes that these functions add, for methods' tables.
#include "light/passes.h"
