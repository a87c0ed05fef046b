// probe_point.c -- the light field at a point that the user picked in the picture.
#include "view/probe_point.h"
#include "view/viewer.h"
#include <math.h>

void probe_place(viewer *v)
{
    const uint32_t needed = TYN_OUTPUT_PROBE | TYN_OUTPUT_DEPTH;
    if ((v->method.info.outputs & needed) != needed) {
        viewer_note(v, "method '%s' cannot be probed", v->method.info.name);
        return;
    }
    if (v->mouse[0] < 0 || v->mouse[1] < 0 || v->mouse[0] >= v->view.width ||
        v->mouse[1] >= v->view.height) {
        viewer_note(v, "the pointer is not on the picture");
        return;
    }
    v->probe.state = PROBE_PLACED;
    v->probe.x = (float)(v->mouse[0] / v->view.width);
    v->probe.y = (float)(v->mouse[1] / v->view.height);
    // Until the depth is known a point of the ray stands for it: as far as what the camera turns about.
    camera_control_point(&v->camera, v->probe.x, v->probe.y, viewer_aspect(v),
                         camera_control_distance(&v->camera), v->probe.position);
    v->outdated = true;
    v->woken = true;
}

void probe_remove(viewer *v)
{
    v->probe.state = PROBE_OFF;
    v->outdated = true;
    v->woken = true;
}

// The depth is asked for once: methods march every pixel for it, which changes the picture that is saved.
void probe_ask(const viewer *v, tyn_view *view)
{
    const uint32_t needed = TYN_OUTPUT_PROBE | TYN_OUTPUT_DEPTH;
    if (v->probe.state != PROBE_OFF && (v->method.info.outputs & needed) == needed) {
        view->outputs |= v->probe.state == PROBE_PLACED ? needed : TYN_OUTPUT_PROBE;
        view->points = &v->probe.position;
        view->num_points = 1;
    }
}

// The surface at the probe's pixel, or what of the medium lets half of the light through, whichever is nearer. False:
// nothing is seen there.
static bool depth_at(const viewer *v, const rendering *r, float *depth)
{
    const float *depths = rendering_output(r, TYN_OUTPUT_DEPTH);
    const uint32_t x = (uint32_t)(v->probe.x * (float)r->width);
    const uint32_t y = (uint32_t)(v->probe.y * (float)r->height);
    if (!depths || x >= r->width || y >= r->height) {
        return false;
    }
    const float *texel = depths + 4 * ((size_t)y * r->width + x);
    *depth = INFINITY;
    for (int i = 0; i < 2; i++) {
        if (texel[i] > 0 && texel[i] < *depth) {
            *depth = texel[i];
        }
    }
    return isfinite(*depth);
}

void probe_take(viewer *v, const rendering *r)
{
    const tyn_probe_result *result = rendering_output(r, TYN_OUTPUT_PROBE);
    if (v->probe.state == PROBE_OFF || !result) {
        return;
    }
    float depth;
    if (v->probe.state == PROBE_PLACED) {
        if (depth_at(v, r, &depth)) {
            camera_control_point(&v->camera, v->probe.x, v->probe.y, viewer_aspect(v), depth,
                                 v->probe.position);
        }
        v->probe.state = PROBE_ASKED;
        v->outdated = true;
        return;
    }
    v->probe.result =
        *result; // where nothing is seen, of the point beside what the camera turns about
    v->probe.state = PROBE_KNOWN;
}
