// registry.c -- the passes and methods of the library, by the list of the build, and those that were added.
//
// The lists only grow: an entry is written, under the lock, before the count that lets others see it.
#include "registry/registry.h"
#include "registry/addition.h"
#include "base/given.h"
#include "registry/built_in.h"
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

enum { MAX_PASSES = 256, MAX_METHODS = 64, MAX_HOOKS = 32, MAX_NAMED = 64 * MAX_METHODS };

static const tyn_pass_desc *passes[MAX_PASSES];
static tyn_method methods[MAX_METHODS];
static const tyn_pass_desc *named[MAX_NAMED]; // the lists of passes of methods, one after the other
static const tyn_picture_hook *hooks[MAX_HOOKS];
static atomic_uint num_passes, num_methods, num_hooks;
static uint32_t num_named;
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static pthread_once_t started = PTHREAD_ONCE_INIT;

static void add_built_in(void);

static void start(void)
{
    pthread_once(&started, add_built_in);
}

static const tyn_pass_desc *find_pass(const char *name)
{
    for (uint32_t i = 0; i < atomic_load(&num_passes); i++) {
        if (!strcmp(passes[i]->name, name)) {
            return passes[i];
        }
    }
    return NULL;
}

static const tyn_method *find_method(const char *name)
{
    for (uint32_t i = 0; i < atomic_load(&num_methods); i++) {
        if (!strcmp(methods[i].info.name, name)) {
            return &methods[i];
        }
    }
    return NULL;
}

uint32_t tyn_num_passes(void)
{
    start();
    return atomic_load(&num_passes);
}

const tyn_pass_desc *tyn_pass_at(uint32_t index)
{
    return index < tyn_num_passes() ? passes[index] : NULL;
}

const tyn_pass_desc *tyn_pass_find(const char *name)
{
    start();
    return find_pass(name);
}

uint32_t tyn_num_methods(void)
{
    start();
    return atomic_load(&num_methods);
}

void tyn_method_at(uint32_t index, tyn_method_info *info)
{
    if (!info) {
        return;
    }
    *info = index < tyn_num_methods() ? methods[index].info : (tyn_method_info){0};
}

const tyn_method *tyn_method_find(const char *name)
{
    start();
    return name ? find_method(name) : &methods[0];
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
    return tyn_method_find(NULL)->info.name;
}

const char *tyn_method_reference(void)
{
    start();
    uint32_t i = 0;
    while (!methods[i].info.reference) {
        i++;
    }
    return methods[i].info.name;
}

const char *tyn_methods_left_out(void)
{
    return tyn_left_out;
}

void tyn_method_names(uint32_t outputs, char *text, size_t size)
{
    size_t at = 0;
    for (uint32_t i = 0; i < tyn_num_methods() && at < size; i++) {
        const tyn_method_info *info = &methods[i].info;
        if ((info->outputs & outputs) == outputs) {
            at += (size_t)snprintf(text + at, size - at, "%s%s", at ? ", " : "", info->name);
        }
    }
}

const tyn_picture_hook *const *tyn_picture_hooks(uint32_t *count)
{
    start();
    *count = atomic_load(&num_hooks);
    return hooks;
}

// ---- adding -----------------------------------------------------------------------------------

// The passes that a hook declares in methods that have this one.
static const char *const *passes_behind(const char *pass, const tyn_picture_hook *hook)
{
    static const char *const none[] = {NULL};
    return hook->passes && hook->follows && !strcmp(hook->follows, pass) ? hook->passes : none;
}

// Adds the pass to the list of a method, and behind it those of the hooks that follow it.
static void list_pass(const char *name)
{
    named[num_named++] = find_pass(name);
    for (uint32_t i = 0; i < atomic_load(&num_hooks); i++) {
        for (const char *const *p = passes_behind(name, hooks[i]); *p; p++) {
            named[num_named++] = find_pass(*p);
        }
    }
}

// How many entries the lists of the addition's methods take.
static uint32_t count_listed(const tyn_addition *a)
{
    uint32_t count = a->num_methods;
    const uint32_t own = atomic_load(&num_hooks);
    for (uint32_t m = 0; m < a->num_methods; m++) {
        for (const char *const *name = a->methods[m]->passes; *name; name++, count++) {
            for (uint32_t i = 0; i < own + a->num_hooks; i++) {
                const tyn_picture_hook *hook = i < own ? hooks[i] : a->hooks[i - own];
                for (const char *const *p = passes_behind(*name, hook); *p; p++) {
                    count++;
                }
            }
        }
    }
    return count;
}

// The method, with its passes.
static void add_method(const tyn_addition *a, const tyn_method *method)
{
    tyn_method *copy = &methods[atomic_load(&num_methods)];
    *copy = *method;
    copy->info.passes = &named[num_named];
    copy->info.plugin = a->plugin;
    copy->info.limits = method->info.limits ? method->info.limits : tyn_limits_untold;
    for (uint32_t i = 0; method->passes[i]; i++) {
        list_pass(method->passes[i]);
    }
    named[num_named++] = NULL;
    atomic_fetch_add(&num_methods, 1);
}

