// registry.h -- the inside of the registry: methods by name, copies of settings.
#pragma once
#include <tyndall/registry.h>
#include <tyndall/extend/method.h>

const tyn_method *tyn_method_find(const char *name); // `name` NULL: the default; NULL: not there
// "pop, path, ...": those that make all of `outputs`, a set of tyn_output; 0: all.
void tyn_method_names(uint32_t outputs, char *text, size_t size);
const tyn_pass_desc *tyn_pass_find(const char *name);
const tyn_picture_hook *const *tyn_picture_hooks(uint32_t *count);
// A preset, and before that what `from` has set (NULL: nothing).
tyn_result tyn_settings_copy(const tyn_settings *from, tyn_quality quality, const tyn_log *log,
                             tyn_settings **out);
const char *tyn_quality_name(tyn_quality quality); // NULL: there is none
// Of the values that differ from defaults, in the order in which they were set.
uint64_t tyn_settings_hash(const tyn_settings *settings);
