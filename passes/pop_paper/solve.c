// solve.c -- see solve.h.
#include "solve.h"
#include <math.h>
#include <string.h>

// What the nodes of one frame share.
typedef struct propagated {
    tyn_propagate_rect_params grids;
    tyn_propagate_radial_params lamps, vpls;
    tyn_residuum_params residuum;
    const tyn_sources *sources;
    tyn_ref places, seen, light, isotropic, merged;
    tyn_ref lamp_places, lamp_seen, vpl_places, vpl_seen;
} propagated;

static float longest_side(const tyn_job *job)
{
    const float *extent = job->frame->medium.extent;
    return fmaxf(extent[0], fmaxf(extent[1], extent[2]));
}

// The largest mean cosine of light as it enters (section 5.4): that of suns and of the sky's regions as the prefilter leaves
// them. Regions are made on the device: the mean one's counts, 1 - 1 / N of N.
static float largest_mean_cosine(const propagated *p, const tyn_job *job)
{
    const tyn_lights *lights = &job->frame->lights;
    const float count = (float)p->sources->sky.count;
    float most = p->sources->sky.count > lights->num_suns ? 1.0f - 1.0f / count : 0.0f;
    for (uint32_t i = 0; i < lights->num_suns; i++) {
        most = fmaxf(most, lights->suns[i].mean_cosine);
    }
    // The heuristic has the region's share of the sphere, which of a cap is 1 - mean cosine, at most 1 / N.
    const float share = fminf(1.0f - most, 1.0f / count);
    return p->grids.prefilter == TYN_PROPAGATE_PREFILTER_OFF ? 1.0f
           : p->grids.prefilter == TYN_PROPAGATE_PREFILTER_HEURISTIC
               ? powf(1.0f - share, p->grids.beta)
               : most;
}

// Iterations in the aligned grids before what is left in them counts as isotropic (section 5.4, Eq 10). Light has
// to cross the grid, so there are as many iterations as cells along it at least; no more are known to be needed
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
        g = fmaxf(g, (float)tyn_phase_mean_cosine(m->phase[c]));
    }
    float along = (float)(p->grids.cells_along ? p->grids.cells_along : p->grids.cells);
    float hop = longest_side(job) / along;
    uint32_t hops = sigma_s > 0.0f ? tyn_residuum_after(largest_mean_cosine(p, job), g, sigma_s,
                                                        hop, p->residuum.epsilon)
                                   : 0;
    return (int32_t)fminf(fmaxf((float)hops, along), 256.0f);
}

static void set_radial(tyn_propagate_radial_params *params, const tyn_job *job)
{
    const struct medium_block *block = &job->frame->medium;
    params->channels = job->frame->grey ? 1 : 3;
    params->mode = block->mode;
    memcpy(params->extent, block->extent, sizeof params->extent);
    memcpy(params->size, block->size, sizeof params->size);
}

static void set_lamps(tyn_propagate_radial_params *params, const tyn_job *job, const tyn_sources *s)
{
    const tyn_lights *lights = &job->frame->lights;
    set_radial(params, job);
    params->num_lamps = lights->num_lamps;
    params->shadowed = s->shadows.shadow_atlas.resource != 0;
    memcpy(params->lamps, tyn_first_lamp(lights), lights->num_lamps * sizeof *params->lamps);
}

// VPLs have coarser grids: there are many of them.
static void set_vpls(tyn_propagate_radial_params *params, const tyn_job *job)
{
    set_radial(params, job);
    params->cells = params->shells = params->vpl_cells;
    params->max_vpls = TYN_RADIAL_VPLS_MAX;
    params->shadowed = 1; // what VPLs see is known, or that nothing stops their light
}

static void add_radial(tyn_graph *g, const tyn_job *job, const propagated *p,
                       const tyn_propagate_radial_params *params, tyn_ref *places, tyn_ref *seen)
{
    tyn_ref refs[PROPAGATE_RADIAL_NUM_PORTS] = {
        [PROPAGATE_RADIAL_PORT_CAMERA] = job->refs.camera,
    };
    tyn_connect(refs, PROPAGATE_RADIAL_PORT_MEDIUM, p->sources->medium);
    if (params->max_vpls) {
        tyn_connect(refs, PROPAGATE_RADIAL_PORT_VPLS, p->sources->surface_light.vpls);
    }
    if (params->num_lamps && params->shadowed) {
        tyn_connect(refs, PROPAGATE_RADIAL_PORT_SHADOW_ATLAS, p->sources->shadows);
    }
    tyn_graph_add(g, &tyn_pass_propagate_radial, params, refs);
    *places = refs[PROPAGATE_RADIAL_PORT_PLACES];
    *seen = refs[PROPAGATE_RADIAL_PORT_SEEN];
}

static void set_grids(propagated *p, const tyn_job *job)
{
    const struct medium_block *block = &job->frame->medium;
    p->grids.num_ordinates = p->sources->sky.count;
    p->grids.channels = job->frame->grey ? 1 : 3;
    p->grids.mode = block->mode;
    // Suns come first among the ordinates. Where surfaces have no hierarchy light without a map is not stopped.
    p->grids.num_mapped =
        p->sources->shadows.shadow_atlas.resource ? tyn_num_beams(&job->frame->lights) : 0;
    if (p->grids.num_ordinates > p->grids.num_mapped && tyn_can_trace(job)) {
        p->grids.num_triangles = job->frame->num_triangles;
    }
    memcpy(p->grids.extent, block->extent, sizeof p->grids.extent);
    memcpy(p->grids.size, block->size, sizeof p->grids.size);
}

