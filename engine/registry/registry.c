// registry.c -- the passes and methods of the library, by the lists of the build, and those that were added.
//
// The lists only grow: an entry is written, under the lock, before the count that lets others see it.
#include "registry/registry.h"
#include "registry/addition.h"
#include "base/given.h"
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PASS(name) extern const tyn_pass_desc tyn_pass_##name;
#define METHOD(name) extern const tyn_method tyn_method_##name;
#include "passes/pass_list.h"
#include "passes/methods/method_list.h"
#undef PASS
#undef METHOD

enum { MAX_PASSES = 256, MAX_METHODS = 64, MAX_HOOKS = 32 };

#define PASS(name) 1 +
#define METHOD(name) 1 +
enum {
    NUM_OWN_PASSES =
#include "passes/pass_list.h"
        0,
    NUM_OWN_METHODS =
#include "passes/methods/method_list.h"
        0,
};
#undef PASS
#undef METHOD

#define PASS(name) &tyn_pass_##name,
#define METHOD(name) &tyn_method_##name,
static const tyn_pass_desc *passes[MAX_PASSES] = {
#include "passes/pass_list.h"
};
static const tyn_method *methods[MAX_METHODS] = {
#include "passes/methods/method_list.h"
};
static const tyn_picture_hook *hooks[MAX_HOOKS];
static atomic_uint num_passes = NUM_OWN_PASSES, num_methods = NUM_OWN_METHODS, num_hooks;
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

uint32_t tyn_num_passes(void)
{
    return atomic_load(&num_passes);
}

const tyn_pass_desc *tyn_pass_at(uint32_t index)
{
    return index < tyn_num_passes() ? passes[index] : NULL;
}

const tyn_pass_desc *tyn_pass_find(const char *name)
{
    for (uint32_t i = 0; i < tyn_num_passes(); i++) {
        if (!strcmp(passes[i]->name, name)) {
            return passes[i];
        }
    }
    return NULL;
}

uint32_t tyn_num_methods(void)
{
    return atomic_load(&num_methods);
}

void tyn_method_at(uint32_t index, tyn_method_info *info)
{
    if (!info) {
        return;
    }
    *info = index < tyn_num_methods() ? methods[index]->info : (tyn_method_info){0};
}

const tyn_method *tyn_method_find(const char *name)
{
    for (uint32_t i = 0; i < tyn_num_methods(); i++) {
        if (!strcmp(methods[i]->info.name, name ? name : tyn_method_default())) {
            return methods[i];
        }
    }
    return NULL;
}

bool tyn_method_named(const char *name, tyn_method_info *info)
{
    const tyn_method *method = tyn_method_find(name);
    if (info) {
        *info = method ? method->info : (tyn_method_info){0};
    }
    return method != NULL;
}

const char *tyn_method_default(void)
{
    return methods[0]->info.name;
}

const char *tyn_method_reference(void)
{
    uint32_t i = 0;
    while (!methods[i]->info.reference) {
        i++;
    }
    return methods[i]->info.name;
}

void tyn_method_names(uint32_t outputs, char *text, size_t size)
{
    size_t at = 0;
    for (uint32_t i = 0; i < tyn_num_methods() && at < size; i++) {
        const tyn_method_info *info = &methods[i]->info;
        if ((info->outputs & outputs) == outputs) {
            at += (size_t)snprintf(text + at, size - at, "%s%s", at ? ", " : "", info->name);
        }
    }
}

const tyn_picture_hook *const *tyn_picture_hooks(uint32_t *count)
{
    *count = atomic_load(&num_hooks);
    return hooks;
}

// ---- adding -----------------------------------------------------------------------------------

// A pass of the addition, or one that is there.
static const tyn_pass_desc *find_with(const tyn_addition *a, const char *name)
{
    for (uint32_t i = 0; i < a->num_passes; i++) {
        if (!strcmp(a->passes[i]->name, name)) {
            return a->passes[i];
        }
    }
    return tyn_pass_find(name);
}

// The copy of a method that the registry keeps, with its passes. NULL: one of them is not there, and a line was logged.
static tyn_method *copy_method(const tyn_addition *a, const tyn_method *method, const tyn_log *log)
{
    uint32_t count = 0;
    while (method->passes[count]) {
        count++;
    }
    struct {
        tyn_method method;
        const tyn_pass_desc *passes[];
    } *copy = calloc(1, sizeof *copy + (count + 1) * sizeof copy->passes[0]);
    if (!copy) {
        tyn_log_print(log, TYN_LOG_ERROR, "%s: out of memory", a->who);
        return NULL;
    }
    for (uint32_t i = 0; i < count; i++) {
        copy->passes[i] = find_with(a, method->passes[i]);
        if (!copy->passes[i]) {
            tyn_log_print(log, TYN_LOG_ERROR,
                          "%s: method '%s' names the pass '%s', which is not there", a->who,
                          method->info.name, method->passes[i]);
            free(copy);
            return NULL;
        }
    }
    copy->method = *method;
    copy->method.info.passes = copy->passes;
    copy->method.info.plugin = a->plugin;
    copy->method.info.limits = method->info.limits ? method->info.limits : tyn_limits_untold;
    return &copy->method;
}

