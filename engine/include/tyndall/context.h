// context.h -- record a volumetric pass into a host's own Vulkan frame. Tier 3.
//
// The host owns instance, device, queue, command buffers and images. It makes a tyn_device on its
// VkDevice and a tyn_context per volume scene, calls tyn_context_prepare when sizes change, and
// tyn_context_record once a frame with its own command buffer.
//
// Contract:
//  (a) Clobbered on `cmd`: compute pipeline, compute descriptor sets, push constants; with surfaces in the
//      scene also graphics pipeline, graphics descriptor sets, viewport, scissor and other dynamic state.
//  (b) `before` of a host image is trusted, `after` is guaranteed; any layout, any stage. There is no
//      queue family transfer.
//  (c) If record fails, nothing was appended and host images are in their `before` state.
//  (d) Record i + frames_in_flight, and the prepare before it, are called after the GPU finished what record i appended.
//      What it appended is executed, in the order of the calls; else tyn_context_forget.
//  (e) record never submits, waits, or allocates device memory; prepare does the last two. After a prepare of the same frame
//      it allocates no host memory either; of surfaces or maps that changed without one it makes their tables.
//  (f) With `background`, a frame whose kernels are still being compiled gives TYN_PENDING: record then takes host
//      images from `before` to `after` with their content as it was, and appends nothing else. To ask for kernels it
//      allocates host memory.
//  (g) So does, with or without `background`, a record whose values ask for other grids or kernels than those that were
//      prepared, where sizes, formats, counts and settings are the same: prepare mends it. To call prepare in every frame is
//      cheap and never waits for the GPU.
#pragma once
#include "device.h"
#include "outputs.h"
#include "scene.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct tyn_context tyn_context;
typedef struct tyn_settings tyn_settings; // values of pass parameters; see registry.h

// Presets of those settings that trade error for time.
typedef enum tyn_quality {
    TYN_QUALITY_NORMAL = 0, // the defaults
    TYN_QUALITY_DRAFT,
    TYN_QUALITY_HIGH,
} tyn_quality;

typedef struct tyn_context_params {
    size_t struct_size TYN_PARAMS_SIZE(tyn_context_params);
    const char *method;           // one of tyndall/registry.h; NULL: "pop"
    const tyn_settings *settings; // NULL = defaults; copied; before the preset's
    uint32_t frames_in_flight;    // 1..8; 0 = 2
    bool readback;                // copy outputs to host memory (tyn_context_output)
    tyn_quality quality;
    // Bytes of device memory that the context may have at any time, uploads under way and what is replaced but may be in use by
    // frames in flight among them; 0 = no limit. Pipelines and descriptors are not counted. A prepare that would take more
    // gives TYN_ERR_MEMORY with one log line: what is needed, and the three largest resources. What was prepared before stays.
    uint64_t memory_budget;
} tyn_context_params;
#define tyn_context_params(...) TYN_PARAMS(tyn_context_params, __VA_ARGS__)
TYN_API tyn_result tyn_context_create(tyn_device *dev, const tyn_context_params *params,
                                      tyn_context **out);
TYN_API void tyn_context_destroy(tyn_context **ctx); // the GPU must be done with our work

// Changes a setting ("lattice.cells", "48"; `tyndall info --passes` lists them), or those of a preset, for the frames that
// come. Unknown names, bad numbers and values out of range are one log line and TYN_ERR_PARAMS, and change nothing. Some
// settings choose other kernels or grids: record refuses then, and prepare mends it.
TYN_API tyn_result tyn_context_set(tyn_context *ctx, const char *name, const char *value);
TYN_API tyn_result tyn_context_set_quality(tyn_context *ctx, tyn_quality quality);
// What is in effect: a number; of switches 0 or 1, of words their place in the list.
TYN_API tyn_result tyn_context_get(tyn_context *ctx, const char *name, double *value);

// "radiance", ... in lower case; of what is none of them "unknown".
TYN_API const char *tyn_output_name(tyn_output which);

typedef struct tyn_probe_result {
    float fluence[3];                // W/m^2
    float flux[9];                   // net flux, x_r x_g x_b y_r ... z_b, W/m^2
    float fluence_se[3], flux_se[9]; // standard errors (path), else 0
} tyn_probe_result;