static void add_propagation(tyn_graph *g, const tyn_job *job, propagated *p)
{
    p->grids.keep_light = p->residuum.on;
    if (p->residuum.on) {
        p->grids.iterations = iterations_before_residuum(p, job);
    }
    tyn_ref refs[PROPAGATE_RECT_NUM_PORTS] = {
        [PROPAGATE_RECT_PORT_ORDINATES] = p->sources->sky.ordinates,
        [PROPAGATE_RECT_PORT_CAMERA] = job->refs.camera,
    };
    tyn_connect(refs, PROPAGATE_RECT_PORT_MEDIUM, p->sources->medium);
    if (p->grids.num_mapped) {
        tyn_connect(refs, PROPAGATE_RECT_PORT_SHADOW_ATLAS, p->sources->shadows);
    }
    if (p->grids.num_triangles) {
        tyn_connect(refs, PROPAGATE_RECT_PORT_SURFACES, job->refs.geometry);
    }
    tyn_graph_add(g, &tyn_pass_propagate_rect, &p->grids, refs);
    p->places = refs[PROPAGATE_RECT_PORT_PLACES];
    p->seen = refs[PROPAGATE_RECT_PORT_SEEN];
    p->light = refs[PROPAGATE_RECT_PORT_LIGHT];
}

static void add_residuum(tyn_graph *g, propagated *p)
{
    p->residuum.num_grids = p->grids.num_ordinates;
    p->residuum.grid_cells = (uint32_t)p->grids.cells;
    p->residuum.grid_along = (uint32_t)p->grids.cells_along;
    p->residuum.channels = p->grids.channels;
    p->residuum.mode = p->grids.mode;
    memcpy(p->residuum.extent, p->grids.extent, sizeof p->residuum.extent);
    tyn_ref refs[RESIDUUM_NUM_PORTS] = {
        [RESIDUUM_PORT_PLACES] = p->places,
        [RESIDUUM_PORT_LIGHT] = p->light,
    };
    tyn_connect(refs, RESIDUUM_PORT_MEDIUM, p->sources->medium);
    tyn_graph_add(g, &tyn_pass_residuum, &p->residuum, refs);
    p->isotropic = refs[RESIDUUM_PORT_RESIDUUM];
}

// Cells of a map along its side, as propagate_radial makes them.
static uint32_t even(int32_t cells)
{
    return ((uint32_t)cells + 1) & ~1u;
}

static void add_merge(tyn_graph *g, const tyn_job *job, propagated *p)
{
    tyn_merge_grids_params params;
    tyn_settings_params(job->settings, &tyn_pass_merge_grids, &params);
    params.num_grids = p->grids.num_ordinates;
    params.grid_cells = (uint32_t)p->grids.cells;
    params.grid_along = (uint32_t)p->grids.cells_along;
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
    tyn_connect(refs, MERGE_GRIDS_PORT_MEDIUM, p->sources->medium);
    tyn_graph_add(g, &tyn_pass_merge_grids, &params, refs);
    p->merged = refs[MERGE_GRIDS_PORT_MERGED];
}

static void add_upsampling(tyn_graph *g, const tyn_job *job, propagated *p, tyn_field *field)
{
    tyn_upsample_params params;
    tyn_settings_params(job->settings, &tyn_pass_upsample, &params);
    params.mode = p->grids.mode;
    memcpy(params.extent, p->grids.extent, sizeof params.extent);
    memcpy(params.size, p->grids.size, sizeof params.size);
    tyn_ref refs[UPSAMPLE_NUM_PORTS] = {
        [UPSAMPLE_PORT_MERGED] = p->merged,
    };
    tyn_connect(refs, UPSAMPLE_PORT_MEDIUM, p->sources->medium);
    tyn_graph_add(g, &tyn_pass_upsample, &params, refs);
    field->inscatter = refs[UPSAMPLE_PORT_INSCATTER];
    field->cell =
        longest_side(job) /
        (float)(p->grids.cells > p->grids.cells_along ? p->grids.cells : p->grids.cells_along);
    field->inscatter_is = TYN_INSCATTER_PLAIN;
}

void tyn_solve_propagation(tyn_graph *g, const tyn_job *job, const tyn_sources *s, tyn_field *field)
{
    propagated p = {.sources = s};
    tyn_settings_params(job->settings, &tyn_pass_propagate_rect, &p.grids);
    tyn_settings_params(job->settings, &tyn_pass_propagate_radial, &p.lamps);
    tyn_settings_params(job->settings, &tyn_pass_propagate_radial, &p.vpls);
    tyn_settings_params(job->settings, &tyn_pass_residuum, &p.residuum);
    set_lamps(&p.lamps, job, s);
    if (s->surface_light.vpls.vpls.resource) {
        set_vpls(&p.vpls, job);
    }
    if (!s->sky.count && !p.lamps.num_lamps && !p.vpls.max_vpls) {
        return; // nothing shines
    }
    set_grids(&p, job);
    if (s->sky.count) {
        add_propagation(g, job, &p);
        if (p.residuum.on) {
            add_residuum(g, &p);
        }
    }
    if (p.lamps.num_lamps) {
        add_radial(g, job, &p, &p.lamps, &p.lamp_places, &p.lamp_seen);
    }
    if (p.vpls.max_vpls) {
        add_radial(g, job, &p, &p.vpls, &p.vpl_places, &p.vpl_seen);
    }
    add_merge(g, job, &p);
    add_upsampling(g, job, &p, field);
}
