// method.c -- method "gradient": light that has scattered once, from few samples that know its gradient (Ren, Zhou, Lin and
// Guo 2008).
//
// Samples are split where the light that they stand for is not as they say; the march reads the field that is made of them
// (gradient.md). An environment shines as suns and distant lights, past what surfaces hide of it. Samples may read what has
// scattered more than once from the lattice of method "pop".
#include <tyndall/extend/limits.h>
#include <tyndall/extend/method.h>
#include "gradient/gradient.h"
#include "passes/light_list/list.h"
#include <math.h>
#include <string.h>

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

#define MEASURED "passes/gradient/gradient.md, \"Measured\""
#define THICK                                                                                      \
    {                                                                                              \
        .key = "thick cells", .where = {TYN_ABOVE(depth, 20)}, .error = thick,                     \
        .level = TYN_LIMIT_STRAINED,                                                               \
        .advice =                                                                                  \
            {"field: the medium is %.3g mean free paths deep, and light that enters is lost "      \
             "within its cells (about %g %% of what has scattered once): -D gradient.field",       \
             {TYN_FIGURE(depth), TYN_LIMIT_ERROR}},                                                \
        .source = "passes/gradient/gradient.md, \"Limits\"", .warned = {TYN_ABOVE(depth, 70)},     \
        .warning = {                                                                               \
            "accuracy: the medium is %.3g mean free paths deep; light that enters is lost "        \
            "within the cells of the field: 36 %% of it at 100 in a cube, all of it at 1000",      \
            {TYN_FIGURE(depth)}                                                                    \
        }                                                                                          \
    }
#define FLAT                                                                                       \
    {                                                                                              \
        .key = "flat media", .where = {TYN_BELOW(cells_through, 2), TYN_ABOVE(mean_depth, 0)},     \
        .error = flat, .level = TYN_LIMIT_STRAINED,                                                \
        .advice = {"flat media: few cells of the field lie through the shortest side (about %g "   \
                   "%% off)",                                                                      \
                   {TYN_LIMIT_ERROR}},                                                             \
        .source = "passes/gradient/gradient.md, \"Limits\"",                                       \
        .warned = {TYN_ABOVE(cells_through, 0)}, .warning = {                                      \
            "accuracy: the medium's shortest side is %.2g of a cell of 32 along the longest; few " \
            "cells of the field lie through it",                                                   \
            {TYN_FIGURE(cells_through)}                                                            \
        }                                                                                          \
    }
#define LOBES                                                                                      \
    {                                                                                              \
        .key = "lobes under a map", .where = {TYN_ABOVE(most_g, 0.6), TYN_ABOVE(mean_depth, 0)},   \
        .level = TYN_LIMIT_STRAINED,                                                               \
        .advice = {"forward lobe: each of the lights in a map's place is dimmed along one "        \
                   "direction (cloud-sunset, g 0.85, 21 %% off): -D gradient.lights=64"},          \
        .source = MEASURED                                                                         \
    }

static const tyn_limit limits[] = {
    TYN_LIMIT_NOT_PERIODIC("passes/gradient/gradient.md, \"Limits\""),
    TYN_LIMIT_ONE_SCATTERING(MEASURED),
    THICK,
    FLAT,
    LOBES,
    {.key = "surfaces",
     .where = {TYN_ABOVE(surfaces, 0)},
     .level = TYN_LIMIT_STRAINED,
     .advice = {"surfaces send no light into the medium and are seen in direct light alone "
                "(-D gradient.multiple=lattice)"},
     .source = "passes/gradient/gradient.md, \"Limits\""},
    TYN_LIMIT_FLOATS,
    {NULL},
};

// With what has scattered more than once.
static const tyn_limit limits_multiple[] = {
    TYN_LIMIT_NOT_PERIODIC("passes/gradient/gradient.md, \"Limits\""),
    THICK,
    FLAT,
    TYN_LIMIT_FLOATS,
    {NULL}};

static const int32_t column_cells = 32; // in which the medium dims the sky's light on surfaces

static void warn_of_surfaces(const tyn_job *job, bool multiple)
{
    if (!job->frame->num_triangles || multiple) {
        return;
    }
    tyn_job_warn_surfaces(job, "send no light into the medium (-D gradient.multiple=lattice)");
    if (tyn_surfaces_emit(&job->scene->surfaces)) {
        tyn_job_warn(job, "surfaces that emit are seen, but light nothing ('gradient')");
    }
}

