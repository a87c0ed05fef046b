// rendering.c -- a context of the library, frame by frame, on the viewer's device for it.
#include "view/rendering.h"
#include <string.h>

bool rendering_open(rendering *r, gpu *g, const method *m)
{
    *r = (rendering){.gpu = g, .method = m->info, .batch = 1};
    return gpu_commands_make(g, &r->commands) &&
           tyn_context_create(g->tyn,
                              tyn_context_params(.method = m->info.name, .settings = m->settings,
                                                 .frames_in_flight = 1, .readback = true,
                                                 .memory_budget = m->memory_budget),
                              &r->context) == TYN_OK;
}

void rendering_close(rendering *r)
{
    if (r->gpu) {
        gpu_finish(r->gpu, &r->commands);
        tyn_context_destroy(&r->context);
        gpu_commands_free(r->gpu, &r->commands);
    }
    *r = (rendering){0};
}

static void adapt_batch(rendering *r, double budget_ms, uint32_t most)
{
    if (r->ms > 1.3 * budget_ms) {
        r->batch = r->batch > 1 ? r->batch / 2 : 1;
    } else if (r->ms < 0.5 * budget_ms) {
        r->batch *= 2;
    }
    r->batch = r->batch > most ? most : r->batch;
}

uint32_t rendering_pending(const rendering *r)
{
    return tyn_context_pending(r->context);
}

rendering_state rendering_begin(rendering *r, const tyn_scene *scene, const tyn_view *view,
                                bool more)
{
    gpu *g = r->gpu;
    const double start = app_seconds();
    tyn_view asked = *view;
    const bool same = r->width == view->width && r->height == view->height;
    more = more && same;
    r->batch = same ? r->batch : 1;
    asked.first_sample = r->method.progressive && more ? r->samples : 0;
    asked.num_samples = r->method.progressive ? r->batch : 0;
    tyn_frame frame =
        *tyn_frame(.scene = scene, .view = &asked, .cmd = r->commands.cmd, .background = true);
    const tyn_result prepared = tyn_context_prepare(r->context, &frame);
    if (prepared != TYN_OK) {
        return prepared == TYN_PENDING ? RENDERING_PENDING : RENDERING_FAILED;
    }
    // Anew for each frame: another scene or camera takes another time.
    r->most = tyn_context_batch(r->context, &frame);
    if (asked.num_samples > r->most) {
        asked.num_samples = r->batch = r->most;
    }
    if (!gpu_begin(g, &r->commands) || tyn_context_record(r->context, &frame) != TYN_OK ||
        !gpu_submit(g, &r->commands, VK_NULL_HANDLE, VK_NULL_HANDLE)) {
        return RENDERING_FAILED;
    }
    r->started = start;
    r->width = view->width;
    r->height = view->height;
    r->resized = !same;
    r->added = asked.num_samples;
    r->samples = asked.first_sample + asked.num_samples;
    return RENDERING_BUSY;
}

rendering_state rendering_poll(rendering *r, double seconds, double budget_ms)
{
    const gpu_state state = gpu_wait_for(r->gpu, &r->commands, seconds);
    if (state != GPU_DONE) {
        return state == GPU_BUSY ? RENDERING_BUSY : RENDERING_FAILED;
    }
    r->ms = 1e3 * (app_seconds() - r->started);
    r->frames++;
    adapt_batch(r, budget_ms, r->most);
    return RENDERING_DONE;
}

const void *rendering_output(const rendering *r, tyn_output output)
{
    return tyn_context_output(r->context, output);
}

double rendering_pixels_ms(const rendering *r)
{
    tyn_report report = {0};
    tyn_context_report(r->context, &report);
    double sum = 0;
    for (uint32_t i = 0; i < report.num_nodes; i++) {
        const tyn_node_report *n = &report.nodes[i];
        for (const tyn_pass_desc *const *pass = r->method.passes; *pass; pass++) {
            const bool counts = (*pass)->of_pixels && strcmp((*pass)->name, n->name) == 0;
            sum += counts ? n->gpu_ms : 0;
        }
    }
    return sum / (r->added > 1 ? r->added : 1);
}
