// impostor.c -- tables of the impostor.
#include "impostor.h"
#include "impostor_args.h"
#include "passes/impostor_tables.h"

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_impostor_params *p = params;
    const tyn_extent size = {p->width, p->height, 1};
    tyn_build_image(b, IMPOSTOR_PORT_RADIANCE, size, 1);
    tyn_build_image(b, IMPOSTOR_PORT_TRANSMITTANCE, size, 1);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_impostor_params *p = params;
    const struct impostor_args args = {.background = p->background};
    TYN_DISPATCH(r, .cells = {p->width, p->height, 1}, .args = &args);
}

static const tyn_param param_table[] = {
    {"on", TYN_PARAM_BOOL, offsetof(tyn_impostor_params, on), 0, 0, 1, "",
     "march the media anew only where the view has changed by more than the next two say; not "
     "among "
     "surfaces, nor from within",
     NULL},
    {"angle", TYN_PARAM_FLOAT, offsetof(tyn_impostor_params, angle), 5, 0.1, 45, "degrees",
     "under which the media are seen", NULL},
    {"distance", TYN_PARAM_FLOAT, offsetof(tyn_impostor_params, distance), 0.2, 0.001, 1, "",
     "from the media, relative", NULL},
};

const tyn_pass_desc tyn_pass_impostor = {
    .name = "impostor",
    .summary = "the media as they were marched last, seen by another camera",
    .serves = "impostors (impostor.on)",
    TYN_PASS_TABLES(tyn_impostor_params),
    .of_pixels = true,
    TYN_SETTINGS(param_table),
    .debug_port = IMPOSTOR_PORT_RADIANCE,
    .debug_meaning = "radiance, exposed by its own mean",
};
