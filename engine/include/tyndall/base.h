// base.h -- results, the log, the version. Tier 0: every other header builds on this one.
//
// Conventions of all Tyndall headers:
//  * Units are SI: metres, seconds, radians, W/m^2 (irradiance, fluence), W/(m^2 sr) (radiance),
//    W/sr (radiant intensity), 1/m (sigma_s, sigma_a). Colours are linear RGB, Rec.709 primaries.
//  * Directions of light are directions of travel. Matrices are column-major.
//  * `{0}` means "default" for every field that is not marked Required.
//  * A params struct needs to live only until the call returns.
//  * A create function gives back TYN_OK and an object or a negative result and NULL; a destroy
//    function takes the address of the variable, accepts NULL inside it, and clears it.
//  * Thread-safety: an object is used by one thread at a time; different objects are independent.
//    The only globals are the lists of what plugins have added (registry.h), which may be asked on any thread.
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

// Params structs hold their size. The macro of the same name makes one where a call wants it: what is not named is 0. In C++
// it takes designators (C++20), members in their order; or declare one, `tyn_frame frame{};`, which has its size, set
// members, and give it as it is: calls take references as well.
#ifdef __cplusplus
} // extern "C"
template <class T> const T *tyn_address_of(const T &params)
{
    return &params;
}
extern "C" {
#define TYN_PARAMS(type, ...) (tyn_address_of(type{.struct_size = sizeof(type), __VA_ARGS__}))
#define TYN_PARAMS_SIZE(type) = sizeof(type)
#else
#define TYN_PARAMS(type, ...) (&(type){.struct_size = sizeof(type), __VA_ARGS__})
#define TYN_PARAMS_SIZE(type)
#endif

#if defined(_WIN32)
#define TYN_API
#elif defined(TYN_PLUGIN_BUILD) // a plugin has the calls of its own (extend/plugin.h)
#define TYN_API __attribute__((visibility("hidden")))
#else
#define TYN_API __attribute__((visibility("default")))
#endif

#if defined(__GNUC__)
#define TYN_PRINTF(fmt, args) __attribute__((format(printf, fmt, args)))
#else
#define TYN_PRINTF(fmt, args)
#endif

#define TYN_VERSION_MAJOR 0
#define TYN_VERSION_MINOR 1
#define TYN_VERSION_PATCH 0
#define TYN_VERSION (TYN_VERSION_MAJOR * 1000u + TYN_VERSION_MINOR * 10u + TYN_VERSION_PATCH)

// The version of the library that is really linked, and as text ("0.1.0").
TYN_API uint32_t tyn_version(void);
TYN_API const char *tyn_version_string(void);

typedef enum tyn_result {
    TYN_OK = 0,
    TYN_PENDING =
        1, // no error: kernels are still compiled (tyn_frame.background); try a later frame
    TYN_ERR_PARAMS = -1,      // an argument or an input is wrong (the tool exits 2)
    TYN_ERR_UNSUPPORTED = -2, // valid, but this device or this build cannot do it
    TYN_ERR_MEMORY = -3,      // out of host or device memory
    TYN_ERR_DEVICE = -4,      // no device, or a Vulkan call failed
    TYN_ERR_IO = -5,          // a file cannot be read or written
    TYN_ERR_STOPPED = -6,     // a callback of the caller's asked to stop
} tyn_result;

typedef enum tyn_log_level {
    TYN_LOG_ERROR = 0,
    TYN_LOG_WARN,
    TYN_LOG_INFO,
    TYN_LOG_DEBUG
} tyn_log_level;

// Where messages go. A NULL `tyn_log *` and a NULL `fn` are silence. One message is one line
// without a newline: what, where, and what would be right. Called on the calling thread.
typedef struct tyn_log {
    void (*fn)(void *user, tyn_log_level level, const char *message);
    void *user;
    tyn_log_level level; // messages above this level are dropped
} tyn_log;

TYN_API void tyn_log_print(const tyn_log *log, tyn_log_level level, const char *format, ...)
    TYN_PRINTF(3, 4);
// The value `result`, and why in the log: return TYN_FAULT(log, TYN_ERR_PARAMS, "'%s' is not there", name);
#define TYN_FAULT(log, result, ...) (tyn_log_print(log, TYN_LOG_ERROR, __VA_ARGS__), result)

#ifdef __cplusplus
}
#endif
