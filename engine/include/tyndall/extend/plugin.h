// plugin.h -- passes, methods and hooks in a shared object of their own. Tier 12.
//
// A plugin is one file more than the passes and methods themselves: static tables, and TYN_PLUGIN in one C or C++ file. It
// is compiled with -DTYN_PLUGIN_BUILD (pkg-config's tyndall-plugin says so), links nothing of Tyndall (calls.h), and is
// loaded by tyn_plugin_load, or `tyndall COMMAND --plugin FILE.so`. docs/writing-a-plugin.md walks through one.
#pragma once
#include <tyndall/extend/calls.h>
#include <stdarg.h>
#include <stdio.h>

// Rises whenever anything in the headers of this folder, in a struct that they hold, or in what the GLSL under shaders/ reads
// changes its meaning, or a block of the GLSL its layout. A plugin of another number is refused when it is loaded.
#define TYN_EXTEND_ABI 17u

// clang-format off
// The sizes of all structs that a plugin and the library both know, in one number: what differs in them is refused even if
// the number above was forgotten.
#define TYN_LAYOUT_STEP(before, type) ((before) * 16777619u ^ (uint32_t)sizeof(type))
#define TYN_LAYOUT_PASS \
    TYN_LAYOUT_STEP(TYN_LAYOUT_STEP(TYN_LAYOUT_STEP(TYN_LAYOUT_STEP(TYN_LAYOUT_STEP(TYN_LAYOUT_STEP(TYN_LAYOUT_STEP( \
        TYN_LAYOUT_STEP(TYN_LAYOUT_STEP(2166136261u, tyn_port), tyn_binding), tyn_raster), tyn_kernel), tyn_param), \
        tyn_counter), tyn_pass_desc), tyn_dispatch), tyn_draw)
#define TYN_LAYOUT_JOB \
    TYN_LAYOUT_STEP(TYN_LAYOUT_STEP(TYN_LAYOUT_STEP(TYN_LAYOUT_STEP(TYN_LAYOUT_STEP(TYN_LAYOUT_STEP(TYN_LAYOUT_STEP( \
        TYN_LAYOUT_STEP(TYN_LAYOUT_PASS, tyn_scene), tyn_view), tyn_frame_scene), tyn_lights), tyn_scene_refs), \
        tyn_job), tyn_picture_hook), tyn_lattice_shape)
#define TYN_EXTEND_LAYOUT \
    TYN_LAYOUT_STEP(TYN_LAYOUT_STEP(TYN_LAYOUT_STEP(TYN_LAYOUT_STEP(TYN_LAYOUT_STEP(TYN_LAYOUT_STEP(TYN_LAYOUT_STEP( \
        TYN_LAYOUT_STEP(TYN_LAYOUT_JOB, tyn_sources), tyn_rsm), tyn_field), tyn_view_inputs), tyn_limit), tyn_regime), \
        tyn_method), tyn_calls)
// clang-format on

#ifdef __cplusplus
extern "C" {
#endif

typedef struct tyn_plugin {
    uint32_t
        abi; // TYN_EXTEND_ABI of the headers that it was built with; the first two members never move
    uint32_t version;        // TYN_VERSION of them
    uint32_t layout;         // TYN_EXTEND_LAYOUT of them
    const char *name;        // "diffusion": for messages; letters, digits, '_' and '-'
    const char *summary;     // one line
    const tyn_calls **calls; // where the loader puts the table, before anything is called
    // Each NULL at the end; NULL = none. Passes that methods name are among these or the library's.
    const tyn_pass_desc *const *passes;
    const tyn_method *const *methods;
    const tyn_picture_hook *const *hooks;
} tyn_plugin;

#if defined(_WIN32)
extern __declspec(dllexport) const tyn_plugin tyn_plugin_entry;
#else
extern __attribute__((visibility("default"))) const tyn_plugin tyn_plugin_entry;
#endif

#ifdef __cplusplus
}
#endif

// clang-format off
#define TYN_CALL_DEFINE(type, name, params, args) type name params { return tyn_plugin_calls->name args; }
#define TYN_CALL_DEFINE_VOID(name, params, args) void name params { tyn_plugin_calls->name args; }
#define TYN_PLUGIN_LINE(line, format) \
    char line[512]; \
    va_list arguments; \
    va_start(arguments, format); \
    vsnprintf(line, sizeof line, format, arguments); \
    va_end(arguments)

// The one thing that a plugin exports, and the functions that it calls:
//   TYN_PLUGIN("diffusion", "a diffusion solver", passes, methods, hooks)
// Where it is built into the library, the build defines TYN_BUILT_IN, the name of its table; it calls the library straight.
#if defined(TYN_BUILT_IN)
#define TYN_PLUGIN(its_name, its_summary, its_passes, its_methods, its_hooks) \
    extern const tyn_plugin TYN_BUILT_IN; \
    const tyn_plugin TYN_BUILT_IN = {TYN_EXTEND_ABI, TYN_VERSION, TYN_EXTEND_LAYOUT, its_name, its_summary, NULL, \
                                     its_passes, its_methods, its_hooks};
#else
#define TYN_PLUGIN(its_name, its_summary, its_passes, its_methods, its_hooks) \
    static const tyn_calls *tyn_plugin_calls; \
    TYN_CALLS(TYN_CALL_DEFINE, TYN_CALL_DEFINE_VOID) \
    void tyn_log_print(const tyn_log *log, tyn_log_level level, const char *format, ...) \
    { \
        TYN_PLUGIN_LINE(line, format); \
        if (log && log->fn && level <= log->level) { \
            log->fn(log->user, level, line); \
        } \
    } \
    void tyn_job_warn(const tyn_job *job, const char *format, ...) \
    { \
        TYN_PLUGIN_LINE(line, format); \
        if (job->warn) { \
            job->warn(job->warn_user, line); \
        } \
    } \
    const tyn_plugin tyn_plugin_entry = {TYN_EXTEND_ABI, TYN_VERSION, TYN_EXTEND_LAYOUT, its_name, its_summary, &tyn_plugin_calls, \
                                         its_passes, its_methods, its_hooks};
#endif
// clang-format on
