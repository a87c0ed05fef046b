// text.c -- a text that grows.
#include "text.h"
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void text_put(text *t, const char *bytes, size_t size)
{
    if (!t->failed && t->size + size + 1 > t->room) {
        const size_t room = 2 * (t->size + size + 1);
        char *moved = realloc(t->bytes, room);
        t->failed = !moved;
        if (moved) {
            t->bytes = moved;
            t->room = room;
        }
    }
    if (!t->failed) {
        memcpy(t->bytes + t->size, bytes, size);
        t->size += size;
        t->bytes[t->size] = '\0';
    }
}

void text_add(text *t, const char *format, ...)
{
    char line[1024];
    va_list list;
    va_start(list, format);
    const int size = vsnprintf(line, sizeof line, format, list);
    va_end(list);
    if (size > 0) {
        text_put(t, line, (size_t)size < sizeof line ? (size_t)size : sizeof line - 1);
    }
}

void text_finish(text *t)
{
    free(t->bytes);
    *t = (text){0};
}
