// pop_paper.c -- method "pop-paper": principal-ordinates propagation as published in 2014.
//
// The light of each sun, ordinate and lamp, scattered or not, moves from cell to cell of its own aligned grid;
// what all of them send to the eye is merged into one grid, upsampled with the medium as guide and
// marched. Kept as it was published (the readings are settings of propagate_rect): the baseline of
// method "pop".
#include "methods/lamps.h"
#include "methods/limits.h"
#include "methods/shading.h"
#include "methods/sky.h"
#include "methods/surfaces.h"
#include "passes/env_importance/env_importance.h"
#include "passes/importance/importance.h"
#include "passes/ordinates/ordinates.h"
#include "passes/medium/medium.h"
#include "passes/propagate_radial/propagate_radial.h"
#include "passes/propagate_rect/propagate_rect.h"
#include "passes/radial_beam/radial_beam.h"
#include "passes/beam/beam.h"
#include "passes/gbuffer/gbuffer.h"
#include "passes/rsm/rsm.h"
#include "passes/shade/shade.h"
#include "passes/light_cells/light_cells.h"
#include "passes/shadow_map/shadow_map.h"
#include "passes/vpl/vpl.h"
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
    tyn_propagate_radial_params lamps, vpls;
    tyn_residuum_params residuum;
    tyn_picture_inputs picture;
    tyn_sky_refs sky;
    tyn_ref places, seen, light, isotropic, merged;
    tyn_ref lamp_places, lamp_seen, vpl_places, vpl_seen;
    tyn_vpl_refs surface_lights;
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

static void set_radial(tyn_propagate_radial_params *params, const tyn_job *job)
{
    const struct medium_block *block = &job->frame->medium;
    params->channels = job->frame->grey ? 1 : 3;
    params->mode = block->mode;
    memcpy(params->extent, block->extent, sizeof params->extent);
    memcpy(params->size, block->size, sizeof params->size);
}

// Lamps that shine.
static void set_lamps(tyn_propagate_radial_params *params, const tyn_job *job)
{
    const tyn_frame_scene *frame = job->frame;
    set_radial(params, job);
    for (uint32_t i = frame->num_suns; i < frame->num_lights; i++) {
        const float *color = frame->lights[i].color;
        if (color[0] + color[1] + color[2] > 0.0f && params->num_lamps < TYN_RADIAL_LAMPS_MAX) {
            params->lamps[params->num_lamps++] = tyn_radial_of_lamp(&frame->lights[i], i);
        }
    }
}

// VPLs have coarser grids: there are many of them.
static void set_vpls(tyn_propagate_radial_params *params, const tyn_job *job)
{
    set_radial(params, job);
    params->cells = params->shells = params->vpl_cells;
    params->max_vpls = TYN_RADIAL_VPLS_MAX;
}

static tyn_result add_radial(tyn_graph *g, const tyn_job *job, const propagated *p,
                             const tyn_propagate_radial_params *params, tyn_ref *places,
                             tyn_ref *seen)
{
    tyn_ref refs[PROPAGATE_RADIAL_NUM_PORTS] = {
        [PROPAGATE_RADIAL_PORT_CAMERA] = job->refs.camera,
    };
    tyn_connect(refs, PROPAGATE_RADIAL_PORT_MEDIUM, p->picture.media.medium);
    if (params->max_vpls) {
        refs[PROPAGATE_RADIAL_PORT_VPLS] = p->surface_lights.vpls;
    }
    tyn_result result = tyn_graph_add(g, &tyn_pass_propagate_radial, params, refs);
    *places = refs[PROPAGATE_RADIAL_PORT_PLACES];
    *seen = refs[PROPAGATE_RADIAL_PORT_SEEN];
    return result;
}

static void set_grids(propagated *p, const tyn_job *job)
{
    const struct medium_block *block = &job->frame->medium;
    p->grids.num_ordinates = p->sky.count;
    p->grids.channels = job->frame->grey ? 1 : 3;
    p->grids.mode = block->mode;
    memcpy(p->grids.extent, block->extent, sizeof p->grids.extent);
    memcpy(p->grids.size, block->size, sizeof p->grids.size);
}