typedef struct tyn_balance { // W, per channel
    double entering[3], emitted[3], absorbed_media[3], absorbed_surfaces[3], escaped[3],
        imbalance[3];
    double imbalance_se[3]; // its standard error (path), else 0
    // Least and most of the factors that make what the lattice gets of these lights agree with what they
    // send (pop); 0, 0: there are none.
    double scale_suns[2], scale_lamps[2], scale_vpls[2];
} tyn_balance;

// Where light of suns and surroundings goes that enters the media's box, along the axes of that box; with
// surfaces the box of a balance (docs/balance.md). Along axes on which the medium repeats the box has no faces,
// and its others stand for one period.
typedef struct tyn_flux_values { // W, per channel
    float incident[3];
    float leaving[6][3]; // through the faces -x, +x, -y, +y, -z, +z
    float direct[3];     // of that, what has met nothing
    // Leaves through faces that its light shines on when it enters, and through others: together all
    // that leaves.
    float reflected[3], transmitted[3];
    float absorbed_media[3], absorbed_surfaces[3];
    float arriving_surfaces[3]; // on surfaces, each time light meets one
    float missing[3]; // incident less all of it: 0 but for noise and for paths that were cut
} tyn_flux_values;
typedef struct tyn_fluxes {
    tyn_flux_values mean, se; // and standard errors
} tyn_fluxes;

// Samples of the same picture that an earlier context has taken, by the same method, settings and seed. Its outputs, RGBA
// each, as large as the view.
typedef struct tyn_resume {
    uint32_t num_samples;                           // of each pixel, > 0
    const float *radiance, *low, *deviation;        // Required
    const float *single, *multiple, *transmittance; // Required with the output of this name
    uint64_t hash; // another number whenever something above changes; not 0
} tyn_resume;

// What to compute and from where.
typedef struct tyn_view {
    tyn_camera camera;
    uint32_t width, height; // pixels, 1..16384
    // Not {0}: the picture is a part of one of `whole` (width, height), which camera or matrices are of, from `corner` (column,
    // row) on. Its pixels are those of the whole picture where it begins at multiples of 40 pixels and not within 24 of its
    // borders: tyn_offline renders such a part and gives the pixels that were asked for.
    uint32_t whole[2], corner[2];
    uint32_t outputs;   // set of tyn_output; 0 = RADIANCE
    bool no_background; // RGB is the medium alone, premultiplied
    float exposure_ev;  // for DISPLAY
    uint32_t seed;
    // Progressive methods (path): this record adds samples [first_sample, first_sample + num_samples)
    // of every pixel or point to what the context has accumulated; first_sample 0 starts anew.
    uint32_t first_sample, num_samples;
    // Pictures (path): random numbers are those of samples from here on, so that parts of a picture may be taken apart.
    uint32_t sample_offset;
    // Pictures (path): the record whose first_sample is resume->num_samples goes on from there, to the bit. NULL: from what
    // the context has accumulated.
    const tyn_resume *resume;
    uint32_t max_depth;       // path: longest path in scatterings; 0 = no limit but the safety cap
    uint32_t rr_depth;        // path: Russian roulette from this depth on; 0 = default
    const float (*points)[3]; // PROBE: world positions
    uint32_t num_points;
    bool scattered_only; // PROBE: without the uncollided light
    // Progressive methods: more samples follow before anybody looks. Pictures are undefined until a record without it (refined):
    // not together with COMPOSITE or images of the host's.
    bool unfinished;
    // Frame number of a sequence: importance.smoothing takes a step when it changes.
    uint64_t time_index;
    uint32_t cut; // another number forgets what earlier frames left (importance.smoothing,
                  // refine.carry): for another scene, or a camera that jumps
} tyn_view;

// Images of the host that take results: as large as the view, one sample a pixel, STORAGE. What was in them is lost, so
// `before` may be UNDEFINED. Each needs its output in tyn_view.outputs; NULL: not there.
typedef struct tyn_frame_images {
    const tyn_image *radiance, *transmittance; // rgba16f or rgba32f
    const tyn_image *depth; // r32f (depth) or rgba32f (depth, depth_t50, 0, 0), m
} tyn_frame_images;

