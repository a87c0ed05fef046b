// medium.c -- the media as grids.
#include "passes/methods/light/sources.h"
#include <math.h>
#include <string.h>

bool tyn_is_sheared(const tyn_frame_scene *frame)
{
    bool sheared = false;
    for (int i = 0; i < 9; i++) {
        float across = fabsf(frame->shapes[0].rows[i / 3][i % 3]) * frame->medium.extent[i % 3];
        sheared = sheared || (i / 3 != i % 3 && across > 1e-4f);
    }
    return sheared;
}

void tyn_add_medium(tyn_graph *g, const tyn_job *job, tyn_sources *s)
{
    const struct medium_block *block = &job->frame->medium;
    tyn_medium_params params;
    tyn_settings_params(job->settings, &tyn_pass_medium, &params);
    params.mode = block->mode;
    params.direct = job->frame->direct;
    params.emissive = job->frame->emissive;
    params.colors = job->refs.colors.resource != 0 && block->mode != TYN_MEDIUM_DENSITY;
    memcpy(params.size, block->size, sizeof params.size);
    memcpy(params.bricks, block->bricks, sizeof params.bricks);

    tyn_ref refs[TYN_MAX_PORTS] = {
        [MEDIUM_PORT_ATLAS] = job->refs.atlas,
        [MEDIUM_PORT_SHAPES] = job->refs.shapes,
        [MEDIUM_PORT_COLORS] = job->refs.colors,
        [MEDIUM_PORT_MEDIUM] = job->refs.medium,
    };
    tyn_graph_add(g, &tyn_pass_medium, &params, refs);
    tyn_take(refs, MEDIUM_PORT_MEDIUM, s->medium);
    if (job->frame->direct) {
        s->medium.density = job->refs.atlas;
    }
    s->bricks = refs[MEDIUM_PORT_BRICKS];
    s->distance = refs[MEDIUM_PORT_DISTANCE];
}
