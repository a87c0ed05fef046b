// addition.h -- passes, methods and hooks that are added to those of the library, all of them or none.
#pragma once
#include <tyndall/extend/plugin.h>

typedef struct tyn_addition {
    const char *who;    // begins every line of the log: "plugin 'x.so'"
    const char *plugin; // tyn_method_info.plugin; lives as long as the process
    const tyn_pass_desc *const *passes;
    uint32_t num_passes;
    const tyn_method *const *methods;
    uint32_t num_methods;
    const tyn_picture_hook *const *hooks;
    uint32_t num_hooks;
} tyn_addition;

// What a plugin or a module brings; `who` and `plugin` are left empty.
tyn_addition tyn_addition_of(const tyn_plugin *plugin);

// Are the tables fit, each for itself? What is wrong first is one log line.
bool tyn_addition_check(const tyn_addition *a, const tyn_log *log);
tyn_result tyn_registry_add(const tyn_addition *a, const tyn_log *log);

// Of methods that tell no limits.
extern const tyn_limit tyn_limits_untold[];
