// skip.c -- see skip.h.
#include "skip.h"
#include <stdio.h>
#include <stdlib.h>

static size_t num_skipped;

static void tell(const char *name, const char *why, va_list args)
{
    printf("skipped: %s (", name);
    vprintf(why, args);
    printf(")\n");
    fflush(stdout);
}

void skip_from(const char *name, const char *why, ...)
{
    va_list args;
    va_start(args, why);
    tell(name, why, args);
    va_end(args);
    num_skipped++;
    skip();
}

void skip_all(const char *why, ...)
{
    va_list args;
    va_start(args, why);
    tell("all cases", why, args);
    va_end(args);
    exit(77);
}

int skip_result(int failed, size_t num_cases)
{
    return failed ? 1 : num_skipped == num_cases ? 77 : 0;
}
