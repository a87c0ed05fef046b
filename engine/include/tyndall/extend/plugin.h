// plugin.h -- passes, methods and hooks in a shared object of their own. Tier 12.
//
// A plugin is one file more than the passes and methods themselves: static tables, and TYN_PLUGIN in one C or C++ file. It
// is compiled with -DTYN_PLUGIN_BUILD (pkg-config's tyndall-plugin says so), links nothing of Tyndall (calls.h), and is
// loaded by tyn_plugin_load, or `tyndall COMMAND --plugin FILE.so`. docs/writing-a-plugin.md walks through one.
#pragma once
#include "calls.h"
#include <stdarg.h>
#include <stdio.h>

// Rises whenever anything in the headers of this folder, in a struct that they hold, or in what the GLSL under shaders/ reads
// changes its layout or its meaning. A plugin of another number is refused when it is loaded.
#define TYN_EXTEND_ABI 1u

#ifdef __cplusplus
extern "C" {
#endif

typedef struct tyn_plugin {
    uint32_t
        abi; // TYN_EXTEND_ABI of the headers that it was built with; the first three members never move
    uint32_t version;        // TYN_VERSION of them
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
    const tyn_plugin tyn_plugin_entry = {TYN_EXTEND_ABI, TYN_VERSION, its_name, its_summary, &tyn_plugin_calls, \
                                         its_passes, its_methods, its_hooks};
// clang-format on