static bool has_light(const tyn_frame_scene *frame)
{
    return frame->lights.num_directional || frame->lights.num_lamps ||
           tyn_is_lit(frame->environment.mean);
}

static bool has_sky(const tyn_frame_scene *frame)
{
    return tyn_is_lit(frame->environment.sky) ||
           frame->lights.num_suns > tyn_num_beams(&frame->lights);
}

static int32_t lattice_cells(const tyn_job *job)
{
    tyn_setting cells;
    tyn_settings_get(job->settings, "lattice.cells", &cells, job->log);
    return (int32_t)cells.value;
}

// All that shines. Suns and lamps have optical depths where the lattice is to carry on what they scatter.
static void add_lights(tyn_graph *g, const tyn_job *job, bool multiple, tyn_sources *s)
{
    const tyn_frame_scene *frame = job->frame;
    if (multiple) {
        tyn_add_beams(g, job, s);
    }
    tyn_add_shadows(g, job, s);
    if (has_sky(frame) && !(frame->empty && !frame->num_triangles)) {
        tyn_add_whole_sky(g, job, s);
    }
    if (multiple) {
        tyn_add_columns(g, job, lattice_cells(job), s);
        tyn_add_vpls(g, job, s); // also of the sky that passes the columns
        tyn_add_radials(g, job, s);
    }
}

// Light that has scattered before, towards the eye: the lattice's moments and what surfaces send, without the light of suns, lamps
// and sky that comes straight, which samples follow.
static tyn_ref add_scattered(tyn_graph *g, const tyn_job *job, tyn_sources *s, tyn_field *solved)
{
    tyn_add_cells(g, job, lattice_cells(job), "lattice.cells", s);
    tyn_solve_lattice(g, job, s, solved);
    tyn_sources before = *s;
    before.sky = (tyn_sky){{0}};
    tyn_view_inputs view = {
        .sources = &before, .field = solved, .num_marched_lamps = before.lamps.num_lamps};
    tyn_gather(g, job, &view);
    return view.inscatter;
}

// The medium that light is followed through: no finer than samples tell, so that steps do not grow in number with its voxels.
static void average(tyn_graph *g, const tyn_job *job, const tyn_gradient_params *params,
                    tyn_medium_refs *medium, float texel[3])
{
    const struct medium_block *m = &job->frame->medium;
    memcpy(texel, m->voxel, sizeof m->voxel);
    if (m->mode == TYN_MEDIUM_DENSITY && params->medium < 256) {
        const int32_t texels = tyn_gradient_cells(m->extent, params->medium);
        const tyn_extent cells = tyn_lattice_dims(m->extent, (texels + 1) / 2);
        tyn_average_medium(g, job, (const uint32_t[]){cells.x, cells.y, cells.z}, medium, texel);
    }
}

static void add_field(tyn_graph *g, const tyn_job *job, const tyn_sources *s,
                      const tyn_field *solved, tyn_ref scattered, tyn_field *field)
{
    const struct medium_block *m = &job->frame->medium;
    tyn_gradient_params params;
    tyn_settings_params(job->settings, &tyn_pass_gradient, &params);
    params.mode = m->mode;
    memcpy(params.extent, m->extent, sizeof params.extent);
    tyn_medium_refs medium = s->medium;
    float texel[3];
    average(g, job, &params, &medium, texel);
    params.voxel = tyn_gradient_voxel(m->extent, texel);
    const float longest = fmaxf(m->extent[0], fmaxf(m->extent[1], m->extent[2]));
    params.voxels = (int32_t)fminf(ceilf(0.999f * longest / params.voxel), 256);
    params.lamps = job->frame->lights.num_lamps > 0;
    params.one_channel = solved->one_channel;
    memcpy(params.tint, solved->tint, sizeof params.tint);
    const tyn_light_list list = tyn_add_light_list(g, job, s, (uint32_t)params.lights, true);
    params.num_lights = list.most;
    tyn_ref refs[TYN_MAX_PORTS] = {
        [GRADIENT_PORT_CAMERA] = job->refs.camera,  [GRADIENT_PORT_LIGHT_LIST] = list.lights,
        [GRADIENT_PORT_LIGHT_SHADES] = list.shades, [GRADIENT_PORT_SCATTERED] = scattered,
        [GRADIENT_PORT_BRICKS] = s->bricks,
    };
    tyn_connect(refs, GRADIENT_PORT_MEDIUM, medium);
    tyn_connect(refs, GRADIENT_PORT_SHADOW_ATLAS, s->shadows);
    tyn_connect(refs, GRADIENT_PORT_SKY_ATLAS, s->sky.maps);
    if (scattered.resource) {
        tyn_connect(refs, GRADIENT_PORT_WALL_LINKS, s->walls.cut);
    }
    tyn_graph_add(g, &tyn_pass_gradient, &params, refs);
    field->inscatter = refs[GRADIENT_PORT_INSCATTER];
    field->inscatter_is = scattered.resource ? TYN_INSCATTER_SCALED : TYN_INSCATTER_PLAIN;
    field->cell = longest / (float)tyn_gradient_field(&params);
}

