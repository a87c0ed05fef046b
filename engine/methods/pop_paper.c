// pop_paper.c -- method "pop-paper": principal-ordinates propagation as published in 2014.
//
// The light of each sun, scattered or not, moves from cell to cell of the sun's own aligned grid; what
// it sends to the eye is upsampled with the medium as guide and marched. Kept as it was published (the
// readings are settings of propagate_rect): the baseline of method "pop".
#include "methods/nodes.h"
#include "passes/medium/medium.h"
#include "passes/propagate_rect/propagate_rect.h"
#include "passes/upsample/upsample.h"
#include "passes/merge_grids/merge_grids.h"
#include "passes/composite/composite.h"
#include "passes/tonemap/tonemap.h"
#include <tyndall/registry.h>
#include <math.h>
#include <string.h>

// What the two passes hand on.
typedef struct propagated {
    tyn_propagate_rect_params params;
    tyn_ref refs[PROPAGATE_RECT_NUM_PORTS];
} propagated;

static tyn_result add_propagation(tyn_graph *g, const tyn_job *job, const tyn_picture_inputs *in,
                                  propagated *light)
{
    tyn_settings_params(job->settings, &tyn_pass_propagate_rect, &light->params);
    light->params.num_suns = in->num_suns;
    light->params.channels = job->frame->grey ? 1 : 3;
    light->params.mode = job->frame->medium.mode;
    memcpy(light->params.extent, job->frame->medium.extent, sizeof light->params.extent);
    memcpy(light->params.size, job->frame->medium.size, sizeof light->params.size);
    light->refs[PROPAGATE_RECT_PORT_MEDIUM] = job->refs.medium;
    light->refs[PROPAGATE_RECT_PORT_LIGHTS] = job->refs.lights;
    light->refs[PROPAGATE_RECT_PORT_CAMERA] = job->refs.camera;
    light->refs[PROPAGATE_RECT_PORT_DENSITY] = in->media.density;
    light->refs[PROPAGATE_RECT_PORT_SIGMA_A] = in->media.sigma_a;
    light->refs[PROPAGATE_RECT_PORT_G] = in->media.g;
    return tyn_graph_add(g, &tyn_pass_propagate_rect, &light->params, light->refs);
}

static tyn_result add_upsampling(tyn_graph *g, const tyn_job *job, const propagated *light,
                                 tyn_picture_inputs *in)
{
    const struct medium_block *block = &job->frame->medium;
    tyn_merge_grids_params merge;
    tyn_settings_params(job->settings, &tyn_pass_merge_grids, &merge);
    merge.num_grids = light->params.num_suns + light->params.num_ordinates;
    merge.grid_cells = (uint32_t)light->params.cells;
    merge.channels = light->params.channels;
    merge.mode = block->mode;
    memcpy(merge.extent, block->extent, sizeof merge.extent);
    tyn_ref merged[MERGE_GRIDS_NUM_PORTS] = {
        [MERGE_GRIDS_PORT_MEDIUM] = job->refs.medium,
        [MERGE_GRIDS_PORT_DENSITY] = in->media.density,
        [MERGE_GRIDS_PORT_PLACES] = light->refs[PROPAGATE_RECT_PORT_PLACES],
        [MERGE_GRIDS_PORT_SEEN] = light->refs[PROPAGATE_RECT_PORT_SEEN],
    };
    tyn_result result = tyn_graph_add(g, &tyn_pass_merge_grids, &merge, merged);
    if (result != TYN_OK) {
        return result;
    }
    tyn_upsample_params params;
    tyn_settings_params(job->settings, &tyn_pass_upsample, &params);
    params.mode = block->mode;
    memcpy(params.extent, block->extent, sizeof params.extent);
    memcpy(params.size, block->size, sizeof params.size);
    tyn_ref refs[UPSAMPLE_NUM_PORTS] = {
        [UPSAMPLE_PORT_MEDIUM] = job->refs.medium,
        [UPSAMPLE_PORT_DENSITY] = in->media.density,
        [UPSAMPLE_PORT_MERGED] = merged[MERGE_GRIDS_PORT_MERGED],
    };
    result = tyn_graph_add(g, &tyn_pass_upsample, &params, refs);
    in->inscatter = refs[UPSAMPLE_PORT_INSCATTER];
    float longest = fmaxf(block->extent[0], fmaxf(block->extent[1], block->extent[2]));
    in->cell = longest / (float)light->params.cells;
    in->field = light->params.source == TYN_PROPAGATE_SOURCE_ACCUMULATED ? RAYMARCH_INSCATTER_SOURCE
                                                                         : RAYMARCH_INSCATTER_PLAIN;
    return result;
}

static tyn_result declare(tyn_graph *g, const tyn_job *job)
{
    const tyn_frame_scene *frame = job->frame;
    tyn_result result = tyn_method_refuse_repeat(job, "pop-paper");
    if (result != TYN_OK) {
        return result;
    }
    if (frame->empty) {
        return tyn_add_picture(g, job, NULL);
    }
    const float *mean = frame->environment.mean;
    if (mean[0] + mean[1] + mean[2] > 0.0f) {
        tyn_method_warn(job, "the environment is seen, but does not light the medium");
    }
    if (frame->emissive) {
        tyn_method_warn(job, "emission is seen, but does not light the medium");
    }
    tyn_picture_inputs in = {.num_suns = tyn_method_suns(job), .field = RAYMARCH_INSCATTER_PLAIN};
    propagated light = {.refs = {{0}}};
    result = tyn_add_medium(g, job, &in.media);
    if (result == TYN_OK && in.num_suns) {
        result = add_propagation(g, job, &in, &light);
    }
    if (result == TYN_OK && in.num_suns) {
        result = add_upsampling(g, job, &light, &in);
    }
    in.num_suns = 0; // all of their light is in the field
    return result == TYN_OK ? tyn_add_picture(g, job, &in) : result;
}

static const tyn_pass_desc *const passes[] = {
    &tyn_pass_medium,   &tyn_pass_propagate_rect, &tyn_pass_merge_grids, &tyn_pass_upsample,
    &tyn_pass_raymarch, &tyn_pass_composite,      &tyn_pass_tonemap,     NULL,
};

const tyn_method tyn_method_pop_paper = {
    .name = "pop-paper",
    .summary = "principal-ordinates propagation as published in 2014, cell by cell",
    .passes = passes,
    .outputs = TYN_PICTURE_OUTPUTS & ~(uint32_t)(TYN_OUTPUT_SINGLE | TYN_OUTPUT_MULTIPLE),
    .declare = declare,
};
