// solve.c -- see solve.h.
#include "solve.h"
#include <math.h>
#include <string.h>

static void add_view(tyn_graph *g, const tyn_job *job, const tyn_sources *s, uint32_t num_suns,
                     const tyn_ref *solved, int32_t bands, tyn_field *picture)
{
    tyn_shdom_view_params params;
    tyn_settings_params(job->settings, &tyn_pass_shdom_view, &params);
    params.bands = bands;
    params.channels = s->lattice.shape.channels;
    memcpy(params.tint, s->lattice.shape.tint, sizeof params.tint);
    params.mode = job->frame->medium.mode;
    params.grey = job->frame->grey;
    params.num_suns = num_suns;
    tyn_ref refs[TYN_MAX_PORTS] = {
        [SHDOM_VIEW_PORT_MEDIUM] = job->refs.medium,
        [SHDOM_VIEW_PORT_CAMERA] = job->refs.camera,
        [SHDOM_VIEW_PORT_CELLS] = s->lattice.cells,
    };
    for (uint32_t ch = 0; ch < params.channels; ch++) {
        refs[SHDOM_VIEW_PORT_SENT_0 + ch] = solved[SHDOM_PORT_SENT_0 + ch];
    }
    params.lamps = s->lamps.num_lamps;
    tyn_connect(refs, SHDOM_VIEW_PORT_ORDINATES, s->sky.columns);
    tyn_connect(refs, SHDOM_VIEW_PORT_RADIALS, s->lamps.radials);
    tyn_graph_add(g, &tyn_pass_shdom_view, &params, refs);
    picture->inscatter = refs[SHDOM_VIEW_PORT_INSCATTER];
    picture->inscatter_is = TYN_INSCATTER_PLAIN;
    picture->cell = s->lattice.side;
}

// Depths along ordinates are kept as squares of halves (columns.glsl).
static void warn_of_densities(const tyn_job *job)
{
    const struct medium_block *m = &job->frame->medium;
    const float longest = fmaxf(m->extent[0], fmaxf(m->extent[1], m->extent[2]));
    if (m->mode == TYN_MEDIUM_DENSITY && m->max_density * longest > 1e9f) {
        tyn_job_warn(job,
                     "accuracy: densities of up to %.2g over %.2g m: more than 1e9 in a column is "
                     "not kept; smaller densities and larger coefficients are the same medium",
                     (double)m->max_density, (double)longest);
    }
}

void tyn_solve_shdom(tyn_graph *g, const tyn_job *job, const tyn_sources *s, uint32_t num_suns,
                     tyn_field *probes, tyn_field *picture)
{
    tyn_shdom_params params;
    tyn_settings_params(job->settings, &tyn_pass_shdom, &params);
    warn_of_densities(job);
    params.shape = s->lattice.shape;
    params.mode = job->frame->medium.mode;
    params.count = s->sky.columns.columns.resource ? s->sky.count : 0;
    tyn_ref refs[TYN_MAX_PORTS] = {
        [SHDOM_PORT_MEDIUM] = job->refs.medium,
        [SHDOM_PORT_CELLS] = s->lattice.cells,
        [SHDOM_PORT_SOURCE] = s->lattice.source,
    };
    params.lamps = s->lamps.num_lamps;
    tyn_connect(refs, SHDOM_PORT_ORDINATES, s->sky.columns);
    tyn_connect(refs, SHDOM_PORT_RADIALS, s->lamps.radials);
    tyn_graph_add(g, &tyn_pass_shdom, &params, refs);
    probes->moments = refs[SHDOM_PORT_MOMENTS];
    probes->cell = s->lattice.side;
    probes->one_channel = s->lattice.shape.channels == 1;
    memcpy(probes->tint, s->lattice.shape.tint, sizeof probes->tint);
    if (job->outputs & TYN_PICTURE_OUTPUTS) {
        add_view(g, job, s, num_suns, refs, params.bands, picture);
    }
}
