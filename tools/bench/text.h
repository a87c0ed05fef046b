// text.h -- a text that grows.
#pragma once
#include <tyndall/base.h>

typedef struct text {
    char *bytes; // ends in '\0' once something was put
    size_t size, room;
    bool failed; // out of memory; what is put from then on is dropped
} text;

void text_put(text *t, const char *bytes, size_t size);
void text_add(text *t, const char *format, ...) TYN_PRINTF(2, 3); // at most 1023 bytes
void text_finish(text *t);
