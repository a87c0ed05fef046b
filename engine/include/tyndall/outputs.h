// tyndall/outputs.h -- what a frame can give back: the one table that lists of outputs are made from.
#pragma once

// X(constant, bit, name, bytes, set)
//   bytes  a pixel of a picture that is read back; 0: no picture, or one that goes into an image of the host
//   set    VIEW: gathered along the rays of a camera. GUIDE: as well, and read by denoisers: of the first surfaces, means over
//          the pixel, 0 where there is none (methods that draw surfaces). SAMPLES: of pictures that are sampled (path).
//          FIELD: without a camera.
// RADIANCE      RGBA32F; RGB radiance, A as in docs/scene-format.md, "Output"
// DEPTH         RGBA32F: depth, depth_t50, 0, 0
// ERROR         RGBA32F: standard error of the mean
// DISPLAY       RGBA8: tone mapped, sRGB encoded
// PROBE         buffer of tyn_probe_result, one a point
// BALANCE       buffer: tyn_balance
// COMPOSITE     into tyn_frame.color
// FLUXES        buffer: tyn_fluxes (path)
// LIGHT         into tyn_frame.light
// LOW           RGBA32F: what single precision has lost of the mean: radiance and alpha less this. RADIANCE, LOW and DEVIATION
//               are all that the samples so far have left, for tyn_resume.
// DEVIATION     RGBA32F; RGB: sum of squared deviations of the radiance; A: mean alpha
// ALBEDO        RGBA32F; RGB 0 to 1; A: share of the pixel that shows a surface
// NORMAL        RGBA32F; XYZ for shading, world, towards the camera; shorter than 1 where they differ
// BIAS          RGBA32F: estimated error of the picture that was refined (refined), root mean square; ERROR: of the result
// Others are RGBA32F.
#define TYN_OUTPUTS(X)                                                                             \
    X(RADIANCE, 0, "radiance", 16, VIEW)                                                           \
    X(TRANSMITTANCE, 1, "transmittance", 16, VIEW)                                                 \
    X(DEPTH, 2, "depth", 16, VIEW)                                                                 \
    X(SINGLE, 3, "single", 16, VIEW)                                                               \
    X(MULTIPLE, 4, "multiple", 16, VIEW)                                                           \
    X(ERROR, 5, "error", 16, SAMPLES)                                                              \
    X(DISPLAY, 6, "display", 4, VIEW)                                                              \
    X(PROBE, 7, "probe", 0, FIELD)                                                                 \
    X(BALANCE, 8, "balance", 0, FIELD)                                                             \
    X(COMPOSITE, 9, "composite", 0, VIEW)                                                          \
    X(FLUXES, 10, "fluxes", 0, FIELD)                                                              \
    X(LIGHT, 11, "light", 0, FIELD)                                                                \
    X(LOW, 12, "low", 16, SAMPLES)                                                                 \
    X(DEVIATION, 13, "deviation", 16, SAMPLES)                                                     \
    X(ALBEDO, 14, "albedo", 16, GUIDE)                                                             \
    X(NORMAL, 15, "normal", 16, GUIDE)                                                             \
    X(BIAS, 16, "bias", 16, SAMPLES)

#define TYN_OUTPUT_BIT(constant, bit, name, bytes, set) TYN_OUTPUT_##constant = 1 << bit,
typedef enum tyn_output { TYN_OUTPUTS(TYN_OUTPUT_BIT) } tyn_output; // a set

#define TYN_OUTPUT_INDEX(constant, bit, name, bytes, set) TYN_INDEX_##constant = bit,
enum { TYN_OUTPUTS(TYN_OUTPUT_INDEX) };

#define TYN_OUTPUT_ONE(constant, bit, name, bytes, set) +1
enum { TYN_NUM_OUTPUTS = 0 TYN_OUTPUTS(TYN_OUTPUT_ONE) };

// The outputs of sets, as a constant.
enum { TYN_SET_VIEW = 1, TYN_SET_GUIDE = 2, TYN_SET_SAMPLES = 4, TYN_SET_FIELD = 8 };
#define TYN_OUTPUT_GUIDE(constant, bit, name, bytes, set)                                          \
    | (TYN_SET_##set & TYN_SET_GUIDE ? 1 << bit : 0)
#define TYN_OUTPUT_PICTURE(constant, bit, name, bytes, set)                                        \
    | (TYN_SET_##set & (TYN_SET_VIEW | TYN_SET_GUIDE) ? 1 << bit : 0)
enum {
    TYN_GUIDE_OUTPUTS = 0 TYN_OUTPUTS(TYN_OUTPUT_GUIDE),
    TYN_PICTURE_OUTPUTS = 0 TYN_OUTPUTS(TYN_OUTPUT_PICTURE)
};
