// method.c -- method "constellation": an environment as a constellation of distant lights, ray marching back to front
// with a shadow ray per light and slice, as published in 2008.
//
// Navarro, Gutierrez and Seron, "Interactive HDR lighting of dynamic participating media" (The Visual Computer 24, 2008).
// Light scatters once. passes/constellation/constellation.md says what is as published and what is beyond it.
#include <tyndall/extend/limits.h>
#include <tyndall/extend/method.h>
#include "constellation/constellation.h"
#include "passes/light_list/list.h"
#include "validity_mask/validity_mask.h"
#include "voxel_distance/voxel_distance.h"
#include <string.h>

// The medium with its distance map.
static tyn_ref add_voxel_distance(tyn_graph *g, const tyn_job *job, const tyn_sources *s)
{
    tyn_voxel_distance_params params = {
        .mode = job->frame->medium.mode, .emissive = s->medium.emission.resource != 0, .reach = 1};
    memcpy(params.voxel, job->frame->medium.voxel, sizeof params.voxel);
    tyn_ref refs[TYN_MAX_PORTS] = {
        [VOXEL_DISTANCE_PORT_DENSITY] = s->medium.density,
        [VOXEL_DISTANCE_PORT_SIGMA_A] = s->medium.sigma_a,
        [VOXEL_DISTANCE_PORT_EMISSION] = s->medium.emission,
    };
    tyn_graph_add(g, &tyn_pass_voxel_distance, &params, refs);
    return refs[VOXEL_DISTANCE_PORT_VOXELS];
}

static tyn_ref add_mask(tyn_graph *g, const tyn_job *job, const tyn_sources *s,
                        const tyn_constellation_params *march, tyn_ref voxels)
{
    const tyn_validity_mask_params params = {
        .mode = march->mode,
        .distance = march->distance,
        .width = march->width,
        .height = march->height,
        .slices = march->slices,
    };
    tyn_ref refs[TYN_MAX_PORTS] = {
        [VALIDITY_MASK_PORT_MEDIUM] = job->refs.medium,
        [VALIDITY_MASK_PORT_VOXELS] = voxels,
        [VALIDITY_MASK_PORT_EMISSION] = s->medium.emission,
        [VALIDITY_MASK_PORT_CAMERA] = job->refs.camera,
    };
    tyn_graph_add(g, &tyn_pass_validity_mask, &params, refs);
    return refs[VALIDITY_MASK_PORT_MASK];
}

static void set_view(tyn_constellation_params *p, const tyn_job *job)
{
    const struct env_block *env = &job->frame->environment;
    const bool surroundings =
        env->has_map || env->radiance[0] + env->radiance[1] + env->radiance[2] > 0.0f;
    // Over a host's picture only the medium is laid.
    const bool whole = !job->view->no_background && !(job->outputs & TYN_OUTPUT_COMPOSITE);
    p->background = surroundings && whole;
    p->surfaces = whole;
    p->width = job->view->width;
    p->height = job->view->height;
    const uint32_t read = job->outputs | tyn_job_hooks_read(job);
    p->layers |= read & (TYN_OUTPUT_TRANSMITTANCE | TYN_OUTPUT_COMPOSITE)
                     ? CONSTELLATION_LAYER_TRANSMITTANCE
                     : 0;
    p->layers |= read & TYN_OUTPUT_DEPTH ? CONSTELLATION_LAYER_DEPTH : 0;
    if (job->refs.depth.resource) {
        memcpy(p->depth, job->host_depth, sizeof p->depth);
    }
}

static void set_medium(tyn_constellation_params *p, const tyn_job *job)
{
    const struct medium_block *block = &job->frame->medium;
    p->mode = block->mode;
    p->emissive = job->frame->emissive;
    memcpy(p->extent, block->extent, sizeof p->extent);
    p->slices = tyn_constellation_slices(block, p->slice, tyn_longest_step(job->frame, 0));
}

// The surfaces that the camera sees, in the light of suns, lamps and the VPLs that these make, which the medium dims.
static void add_surfaces(tyn_graph *g, const tyn_job *job, tyn_sources *s, tyn_view_inputs *view)
{
    const tyn_field no_field = {0};
    tyn_sources own = *s;
    tyn_view_inputs surfaces = {.sources = &own, .field = &no_field};
    tyn_job_warn_suns(job, "surfaces");
    tyn_add_vpls(g, job, &own);
    tyn_add_beams(g, job, &own);
    tyn_add_radials(g, job, &own);
    tyn_add_surfaces(g, job, &surfaces);
    view->surface = surfaces.surface;
    view->seen = surfaces.seen;
}