// LIGHT: the light field over the media's box in 3D images, one a colour: fluence (x) and net flux along the world's axes
// (y, z, w), W/m^2. All three of one size, of the host's choice, and one format, rgba16f or rgba32f, with STORAGE; at most
// 1048576 texels. tyndall/light.glsl reads them, with the matrix of tyn_context_light.
typedef struct tyn_frame_lights {
    const tyn_image *red, *green, *blue; // Required
    // With light that comes straight from lights; else what has scattered, was emitted or reflected.
    bool unscattered;
} tyn_frame_lights;

typedef struct tyn_frame {
    size_t struct_size TYN_PARAMS_SIZE(tyn_frame);
    VkCommandBuffer cmd;    // Required: recording, outside a render pass
    const tyn_scene *scene; // Required: same counts and sizes as prepared; values may
                            // differ, but some choose other kernels or grids: record gives
                            // TYN_PENDING then, and prepare mends it (docs/events.md)
    const tyn_view *view;   // Required: same size, outputs and point count as prepared
    // One per volume whose data is NULL, in order, each an image of its own: 3D, as large as the volume, SAMPLED; red, a number
    // from 0 on, is the density: UNORM, SFLOAT or UFLOAT.
    const tyn_image *densities;
    const uint64_t *density_versions; // NULL = they may have changed every frame
    // COMPOSITE: hardware depth of the host's surfaces, or NULL. D16, D24 or D32 with or without stencil, SAMPLED, one sample
    // a pixel (resolve before), as large as `color`.
    const tyn_image *depth;
    // Required with depth and with world_to_view: the projection, view space (x right, y up, looking along -z) to Vulkan's
    // clip space, z / w in [0, 1], by columns. Without world_to_view only how z and w follow from z is read, so it makes no
    // difference whether it turns y over.
    float view_to_clip[16];
    // Not all 0: the picture is taken by view_to_clip x world_to_view, and view.camera is not read. Affine, in metres in the
    // world, by columns. Any perspective (off-axis, reversed or infinite z) or parallel projection whose picture has right
    // angles; row 0 of pixels is at clip y = -w, as under a viewport of positive height. Rays begin in the eye; parallel ones
    // where view z is 0.
    float world_to_view[16];
    // Pixels: the ray of pixel (x, y) goes through (x + 0.5 + jitter[0], y + 0.5 + jitter[1]), y down. For temporal
    // anti-aliasing, where the matrix does not hold it already. `depth` is of the moved picture.
    float jitter[2];
    // COMPOSITE: Required; rgba16f or rgba32f, STORAGE, one sample a pixel. As large as the view; or exactly twice that, and
    // `depth` as well: then the medium is laid over it by bilinear upsampling that keeps to the edges in `depth`.
    const tyn_image *color;
    tyn_frame_images images;
    tyn_frame_lights light;
    // Kernels that are missing are compiled beside the call (tyn_device_params.jobs, compile_threads), not in it: prepare
    // and record give TYN_PENDING meanwhile and change nothing that was prepared before, so that frames like those may go
    // on. The call is cheap: prepare in each frame until it gives TYN_OK, or when tyn_context_pending gives 0.
    bool background;
    bool recompute;  // run every node but those that depend on the media alone, changed or not
    bool setup_only; // record only uploads and nodes that depend on the media alone
    // For prepare: the GPU is done with all earlier records. What it replaces goes before it allocates, so that both never
    // take memory at once; else what was replaced stays until the frames that were recorded with it are over.
    bool idle;
} tyn_frame;
#define tyn_frame(...) TYN_PARAMS(tyn_frame, __VA_ARGS__)

// Allocates for this scene and view. Cheap if nothing structural changed. Earlier records may still be under way (d).
// `frame.cmd` is not used; images must have their formats and extents.
TYN_API tyn_result tyn_context_prepare(tyn_context *ctx, const tyn_frame *frame);
TYN_API tyn_result tyn_context_record(tyn_context *ctx, const tyn_frame *frame);

