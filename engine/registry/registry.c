// registry.c -- the passes and methods of the library, by the lists of the build.
#include "registry/registry.h"
#include <stdio.h>
#include <string.h>

#define PASS(name) extern const tyn_pass_desc tyn_pass_##name;
#define METHOD(name) extern const tyn_method tyn_method_##name;
#include "passes/pass_list.h"
#include "method_list.h"
#undef PASS
#undef METHOD

#define PASS(name) &tyn_pass_##name,
#define METHOD(name) &tyn_method_##name,
static const tyn_pass_desc *const passes[] = {
#include "passes/pass_list.h"
};
static const tyn_method *const methods[] = {
#include "method_list.h"
};
enum { NUM_PASSES = TYN_COUNT(passes), NUM_METHODS = TYN_COUNT(methods) };

uint32_t tyn_num_passes(void)
{
    return NUM_PASSES;
}

const tyn_pass_desc *tyn_pass_at(uint32_t index)
{
    return index < NUM_PASSES ? passes[index] : NULL;
}

const tyn_pass_desc *tyn_pass_find(const char *name)
{
    for (uint32_t i = 0; i < NUM_PASSES; i++) {
        if (!strcmp(passes[i]->name, name)) {
            return passes[i];
        }
    }
    return NULL;
}

uint32_t tyn_num_methods(void)
{
    return NUM_METHODS;
}

void tyn_method_at(uint32_t index, tyn_method_info *info)
{
    if (!info) {
        return;
    }
    *info = index < NUM_METHODS ? methods[index]->info : (tyn_method_info){0};
}

const tyn_method *tyn_method_find(const char *name)
{
    for (uint32_t i = 0; i < NUM_METHODS; i++) {
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

void tyn_method_names(char *text, size_t size)
{
    size_t at = 0;
    for (uint32_t i = 0; i < NUM_METHODS && at < size; i++) {
        at += (size_t)snprintf(text + at, size - at, "%s%s", i ? ", " : "", methods[i]->info.name);
    }
}