static void add_march(tyn_graph *g, const tyn_job *job, const tyn_sources *s,
                      const tyn_view_inputs *view)
{
    tyn_constellation_params params;
    tyn_settings_params(job->settings, &tyn_pass_constellation, &params);
    set_view(&params, job);
    set_medium(&params, job);
    tyn_ref refs[TYN_MAX_PORTS] = {
        [CONSTELLATION_PORT_VOXELS] = add_voxel_distance(g, job, s),
        [CONSTELLATION_PORT_CAMERA] = job->refs.camera,
        [CONSTELLATION_PORT_ENVIRONMENT] = job->refs.environment,
        [CONSTELLATION_PORT_ENV_MAP] = job->refs.env_map,
        [CONSTELLATION_PORT_HOST_DEPTH] = job->refs.depth,
        [CONSTELLATION_PORT_SURFACE] = view->surface,
        [CONSTELLATION_PORT_SEEN] = view->seen,
    };
    if (params.mask) {
        refs[CONSTELLATION_PORT_MASK] =
            add_mask(g, job, s, &params, refs[CONSTELLATION_PORT_VOXELS]);
    }
    const tyn_light_list list = tyn_add_light_list(g, job, s, (uint32_t)params.lights, false);
    refs[CONSTELLATION_PORT_LIGHT_LIST] = list.lights;
    params.num_lights = list.most;
    params.lamps = job->frame->lights.num_lamps > 0;
    tyn_connect(refs, CONSTELLATION_PORT_MEDIUM, s->medium);
    refs[CONSTELLATION_PORT_MEDIUM] = job->refs.medium;
    tyn_connect(refs, CONSTELLATION_PORT_SHADOW_ATLAS, s->shadows);
    tyn_graph_add(g, &tyn_pass_constellation, &params, refs);
    tyn_add_results(g, job,
                    (tyn_picture){refs[CONSTELLATION_PORT_RADIANCE],
                                  refs[CONSTELLATION_PORT_TRANSMITTANCE],
                                  refs[CONSTELLATION_PORT_DEPTH]});
}

static tyn_result declare(tyn_graph *g, const tyn_job *job)
{
    tyn_sources s = {0};
    const tyn_field no_field = {0};
    tyn_view_inputs view = {.sources = &s, .field = &no_field};
    if (!tyn_job_refuse_repeat(job)) {
        return TYN_ERR_PARAMS;
    }
    if (job->frame->empty) { // nothing to march through
        tyn_job_warn_surfaces(job, "are left out");
        tyn_add_picture(g, job, &view);
        return tyn_graph_status(g);
    }
    if (job->frame->num_triangles) {
        const struct env_block *sky = &job->frame->environment;
        tyn_job_warn_surfaces(
            job, sky->has_map || sky->radiance[0] + sky->radiance[1] + sky->radiance[2] > 0
                     ? "do not stop an environment's light on its way through "
                       "the medium, and send none into it"
                     : "send no light into the medium");
    }
    if (job->frame->emissive) {
        tyn_job_warn(job, "emission is seen, but does not light the medium");
    }
    tyn_limits_warn(job, 0);
    tyn_add_medium(g, job, &s);
    tyn_add_shadows(g, job, &s);
    if (job->frame->num_triangles) {
        add_surfaces(g, job, &s, &view);
    }
    add_march(g, job, &s, &view);
    return tyn_graph_status(g);
}

static const char *const passes[] = {
    TYN_MEDIUM_PASSES(TYN_PASS_NAME),
    TYN_SUN_PASSES(TYN_PASS_NAME),
    TYN_VIRTUAL_LIGHT_PASSES(TYN_PASS_NAME),
    TYN_LAMP_PASSES(TYN_PASS_NAME),
    TYN_SURFACE_PASSES(TYN_PASS_NAME),
    TYN_LIST_PASSES(TYN_PASS_NAME),
    "voxel_distance",
    "validity_mask",
    "constellation",
    TYN_PICTURE_PASSES(TYN_PASS_NAME),
    NULL,
};

static double thick_slices(const tyn_regime *r)
{
    static const tyn_limit_point curve[] = {{300, 0.024}, {1000, 0.15}, {1e4, 1}};
    return tyn_limit_along(curve, sizeof curve / sizeof *curve, r->depth);
}

static double near_lamps(const tyn_regime *r)
{
    return 0.035 * r->lamps;
}

static const tyn_limit limits[] = {
    TYN_LIMIT_NOT_PERIODIC("passes/constellation/constellation.md"),
    TYN_LIMIT_ONE_SCATTERING("passes/constellation/constellation.md, \"Measured\""),
    {.key = "thick slices",
     .where = {TYN_ABOVE(depth, 300)},
     .error = thick_slices,
     .advice = {"slices: the medium is %.3g mean free paths deep, and a ray has 8192 slices at "
                "most (about %g %% of what has scattered once)",
                {TYN_FIGURE(depth), TYN_LIMIT_ERROR}},
     .source = "docs/stress.md, \"What is found\"",
     .warned = {TYN_ABOVE(depth, 700)},
     .warning = {"accuracy: the medium is %.3g mean free paths deep; shadow rays go from slice to "
                 "slice, of which a ray has 8192 at most: 15 %% of "
                 "the light that has scattered once are off at 1000, a factor of 2 at 10 000",
                 {TYN_FIGURE(depth)}}},
    {.key = "lamps near the medium",
     .where = {TYN_ABOVE(lamps, 0.05), TYN_ABOVE(mean_depth, 0)},
     .error = near_lamps,
     .advice = {"lamps: what is near one is summed at the slices alone (a lamp in the middle of a "
                "cube: 3 %% off)"},
     .source = "docs/stress.md, \"What is found\""},
    {.key = "surfaces",
     .where = {TYN_ABOVE(surfaces, 0)},
     .level = TYN_LIMIT_BREAKS,
     .advice = {"surfaces: they stop the light of suns and lamps, but not that of an environment, "
                "and send none into the medium"},
     .source = "passes/constellation/constellation.md"},
    TYN_LIMIT_FLOATS,
    {NULL},
};

static const tyn_promise promise = {.cube_once = 0.01};

const tyn_method tyn_method_constellation = {
    .info = {.name = "constellation",
             .summary = "one scattering under distant lights that stand for the environment, as "
                        "published in 2008",
             .outputs = TYN_PICTURE_OUTPUTS & ~(uint32_t)(TYN_OUTPUT_SINGLE | TYN_OUTPUT_MULTIPLE),
             .single_only = true,
             .limits = limits,
             .promise = &promise},
    .passes = passes,
    .declare = declare,
};
