// gather.c -- what a camera sees of the field, and tables of what scatters forward.
#include "passes/methods/view/view.h"
#include <tyndall/registry.h>
#include <string.h>

static float largest_g(const tyn_job *job)
{
    float least, most;
    tyn_range_of_g(job->scene, &least, &most);
    return most;
}

void tyn_add_forward_tables(tyn_graph *g, const tyn_job *job, tyn_view_inputs *in)
{
    const tyn_sources *s = in->sources;
    const struct medium_block *m = &job->frame->medium;
    if (!s->num_suns && !s->lamps.radials.radials.resource && !s->sky.ordinates.resource) {
        return;
    }
    tyn_scatter_lut_params params;
    tyn_settings_params(job->settings, &tyn_pass_scatter_lut, &params);
    params.mode = m->mode;
    memcpy(params.phase, m->phase, sizeof params.phase);
    params.tables = job->frame->phase_tables;
    params.g_max = largest_g(job);
    params.num_suns = s->num_suns;
    for (uint32_t n = 0; n < params.num_suns; n++) {
        params.mean_cosine[n] = job->frame->lights.suns[n].mean_cosine;
    }
    params.tms = s->sky.ordinates.resource != 0;
    tyn_ref refs[TYN_MAX_PORTS] = {{0}};
    tyn_graph_add(g, &tyn_pass_scatter_lut, &params, refs);
    in->tms = refs[SCATTER_LUT_PORT_TMS];
    in->lut = refs[SCATTER_LUT_PORT_LUT];
    in->lut_block = refs[SCATTER_LUT_PORT_LUT_BLOCK];
}

void tyn_add_glow(tyn_graph *g, const tyn_job *job, tyn_view_inputs *in)
{
    if (!in->sources->sky.map.resource) {
        return;
    }
    const struct medium_block *m = &job->frame->medium;
    const tyn_phase narrowest = tyn_phase_of_mean_cosine(largest_g(job));
    tyn_env_glow_params params;
    tyn_settings_params(job->settings, &tyn_pass_env_glow, &params);
    for (int c = 0; c < 3; c++) {
        params.phase[c] = m->mode == TYN_MEDIUM_COEFFICIENTS ? narrowest : m->phase[c];
    }
    params.tables = job->frame->phase_tables;
    tyn_ref refs[TYN_MAX_PORTS] = {[ENV_GLOW_PORT_SKY] = in->sources->sky.map};
    tyn_graph_add(g, &tyn_pass_env_glow, &params, refs);
    in->glow = refs[ENV_GLOW_PORT_GLOW];
}

void tyn_gather(tyn_graph *g, const tyn_job *job, tyn_view_inputs *in)
{
    const tyn_sources *s = in->sources;
    in->inscatter = in->field->inscatter;
    if (!in->field->moments.resource || in->field->inscatter.resource) {
        return;
    }
    tyn_merge_params params;
    tyn_settings_params(job->settings, &tyn_pass_merge, &params);
    params.channels = s->lattice.shape.channels;
    memcpy(params.repeat, s->lattice.shape.repeat, sizeof params.repeat);
    memcpy(params.tint, s->lattice.shape.tint, sizeof params.tint);
    params.mode = job->frame->medium.mode;
    params.grey = job->frame->grey;
    params.tabled = job->refs.phases.resource != 0;
    tyn_ref refs[TYN_MAX_PORTS] = {
        [MERGE_PORT_MEDIUM] = job->refs.medium,
        [MERGE_PORT_CAMERA] = job->refs.camera,
        [MERGE_PORT_CELLS] = s->lattice.cells,
        [MERGE_PORT_MOMENTS] = in->field->moments,
    };
    if (s->sky.ordinates.resource) {
        tyn_connect(refs, MERGE_PORT_ORDINATES, s->sky.columns);
        tyn_connect(refs, MERGE_PORT_SKY_SEEN, s->sky.seen);
        refs[MERGE_PORT_EVEN] = s->sky.even;
        refs[MERGE_PORT_TMS] = in->tms;
        refs[MERGE_PORT_LUT_BLOCK] = in->lut_block;
    }
    const tyn_lamps *lamps = &s->lamps;
    params.marched_lamps = in->num_marched_lamps;
    refs[MERGE_PORT_VPL_LIGHT] = s->lattice.vpl_light;
    if (lamps->num_lamps > params.marched_lamps) {
        in->num_near_lamps = lamps->num_lamps - params.marched_lamps;
        params.reach = TYN_LAMP_REACH * s->lattice.side;
        tyn_connect(refs, MERGE_PORT_RADIALS, lamps->radials);
        refs[MERGE_PORT_LUT] = in->lut;
        refs[MERGE_PORT_PHASES] = job->refs.phases;
        refs[MERGE_PORT_LUT_BLOCK] = in->lut_block;
        tyn_connect(refs, MERGE_PORT_SHADOW_ATLAS, s->shadows);
    }
    tyn_graph_add(g, &tyn_pass_merge, &params, refs);
    in->inscatter = refs[MERGE_PORT_INSCATTER];
}
