// photon_view.c -- tables of what the cache sends to the eye.
#include "photon_view.h"
#include "photon_view_args.h"
#include "shaders/common/counters.h"
#include "passes/photon_view_tables.h"
#include <string.h>

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_photon_view_params *p = params;
    const tyn_extent n = tyn_build_extent(b, PHOTON_VIEW_PORT_FLUENCE);
    tyn_build_image(b, PHOTON_VIEW_PORT_INSCATTER,
                    (tyn_extent){n.x + 2, n.y + 2, n.z / p->lobes + 2}, 1);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_photon_view_params *p = params;
    const tyn_extent all = tyn_rec_extent(r, PHOTON_VIEW_PORT_FLUENCE);
    const tyn_extent n = {all.x, all.y, all.z / p->lobes};
    const struct photon_view_args args = {
        .dims = {n.x, n.y, n.z},
        .sun = {p->axis[0], p->axis[1], p->axis[2]},
        .lobes = p->lobes,
        .suns = p->has_sun,
        .sun_is = p->sun ? PHOTON_LOBE_FLUX : PHOTON_LOBE_AXIS,
        .sky_is = p->sky ? PHOTON_LOBE_FLUX : PHOTON_LOBE_EVEN,
        .scaled = p->scaled,
    };
    TYN_DISPATCH(r, .cells = {n.x + 2, n.y + 2, n.z + 2}, .args = &args, .spec = &p->mode);
    tyn_rec_work(r, "cells", (double)n.x * n.y * n.z);
}

static const char *const suns[] = {"axis", "lobe"};
static const char *const skies[] = {"even", "lobe"};

static const tyn_param param_table[] = {
    {"sun", TYN_PARAM_ENUM, offsetof(tyn_photon_view_params, sun), 1, 0, 1, "",
     "directions of the strongest sun's light: axis = about the sun, as published; lobe = about "
     "its "
     "net flux in each cell",
     suns},
    {"sky", TYN_PARAM_ENUM, offsetof(tyn_photon_view_params, sky), 1, 0, 1, "",
     "directions of light that is not the strongest sun's: even = from all alike, as published; "
     "lobe = about its net flux in each cell",
     skies},
};

const tyn_pass_desc tyn_pass_photon_view = {
    .name = "photon_view",
    .summary = "what photons' light scatters towards the eye",
    TYN_PASS_TABLES(tyn_photon_view_params),
    TYN_SETTINGS(param_table),
    .debug_port = PHOTON_VIEW_PORT_INSCATTER,
    .debug_meaning = "light scattered towards the eye, per sigma_s",
    TYN_COUNTS(PHOTON_VIEW_PORT_COUNTERS, struct counters_block, TYN_COUNTER_NON_FINITE),
};
