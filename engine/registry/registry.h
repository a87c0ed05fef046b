// registry.h -- the inside of the registry: methods by name, copies of settings.
#pragma once
#include <tyndall/registry.h>
#include "methods/job.h"

const tyn_method *tyn_method_find(const char *name); // NULL: not there
const char *tyn_method_names(void);                  // "pop, path, ..."
const tyn_pass_desc *tyn_pass_find(const char *name);
tyn_result tyn_settings_copy(const tyn_settings *from, tyn_settings **out); // NULL: empty
