// false_colour.c -- tables and dispatch of pass "false_colour", and its place between march and composite.
#include "false_colour.h"
#include "false_colour_args.h"
#include "false_colour_show.comp.h"

static const tyn_port ports[] = {FALSE_COLOUR_PORTS(TYN_PORT_ROW)};
static const tyn_kernel kernels[] = {TYN_KERNEL(false_colour_show)};

static tyn_result declare(tyn_builder *b, const void *params)
{
    (void)params;
    tyn_build_image(b, FALSE_COLOUR_PORT_COLOURS, tyn_build_extent(b, FALSE_COLOUR_PORT_RADIANCE),
                    1);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const false_colour_params *p = params;
    const struct false_colour_args args = {(tyn_uint)p->of, p->most};
    TYN_DISPATCH(r, .kernel = 0, .cells = tyn_rec_extent(r, FALSE_COLOUR_PORT_COLOURS),
                 .args = &args);
}

static const char *const quantities[] = {"optical_depth", "transmittance", "distance"};
static const tyn_param table[] = {
    {"show", TYN_PARAM_BOOL, offsetof(false_colour_params, show), 0, 0, 1, "",
     "colours in place of the picture", NULL},
    {"of", TYN_PARAM_ENUM, offsetof(false_colour_params, of), 0, 0, 2, "",
     "what is shown: optical depth, transmittance, or the distance at which half of what is behind "
     "is hidden",
     quantities},
    {"most", TYN_PARAM_FLOAT, offsetof(false_colour_params, most), 4, 1e-6, 1e6, "",
     "what the last colour stands for; of distances in m", NULL},
};

const tyn_pass_desc pass_false_colour = {
    .name = "false_colour",
    .summary = "optical depth, transmittance or distance of the medium in colours",
    .serves = "false_colour.show",
    TYN_PASS_TABLES(false_colour_params),
    .of_pixels = true,
    .params = table,
    .num_params = TYN_COUNT(table),
    .debug_port = FALSE_COLOUR_PORT_COLOURS,
    .debug_meaning = "the colours",
};

static uint32_t reads(const tyn_job *job)
{
    false_colour_params params;
    tyn_settings_params(job->settings, &pass_false_colour, &params);
    return !params.show                         ? 0
           : params.of == FALSE_COLOUR_DISTANCE ? TYN_OUTPUT_RADIANCE | TYN_OUTPUT_DEPTH
                                                : TYN_OUTPUT_RADIANCE | TYN_OUTPUT_TRANSMITTANCE;
}

static void show(tyn_graph *g, const tyn_job *job, tyn_picture *picture)
{
    false_colour_params params;
    tyn_settings_params(job->settings, &pass_false_colour, &params);
    tyn_ref refs[FALSE_COLOUR_NUM_PORTS] = {
        [FALSE_COLOUR_PORT_RADIANCE] = picture->radiance,
        [FALSE_COLOUR_PORT_TRANSMITTANCE] = picture->transmittance,
        [FALSE_COLOUR_PORT_DEPTH] = picture->depth,
    };
    tyn_graph_add(g, &pass_false_colour, &params, refs);
    picture->radiance = refs[FALSE_COLOUR_PORT_COLOURS];
}

const tyn_picture_hook hook_false_colour = {"false_colour", reads, show};
