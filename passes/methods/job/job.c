// job.c -- what methods give the graph of what a job asks for.
#include <tyndall/extend/job.h>
#include "base/fault.h"
#include "frame/output.h"
#include "registry/registry.h"
#include "passes/export/export.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

// Into the host's image, if it lent one for this.
static void export_output(tyn_graph *g, const tyn_job *job, tyn_output which, tyn_ref ref)
{
    for (uint32_t i = 0; i < TYN_NUM_LENT; i++) {
        if (which != tyn_lent_images[i].output || !job->refs.images[i].resource) {
            continue;
        }
        const VkFormat format = tyn_graph_format(g, job->refs.images[i]);
        const tyn_export_params params = {format == VK_FORMAT_R16G16B16A16_SFLOAT ? TYN_EXPORT_HALF
                                          : format == VK_FORMAT_R32_SFLOAT        ? TYN_EXPORT_ONE
                                                                           : TYN_EXPORT_FLOAT};
        tyn_ref refs[EXPORT_NUM_PORTS] = {
            [EXPORT_PORT_RESULT] = ref, [EXPORT_PORT_HOST] = job->refs.images[i]};
        tyn_graph_add(g, &tyn_pass_export, &params, refs);
        tyn_graph_output(g, tyn_lent_images[i].made, refs[EXPORT_PORT_HOST], false);
    }
}

tyn_result tyn_job_declare(tyn_graph *g, const tyn_job *job, const char *name, tyn_ref *made)
{
    const tyn_method *method = tyn_method_find(name);
    if (!method) {
        const tyn_result missing =
            TYN_FAULT(job->log, TYN_ERR_UNSUPPORTED,
                      "method '%s' needs method '%s', which is not there", job->method->name, name);
        tyn_graph_refuse(g, missing);
        return missing;
    }
    tyn_job own = *job;
    own.method = &method->info;
    own.outputs &= method->info.outputs;
    own.num_hooks = 0;
    own.made = made;
    memset(made, 0, TYN_NUM_OUTPUTS * sizeof *made);
    return method->declare(g, &own);
}

uint32_t tyn_job_batch(const tyn_job *job, const char *name)
{
    const tyn_method *method = tyn_method_find(name);
    return method && method->batch ? method->batch(job) : 1;
}

void tyn_job_output(tyn_graph *g, const tyn_job *job, tyn_output which, tyn_ref ref)
{
    if (job->outputs & which && job->made) {
        uint32_t index = 0;
        while ((uint32_t)which >> index != 1) {
            index++;
        }
        job->made[index] = ref;
    } else if (job->outputs & which) {
        tyn_graph_output(g, tyn_job_output_name(which), ref,
                         job->readback && which != TYN_OUTPUT_COMPOSITE &&
                             which != TYN_OUTPUT_LIGHT);
        export_output(g, job, which, ref);
    }
}

uint32_t tyn_job_hooks_read(const tyn_job *job)
{
    uint32_t all = 0;
    for (uint32_t i = 0; i < job->num_hooks; i++) {
        all |= job->hooks[i]->reads ? job->hooks[i]->reads(job) : 0;
    }
    return all;
}

void tyn_job_warn(const tyn_job *job, const char *format, ...)
{
    char line[256];
    va_list args;
    va_start(args, format);
    vsnprintf(line, sizeof line, format, args);
    va_end(args);
    if (job->warn) {
        job->warn(job->warn_user, line);
    }
}

void tyn_job_warn_surfaces(const tyn_job *job, const char *what)
{
    if (job->frame->num_triangles) {
        tyn_job_warn(job, "surfaces %s: %u triangles", what, job->frame->num_triangles);
    }
}

void tyn_job_warn_suns(const tyn_job *job, const char *what)
{
    const tyn_lights *lights = &job->frame->lights;
    const uint32_t suns = lights->num_suns, used = tyn_num_beams(lights);
    double left_out = 0, all = 0;
    for (uint32_t i = 0; i < suns; i++) {
        const float *color = lights->suns[i].color;
        const double irradiance = (double)color[0] + (double)color[1] + (double)color[2];
        all += irradiance;
        left_out += i < used ? 0 : irradiance;
    }
    if (left_out > 0) {
        tyn_job_warn(
            job, "%u suns: the %u strongest light %s, %.2g %% of the suns' irradiance is left out",
            suns, used, what, 100 * left_out / all);
    }
}

bool tyn_job_refuse_repeat(const tyn_job *job)
{
    for (uint32_t i = 0; i < job->scene->num_shapes; i++) {
        const bool *repeat = job->scene->shapes[i].repeat;
        if (repeat[0] || repeat[1] || repeat[2]) {
            return TYN_FAULT(job->log, false,
                             "shape %u: method '%s' cannot do periodic media (\"repeat\"); "
                             "'path' can",
                             i, job->method->name);
        }
    }
    return true;
}
