// pop_paper.c -- method "pop-paper": principal-ordinates propagation as published in 2014.
//
// The light of each sun, ordinate and lamp, scattered or not, moves from cell to cell of its own aligned grid;
// what all of them send to the eye is merged into one grid, upsampled with the medium as guide and
// marched. Kept as it was published (the readings are settings of propagate_rect): the baseline of
// method "pop".
#include "methods/sky.h"
#include "passes/env_importance/env_importance.h"
#include "passes/importance/importance.h"
#include "passes/ordinates/ordinates.h"
#include "passes/medium/medium.h"
#include "passes/propagate_radial/propagate_radial.h"
#include "passes/propagate_rect/propagate_rect.h"
#include "passes/radial_beam/radial_beam.h"
#include "passes/residuum/residuum.h"
#include "passes/merge_grids/merge_grids.h"
#include "passes/upsample/upsample.h"
#include "passes/composite/composite.h"
#include "passes/tonemap/tonemap.h"
#include <tyndall/registry.h>
#include <math.h>
#include <string.h>

// What the nodes of one frame share.
typedef struct propagated {
    tyn_propagate_rect_params grids;
    tyn_propagate_radial_params radial;
    tyn_residuum_params residuum;
    tyn_picture_inputs picture;
    tyn_sky_refs sky;
    tyn_ref places, seen, light, isotropic, merged;
    tyn_ref radial_places, radial_seen;
} propagated;

static float longest_side(const tyn_job *job)
{
    const float *extent = job->frame->medium.extent;
    return fmaxf(extent[0], fmaxf(extent[1], extent[2]));
}

// Iterations in the aligned grids before what is left in them counts as isotropic (section 5.4). The
// largest mean cosine at the start is that of a sun or of the smallest region, next to 1. Light has
// to cross the grid, so there are as many iterations as cells at least; no more are known to be needed
// where the mean of the medium is not known.
static int32_t iterations_before_residuum(const propagated *p, const tyn_job *job)
{
    const struct medium_block *m = &job->frame->medium;
    float sigma_s = 0.0f, g = -1.0f;
    if (p->residuum.after > 0) {
        return p->residuum.after;
    }
    for (int c = 0; c < 3; c++) {
        sigma_s += m->sigma_s[c] / 3.0f * job->frame->mean_density;
        g = fmaxf(g, m->g[c]);
    }
    float hop = longest_side(job) / (float)p->grids.cells;
    uint32_t hops =
        sigma_s > 0.0f ? tyn_residuum_after(1.0f, g, sigma_s, hop, p->residuum.epsilon) : 0;
    return (int32_t)fminf(fmaxf((float)hops, (float)p->grids.cells), 256.0f);
}

// What all grids need to know of the medium.
static void set_grids(propagated *p, const tyn_job *job)
{
    const struct medium_block *block = &job->frame->medium;
    p->grids.num_ordinates = p->sky.count;
    p->grids.channels = p->radial.channels = job->frame->grey ? 1 : 3;
    p->grids.mode = p->radial.mode = block->mode;
    memcpy(p->grids.extent, block->extent, sizeof p->grids.extent);
    memcpy(p->grids.size, block->size, sizeof p->grids.size);
    memcpy(p->radial.extent, block->extent, sizeof p->radial.extent);
    memcpy(p->radial.size, block->size, sizeof p->radial.size);
}

// Lamps that shine.
static void set_lamps(propagated *p, const tyn_job *job)
{
    const tyn_frame_scene *frame = job->frame;
    for (uint32_t i = frame->num_suns; i < frame->num_lights; i++) {
        const float *color = frame->lights[i].color;
        if (color[0] + color[1] + color[2] > 0.0f && p->radial.num_lamps < TYN_RADIAL_LAMPS_MAX) {
            p->radial.lamps[p->radial.num_lamps++] = tyn_radial_of_lamp(&frame->lights[i], i);
        }
    }
}

