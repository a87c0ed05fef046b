// probe.c -- the light field at points.
#include "passes/methods/view/view.h"
#include <tyndall/registry.h>
#include <string.h>

static uint32_t points_outside(const tyn_job *job)
{
    const float *m = job->frame->m_from_world, *extent = job->frame->medium.extent;
    uint32_t count = 0;
    for (uint32_t i = 0; job->view->points && i < job->view->num_points; i++) {
        const float *p = job->view->points[i];
        bool outside = false;
        for (int a = 0; a < 3; a++) {
            float x = m[a] * p[0] + m[4 + a] * p[1] + m[8 + a] * p[2] + m[12 + a];
            outside = outside || (!job->frame->medium.repeat[a] &&
                                  (x < -1e-3f * extent[a] || x > 1.001f * extent[a]));
        }
        count += outside;
    }
    return count;
}

// Which light, in which form.
enum form { ALL, SCATTERED, PARTS };

// The node; its results.
static tyn_ref add_probe(tyn_graph *g, const tyn_job *job, const tyn_view_inputs *in,
                         tyn_ref points, enum form wanted)
{
    tyn_probe_params params;
    tyn_settings_params(job->settings, &tyn_pass_probe, &params);
    params.mode = job->frame->medium.mode;
    params.channels = in->sources->lattice.shape.channels;
    memcpy(params.tint, in->sources->lattice.shape.tint, sizeof params.tint);
    params.num_suns = in->sources->num_suns;
    params.num_ordinates = in->sources->sky.count;
    if (in->sources->lamps.radials.radials.resource) {
        params.local_lights = in->sources->lamps.vpls ? TYN_PROBE_LOCAL_ALL : TYN_PROBE_LOCAL_LAMPS;
    }
    params.scattered_only = wanted == SCATTERED;
    params.parts = wanted == PARTS;
    for (int axis = 0; axis < 3; axis++) {
        memcpy(params.world[axis], job->frame->m_from_world + 4 * axis, sizeof params.world[axis]);
    }
    tyn_ref refs[TYN_MAX_PORTS] = {
        [PROBE_PORT_MEDIUM] = job->refs.medium,
        [PROBE_PORT_LIGHTS] = job->refs.suns,
        [PROBE_PORT_MOMENTS] = in->field->moments,
        [PROBE_PORT_CELLS] = in->sources->lattice.cells,
        [PROBE_PORT_POINTS] = points,
        [PROBE_PORT_VPL_DISTANCES] = in->sources->surface_light.vpls.vpl_distances,
        [PROBE_PORT_ROOMS] = in->sources->surface_light.rooms,
        [PROBE_PORT_ENVIRONMENT] = tyn_mean_environment(job, in->sources),
    };
    tyn_connect(refs, PROBE_PORT_ORDINATES, in->sources->sky.columns);
    tyn_connect(refs, PROBE_PORT_BEAMS, in->sources->beams);
    tyn_connect(refs, PROBE_PORT_RADIALS, in->sources->lamps.radials);
    tyn_connect(refs, PROBE_PORT_WALL_LINKS, in->sources->walls.cut);
    tyn_connect(refs, PROBE_PORT_SHADOW_ATLAS, in->sources->shadows);
    tyn_graph_add(g, &tyn_pass_probe, &params, refs);
    return refs[PROBE_PORT_RESULTS];
}

void tyn_add_probe(tyn_graph *g, const tyn_job *job, const tyn_view_inputs *in)
{
    uint32_t outside = points_outside(job);
    if (outside > 0) {
        tyn_job_warn(job,
                     "probe: %u of %u points lie outside the media's box; there the scattered "
                     "light is the nearest face's, too much",
                     outside, job->view->num_points);
    }
    tyn_job_output(
        g, job, TYN_OUTPUT_PROBE,
        add_probe(g, job, in, job->refs.points, job->view->scattered_only ? SCATTERED : ALL));
}

tyn_ref tyn_add_field_points(tyn_graph *g, const tyn_job *job, tyn_extent size)
{
    const tyn_light_points_params params = {{size.x, size.y, size.z}};
    tyn_ref refs[LIGHT_POINTS_NUM_PORTS] = {[LIGHT_POINTS_PORT_MEDIUM] = job->refs.medium};
    tyn_graph_add(g, &tyn_pass_light_points, &params, refs);
    return refs[LIGHT_POINTS_PORT_POINTS];
}

static void add_field_images(tyn_graph *g, const tyn_light_field_params *params, tyn_ref results,
                             tyn_ref images[3])
{
    tyn_ref refs[LIGHT_FIELD_NUM_PORTS] = {[LIGHT_FIELD_PORT_RESULTS] = results};
    memcpy(&refs[LIGHT_FIELD_PORT_RED], images, 3 * sizeof *images);
    tyn_graph_add(g, &tyn_pass_light_field, params, refs);
    memcpy(images, &refs[LIGHT_FIELD_PORT_RED], 3 * sizeof *images);
}

// Images of the frame of these names.
static void add_named_images(tyn_graph *g, const tyn_job *job, const char *const names[3],
                             tyn_extent size, tyn_ref results, tyn_ref images[3])
{
    tyn_light_field_params params = {0};
    for (int axis = 0; axis < 3; axis++) {
        memcpy(params.args.world[axis], job->frame->m_from_world + 4 * axis,
               sizeof params.args.world[axis]);
        images[axis] = tyn_graph_history_image(g, names[axis], TYN_IMAGE_3D,
                                               VK_FORMAT_R32G32B32A32_SFLOAT, size, 1);
    }
    add_field_images(g, &params, results, images);
}

void tyn_add_field_images(tyn_graph *g, const tyn_job *job, tyn_extent size, tyn_ref results,
                          tyn_ref images[3])
{
    static const char *const names[] = {"field_red", "field_green", "field_blue"};
    add_named_images(g, job, names, size, results, images);
}

void tyn_add_guide(tyn_graph *g, const tyn_job *job, const tyn_view_inputs *in)
{
    enum { CELLS = 32 }; // along the longest side: with twice or half as many paths are as noisy
    static const char *const names[] = {"guide_scattered", "guide_beams", "guide_none"};
    const tyn_extent size = tyn_lattice_dims(job->frame->medium.extent, CELLS);
    tyn_ref images[3];
    const tyn_ref points = tyn_add_field_points(g, job, size);
    add_named_images(g, job, names, size, add_probe(g, job, in, points, PARTS), images);
    memcpy(job->guide, images, 2 * sizeof *images);
}

// A probe at every texel.
void tyn_add_light_field(tyn_graph *g, const tyn_job *job, const tyn_view_inputs *in)
{
    const VkExtent3D size = job->light->red->extent;
    const tyn_light_field_params params = {
        .half = job->light->red->format == VK_FORMAT_R16G16B16A16_SFLOAT,
        .args.world = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
    };
    const tyn_ref points =
        tyn_add_field_points(g, job, (tyn_extent){size.width, size.height, size.depth});
    tyn_ref images[3];
    memcpy(images, job->refs.light, sizeof images);
    add_field_images(g, &params,
                     add_probe(g, job, in, points, job->light->unscattered ? ALL : SCATTERED),
                     images);
    tyn_job_output(g, job, TYN_OUTPUT_LIGHT, images[0]);
}
