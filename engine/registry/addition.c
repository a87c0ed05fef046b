// addition.c -- are the tables of passes, methods and hooks fit that somebody adds?
#include "registry/addition.h"
#include <string.h>

#define REFUSE(...) return TYN_FAULT(log, false, __VA_ARGS__)

#define LENGTH(list, count)                                                                        \
    for (count = 0; (list) && (list)[count]; count++) {                                            \
    }

tyn_addition tyn_addition_of(const tyn_plugin *p)
{
    tyn_addition a = {.passes = p->passes, .methods = p->methods, .hooks = p->hooks};
    LENGTH(p->passes, a.num_passes)
    LENGTH(p->methods, a.num_methods)
    LENGTH(p->hooks, a.num_hooks)
    return a;
}

const tyn_limit tyn_limits_untold[] = {
    {.key = "limits",
     .level = TYN_LIMIT_STRAINED,
     .advice = {"its plugin does not tell what it is good and bad at: compare with 'path'"},
     .source = "docs/writing-a-plugin.md, \"Limits\""},
    {NULL},
};

// Settings are "pass.param", and lists of names are separated by blanks and commas.
static bool check_name(const char *who, const char *what, const char *name, const tyn_log *log)
{
    if (!name || !name[0] || strlen(name) > 31 ||
        strspn(name, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") !=
            strlen(name)) {
        REFUSE("%s: the name of a %s is '%s'; it must be 1 to 31 letters, digits, '_' and '-'", who,
               what, name ? name : "NULL");
    }
    return true;
}

static bool check_kernel(const char *who, const tyn_pass_desc *pass, const tyn_kernel *k,
                         const tyn_log *log)
{
    enum { SPIRV_MAGIC = 0x07230203 };
    const char *name = k->name ? k->name : "NULL";
    if (!k->name || !k->spirv || k->spirv_size < 20 || k->spirv_size % 4 ||
        k->spirv[0] != SPIRV_MAGIC) {
        REFUSE("%s: pass '%s', kernel '%s': it must have a name and SPIR-V", who, pass->name, name);
    }
    if (k->num_bindings > TYN_MAX_BINDINGS || (k->num_bindings && !k->bindings) ||
        k->num_spec > TYN_MAX_SPEC || k->args_size > TYN_MAX_ARGS || k->args_size % 4) {
        REFUSE("%s: pass '%s', kernel '%s': %u bindings, %u constants and %u bytes of arguments; "
               "%d, %d and %d (a multiple of 4) are the most",
               who, pass->name, name, k->num_bindings, k->num_spec, k->args_size, TYN_MAX_BINDINGS,
               TYN_MAX_SPEC, TYN_MAX_ARGS);
    }
    for (uint32_t i = 0; i < k->num_bindings; i++) {
        if (k->bindings[i].port >= pass->num_ports) {
            REFUSE("%s: pass '%s', kernel '%s': binding %u is of port %u; there are %u", who,
                   pass->name, name, i, k->bindings[i].port, pass->num_ports);
        }
    }
    if (!k->raster && !(k->local_size[0] && k->local_size[1] && k->local_size[2])) {
        REFUSE("%s: pass '%s', kernel '%s': local_size is %u x %u x %u; each must be 1 or more",
               who, pass->name, name, k->local_size[0], k->local_size[1], k->local_size[2]);
    }
    return true;
}

static bool check_param(const char *who, const tyn_pass_desc *pass, const tyn_param *p,
                        const tyn_log *log)
{
    const char *name = p->name ? p->name : "NULL";
    if (!p->name || !p->unit || !p->doc || (p->type == TYN_PARAM_ENUM && !p->names)) {
        REFUSE("%s: pass '%s', parameter '%s': name, unit, doc and the names of words are required",
               who, pass->name, name);
    }
    if (p->offset % 4 || p->offset + 4 > pass->params_size || !(p->min <= p->def) ||
        !(p->def <= p->max) ||
        (p->least > 0 && (p->least > p->max || (p->def < p->least && p->def != p->min)))) {
        REFUSE("%s: pass '%s', parameter '%s': it must lie within the %zu bytes of the params, and "
               "its default %g between %g and %g",
               who, pass->name, name, pass->params_size, p->def, p->min, p->max);
    }
    return true;
}

static bool check_pass(const char *who, const tyn_pass_desc *pass, const tyn_log *log)
{
    if (!check_name(who, "pass", pass->name, log)) {
        return false;
    }
    if (!pass->summary || !pass->declare || !pass->record || !pass->ports ||
        (pass->num_kernels && !pass->kernels)) {
        REFUSE("%s: pass '%s': summary, ports, kernels, declare and record are required", who,
               pass->name);
    }
    if (!pass->num_ports || pass->num_ports > TYN_MAX_PORTS ||
        (pass->num_params && !pass->params) || pass->debug_port >= pass->num_ports ||
        pass->counter_port >= pass->num_ports) {
        REFUSE("%s: pass '%s': %u ports; it must have 1 to %d, the debug port %u and the counters' "
               "port %u among them",
               who, pass->name, pass->num_ports, TYN_MAX_PORTS, pass->debug_port,
               pass->counter_port);
    }
    bool fit = true;
    for (uint32_t i = 0; i < pass->num_ports; i++) {
        if (!pass->ports[i].name || !pass->ports[i].meaning) {
            REFUSE("%s: pass '%s': port %u has no name, or no meaning", who, pass->name, i);
        }
    }
    const tyn_port *counts = &pass->ports[pass->counter_port];
    if (pass->counters && (counts->dir != TYN_OUT || counts->dim != TYN_BUFFER)) {
        REFUSE("%s: pass '%s' counts in its port '%s', which is no buffer that it makes", who,
               pass->name, counts->name);
    }
    for (uint32_t i = 0; i < pass->num_kernels && fit; i++) {
        fit = check_kernel(who, pass, &pass->kernels[i], log);
    }
    for (uint32_t i = 0; i < pass->num_params && fit; i++) {
        fit = check_param(who, pass, &pass->params[i], log);
    }
    return fit;
}

static bool check_method(const char *who, const tyn_method *method, const tyn_log *log)
{
    if (!check_name(who, "method", method->info.name, log)) {
        return false;
    }
    if (!method->info.summary || !method->declare || !method->passes || !method->info.outputs) {
        REFUSE("%s: method '%s': info.summary, info.outputs, passes and declare are required", who,
               method->info.name);
    }
    if (method->info.reference || (method->info.progressive && !method->batch)) {
        REFUSE("%s: method '%s': %s", who, method->info.name,
               method->info.reference ? "'path' is the reference"
                                      : "one that is progressive needs 'batch'");
    }
    for (const tyn_limit *l = method->info.limits; l && l->key; l++) {
        if (!l->source) {
            REFUSE("%s: method '%s', limit '%s': source is required", who, method->info.name,
                   l->key);
        }
    }
    return true;
}

bool tyn_addition_check(const tyn_addition *a, const tyn_log *log)
{
    bool fit = true;
    for (uint32_t i = 0; i < a->num_passes && fit; i++) {
        fit = check_pass(a->who, a->passes[i], log);
    }
    for (uint32_t i = 0; i < a->num_methods && fit; i++) {
        fit = check_method(a->who, a->methods[i], log);
    }
    for (uint32_t i = 0; i < a->num_hooks && fit; i++) {
        const tyn_picture_hook *h = a->hooks[i];
        fit = check_name(a->who, "hook", h->name, log);
        if (fit && (!h->reads != !h->declare || (!h->reads && !h->prepare))) {
            REFUSE("%s: hook '%s': prepare, or reads and declare, are required", a->who, h->name);
        }
    }
    return fit;
}
