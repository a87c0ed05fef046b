// registry.c -- the passes and methods of the library: one line each.
#include "plugin/registry.h"
#include <string.h>

static const tyn_pass_desc *const passes[] = {
    NULL,
};
enum { NUM_PASSES = sizeof passes / sizeof passes[0] - 1 };

static const tyn_method *const methods[] = {
    NULL,
};
enum { NUM_METHODS = sizeof methods / sizeof methods[0] - 1 };

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
    *info = (tyn_method_info){0};
    if (index < NUM_METHODS) {
        const tyn_method *m = methods[index];
        *info = (tyn_method_info){m->name, m->summary, m->passes, m->outputs, m->progressive};
    }
}

const tyn_method *tyn_method_find(const char *name)
{
    for (uint32_t i = 0; i < NUM_METHODS; i++) {
        if (!strcmp(methods[i]->name, name)) {
            return methods[i];
        }
    }
    return NULL;
}

const char *tyn_method_names(void)
{
    return "pop, pop-paper, single, path";
}
