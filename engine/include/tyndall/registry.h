// registry.h -- which passes and methods there are, and values for their parameters. Tier 3.
//
// They are of the process: those of the library, and those that plugins and hosts add, which stay. Adding is safe at any time
// and on any thread; what a call below has given stays as it is.
#pragma once
#include "context.h"
#include "pass.h"

#ifdef __cplusplus
extern "C" {
#endif

TYN_API uint32_t tyn_num_passes(void);
TYN_API const tyn_pass_desc *tyn_pass_at(uint32_t index);
// Adds a pass, for good: its tables must live as long as the process. A name that is there, or a table that is wrong, is one
// log line and TYN_ERR_PARAMS. (Methods: tyn_method_register of <tyndall/extend/method.h>.)
TYN_API tyn_result tyn_pass_register(const tyn_pass_desc *pass, const tyn_log *log);

// ---- plugins ---------------------------------------------------------------------------------

// Loads a shared object that brings passes, methods and hooks (<tyndall/extend/plugin.h>, docs/writing-a-plugin.md): all of
// them, or none with one log line and TYN_ERR_IO (no file that can be loaded) or TYN_ERR_PARAMS (no plugin, one for another
// ABI, a name that is there, a table that is wrong). One that is loaded already is TYN_OK. Never unloaded.
TYN_API tyn_result tyn_plugin_load(const char *path, const tyn_log *log);
TYN_API uint32_t tyn_num_plugins(void);
typedef struct tyn_plugin_info {
    const char *name, *summary; // as it calls itself
    const char *path;
    uint32_t num_passes, num_methods, num_hooks;
} tyn_plugin_info;
TYN_API void tyn_plugin_at(uint32_t index, tyn_plugin_info *info); // beyond the last: all 0

// ---- what methods are good and bad at --------------------------------------------------------

// What decides how right a method is in a scene. Of what differs between channels and places: where the medium is dense,
// the channel in which it is most. "Scaled": what is scattered forward counts as not scattered.
typedef struct tyn_regime { // NAN: not known, and beyond no bound
    double depth;           // mean free paths along the longest side of the medium's box
    double mean_free_path;  // of that side
    double mean_depth;      // ... along a straight way through the medium, on average
    double transport_depth; // transport mean free paths along it
    double scatterings;     // scaled, along the longest side
    double all_scatterings; // not scaled
    double thickness;       // scaled mean free paths through the shortest side
    double albedo, scaled_albedo;
    // Mean cosines; least_g also that of a lobe with as high a peak straight back.
    double g, least_g, most_g;
    double again; // share of the scattered light that has scattered more than once
    // Of the lattice of the method; 0: it has none.
    double cell_depth;     // scaled mean free paths across a cell
    double cell_transport; // transport mean free paths
    double cells_through;  // the shortest side
    double cells_needed;   // along the longest side, for a cell of one mean free path
    double cells_most;     // along it, that there can be
    double cells_spare;    // of these, beyond those needed
    // Light: shares of its power.
    double lamps, map;
    double sky_on_surfaces;   // of an environment, where there are surfaces
    double glow_on_surfaces;  // of media that emit, where there are surfaces
    double surfaces, repeats; // 1: there are surfaces; the medium is periodic
} tyn_regime;

enum { TYN_LIMIT_BOUNDS = 3 };
typedef struct tyn_bound { // above < figure < below; both 0: the end of a list
    size_t figure;         // offset in tyn_regime
    double above, below;
} tyn_bound;

typedef struct tyn_limit_text {
    const char *format; // of printf, for doubles; NULL: nothing is said
    size_t figures[3];  // offsets in tyn_regime, or TYN_LIMIT_ERROR: the expected error in percent
} tyn_limit_text;
#define TYN_LIMIT_ERROR SIZE_MAX

typedef enum tyn_limit_level {
    TYN_LIMIT_HOLDS = 0,
    TYN_LIMIT_STRAINED, // costs accuracy
    TYN_LIMIT_BREAKS,   // do not rely on it
    TYN_LIMIT_REFUSED,  // the method does not take such scenes
} tyn_limit_level;

// A row of a method's table: something that costs it accuracy. Rows of one key follow each other: the first that holds
// counts.
typedef struct tyn_limit {
    const char *key;                      // "thick lattice cells"; NULL: the end of the table
    tyn_bound where[TYN_LIMIT_BOUNDS];    // where it counts: all of them hold
    double (*error)(const tyn_regime *r); // expected; NULL: not known (tyn_limit_error)
    tyn_limit_level level;                // at least
    tyn_limit_text advice;                // to who chooses a method: what is lost, what to do
    const char *source;                   // page with the measurement
    tyn_bound warned[TYN_LIMIT_BOUNDS];   // where these hold as well
    tyn_limit_text warning;               // a frame's report says this
} tyn_limit;

// The row of a table that counts after `last` (NULL: the first); NULL: no more do.
TYN_API const tyn_limit *tyn_limit_next(const tyn_limit *table, const tyn_limit *last,
                                        const tyn_regime *r);
// Expected relative error of the medium's light over blocks of 8x8 pixels; 0: none is known.
TYN_API double tyn_limit_error(const tyn_limit *limit, const tyn_regime *r);
TYN_API void tyn_limit_say(const tyn_limit *limit, const tyn_limit_text *text, const tyn_regime *r,
                           char *line, size_t size);

// ---- methods ---------------------------------------------------------------------------------

// Phase functions that a method knows beside Henyey-Greenstein lobes; others count as the lobe of their mean cosine, with a
// warning.
typedef enum tyn_known_phases {
    TYN_PHASES_LOBES = 0,
    TYN_PHASES_ONE, // tables, where all media have the same one
    TYN_PHASES_ALL,
} tyn_known_phases;

// What a method promises in the groups of `tyndall selftest`. The largest error in a group of checks; 0: none is promised, and the group leaves the method out. Relative to the
// expected value where nothing else is said. Of a method that tells its standard error four of these come on top.
typedef struct tyn_promise {
    double furnace;        // absolute: of the worst pixel; of the mean where the method is noisy
    double cube_isotropic; // mean of the picture, g 0
    double cube_forward;   // ... g 0.5
    double cube_once;      // ... g 0.5, of the light that has scattered once
    double
        cube_as_recorded; // ... side view, of cube_recorded: of a method that is far off, but always equally
    double cube_recorded; // that mean, W/(m^2 sr)
    double slabs;         // in units of the flux that comes in
    double half_space;    //
    double airlight;      // light about a lamp that has scattered once
    double point_source;  // fluence about a lamp
    double energy;        // imbalance, in units of the power that comes in
    bool wide_ground;     // wants a ground that is wide, and not one that repeats with the slab
} tyn_promise;

typedef struct tyn_method_info {
    const char *name, *summary;
    const tyn_pass_desc *const *passes; // NULL-terminated, in the order of the frame
    uint32_t outputs;                   // set of tyn_output it can make
    bool progressive;                   // adds view.num_samples samples a call to what it has
    bool traces_rays; // surfaces need a hierarchy: tyn_surfaces_build_nodes of <tyndall/io.h>
    bool reference;   // right but for noise: the others are judged by it
    bool single_only; // its answer is the light that has scattered once
    tyn_known_phases phases;
    const tyn_limit *limits;
    const tyn_promise *promise; // NULL: none; those of plugins are theirs to test
    const char *
        plugin; // which one has brought it; "" = it was registered by the host; NULL: it is the library's
} tyn_method_info;
TYN_API uint32_t tyn_num_methods(void);
TYN_API void tyn_method_at(uint32_t index, tyn_method_info *info);
// NULL: the default. False: there is none of that name; `info` is all 0.
TYN_API bool tyn_method_named(const char *name, tyn_method_info *info);
// "lpv, photon": methods of the library that this build leaves out; "": none.
TYN_API const char *tyn_methods_left_out(void);
TYN_API const char *tyn_method_default(void);   // the first one's name
TYN_API const char *tyn_method_reference(void); // the name of the one that is `reference`

// ---- settings --------------------------------------------------------------------------------

TYN_API tyn_result tyn_settings_create(tyn_settings **out);
TYN_API void tyn_settings_destroy(tyn_settings **settings);
// "lattice.cells", "32": unknown names, bad numbers and values out of range are one log line and
// TYN_ERR_PARAMS.
TYN_API tyn_result tyn_settings_set(tyn_settings *settings, const char *name, const char *value,
                                    const tyn_log *log);
// "draft", "normal", "high": sets what presets set, and leaves the rest.
TYN_API tyn_result tyn_settings_quality(tyn_settings *settings, const char *preset,
                                        const tyn_log *log);
// What is in effect of one parameter; NULL settings have the defaults.
typedef struct tyn_setting {
    const tyn_param *param; // its type, range, unit, words
    double value;           // of switches 0 or 1, of words their place in param->names
    const char *word;       // of words; else NULL
    bool given;             // it was set, to whatever
} tyn_setting;
TYN_API tyn_result tyn_settings_get(const tyn_settings *settings, const char *name,
                                    tyn_setting *setting, const tyn_log *log);
// Defaults of the pass, then what was set.
TYN_API void tyn_settings_params(const tyn_settings *settings, const tyn_pass_desc *pass,
                                 void *params);

#ifdef __cplusplus
}
#endif