// What was recorded last was not executed: its submission failed, or its command buffer was thrown away. All is made anew by
// the next prepare, and what progressive methods accumulated is lost. The GPU must be done with earlier records.
TYN_API void tyn_context_forget(tyn_context *ctx);

// How many kernels are still to be compiled of the last frame that gave TYN_PENDING. 0: prepare it again.
TYN_API uint32_t tyn_context_pending(tyn_context *ctx);

// LIGHT, after prepare or record: the way from world positions to texture coordinates of tyn_frame.light, by columns. It
// changes with the media's boxes alone.
TYN_API tyn_result tyn_context_light(const tyn_context *ctx, float world_to_texture[16]);

// With `readback`: host memory of an output of the last record, once the GPU has finished it: 4
// floats a pixel (DISPLAY: 4 bytes), or the probe and balance structs. NULL if it was not asked
// for. Valid until the next call.
TYN_API const void *tyn_context_output(tyn_context *ctx, tyn_output output);

// ---- what happened --------------------------------------------------------------------------

typedef struct tyn_node_report {
    const char *name;
    const char *state; // "ran", "unchanged", "culled", "empty"
    double gpu_ms, cpu_ms;
    uint32_t dispatches, barriers; // barriers: commands, however many resources wait
    // Device memory of what the node makes and works in; of it, what lies where that of other nodes does, so that sums over nodes
    // count it more than once.
    uint64_t bytes, shared_bytes;
    double flops;
    struct {
        const char *name;
        double amount;
    } work[8];
    uint32_t num_work;
    bool media_only; // depends on the media alone: part of the set-up, not of a frame
} tyn_node_report;

typedef struct tyn_report {
    const tyn_node_report *nodes;
    uint32_t num_nodes;
    // On the device: kept between frames; what more nodes need while they run.
    uint64_t persistent_bytes, transient_bytes;
    const char *const *warnings; // what the method left out or approximated, one line each
    uint32_t num_warnings;
} tyn_report;
// Of the last record, once the GPU has finished it. Valid until the next call on the context.
TYN_API void tyn_context_report(tyn_context *ctx, tyn_report *report);

// Progressive methods: the most samples that one record should be asked for, so that no dispatch runs
// long (>= 1). Others: 1. After prepare; on a card anew before each record, as it follows the times of those before.
TYN_API uint32_t tyn_context_batch(tyn_context *ctx, const tyn_frame *frame);

// What one pass made, for looking at: the image at its debug port (`tyndall info --passes`).
typedef struct tyn_inspection {
    const char *port, *meaning; // which one, and a word on it
    VkFormat format;            // of `texels`, tightly packed, x fastest
    uint32_t size[3];           // texels; [2] = 1 for a 2D image
    const void *texels;         // valid until the next call on the context
} tyn_inspection;
// From the next prepare on; NULL = nothing. The name must live as long. Needs params.readback.
TYN_API void tyn_context_inspect(tyn_context *ctx, const char *pass);
// Of the last finished record. False: the frame has no such node, or what it makes is no image.
TYN_API bool tyn_context_inspection(tyn_context *ctx, tyn_inspection *inspection);

// The compiled graph as text or Graphviz; freed with free(). NULL: the last prepare or record did not give TYN_OK.
TYN_API char *tyn_context_graph(tyn_context *ctx, bool dot);

#ifdef __cplusplus
} // extern "C"

// The same, of a reference.
inline tyn_result tyn_context_create(tyn_device *dev, const tyn_context_params &params,
                                     tyn_context **out)
{
    return tyn_context_create(dev, &params, out);
}
inline tyn_result tyn_context_prepare(tyn_context *ctx, const tyn_frame &frame)
{
    return tyn_context_prepare(ctx, &frame);
}
inline tyn_result tyn_context_record(tyn_context *ctx, const tyn_frame &frame)
{
    return tyn_context_record(ctx, &frame);
}
inline uint32_t tyn_context_batch(tyn_context *ctx, const tyn_frame &frame)
{
    return tyn_context_batch(ctx, &frame);
}
#endif
