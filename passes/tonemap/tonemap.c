// tonemap.c -- the display transform: exposure, filmic curve, sRGB encoding, ordered dither.
#include "tonemap.h"
#include "tonemap_args.h"
#include "passes/tonemap_tables.h"
#include <math.h>

static const char *const curve_names[TONEMAP_NUM_CURVES] = {"filmic", "linear"};

static const tyn_param params_table[] = {
    {"curve", TYN_PARAM_ENUM, offsetof(tyn_tonemap_params, curve), 0, 0, TONEMAP_NUM_CURVES - 1, "",
     "filmic: ACES-like shoulder and toe; linear: clipped at 1", curve_names},
    {"dither", TYN_PARAM_BOOL, offsetof(tyn_tonemap_params, dither), 1, 0, 1, "",
     "hide the steps of 8 bits by an 8x8 ordered pattern", NULL},
};

static tyn_result declare(tyn_builder *b, const void *params)
{
    (void)params;
    tyn_build_image(b, TONEMAP_PORT_DISPLAY, tyn_build_extent(b, TONEMAP_PORT_RADIANCE), 1);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_tonemap_params *p = params;
    struct tonemap_args args = {
        .scale = exp2f(p->exposure_ev),
        .filmic = p->curve == TONEMAP_CURVE_FILMIC,
        .dither = p->dither,
        .opaque = p->opaque,
    };
    TYN_DISPATCH(r, .kernel = KERNEL_DISPLAY, .cells = tyn_rec_extent(r, TONEMAP_PORT_DISPLAY),
                 .args = &args);
}

const tyn_pass_desc tyn_pass_tonemap = {
    .name = "tonemap",
    .summary = "scene-linear radiance to 8-bit sRGB",
    .serves = "pictures of 8 bits",
    TYN_PASS_TABLES(tyn_tonemap_params),
    .of_pixels = true,
    TYN_SETTINGS(params_table),
    .debug_port = TONEMAP_PORT_DISPLAY,
    .debug_meaning = "the picture as shown",
};
