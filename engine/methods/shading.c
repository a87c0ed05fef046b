// shading.c -- see shading.h.
#include "methods/limits.h"
#include "methods/shading.h"
#include "passes/shade/shade.h"
#include "passes/balance/balance.h"
#include "passes/vpl/vpl.h"
#include <tyndall/registry.h>
#include <math.h>
#include <string.h>

enum { MOST_WITHOUT_HIERARCHY = 256 }; // triangles that every ray may be tested against

// 0: nothing emits; 2: some materials on both sides.
static uint32_t emitters(const tyn_surfaces *surfaces)
{
    uint32_t most = 0;
    for (uint32_t i = 0; i < surfaces->num_materials; i++) {
        const tyn_surface_material *m = &surfaces->materials[i];
        if (m->emission[0] + m->emission[1] + m->emission[2] > 0.0f) {
            const uint32_t sides = m->flags & TYN_SURFACE_EMITS_BOTH_SIDES ? 2 : 1;
            most = most > sides ? most : sides;
        }
    }
    return most;
}

bool tyn_can_trace(const tyn_job *job)
{
    return job->refs.geometry.nodes.resource || job->frame->num_triangles <= MOST_WITHOUT_HIERARCHY;
}

bool tyn_vpls_bounce(const tyn_job *job)
{
    const tyn_frame_scene *frame = job->frame;
    if (frame->empty) {
        return true;
    }
    const float *m = frame->m_from_world, *extent = frame->medium.extent;
    const float margin = 0.15f * fmaxf(extent[0], fmaxf(extent[1], extent[2]));
    bool beyond = false;
    for (int corner = 0; corner < 8; corner++) {
        float p[3];
        for (int a = 0; a < 3; a++) {
            p[a] = corner >> a & 1 ? frame->surfaces.hi[a] : frame->surfaces.lo[a];
        }
        for (int a = 0; a < 3; a++) {
            float x = m[a] * p[0] + m[4 + a] * p[1] + m[8 + a] * p[2] + m[12 + a];
            beyond = beyond || x < -margin || x > extent[a] + margin;
        }
    }
    return beyond;
}

tyn_result tyn_add_vpls(tyn_graph *g, const tyn_job *job, const tyn_medium_refs *medium,
                        uint32_t num_suns, tyn_vpl_refs *vpls)
{
    *vpls = (tyn_vpl_refs){{0}};
    if (!job->frame->num_triangles) {
        return TYN_OK;
    }
    tyn_vpl_params params;
    tyn_settings_params(job->settings, &tyn_pass_vpl, &params);
    params.mode = job->frame->medium.mode;
    params.num_suns = job->frame->num_suns;
    params.num_triangles = job->frame->num_triangles;
    params.emitters = emitters(&job->scene->surfaces);
    params.bounces = tyn_vpls_bounce(job);
    if (params.count == 0) {
        return TYN_OK;
    }
    tyn_rsm rsm;
    tyn_result result = tyn_add_rsm(g, job, num_suns, &rsm);
    if (result != TYN_OK || rsm.num_tiles + params.emitters == 0) {
        return result;
    }
    if (!tyn_can_trace(job)) {
        tyn_method_warn(job, "the surfaces have no hierarchy: light that they reflect passes "
                             "through other surfaces");
        params.visibility = 0;
    }
    params.num_tiles = rsm.num_tiles;
    memcpy(params.tiles, rsm.tiles, sizeof params.tiles);

    tyn_ref refs[TYN_MAX_PORTS] = {
        [VPL_PORT_SUNS] = job->refs.suns,
        [VPL_PORT_LIGHTS] = job->refs.lights,
    };
    tyn_connect(refs, VPL_PORT_FLUX, rsm.maps);
    tyn_connect(refs, VPL_PORT_MEDIUM, *medium);
    refs[VPL_PORT_MEDIUM] = job->refs.medium; // also without media
    tyn_connect(refs, VPL_PORT_SURFACES, job->refs.geometry);
    tyn_connect(refs, VPL_PORT_MATERIALS, job->refs.materials);
    result = tyn_graph_add(g, &tyn_pass_vpl, &params, refs);
    tyn_take(refs, VPL_PORT_VPLS, *vpls);
    return result;
}

// Do surfaces reach farther than the lattice, which has the sky's light with its shadows, by more than rounding?
static bool reach_beyond_media(const tyn_frame_scene *frame)
{
    float lo[3], hi[3];
    tyn_surfaces_box(frame, lo, hi);
    bool beyond = false;
    for (int axis = 0; axis < 3; axis++) {
        const float side = frame->medium.extent[axis];
        beyond = beyond || lo[axis] < -0.02f * side || hi[axis] > 1.02f * side;
    }
    return beyond;
}

// Places around the surfaces and the box, where they are not far from it, from where it is asked what hides the box.
static void place_sight(const tyn_frame_scene *frame, tyn_shade_params *params)
{
    const float *extent = frame->medium.extent;
    const float most = 3 * fmaxf(extent[0], fmaxf(extent[1], extent[2]));
    float lo[3], hi[3], longest = 0;
    tyn_surfaces_box(frame, lo, hi);
    for (int axis = 0; axis < 3; axis++) {
        lo[axis] = fmaxf(fminf(lo[axis], 0), -most);
        hi[axis] = fminf(fmaxf(hi[axis], extent[axis]), extent[axis] + most);
        longest = fmaxf(longest, hi[axis] - lo[axis]);
    }
    params->sight_edge = longest / SHADE_SIGHT_PLACES;
    for (int axis = 0; axis < 3; axis++) {
        params->sight_lo[axis] = lo[axis];
        params->sight_places[axis] =
            (uint32_t)ceilf(0.999f * (hi[axis] - lo[axis]) / params->sight_edge);
    }
}