static tyn_result add_propagation(tyn_graph *g, const tyn_job *job, propagated *p)
{
    p->grids.keep_light = p->residuum.on;
    if (p->residuum.on) {
        p->grids.iterations = iterations_before_residuum(p, job);
    }
    tyn_ref refs[PROPAGATE_RECT_NUM_PORTS] = {
        [PROPAGATE_RECT_PORT_ORDINATES] = p->sky.ordinates,
        [PROPAGATE_RECT_PORT_CAMERA] = job->refs.camera,
    };
    tyn_connect(refs, PROPAGATE_RECT_PORT_MEDIUM, p->picture.media.medium);
    tyn_result result = tyn_graph_add(g, &tyn_pass_propagate_rect, &p->grids, refs);
    p->places = refs[PROPAGATE_RECT_PORT_PLACES];
    p->seen = refs[PROPAGATE_RECT_PORT_SEEN];
    p->light = refs[PROPAGATE_RECT_PORT_LIGHT];
    return result;
}

static tyn_result add_residuum(tyn_graph *g, propagated *p)
{
    p->residuum.num_grids = p->grids.num_ordinates;
    p->residuum.grid_cells = (uint32_t)p->grids.cells;
    p->residuum.channels = p->grids.channels;
    p->residuum.mode = p->grids.mode;
    memcpy(p->residuum.extent, p->grids.extent, sizeof p->residuum.extent);
    tyn_ref refs[RESIDUUM_NUM_PORTS] = {
        [RESIDUUM_PORT_PLACES] = p->places,
        [RESIDUUM_PORT_LIGHT] = p->light,
    };
    tyn_connect(refs, RESIDUUM_PORT_MEDIUM, p->picture.media.medium);
    tyn_result result = tyn_graph_add(g, &tyn_pass_residuum, &p->residuum, refs);
    p->isotropic = refs[RESIDUUM_PORT_RESIDUUM];
    return result;
}

// Cells of a map along its side, as propagate_radial makes them.
static uint32_t even(int32_t cells)
{
    return ((uint32_t)cells + 1) & ~1u;
}

static tyn_result add_merge(tyn_graph *g, const tyn_job *job, propagated *p)
{
    tyn_merge_grids_params params;
    tyn_settings_params(job->settings, &tyn_pass_merge_grids, &params);
    params.num_grids = p->grids.num_ordinates;
    params.grid_cells = (uint32_t)p->grids.cells;
    params.channels = p->grids.channels;
    params.num_lamps = p->lamps.num_lamps;
    params.lamp_cells = even(p->lamps.cells);
    params.num_vpls = p->vpls.max_vpls;
    params.vpl_cells = even(p->vpls.cells);
    params.mode = p->grids.mode;
    memcpy(params.extent, p->grids.extent, sizeof params.extent);
    tyn_ref refs[MERGE_GRIDS_NUM_PORTS] = {
        [MERGE_GRIDS_PORT_PLACES] = p->places,
        [MERGE_GRIDS_PORT_SEEN] = p->seen,
        [MERGE_GRIDS_PORT_LAMP_PLACES] = p->lamp_places,
        [MERGE_GRIDS_PORT_LAMP_SEEN] = p->lamp_seen,
        [MERGE_GRIDS_PORT_VPL_PLACES] = p->vpl_places,
        [MERGE_GRIDS_PORT_VPL_SEEN] = p->vpl_seen,
        [MERGE_GRIDS_PORT_RESIDUUM] = p->isotropic,
    };
    tyn_connect(refs, MERGE_GRIDS_PORT_MEDIUM, p->picture.media.medium);
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
        [UPSAMPLE_PORT_MERGED] = p->merged,
    };
    tyn_connect(refs, UPSAMPLE_PORT_MEDIUM, p->picture.media.medium);
    tyn_result result = tyn_graph_add(g, &tyn_pass_upsample, &params, refs);
    p->picture.inscatter = refs[UPSAMPLE_PORT_INSCATTER];
    p->picture.cell = longest_side(job) / (float)p->grids.cells;
    tyn_limits_hops(job, p->picture.cell);
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
        result = add_residuum(g, p);
    }
    if (result == TYN_OK && p->lamps.num_lamps) {
        result = add_radial(g, job, p, &p->lamps, &p->lamp_places, &p->lamp_seen);
    }
    if (result == TYN_OK && p->vpls.max_vpls) {
        result = add_radial(g, job, p, &p->vpls, &p->vpl_places, &p->vpl_seen);
    }
    if (result == TYN_OK) {
        result = add_merge(g, job, p);
    }
    return result == TYN_OK ? add_upsampling(g, job, p) : result;
}