static tyn_result add_radial(tyn_graph *g, const tyn_job *job, propagated *p)
{
    tyn_ref refs[PROPAGATE_RADIAL_NUM_PORTS] = {
        [PROPAGATE_RADIAL_PORT_MEDIUM] = job->refs.medium,
        [PROPAGATE_RADIAL_PORT_CAMERA] = job->refs.camera,
        [PROPAGATE_RADIAL_PORT_DENSITY] = p->picture.media.density,
        [PROPAGATE_RADIAL_PORT_SIGMA_A] = p->picture.media.sigma_a,
        [PROPAGATE_RADIAL_PORT_G] = p->picture.media.g,
    };
    tyn_result result = tyn_graph_add(g, &tyn_pass_propagate_radial, &p->radial, refs);
    p->radial_places = refs[PROPAGATE_RADIAL_PORT_PLACES];
    p->radial_seen = refs[PROPAGATE_RADIAL_PORT_SEEN];
    return result;
}

static tyn_result add_propagation(tyn_graph *g, const tyn_job *job, propagated *p)
{
    p->grids.keep_light = p->residuum.on;
    if (p->residuum.on) {
        p->grids.iterations = iterations_before_residuum(p, job);
    }
    tyn_ref refs[PROPAGATE_RECT_NUM_PORTS] = {
        [PROPAGATE_RECT_PORT_MEDIUM] = job->refs.medium,
        [PROPAGATE_RECT_PORT_ORDINATES] = p->sky.ordinates,
        [PROPAGATE_RECT_PORT_CAMERA] = job->refs.camera,
        [PROPAGATE_RECT_PORT_DENSITY] = p->picture.media.density,
        [PROPAGATE_RECT_PORT_SIGMA_A] = p->picture.media.sigma_a,
        [PROPAGATE_RECT_PORT_G] = p->picture.media.g,
    };
    tyn_result result = tyn_graph_add(g, &tyn_pass_propagate_rect, &p->grids, refs);
    p->places = refs[PROPAGATE_RECT_PORT_PLACES];
    p->seen = refs[PROPAGATE_RECT_PORT_SEEN];
    p->light = refs[PROPAGATE_RECT_PORT_LIGHT];
    return result;
}

static tyn_result add_residuum(tyn_graph *g, const tyn_job *job, propagated *p)
{
    p->residuum.num_grids = p->grids.num_ordinates;
    p->residuum.grid_cells = (uint32_t)p->grids.cells;
    p->residuum.channels = p->grids.channels;
    p->residuum.mode = p->grids.mode;
    memcpy(p->residuum.extent, p->grids.extent, sizeof p->residuum.extent);
    tyn_ref refs[RESIDUUM_NUM_PORTS] = {
        [RESIDUUM_PORT_MEDIUM] = job->refs.medium,
        [RESIDUUM_PORT_DENSITY] = p->picture.media.density,
        [RESIDUUM_PORT_SIGMA_A] = p->picture.media.sigma_a,
        [RESIDUUM_PORT_PLACES] = p->places,
        [RESIDUUM_PORT_LIGHT] = p->light,
    };
    tyn_result result = tyn_graph_add(g, &tyn_pass_residuum, &p->residuum, refs);
    p->isotropic = refs[RESIDUUM_PORT_RESIDUUM];
    return result;
}

static tyn_result add_merge(tyn_graph *g, const tyn_job *job, propagated *p)
{
    tyn_merge_grids_params params;
    tyn_settings_params(job->settings, &tyn_pass_merge_grids, &params);
    params.num_grids = p->grids.num_ordinates;
    params.grid_cells = (uint32_t)p->grids.cells;
    params.channels = p->grids.channels;
    params.num_radial = p->radial.num_lamps;
    params.radial_cells = ((uint32_t)p->radial.cells + 1) & ~1u;
    params.mode = p->grids.mode;
    memcpy(params.extent, p->grids.extent, sizeof params.extent);
    tyn_ref refs[MERGE_GRIDS_NUM_PORTS] = {
        [MERGE_GRIDS_PORT_MEDIUM] = job->refs.medium,
        [MERGE_GRIDS_PORT_DENSITY] = p->picture.media.density,
        [MERGE_GRIDS_PORT_PLACES] = p->places,
        [MERGE_GRIDS_PORT_SEEN] = p->seen,
        [MERGE_GRIDS_PORT_RADIAL_PLACES] = p->radial_places,
        [MERGE_GRIDS_PORT_RADIAL_SEEN] = p->radial_seen,
        [MERGE_GRIDS_PORT_RESIDUUM] = p->isotropic,
    };
    tyn_result result = tyn_graph_add(g, &tyn_pass_merge_grids, &params, refs);
    p->merged = refs[MERGE_GRIDS_PORT_MERGED];
    return result;
}