// A pass of the addition, or one that is there.
static const tyn_pass_desc *find_with(const tyn_addition *a, const char *name)
{
    for (uint32_t i = 0; i < a->num_passes; i++) {
        if (!strcmp(a->passes[i]->name, name)) {
            return a->passes[i];
        }
    }
    return find_pass(name);
}

// Are all passes there that methods or hooks of the addition name? Else a log line.
static bool check_passes(const tyn_addition *a, const char *what, const char *name,
                         const char *const *names, const tyn_log *log)
{
    for (uint32_t i = 0; names && names[i]; i++) {
        if (!find_with(a, names[i])) {
            return TYN_FAULT(log, false, "%s: %s '%s' names the pass '%s', which is not there",
                             a->who, what, name, names[i]);
        }
    }
    return true;
}

// Are the names new, here and in the addition, and is there room?
static bool check_names(const tyn_addition *a, const tyn_log *log)
{
    const char *clash = NULL, *what = "pass";
    for (uint32_t i = 0; i < a->num_passes && !clash; i++) {
        const char *name = a->passes[i]->name;
        clash = find_pass(name) || find_with(a, name) != a->passes[i] ? name : NULL;
    }
    for (uint32_t i = 0; i < a->num_methods && !clash; i++) {
        const char *name = a->methods[i]->info.name;
        what = "method";
        clash = find_method(name) ? name : NULL;
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
    } else if (atomic_load(&num_passes) + a->num_passes > MAX_PASSES ||
               atomic_load(&num_methods) + a->num_methods > MAX_METHODS ||
               atomic_load(&num_hooks) + a->num_hooks > MAX_HOOKS ||
               num_named + count_listed(a) > MAX_NAMED) {
        return TYN_FAULT(log, false,
                         "%s: more than %d passes, %d methods or %d hooks in one process", a->who,
                         MAX_PASSES, MAX_METHODS, MAX_HOOKS);
    }
    return !clash;
}

static bool check_all(const tyn_addition *a, const tyn_log *log)
{
    bool fit = check_names(a, log);
    for (uint32_t i = 0; fit && i < a->num_methods; i++) {
        fit = check_passes(a, "method", a->methods[i]->info.name, a->methods[i]->passes, log);
    }
    for (uint32_t i = 0; fit && i < a->num_hooks; i++) {
        fit = check_passes(a, "hook", a->hooks[i]->name, a->hooks[i]->passes, log);
    }
    return fit;
}

static void add_all(const tyn_addition *a)
{
    for (uint32_t i = 0; i < a->num_passes; i++) {
        passes[atomic_load(&num_passes)] = a->passes[i];
        atomic_fetch_add(&num_passes, 1);
    }
    for (uint32_t i = 0; i < a->num_hooks; i++) {
        hooks[atomic_load(&num_hooks)] = a->hooks[i];
        atomic_fetch_add(&num_hooks, 1);
    }
    for (uint32_t i = 0; i < a->num_methods; i++) {
        add_method(a, a->methods[i]);
    }
}

// Passes and hooks of all, then the methods that list them.
static void add_built_in(void)
{
    for (uint32_t i = 0; tyn_built_in[i]; i++) {
        tyn_addition a = tyn_addition_of(tyn_built_in[i]);
        a.num_methods = 0;
        add_all(&a);
    }
    for (uint32_t i = 0; tyn_built_in[i]; i++) {
        tyn_addition a = tyn_addition_of(tyn_built_in[i]);
        a.num_passes = a.num_hooks = 0;
        add_all(&a);
    }
}

tyn_result tyn_registry_add(const tyn_addition *a, const tyn_log *log)
{
    if (!tyn_addition_check(a, log)) {
        return TYN_ERR_PARAMS;
    }
    start();
    pthread_mutex_lock(&lock);
    const bool fit = check_all(a, log);
    if (fit) {
        add_all(a);
    }
    pthread_mutex_unlock(&lock);
    return fit ? TYN_OK : TYN_ERR_PARAMS;
}

static tyn_result add_one(const tyn_log *log, const void *given, const char *name, tyn_addition a)
{
    return tyn_given(log, a.who, name, &given, 1) ? tyn_registry_add(&a, log) : TYN_ERR_PARAMS;
}

tyn_result tyn_pass_register(const tyn_pass_desc *pass, const tyn_log *log)
{
    return add_one(log, pass, "pass",
                   (tyn_addition){__func__, "", .passes = &pass, .num_passes = 1});
}

tyn_result tyn_method_register(const tyn_method *method, const tyn_log *log)
{
    return add_one(log, method, "method",
                   (tyn_addition){__func__, "", .methods = &method, .num_methods = 1});
}

tyn_result tyn_picture_hook_register(const tyn_picture_hook *hook, const tyn_log *log)
{
    return add_one(log, hook, "hook", (tyn_addition){__func__, "", .hooks = &hook, .num_hooks = 1});
}
