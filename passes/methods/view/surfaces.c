// surfaces.c -- the surfaces before the camera.
#include "passes/methods/view/view.h"
#include <tyndall/registry.h>
#include <math.h>
#include <string.h>

// All samples of a picture are in one image, which has no more texels along a side than the device can draw.
static void fit_samples(tyn_gbuffer_params *params, uint32_t side, const tyn_job *job)
{
    const uint32_t longest = params->size[0] > params->size[1] ? params->size[0] : params->size[1];
    const int32_t most = (int32_t)(side / longest), asked = params->samples;
    if (asked > most && asked > 1) {
        params->samples = most > 1 ? most : 1;
        tyn_job_warn(job,
                     "%u x %u pixels with %d x %d samples of the surfaces are more than this "
                     "device draws (%u along a side): %d x %d, edges are less smooth",
                     params->size[0], params->size[1], asked, asked, side, params->samples,
                     params->samples);
    }
}

// Gives the samples along each side of a pixel.
static int32_t add_gbuffer(tyn_graph *g, const tyn_job *job, tyn_gbuffer_refs *gbuffer)
{
    tyn_gbuffer_params params;
    tyn_settings_params(job->settings, &tyn_pass_gbuffer, &params);
    params.size[0] = job->view->width;
    params.size[1] = job->view->height;
    params.num_triangles = job->frame->num_triangles;
    fit_samples(&params, tyn_graph_drawn_side(g), job);
    tyn_ref refs[TYN_MAX_PORTS] = {
        [GBUFFER_PORT_CAMERA] = job->refs.camera,
    };
    tyn_connect(refs, GBUFFER_PORT_SURFACES, job->refs.geometry);
    tyn_graph_add(g, &tyn_pass_gbuffer, &params, refs);
    tyn_take(refs, GBUFFER_PORT_SEEN, *gbuffer);
    return params.samples;
}

