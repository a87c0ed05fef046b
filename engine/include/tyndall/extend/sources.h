// sources.h -- what shines, and where its light first collides: what solvers and views read. Tier 7.
//
// Each tyn_add_ function adds the passes of one kind of source, if the scene has it, and fills its part.
//
// Delta scaling: of a forward lobe the part f = g^2 (0 for g <= 0) counts as light that went straight on. Primes mark what is
// left: sigma_s' = (1 - f) sigma_s, g' = (g - f) / (1 - f), sigma_t' = sigma_a + sigma_s'. Sources, the lattice and the march
// are scaled alike, so that what one leaves out the other has.
#pragma once
#include "job.h"
#include "lattice_shape.h"
#include "shaders/light/rsm_args.h"

#ifdef __cplusplus
extern "C" {
#endif

// Lamps and virtual point lights: the first num_fine lamps have grids as fine as the medium.
typedef struct tyn_lamps {
    tyn_radial_refs radials;
    uint32_t num_lamps, num_fine;
    bool vpls; // virtual point lights follow the lamps
} tyn_lamps;

// An environment: what of it shines along ordinates, the directions that stand for the rest of a map or for suns without beam.
typedef struct tyn_sky {
    tyn_ref map;       // the environment's without its suns; {0} if the environment is constant
    tyn_ref ordinates; // struct ordinates_block; {0} if nothing shines from ordinates
    // The same for a radiance of 1, suns without light: stays when the sky is dimmed. For directions, and the map's light.
    tyn_ref unlit_ordinates, unlit_directions;
    uint32_t count; // ordinates at most
    bool split; // they carry the map less its mean, env_block.sky, which comes in from all sides
    // Set before the ordinates are added: how much each direction matters to the picture, latitude and longitude of M, mean 1;
    // {0}: all alike.
    tyn_ref importance;
    tyn_column_refs columns; // optical depths along them
    // Where surfaces stand: what they hide of the ordinates, and of the sky's mean, which then is among `source` of the lattice.
    tyn_ref directions; // struct ordinates_block: parts of the ordinates, which have maps each
    uint32_t fan;       // of an ordinate that is none of the fixed ones, which have one
    tyn_sky_map_refs maps;
    tyn_sky_seen_refs seen;
    tyn_ref even;  // what of `source` is the mean
    tyn_ref guess; // where the solve may start
} tyn_sky;

// What surfaces receive beyond direct light.
typedef struct tyn_surface_light {
    tyn_vpl_refs vpls; // {0} if surfaces send nothing on
    tyn_ref
        rooms; // cells of the lattice that are joined, and the VPLs in them; {0} without walls or VPLs
    bool of_sky; // what surfaces reflect of the sky is among the VPLs
} tyn_surface_light;

// Surfaces as the lattice sees them; {0} without.
typedef struct tyn_walls {
    tyn_wall_refs cut;
    tyn_ref hits;  // the triangles that cut links meet
    tyn_ref light; // what they reflect of a periodic medium's suns
} tyn_walls;

// The cells of the lattice with their unscattered light: cubes that fill a box around the medium's (lattice_box_of of
// shaders/lattice/lattice.glsl), tyn_lattice_dims(shape.extent, shape.cells) of them. Images have a texel for each, the channels
// that are solved stacked along z: texel (i, j, channel * dims.z + k).
typedef struct tyn_cells {
    tyn_lattice_shape shape;
    float side; // of a cell, m; 0: there is no lattice
    // The medium, 3D, RGBA32F: means over the cell of sigma_s' and sigma_a in 1/m, of g', and of the emission in
    // W/(m^3 sr).
    tyn_ref cells;
    // Light that arrives unscattered, 3D, RGBA32F: mean fluence (x) and net flux (y, z, w), W/m^2. {0}: there is none.
    tyn_ref source;
    tyn_ref sun_power, lamp_power; // for the balance
    tyn_ref vpl_light;             // what of `source` virtual point lights bring
} tyn_cells;

// All of it. A method starts from {0} and calls what it wants below, in the order of the calls; what was not called, and what
// the scene has not, stays {0}, and everybody who reads sources leaves it out.
typedef struct tyn_sources {
    tyn_medium_refs medium; // struct medium_block, and the textures that it tells of
    tyn_ref bricks,
        distance; // least and largest values of bricks of it; bricks to the nearest that is not empty
    uint32_t num_suns;       // that have beams: the first of tyn_lights.suns
    tyn_beam_refs beams;     // optical depths along them
    tyn_shadow_refs shadows; // what surfaces hide of suns and lamps
    tyn_lamps lamps;
    tyn_sky sky;
    bool mean_from_all_sides; // the mean of the environment enters the lattice
    tyn_surface_light surface_light;
    tyn_walls walls;
    tyn_cells lattice;
} tyn_sources;

// The medium's textures, bricks and distances. First of all, and not in a scene that is empty.
TYN_API void tyn_add_medium(tyn_graph *g, const tyn_job *job, tyn_sources *s);
// Optical depths along the strongest suns.
TYN_API void tyn_add_beams(tyn_graph *g, const tyn_job *job, tyn_sources *s);
// Virtual point lights of what surfaces reflect first and emit. Of the sky's light, too, if tyn_add_surroundings came before
// (and, where there is a medium, tyn_add_columns).
TYN_API void tyn_add_vpls(tyn_graph *g, const tyn_job *job, tyn_sources *s);
// Optical depths around lamps and, if they are there, around virtual point lights.
TYN_API void tyn_add_radials(tyn_graph *g, const tyn_job *job, tyn_sources *s);
// Shadow maps of the suns that have beams and of the lamps.
TYN_API void tyn_add_shadows(tyn_graph *g, const tyn_job *job, tyn_sources *s);
// Principal ordinates of the environment and of suns from `first_sun` on, which have no beam. `can_split`: the method
// has a way for light that is equal from all sides.
TYN_API void tyn_add_sky(tyn_graph *g, const tyn_job *job, uint32_t first_sun, bool can_split,
                         tyn_sources *s);
// The environment where a lattice carries on what it scatters: ordinates for all but the suns that have beams, and what surfaces
// hide of them; of a constant one the mean, from all sides. After suns, their beams and shadows.
TYN_API void tyn_add_surroundings(tyn_graph *g, const tyn_job *job, bool can_split, tyn_sources *s);
// All light of the environment that is no sun's with a beam, its mean too, as ordinates and their directions, whatever the camera
// sees; with surfaces depth maps.
TYN_API void tyn_add_whole_sky(tyn_graph *g, const tyn_job *job, tyn_sources *s);
static inline bool tyn_is_lit(const float radiance[3])
{
    return radiance[0] > 0.0f || radiance[1] > 0.0f || radiance[2] > 0.0f;
}
// Sums of the environment's map over rectangles (sky_args.h: struct sky_sum), with its suns or without.
TYN_API tyn_ref tyn_add_map_sums(tyn_graph *g, const tyn_job *job, bool suns);
// The medium on the lattice, walls, and the unscattered light of all sources above. `cells` along the longest side, as
// the user's `setting` says, which is named in a warning. After all of them.
TYN_API void tyn_add_cells(tyn_graph *g, const tyn_job *job, int32_t cells, const char *setting,
                           tyn_sources *s);

// The medium averaged for `dims` cells, two texels a cell, if it is much finer; `texel`: the size of its texels then, m. False: it
// is as it was.
TYN_API bool tyn_average_medium(tyn_graph *g, const tyn_job *job, const uint32_t dims[3],
                                tyn_medium_refs *medium, float texel[3]);
// What the medium leaves of the ordinates on their way to so many cells along its longest side.
TYN_API void tyn_add_columns(tyn_graph *g, const tyn_job *job, int32_t cells, tyn_sources *s);

// Cells of the lattice within which all lamps are followed by the march: beams of spots farther, until they are as
// wide.
#define TYN_LAMP_REACH 3.0f
// The environment, if its mean enters the lattice from all sides.
TYN_API tyn_ref tyn_mean_environment(const tyn_job *job, const tyn_sources *s);
// Groups of local lights that the lattice keeps apart (lattice_lamps).
TYN_API uint32_t tyn_radial_groups(const tyn_lamps *lamps);
// Do surfaces reach beyond the medium's box, which the lattice fills, by more than .15 of its longest side? True without a medium.
TYN_API bool tyn_surfaces_beyond(const tyn_job *job);

// What the lights shine on: reflective shadow maps of the same lights as tyn_add_shadows.
typedef struct tyn_rsm {
    tyn_rsm_refs maps;
    uint32_t num_tiles;
    struct rsm_tile tiles[TYN_RSM_MAX_TILES];
} tyn_rsm;
TYN_API void tyn_add_rsm(tyn_graph *g, const tyn_job *job, tyn_rsm *rsm);
// The same as other views see the surfaces, without what they reflect: square maps of `texels`, apart in one atlas.
typedef struct tyn_rsm_view {
    uint32_t offset[2]; // of its map in the atlas, texels
    float rows[4][4];   // M -> clip
} tyn_rsm_view;
TYN_API void tyn_add_rsm_views(tyn_graph *g, const tyn_job *job, const tyn_rsm_view *views,
                               uint32_t count, uint32_t texels, tyn_rsm_refs *maps);

// The passes of these calls, for a method's table: TYN_SUN_PASSES(TYN_PASS_NAME) is "beam", "shadow_map"
// (method.h).
#define TYN_MEDIUM_PASSES(X) X(medium)
#define TYN_SUN_PASSES(X) X(beam), X(shadow_map)
#define TYN_LAMP_PASSES(X) X(radial_beam), X(radial_lights)
#define TYN_VIRTUAL_LIGHT_PASSES(X) X(rsm), X(vpl)
#define TYN_SKY_PASSES(X) X(env_importance), X(ordinates), X(sky_light), X(sky_shadows)
#define TYN_CELL_PASSES(X)                                                                         \
    X(lattice_cells), X(walls), X(wall_light), X(rooms), X(columns_average), X(columns),           \
        X(sky_seen), X(lattice_source), X(lattice_ordinates), X(lattice_lamps)

#ifdef __cplusplus
}
#endif