// The surfaces that the camera sees, in the light of suns, lamps and VPLs that the medium leaves (passes of
// method "pop").
static tyn_result add_surfaces(tyn_graph *g, const tyn_job *job, propagated *p)
{
    tyn_picture_inputs in = {.media = p->picture.media, .vpls = p->surface_lights};
    in.num_suns = tyn_method_suns(job);
    tyn_method_warn_suns(job, "surfaces");
    tyn_result result = tyn_add_beams(g, job, &in.media.medium, in.num_suns, &in.beams);
    if (result == TYN_OK) {
        result = tyn_add_radials(g, job, &in.media.medium, in.vpls.vpls, &in.lamps);
    }
    if (result == TYN_OK) {
        result = tyn_add_shadows(g, job, in.num_suns, &in.shadows, &in.light_cells);
    }
    if (result == TYN_OK) {
        result = tyn_add_surfaces(g, job, (tyn_ref){0}, in.num_suns, &in);
    }
    p->picture.surface = in.surface;
    p->picture.distances = in.distances;
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
        tyn_method_warn_surfaces(job, "are left out");
        return tyn_add_picture(g, job, NULL);
    }
    if (frame->emissive) {
        tyn_method_warn(job, "emission is seen, but does not light the medium");
    }
    tyn_method_warn_surfaces(job, "do not stop light on its way through the medium");
    tyn_limits_rays(job);
    propagated p = {.picture.field = RAYMARCH_INSCATTER_PLAIN};
    tyn_settings_params(job->settings, &tyn_pass_propagate_rect, &p.grids);
    tyn_settings_params(job->settings, &tyn_pass_propagate_radial, &p.lamps);
    tyn_settings_params(job->settings, &tyn_pass_propagate_radial, &p.vpls);
    tyn_settings_params(job->settings, &tyn_pass_residuum, &p.residuum);
    set_lamps(&p.lamps, job);
    result = tyn_add_medium(g, job, &p.picture.media);
    if (result == TYN_OK) {
        result = tyn_add_sky(g, job, &p.picture.media.medium, 0, false, &p.sky);
    }
    if (result == TYN_OK) {
        result =
            tyn_add_vpls(g, job, &p.picture.media.medium, tyn_method_suns(job), &p.surface_lights);
    }
    if (p.surface_lights.vpls.resource) {
        set_vpls(&p.vpls, job);
    }
    if (result == TYN_OK && (p.sky.count || p.lamps.num_lamps || p.vpls.max_vpls)) {
        result = add_light(g, job, &p);
    }
    if (result == TYN_OK && frame->num_triangles) {
        result = add_surfaces(g, job, &p);
    }
    return result == TYN_OK ? tyn_add_picture(g, job, &p.picture) : result;
}

static const tyn_pass_desc *const passes[] = {
    &tyn_pass_medium,
    &tyn_pass_beam,
    &tyn_pass_shadow_map,
    &tyn_pass_light_cells,
    &tyn_pass_rsm,
    &tyn_pass_vpl,
    &tyn_pass_env_importance,
    &tyn_pass_importance,
    &tyn_pass_ordinates,
    &tyn_pass_propagate_rect,
    &tyn_pass_propagate_radial,
    &tyn_pass_residuum,
    &tyn_pass_merge_grids,
    &tyn_pass_upsample,
    &tyn_pass_radial_beam,
    &tyn_pass_gbuffer,
    &tyn_pass_shade,
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