tyn_result tyn_add_surfaces(tyn_graph *g, const tyn_job *job, tyn_ref moments, uint32_t num_suns,
                            tyn_picture_inputs *in)
{
    in->surface = in->distances = (tyn_ref){0};
    if (!job->frame->num_triangles) {
        return TYN_OK;
    }
    tyn_gbuffer_refs seen;
    tyn_result result = tyn_add_gbuffer(g, job, &seen);
    if (result != TYN_OK) {
        return result;
    }
    const float *sky = job->frame->environment.sky;
    tyn_shade_params params;
    tyn_settings_params(job->settings, &tyn_pass_shade, &params);
    params.mode = job->frame->medium.mode;
    params.size[0] = job->view->width;
    params.size[1] = job->view->height;
    params.num_suns = num_suns;
    params.num_directional = job->frame->num_suns;
    const bool media =
        in->media.medium.density.resource != 0; // then lamps are those that have grids
    params.num_lamps = media ? in->lamps.num_lamps : job->frame->num_lights - job->frame->num_suns;
    params.one_channel = in->one_channel;
    memcpy(params.tint, in->tint, sizeof params.tint);
    params.sky = sky[0] + sky[1] + sky[2] > 0.0f;
    const uint32_t *repeat = job->frame->medium.repeat;
    const bool beyond = reach_beyond_media(job->frame);
    params.outside = beyond && !repeat[0] && !repeat[1] && !repeat[2];
    params.hidden = params.outside && tyn_can_trace(job);
    params.textured = job->frame->num_textures > 0;
    if (params.outside) {
        place_sight(job->frame, &params);
    }
    if (params.sky && (in->walls.wall_links.resource == 0 || beyond)) {
        tyn_method_warn(job, "surfaces beyond the media's box are lit by the mean of the "
                             "environment as if nothing stood around them");
    }
    if (params.sky && in->walls.wall_links.resource) {
        tyn_limits_sky(job);
    }
    tyn_ref refs[TYN_MAX_PORTS] = {
        [SHADE_PORT_MEDIUM] = job->refs.medium,
        [SHADE_PORT_CAMERA] = job->refs.camera,
        [SHADE_PORT_ENVIRONMENT] = job->refs.environment,
        [SHADE_PORT_SUNS] = job->refs.suns,
        [SHADE_PORT_LIGHTS] = job->refs.lights,
        [SHADE_PORT_DISTANCES] = seen.distances,
        [SHADE_PORT_FACING] = seen.facing,
        [SHADE_PORT_COLOURS] = seen.colours,
        [SHADE_PORT_EDGE_COUNT] = seen.edge_count,
        [SHADE_PORT_EDGES] = seen.edges,
        // Surfaces far from the medium's box are no walls of the lattice, and outside it.
        [SHADE_PORT_MOMENTS] =
            in->walls.wall_links.resource || params.outside ? moments : (tyn_ref){0},
        [SHADE_PORT_ROOMS] = in->rooms,
    };
    tyn_connect(refs, SHADE_PORT_BEAMS, in->beams);
    tyn_connect(refs, SHADE_PORT_RADIALS, in->lamps.radials);
    tyn_connect(refs, SHADE_PORT_SHADOW_ATLAS, in->shadows);
    if (!media || in->lamps.vpls) {
        tyn_connect(refs, SHADE_PORT_VPLS, in->vpls);
    }
    tyn_connect(refs, SHADE_PORT_WALL_LINKS, in->walls);
    tyn_connect(refs, SHADE_PORT_SURFACES, job->refs.geometry);
    tyn_connect(refs, SHADE_PORT_MATERIALS, job->refs.materials);
    result = tyn_graph_add(g, &tyn_pass_shade, &params, refs);
    in->surface = refs[SHADE_PORT_RADIANCE];
    in->distances = seen.distances;
    return result;
}

void tyn_follow_lights(const tyn_job *job, const tyn_picture_inputs *in, tyn_balance_params *params,
                       tyn_ref *refs)
{
    const uint32_t *repeat = job->frame->medium.repeat;
    const bool follow = job->frame->num_triangles && !repeat[0] && !repeat[1] && !repeat[2];
    if (follow && !tyn_can_trace(job)) {
        tyn_method_warn(job, "the surfaces have no hierarchy: light that meets them without having "
                             "scattered counts as escaped in the balance");
    } else if (follow) {
        params->mode = job->frame->medium.mode;
        tyn_scene_box(job->frame, params->box[0], params->box[1]);
        tyn_connect(refs, BALANCE_PORT_BEAMS, in->beams);
        tyn_connect(refs, BALANCE_PORT_RADIALS, in->lamps.radials);
        tyn_connect(refs, BALANCE_PORT_SURFACES, job->refs.geometry);
        tyn_connect(refs, BALANCE_PORT_MATERIALS, job->refs.materials);
        refs[BALANCE_PORT_EMITTERS] = job->refs.emitters;
    }
}