void tyn_add_guides(tyn_graph *g, const tyn_job *job)
{
    if (!(job->outputs & TYN_GUIDE_OUTPUTS)) {
        return;
    }
    tyn_guides_params params = {.size = {job->view->width, job->view->height},
                                .textured = job->frame->num_textures > 0};
    tyn_ref refs[TYN_MAX_PORTS] = {[GUIDES_PORT_CAMERA] = job->refs.camera};
    if (job->frame->num_triangles) {
        tyn_gbuffer_refs seen;
        add_gbuffer(g, job, &seen);
        tyn_connect(refs, GUIDES_PORT_SURFACES, job->refs.geometry);
        tyn_connect(refs, GUIDES_PORT_MATERIALS, job->refs.materials);
        tyn_connect(refs, GUIDES_PORT_SEEN, seen);
    }
    tyn_graph_add(g, &tyn_pass_guides, &params, refs);
    tyn_job_output(g, job, TYN_OUTPUT_ALBEDO, refs[GUIDES_PORT_ALBEDO]);
    tyn_job_output(g, job, TYN_OUTPUT_NORMAL, refs[GUIDES_PORT_NORMAL]);
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

void tyn_add_surfaces(tyn_graph *g, const tyn_job *job, tyn_view_inputs *in)
{
    if (!job->frame->num_triangles) {
        return;
    }
    tyn_gbuffer_refs seen;
    const int32_t samples = add_gbuffer(g, job, &seen);
    const float *sky = job->frame->environment.sky;
    tyn_shade_params params;
    tyn_settings_params(job->settings, &tyn_pass_shade, &params);
    params.mode = job->frame->medium.mode;
    params.size[0] = job->view->width;
    params.size[1] = job->view->height;
    memcpy(params.whole, job->view->whole, sizeof params.whole);
    params.num_suns = tyn_num_beams(&job->frame->lights);
    params.num_directional = job->frame->lights.num_directional;
    const bool media =
        in->sources->medium.density.resource != 0; // then lamps are those that have grids
    params.num_lamps = media ? in->sources->lamps.num_lamps : job->frame->lights.num_lamps;
    params.one_channel = in->field->one_channel;
    memcpy(params.tint, in->field->tint, sizeof params.tint);
    const tyn_sky *ordinates = &in->sources->sky;
    const bool shadowed = ordinates->maps.sky_maps.resource && !in->no_sky_on_surfaces;
    // Of a constant environment directions have the light only where the lattice has not.
    const bool in_directions = shadowed;
    params.sky = tyn_is_lit(sky) && !in->no_sky_on_surfaces && !in_directions;
    params.sky_fan = ordinates->fan;
    if (shadowed && in->sources->lattice.side > 0) {
        const tyn_lattice_shape *shape = &in->sources->lattice.shape;
        const tyn_extent cells = tyn_lattice_dims(shape->extent, shape->cells);
        memcpy(params.sky_cells, (const uint32_t[]){cells.x, cells.y, cells.z},
               sizeof params.sky_cells);
    }
    const bool beyond = reach_beyond_media(job->frame);
    params.outside = beyond && !tyn_is_periodic(job->frame);
    params.hidden = params.outside && tyn_can_trace(job);
    params.textured = job->frame->num_textures > 0;
    params.parted = job->capacity.software;
    params.samples = (uint32_t)samples;
    if (params.outside) {
        place_sight(job->frame, &params);
    }
    if (params.sky && (in->sources->walls.cut.wall_links.resource == 0 || beyond)) {
        tyn_job_warn(job, "surfaces beyond the media's box are lit by the mean of the "
                          "environment as if nothing stood around them");
    }
    if (shadowed && !params.sky && !in->sources->surface_light.of_sky &&
        (in->sources->walls.cut.wall_links.resource == 0 || beyond)) {
        tyn_job_warn(job, "what surfaces beyond the media's box reflect of the environment's light "
                          "lights no others");
    }
    tyn_ref refs[TYN_MAX_PORTS] = {
        [SHADE_PORT_MEDIUM] = job->refs.medium,
        [SHADE_PORT_CAMERA] = job->refs.camera,
        [SHADE_PORT_ENVIRONMENT] = job->refs.environment,
        [SHADE_PORT_SUNS] = job->refs.suns,
        [SHADE_PORT_LIGHTS] = job->refs.lights,
        // Surfaces far from the medium's box are no walls of the lattice, and outside it.
        [SHADE_PORT_MOMENTS] = in->sources->walls.cut.wall_links.resource || params.outside
                                   ? in->field->moments
                                   : (tyn_ref){0},
        [SHADE_PORT_ROOMS] = in->sources->surface_light.rooms,
    };
    tyn_connect(refs, SHADE_PORT_SEEN, seen);
    tyn_connect(refs, SHADE_PORT_BEAMS, in->sources->beams);
    tyn_connect(refs, SHADE_PORT_RADIALS, in->sources->lamps.radials);
    tyn_connect(refs, SHADE_PORT_SHADOW_ATLAS, in->sources->shadows);
    if (!media || in->sources->lamps.vpls) {
        tyn_connect(refs, SHADE_PORT_VPLS, in->sources->surface_light.vpls);
    }
    if (shadowed) {
        tyn_connect(refs, SHADE_PORT_SKY_ATLAS, ordinates->maps);
        tyn_connect(refs, SHADE_PORT_ORDINATES, ordinates->columns);
        refs[SHADE_PORT_ORDINATES] = ordinates->directions;
    }
    tyn_connect(refs, SHADE_PORT_WALL_LINKS, in->sources->walls.cut);
    tyn_connect(refs, SHADE_PORT_SURFACES, job->refs.geometry);
    tyn_connect(refs, SHADE_PORT_MATERIALS, job->refs.materials);
    tyn_graph_add(g, &tyn_pass_shade, &params, refs);
    in->surface = refs[SHADE_PORT_SURFACE_RADIANCE];
    in->seen = seen.seen;
}

void tyn_add_surfaces_apart(tyn_graph *g, const tyn_job *job, tyn_sources s, tyn_view_inputs *view)
{
    if (!job->frame->num_triangles) {
        return;
    }
    const tyn_field no_field = {0};
    const bool media = s.medium.density.resource != 0;
    const bool maps = s.sky.maps.sky_maps.resource != 0;
    tyn_view_inputs surfaces = {
        .sources = &s, .field = &no_field, .no_sky_on_surfaces = media && !maps};
    if (surfaces.no_sky_on_surfaces && tyn_is_lit(job->frame->environment.sky)) {
        tyn_job_warn(job, "the environment does not light the surfaces");
    }
    if (!maps) {
        tyn_job_warn_suns(job, "surfaces");
    }
    if (media && !s.num_suns) {
        tyn_add_beams(g, job, &s);
    }
    if (media && !s.lamps.num_lamps) {
        tyn_add_radials(g, job, &s);
    }
    tyn_add_surfaces(g, job, &surfaces);
    view->surface = surfaces.surface;
    view->seen = surfaces.seen;
}
