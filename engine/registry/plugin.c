// plugin.c -- loads shared objects with passes, methods and hooks.
#include "registry/addition.h"
#include "base/given.h"
#include <dlfcn.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// clang-format off
#define CALL(type, name, params, args) name,
#define CALL_VOID(name, params, args) name,
static const tyn_calls calls = {TYN_CALLS(CALL, CALL_VOID)};
// clang-format on

typedef struct loaded {
    const tyn_plugin *plugin;
    char *path;
} loaded;

enum { MAX_PLUGINS = 64 };
static loaded plugins[MAX_PLUGINS];
static atomic_uint num_plugins;
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

uint32_t tyn_num_plugins(void)
{
    return atomic_load(&num_plugins);
}

void tyn_plugin_at(uint32_t index, tyn_plugin_info *info)
{
    if (!info) {
        return;
    }
    *info = (tyn_plugin_info){0};
    if (index < tyn_num_plugins()) {
        const tyn_plugin *p = plugins[index].plugin;
        info->name = p->name;
        info->summary = p->summary;
        info->path = plugins[index].path;
        const tyn_addition a = tyn_addition_of(p);
        info->num_passes = a.num_passes;
        info->num_methods = a.num_methods;
        info->num_hooks = a.num_hooks;
    }
}

static tyn_result add(const tyn_plugin *p, const char *path, const char *who, const tyn_log *log)
{
    const uint32_t count = tyn_num_plugins();
    for (uint32_t i = 0; i < count; i++) {
        if (plugins[i].plugin == p) {
            return TYN_OK;
        }
    }
    if (count == MAX_PLUGINS) {
        return TYN_FAULT(log, TYN_ERR_PARAMS, "%s: %d plugins are the most", who, MAX_PLUGINS);
    }
    char *copy = strdup(path);
    if (!copy) {
        return TYN_ERR_MEMORY;
    }
    tyn_addition a = tyn_addition_of(p);
    a.who = who;
    a.plugin = p->name;
    *p->calls = &calls;
    const tyn_result result = tyn_registry_add(&a, log);
    if (result == TYN_OK) {
        plugins[count] = (loaded){p, copy};
        atomic_store(&num_plugins, count + 1);
    } else {
        free(copy);
    }
    return result;
}

// One that this library can read: the number comes first, and what follows it depends on it.
static bool check_abi(const tyn_plugin *p, const char *who, const tyn_log *log)
{
    if (p->abi != TYN_EXTEND_ABI) {
        return TYN_FAULT(log, false,
                         "%s is built for ABI %u (Tyndall %u.%u.%u); this is ABI %u (Tyndall %s): "
                         "build it against the headers of this one",
                         who, p->abi, p->version / 1000, p->version / 10 % 100, p->version % 10,
                         TYN_EXTEND_ABI, tyn_version_string());
    }
    if (p->layout != TYN_EXTEND_LAYOUT) {
        return TYN_FAULT(
            log, false,
            "%s is built for ABI %u with structs of other sizes than here (%08x, %08x): "
            "build it against the headers of this library",
            who, p->abi, p->layout, TYN_EXTEND_LAYOUT);
    }
    if (!p->name || !p->summary || !p->calls) {
        return TYN_FAULT(log, false, "%s: it must have a name and a summary (TYN_PLUGIN)", who);
    }
    return true;
}

tyn_result tyn_plugin_load(const char *path, const tyn_log *log)
{
    if (!TYN_GIVEN(log, path)) {
        return TYN_ERR_PARAMS;
    }
    char who[1024], file[4096];
    snprintf(who, sizeof who, "plugin '%s'", path);
    // A name without a folder is a file here, not one of the system's libraries.
    snprintf(file, sizeof file, "%s%s", strchr(path, '/') ? "" : "./", path);
    void *object = dlopen(file, RTLD_NOW | RTLD_LOCAL);
    if (!object) {
        const char *why = dlerror();
        return TYN_FAULT(log, TYN_ERR_IO, "%s cannot be loaded: %s", who, why ? why : "unknown");
    }
    const tyn_plugin *plugin = dlsym(object, "tyn_plugin_entry");
    tyn_result result = TYN_ERR_PARAMS;
    if (!plugin) {
        tyn_log_print(log, TYN_LOG_ERROR,
                      "%s has no symbol 'tyn_plugin_entry': it is no plugin of Tyndall "
                      "(TYN_PLUGIN of tyndall/extend/plugin.h makes it)",
                      who);
    } else if (check_abi(plugin, who, log)) {
        pthread_mutex_lock(&lock);
        result = add(plugin, path, who, log);
        pthread_mutex_unlock(&lock);
    }
    if (result != TYN_OK) {
        dlclose(object);
    }
    return result;
}
