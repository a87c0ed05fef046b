// offline.h -- render to host memory with a device of our own. Tier 4: built on context.h only.
//
// For tools, tests and researchers; a host renderer uses context.h.
#pragma once
#include "registry.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct tyn_offline tyn_offline;

typedef struct tyn_offline_params {
    size_t struct_size TYN_PARAMS_SIZE(tyn_offline_params);
    const char *method;
    const tyn_settings *settings;
    uint64_t memory_budget; // bytes, as in tyn_context_params; 0 = no limit
} tyn_offline_params;
#define tyn_offline_params(...) TYN_PARAMS(tyn_offline_params, __VA_ARGS__)

// `dev` must come from tyn_device_open; borrowed.
TYN_API tyn_result tyn_offline_create(tyn_device *dev, const tyn_offline_params *params,
                                      tyn_offline **out);
TYN_API void tyn_offline_destroy(tyn_offline **off);

// Prepares if needed, records one frame, submits and waits. Progressive methods: one call adds
// view->num_samples samples, split into dispatches that respect the time limit of the device. After an error what was
// accumulated is lost: begin again with view->first_sample 0.
//
// Of a part of a picture (view->whole) methods that are not progressive render up to 63 pixels more on a side, so that
// its pixels are those of the whole picture, by the defaults of what shares light between pixels and but for rounding
// (docs/surfaces.md, "Limits"). The report and its times are of all that is rendered. Where that is more pixels along a side
// than a picture may have, there is no margin.
TYN_API tyn_result tyn_offline_frame(tyn_offline *off, const tyn_scene *scene, const tyn_view *view,
                                     bool recompute);
// A foreign density image, depth or composite target cannot be given here.

// Called between the records of such a frame with the share of its samples that is done. False stops
// it: tyn_offline_frame returns TYN_ERR_STOPPED, and the outputs are of tyn_offline_samples. They may be read in the call.
typedef bool (*tyn_progress_fn)(void *user, double fraction);
TYN_API void tyn_offline_on_progress(tyn_offline *off, tyn_progress_fn fn, void *user);

// Samples of each pixel or point that the last frame has done, during it and after it: after TYN_ERR_STOPPED fewer than were
// asked for, and the outputs are of these.
TYN_API uint32_t tyn_offline_samples(const tyn_offline *off);

// NULL: the frame has not made it, or there is no memory. Valid until the next frame, or the next call for the same output.
TYN_API const void *tyn_offline_output(tyn_offline *off, tyn_output output);
// Of the last frame: times, dispatches and work of a node are sums over the frame's records.
TYN_API void tyn_offline_report(tyn_offline *off, tyn_report *report);
TYN_API tyn_context *tyn_offline_context(tyn_offline *off);
TYN_API double tyn_offline_setup_ms(const tyn_offline *off); // pipelines, uploads, media-only nodes
// Wall clock of the last frame, fence to fence.
TYN_API double tyn_offline_frame_ms(const tyn_offline *off);

// Runs one node of a pass alone, `runs` times, and gives the shortest time in ms (GPU time where the device
// has timestamps). The pass may be anybody's: it need not be registered. Its inputs are not connected, so
// all of them must be optional; what it makes is thrown away. `params` has pass->params_size bytes. The first
// run counts the compilation of the kernels on some devices: ask for more than one.
TYN_API tyn_result tyn_offline_time_pass(tyn_device *dev, const tyn_pass_desc *pass,
                                         const void *params, uint32_t runs, double *best_ms);

#ifdef __cplusplus
} // extern "C"

// The same, of a reference.
inline tyn_result tyn_offline_create(tyn_device *dev, const tyn_offline_params &params,
                                     tyn_offline **out)
{
    return tyn_offline_create(dev, &params, out);
}
#endif
