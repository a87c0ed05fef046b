// bound.c -- see bound.h.
#include "bound.h"
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_BOUNDS = 512 };

static const double widest = 3; // of what is observed

typedef struct bound_entry {
    char name[160];
    const char *why;
    double observed, bound; // of the check that was nearest to its bound
} bound_entry;

static bound_entry entries[MOST_BOUNDS];
static int num_entries;

bool within(double observed, double bound, const char *why, const char *name, ...)
{
    char text[sizeof entries[0].name];
    va_list args;
    va_start(args, name);
    vsnprintf(text, sizeof text, name, args);
    va_end(args);
    if (getenv("TYN_BOUNDS")) {
        printf("call\t%s\t%.4g\t%.4g\t%s\n", text, observed, bound, why ? "why" : "");
    }
    int i = 0;
    while (i < num_entries && strcmp(entries[i].name, text) != 0) {
        i++;
    }
    bound_entry *e = &entries[i < MOST_BOUNDS ? i : MOST_BOUNDS - 1];
    if (i == num_entries && i < MOST_BOUNDS) {
        num_entries++;
        snprintf(e->name, sizeof e->name, "%s", text);
        e->why = why;
        e->observed = observed;
        e->bound = bound;
    } else if (!(observed * e->bound <= e->observed * bound)) {
        e->observed = observed;
        e->bound = bound;
    }
    return observed <= bound;
}

bool bounds_near(bool judged)
{
    bool near = true;
    for (int i = 0; i < num_entries; i++) {
        const bound_entry *e = &entries[i];
        const bool wide = e->observed * widest < e->bound;
        printf("bound: %s: %.3g of %.3g%s%s\n", e->name, e->observed, e->bound,
               wide && e->why ? ", wide: " : "", wide && e->why ? e->why : "");
        if (judged && wide && !e->why) {
            printf(
                "failed: the bound of \"%s\" is more than %g times what is observed: lower it, or "
                "say why\n",
                e->name, widest);
            near = false;
        }
    }
    num_entries = 0;
    return near;
}