// What the camera sees of surfaces.
static void add_surfaces(tyn_graph *g, const tyn_job *job, const tyn_sources *s,
                         const tyn_field *solved, tyn_view_inputs *view)
{
    if (!solved->moments.resource) {
        tyn_add_surfaces_apart(g, job, *s, view);
        return;
    }
    tyn_view_inputs surfaces = {.sources = s, .field = solved};
    tyn_add_surfaces(g, job, &surfaces);
    view->surface = surfaces.surface;
    view->seen = surfaces.seen;
}

static void warn_of_limits(const tyn_job *job, bool multiple)
{
    const float *e = job->frame->medium.extent;
    tyn_method_info info = *job->method;
    info.limits = multiple ? limits_multiple : info.limits;
    tyn_job own = *job;
    own.method = &info;
    tyn_limits_warn(&own, fmaxf(e[0], fmaxf(e[1], e[2])) / 32); // as the limits count cells
}

static tyn_result declare(tyn_graph *g, const tyn_job *job)
{
    const tyn_frame_scene *frame = job->frame;
    tyn_sources s = {0};
    tyn_field solved = {0}, field = {.inscatter_is = TYN_INSCATTER_PLAIN};
    tyn_gradient_params params;
    tyn_settings_params(job->settings, &tyn_pass_gradient, &params);
    if (!tyn_job_refuse_repeat(job)) {
        return TYN_ERR_PARAMS;
    }
    const bool lit = !frame->empty && (has_light(frame) || (params.multiple && frame->emissive));
    const bool multiple = params.multiple && lit;
    warn_of_surfaces(job, multiple);
    if (!frame->empty) {
        tyn_add_medium(g, job, &s);
    }
    add_lights(g, job, multiple, &s);
    if (lit && frame->emissive && !multiple) {
        tyn_job_warn(job, "emission is seen, but does not light the medium");
    }
    if (lit) {
        warn_of_limits(job, multiple);
        const tyn_ref scattered = multiple ? add_scattered(g, job, &s, &solved) : (tyn_ref){0};
        add_field(g, job, &s, &solved, scattered, &field);
        if (!multiple && frame->num_triangles) {
            tyn_add_columns(g, job, column_cells, &s);
        }
    }
    // The field has all of it.
    const tyn_sources marched = {
        .medium = s.medium, .bricks = s.bricks, .distance = s.distance, .shadows = s.shadows};
    tyn_view_inputs view = {.sources = &marched, .field = &field};
    tyn_gather(g, job, &view);
    add_surfaces(g, job, &s, &solved, &view);
    tyn_add_picture(g, job, &view);
    return tyn_graph_status(g);
}

static const char *const passes[] = {
    TYN_MEDIUM_PASSES(TYN_PASS_NAME),
    TYN_SUN_PASSES(TYN_PASS_NAME),
    TYN_VIRTUAL_LIGHT_PASSES(TYN_PASS_NAME),
    TYN_LAMP_PASSES(TYN_PASS_NAME),
    TYN_SKY_PASSES(TYN_PASS_NAME),
    TYN_LIST_PASSES(TYN_PASS_NAME),
    "gradient",
    TYN_CELL_PASSES(TYN_PASS_NAME),
    TYN_LATTICE_PASSES(TYN_PASS_NAME),
    "merge",
    TYN_SURFACE_PASSES(TYN_PASS_NAME),
    TYN_PICTURE_PASSES(TYN_PASS_NAME),
    NULL,
};

static const tyn_promise promise = {.cube_once = 0.02};

const tyn_method tyn_method_gradient = {
    .info = {.name = "gradient",
             .summary = "one scattering from few samples with gradients, split where they err",
             .outputs = TYN_PICTURE_OUTPUTS & ~(uint32_t)(TYN_OUTPUT_SINGLE | TYN_OUTPUT_MULTIPLE),
             .single_only = true,
             .limits = limits,
             .promise = &promise},
    .passes = passes,
    .declare = declare,
};
