// volume.h -- what the readers of grids share.
#pragma once
#include <tyndall/io.h>

#ifdef __cplusplus
extern "C" {
#endif

// Files are read whole; a grid is stored dense. Fuzzers look for wrong accesses, not for big grids.
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
#define TYN_MAX_VOXELS (1ull << 21)
#else
#define TYN_MAX_VOXELS (1ull << 30)
#endif
#define TYN_MAX_FILE_BYTES (1ull << 34)

// What a grid is read for.
typedef enum tyn_grid_use {
    TYN_GRID_DENSITY = 0, // scalars; negative ones are set to 0
    TYN_GRID_VALUE,       // scalars of any sign, as temperatures in degrees Celsius are
    TYN_GRID_COLOR,       // scalars or vectors; negative values are set to 0
    TYN_GRID_LIST,        // nothing is read: what is there is told
} tyn_grid_use;

// A grid that is asked for, and what comes of it.
typedef struct tyn_grid_job {
    const char *grid; // its name; NULL: a density is looked for (tyn_volume_choose)
    tyn_grid_use use;
    uint32_t used;      // bits of tyn_grid_role: grids that are read as well, and not left out
    bool guessed;       // of several grids one was taken whose name says nothing
    tyn_volume volume;  // data has `channels` values a voxel
    uint32_t channels;  // 1 or 3
    uint64_t clamped;   // negative values that were set to 0
    char left_out[400]; // what else is in the file and is nobody's density, in words; "": nothing
    tyn_volume_grid *list; // LIST: of all grids, from malloc
    uint32_t num_list;
    const tyn_log *log;
} tyn_grid_job;

// Reads a grid of a .nvdb or .vdb file. Nothing is left in `job` after a fault.
tyn_result tyn_grid_read(tyn_grid_job *job, const char *path);

// Allocates zeroed data for a grid of `channels` values a voxel; faults are one line that names `file`.
tyn_result tyn_volume_alloc(tyn_volume *volume, const int64_t size[3], uint32_t channels,
                            const char *file, const tyn_log *log);

// Room for what TYN_GRID_LIST tells, zeroed.
tyn_result tyn_grid_begin_list(tyn_grid_job *job, uint32_t count, const char *file);

// After a fault: nothing is left in `job`.
void tyn_grid_drop(tyn_grid_job *job);

// After data is filled: refuses non-finite values, clamps and counts negative ones, finds the
// maximum, hashes, names the volume. Uses other than DENSITY: as tyn_grid_use says.
tyn_result tyn_grid_seal(tyn_grid_job *job, const char *file, const char *grid);

// What was read, as a grid of colours; `job` is empty then.
tyn_color_grid tyn_grid_take_colors(tyn_grid_job *job);

// Of a grid's size and values.
uint64_t tyn_grid_hash(const uint32_t size[3], uint32_t channels, const float *data);

// What a grid is by its name: density, temperature, velocity, ...
typedef enum tyn_grid_role {
    TYN_ROLE_UNKNOWN = 0,
    TYN_ROLE_DENSITY,
    TYN_ROLE_HEAT,     // temperatures, flames, fuel
    TYN_ROLE_EMISSION, //
    TYN_ROLE_COLOR,
    TYN_ROLE_VELOCITY,
    TYN_ROLE_OTHER, // pressure, distances, ...
} tyn_grid_role;
tyn_grid_role tyn_grid_role_of(const char *name);

// Chooses among the grids of a file. With a name: that one, if it can be read for the use (`scalar`, `vector`: whether it
// is one of numbers or of vectors that can be read). Without: "density", else a name that means one, else the first
// whose name means nothing else: a temperature or a velocity is never taken for a density. Returns its index, or -1 after
// one line that lists the grids there are and says what would be right. `job->left_out` tells of the others.
typedef struct tyn_grid_entry {
    const char *name, *type;
    bool scalar, vector;
} tyn_grid_entry;
int tyn_volume_choose(tyn_grid_job *job, const tyn_grid_entry *grids, uint32_t count,
                      const char *file);

// From the unit box around a grid to the world: first voxel's outer corner at -0.5, last voxel's at +0.5.
void tyn_grid_box(double to_world[16], const double index_to_world[16], const uint32_t size[3]);

// Voxel sizes and the box in the world, from index_to_world and the box of indices.
void tyn_volume_grid_place(tyn_volume_grid *grid);

#ifdef __cplusplus
}
#endif
