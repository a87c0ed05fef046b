// gradient.c -- method "gradient": light that has scattered once, from few samples that know its gradient (Ren, Zhou, Lin and
// Guo 2008).
//
// Samples are split where the light that they stand for is not as they say; the march reads the field that is made of them
// (docs/gradient.md). An environment shines as distant lights, of its own suns among others.
#include "light/list.h"
#include "light/sources.h"
#include <tyndall/extend/limits.h>
#include <tyndall/extend/method.h>
#include "passes/gradient/gradient.h"
#include "scene/surfaces.h"
#include "view/view.h"
#include <tyndall/registry.h>
#include <math.h>
#include <string.h>

static void warn_of_surfaces(const tyn_job *job)
{
    if (!job->frame->num_triangles) {
        return;
    }
    tyn_job_warn_surfaces(job, tyn_is_lit(job->frame->environment.mean)
                                   ? "do not stop an environment's light on its way through the "
                                     "medium, and send none into it"
                                   : "send no light into the medium");
    if (tyn_surfaces_emit(&job->scene->surfaces)) {
        tyn_job_warn(job, "surfaces that emit are seen, but light nothing ('gradient')");
    }
}

static bool has_light(const tyn_frame_scene *frame)
{
    return frame->lights.num_directional || frame->lights.num_lamps ||
           tyn_is_lit(frame->environment.mean);
}

static void add_field(tyn_graph *g, const tyn_job *job, const tyn_sources *s, tyn_field *field)
{
    const struct medium_block *m = &job->frame->medium;
    tyn_gradient_params params;
    tyn_settings_params(job->settings, &tyn_pass_gradient, &params);
    params.mode = m->mode;
    memcpy(params.extent, m->extent, sizeof params.extent);
    params.voxel = tyn_gradient_voxel(m->extent, m->voxel);
    const float longest = fmaxf(m->extent[0], fmaxf(m->extent[1], m->extent[2]));
    params.voxels = (int32_t)fminf(ceilf(0.999f * longest / params.voxel), 256);
    params.lamps = job->frame->lights.num_lamps > 0;
    tyn_ref refs[TYN_MAX_PORTS] = {[GRADIENT_PORT_CAMERA] = job->refs.camera};
    refs[GRADIENT_PORT_LIGHT_LIST] =
        tyn_add_light_list(g, job, s, (uint32_t)params.lights, &params.num_lights);
    tyn_connect(refs, GRADIENT_PORT_MEDIUM, s->medium);
    tyn_connect(refs, GRADIENT_PORT_SHADOW_ATLAS, s->shadows);
    tyn_graph_add(g, &tyn_pass_gradient, &params, refs);
    tyn_job_counters(g, job, &tyn_pass_gradient, refs[GRADIENT_PORT_COUNTERS]);
    field->inscatter = refs[GRADIENT_PORT_INSCATTER];
    field->inscatter_is = TYN_INSCATTER_PLAIN;
    const int32_t cells = params.field < params.voxels ? params.field : params.voxels;
    field->cell = longest / (float)cells;
}

static tyn_result declare(tyn_graph *g, const tyn_job *job)
{
    const tyn_frame_scene *frame = job->frame;
    tyn_sources s = {0};
    tyn_field field = {.inscatter_is = TYN_INSCATTER_PLAIN};
    tyn_view_inputs view = {.sources = &s, .field = &field};
    if (!tyn_job_refuse_repeat(job)) {
        return TYN_ERR_PARAMS;
    }
    warn_of_surfaces(job);
    if (!frame->empty) {
        tyn_add_medium(g, job, &s);
    }
    tyn_add_shadows(g, job, &s);
    if (!frame->empty && has_light(frame)) {
        tyn_limits_warn(job, 0);
        add_field(g, job, &s, &field);
    }
    tyn_gather(g, job, &view);
    tyn_add_surfaces_apart(g, job, s, &view);
    tyn_add_picture(g, job, &view);
    return tyn_graph_status(g);
}

static const tyn_pass_desc *const passes[] = {
    TYN_MEDIUM_PASSES(TYN_PASS_ADDRESS),
    TYN_SUN_PASSES(TYN_PASS_ADDRESS),
    TYN_LAMP_PASSES(TYN_PASS_ADDRESS),
    TYN_LIST_PASSES,
    &tyn_pass_gradient,
    TYN_SURFACE_PASSES(TYN_PASS_ADDRESS),
    TYN_PICTURE_PASSES(TYN_PASS_ADDRESS),
    NULL,
};

static const tyn_limit limits[] = {
    TYN_LIMIT_NOT_PERIODIC("docs/gradient.md"),
    TYN_LIMIT_ONE_SCATTERING("docs/gradient.md, \"Measured\""),
    TYN_LIMIT_FLOATS,
    {NULL},
};

const tyn_method tyn_method_gradient = {
    .info = {.name = "gradient",
             .summary = "one scattering from few samples with gradients, split where they err",
             .passes = passes,
             .outputs = TYN_PICTURE_OUTPUTS & ~(uint32_t)(TYN_OUTPUT_SINGLE | TYN_OUTPUT_MULTIPLE),
             .single_only = true,
             .limits = limits},
    .declare = declare,
};
