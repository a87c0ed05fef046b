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
        const float *e = frame->medium.extent;
        if (job->frame->emissive) {
            tyn_job_warn(job, "emission is seen, but does not light the medium");
        }
        tyn_limits_warn(job, fmaxf(e[0], fmaxf(e[1], e[2])) / 32); // as the limits count cells
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

// Of cubes in the sun, whose light lies within less than a cell of the field.
static double thick(const tyn_regime *r)
{
    static const tyn_limit_point curve[] = {{20, 0.02}, {100, 0.36}, {1000, 1}};
    return tyn_limit_along(curve, sizeof curve / sizeof *curve, r->depth);
}

static double flat(const tyn_regime *r)
{
    static const tyn_limit_point curve[] = {{0.5, 0.05}, {3, 0.3}, {100, 1}};
    return tyn_limit_along(curve, sizeof curve / sizeof *curve, 1 / fmax(r->cells_through, 1e-3));
}

#define MEASURED "docs/gradient.md, \"Measured\""

static const tyn_limit limits[] = {
    TYN_LIMIT_NOT_PERIODIC("docs/gradient.md, \"Limits\""),
    TYN_LIMIT_ONE_SCATTERING(MEASURED),
    {.key = "thick cells",
     .where = {TYN_ABOVE(depth, 20)},
     .error = thick,
     .level = TYN_LIMIT_STRAINED,
     .advice =
         {"field: the medium is %.3g mean free paths deep, and light that enters is lost within "
          "its cells (about %g %% of what has scattered once): -D gradient.field",
          {TYN_FIGURE(depth), TYN_LIMIT_ERROR}},
     .source = "docs/gradient.md, \"Limits\"",
     .warned = {TYN_ABOVE(depth, 70)},
     .warning = {"accuracy: the medium is %.3g mean free paths deep; light that enters is lost "
                 "within the cells of the field: 36 %% of it at 100 in a cube, all of it at 1000",
                 {TYN_FIGURE(depth)}}},
    {.key = "flat media",
     .where = {TYN_BELOW(cells_through, 2), TYN_ABOVE(mean_depth, 0)},
     .error = flat,
     .level = TYN_LIMIT_STRAINED,
     .advice =
         {"flat media: few cells of the field lie through the shortest side (about %g %% off)",
          {TYN_LIMIT_ERROR}},
     .source = "docs/gradient.md, \"Limits\"",
     .warned = {TYN_ABOVE(cells_through, 0)},
     .warning = {"accuracy: the medium's shortest side is %.2g of a cell of 32 along the longest; "
                 "few cells of the field lie through it",
                 {TYN_FIGURE(cells_through)}}},
    {.key = "surfaces",
     .where = {TYN_ABOVE(surfaces, 0)},
     .level = TYN_LIMIT_BREAKS,
     .advice = {"surfaces: they stop the light of suns and lamps, but not that of an environment, "
                "send none into the medium, and are seen in direct light alone"},
     .source = "docs/gradient.md, \"Limits\""},
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
