// built_in.h -- methods that a build may leave out (-Dmethods): what of a test is about them is left out, too, with a line.
#pragma once
#include <tyndall/registry.h>
#include <stdio.h>

static inline bool is_built_in(const char *method)
{
    tyn_method_info info;
    const bool is = tyn_method_named(method, &info);
    if (!is) {
        printf("not in this build: %s\n", method);
    }
    return is;
}