// Are the names new, here and in the addition, and is there room?
static bool check_names(const tyn_addition *a, const tyn_log *log)
{
    const char *clash = NULL, *what = "pass";
    for (uint32_t i = 0; i < a->num_passes && !clash; i++) {
        const char *name = a->passes[i]->name;
        clash = tyn_pass_find(name) || find_with(a, name) != a->passes[i] ? name : NULL;
    }
    for (uint32_t i = 0; i < a->num_methods && !clash; i++) {
        const char *name = a->methods[i]->info.name;
        what = "method";
        clash = tyn_method_find(name) ? name : NULL;
        for (uint32_t k = 0; k < i && !clash; k++) {
            clash = !strcmp(a->methods[k]->info.name, name) ? name : NULL;
        }
    }
    for (uint32_t i = 0; i < a->num_hooks && !clash; i++) {
        what = "hook";
        for (uint32_t k = 0; k < atomic_load(&num_hooks) + i && !clash; k++) {
            const uint32_t own = atomic_load(&num_hooks);
            const tyn_picture_hook *other = k < own ? hooks[k] : a->hooks[k - own];
            clash = !strcmp(other->name, a->hooks[i]->name) ? other->name : NULL;
        }
    }
    if (clash) {
        tyn_log_print(log, TYN_LOG_ERROR, "%s: there is a %s '%s' already; give it another name",
                      a->who, what, clash);
    } else if (tyn_num_passes() + a->num_passes > MAX_PASSES ||
               tyn_num_methods() + a->num_methods > MAX_METHODS ||
               atomic_load(&num_hooks) + a->num_hooks > MAX_HOOKS) {
        tyn_log_print(log, TYN_LOG_ERROR,
                      "%s: more than %d passes, %d methods or %d hooks in one process", a->who,
                      MAX_PASSES, MAX_METHODS, MAX_HOOKS);
        return false;
    }
    return !clash;
}

static tyn_result add_all(const tyn_addition *a, const tyn_log *log)
{
    if (!check_names(a, log)) {
        return TYN_ERR_PARAMS;
    }
    const uint32_t first = tyn_num_methods();
    for (uint32_t i = 0; i < a->num_methods; i++) {
        methods[first + i] = copy_method(a, a->methods[i], log);
        if (!methods[first + i]) {
            for (uint32_t k = 0; k < i; k++) {
                free((void *)methods[first + k]);
            }
            return TYN_ERR_PARAMS;
        }
    }
    for (uint32_t i = 0; i < a->num_passes; i++) {
        passes[tyn_num_passes() + i] = a->passes[i];
    }
    for (uint32_t i = 0; i < a->num_hooks; i++) {
        hooks[atomic_load(&num_hooks) + i] = a->hooks[i];
    }
    atomic_fetch_add(&num_passes, a->num_passes);
    atomic_fetch_add(&num_hooks, a->num_hooks);
    atomic_fetch_add(&num_methods, a->num_methods);
    return TYN_OK;
}

tyn_result tyn_registry_add(const tyn_addition *a, const tyn_log *log)
{
    if (!tyn_addition_check(a, log)) {
        return TYN_ERR_PARAMS;
    }
    pthread_mutex_lock(&lock);
    const tyn_result result = add_all(a, log);
    pthread_mutex_unlock(&lock);
    return result;
}

tyn_result tyn_pass_register(const tyn_pass_desc *pass, const tyn_log *log)
{
    if (!TYN_GIVEN(log, pass)) {
        return TYN_ERR_PARAMS;
    }
    return tyn_registry_add(
        &(tyn_addition){"tyn_pass_register", "", .passes = &pass, .num_passes = 1}, log);
}

tyn_result tyn_method_register(const tyn_method *method, const tyn_log *log)
{
    if (!TYN_GIVEN(log, method)) {
        return TYN_ERR_PARAMS;
    }
    return tyn_registry_add(
        &(tyn_addition){"tyn_method_register", "", .methods = &method, .num_methods = 1}, log);
}

tyn_result tyn_picture_hook_register(const tyn_picture_hook *hook, const tyn_log *log)
{
    if (!TYN_GIVEN(log, hook)) {
        return TYN_ERR_PARAMS;
    }
    return tyn_registry_add(
        &(tyn_addition){"tyn_picture_hook_register", "", .hooks = &hook, .num_hooks = 1}, log);
}