static tyn_result add_upsampling(tyn_graph *g, const tyn_job *job, propagated *p)
{
    tyn_upsample_params params;
    tyn_settings_params(job->settings, &tyn_pass_upsample, &params);
    params.mode = p->grids.mode;
    memcpy(params.extent, p->grids.extent, sizeof params.extent);
    memcpy(params.size, p->grids.size, sizeof params.size);
    tyn_ref refs[UPSAMPLE_NUM_PORTS] = {
        [UPSAMPLE_PORT_MEDIUM] = job->refs.medium,
        [UPSAMPLE_PORT_DENSITY] = p->picture.media.density,
        [UPSAMPLE_PORT_MERGED] = p->merged,
    };
    tyn_result result = tyn_graph_add(g, &tyn_pass_upsample, &params, refs);
    p->picture.inscatter = refs[UPSAMPLE_PORT_INSCATTER];
    p->picture.cell = longest_side(job) / (float)p->grids.cells;
    p->picture.field = p->grids.source == TYN_PROPAGATE_SOURCE_ACCUMULATED
                           ? RAYMARCH_INSCATTER_SOURCE
                           : RAYMARCH_INSCATTER_PLAIN;
    return result;
}

// The light in the medium.
static tyn_result add_light(tyn_graph *g, const tyn_job *job, propagated *p)
{
    set_grids(p, job);
    tyn_result result = TYN_OK;
    if (p->sky.count) {
        result = add_propagation(g, job, p);
    }
    if (result == TYN_OK && p->sky.count && p->residuum.on) {
        result = add_residuum(g, job, p);
    }
    if (result == TYN_OK && p->radial.num_lamps) {
        result = add_radial(g, job, p);
    }
    if (result == TYN_OK) {
        result = add_merge(g, job, p);
    }
    return result == TYN_OK ? add_upsampling(g, job, p) : result;
}

static tyn_result declare(tyn_graph *g, const tyn_job *job)
{
    const tyn_frame_scene *frame = job->frame;
    tyn_result result = tyn_method_refuse_repeat(job, "pop-paper");
    if (result != TYN_OK) {
        return result;
    }
    tyn_method_warn_surfaces(job, "are left out");
    if (frame->empty) {
        return tyn_add_picture(g, job, NULL);
    }
    if (frame->emissive) {
        tyn_method_warn(job, "emission is seen, but does not light the medium");
    }
    propagated p = {.picture.field = RAYMARCH_INSCATTER_PLAIN};
    tyn_settings_params(job->settings, &tyn_pass_propagate_rect, &p.grids);
    tyn_settings_params(job->settings, &tyn_pass_propagate_radial, &p.radial);
    tyn_settings_params(job->settings, &tyn_pass_residuum, &p.residuum);
    set_lamps(&p, job);
    result = tyn_add_medium(g, job, &p.picture.media);
    if (result == TYN_OK) {
        result = tyn_add_sky(g, job, &p.picture.media, 0, false, &p.sky);
    }
    if (result == TYN_OK && (p.sky.count || p.radial.num_lamps)) {
        result = add_light(g, job, &p);
    }
    return result == TYN_OK ? tyn_add_picture(g, job, &p.picture) : result;
}

static const tyn_pass_desc *const passes[] = {
    &tyn_pass_medium,
    &tyn_pass_env_importance,
    &tyn_pass_importance,
    &tyn_pass_ordinates,
    &tyn_pass_propagate_rect,
    &tyn_pass_propagate_radial,
    &tyn_pass_residuum,
    &tyn_pass_merge_grids,
    &tyn_pass_upsample,
    &tyn_pass_raymarch,
    &tyn_pass_composite,
    &tyn_pass_tonemap,
    NULL,
};

const tyn_method tyn_method_pop_paper = {
    .name = "pop-paper",
    .summary = "principal-ordinates propagation as published in 2014, cell by cell",
    .passes = passes,
    .outputs = TYN_PICTURE_OUTPUTS & ~(uint32_t)(TYN_OUTPUT_SINGLE | TYN_OUTPUT_MULTIPLE),
    .declare = declare,
};
