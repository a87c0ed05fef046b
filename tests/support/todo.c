// todo.c -- see todo.h.
#include "todo.h"
#include <stdarg.h>
#include <stdio.h>

bool todo_if(bool known, bool holds, const char *reason, const char *what, ...)
{
    char text[256];
    va_list args;
    va_start(args, what);
    vsnprintf(text, sizeof text, what, args);
    va_end(args);
    if (!known) {
        if (!holds) {
            printf("failed: %s\n", text);
        }
        return holds;
    }
    if (holds) {
        printf("no longer todo: %s: it holds now, so take the mark away (%s)\n", text, reason);
    } else {
        printf("todo: %s: %s\n", text, reason);
    }
    return !holds;
}
