// sequence.c -- --frames: a number of timing frames, or a range of numbered files.
#include "sequence.h"
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_FRAMES = 100000 };

static bool digits(const char **text, uint32_t *value)
{
    char *end;
    unsigned long n = isdigit((unsigned char)**text) ? strtoul(*text, &end, 10) : MAX_FRAMES + 1;
    if (n > MAX_FRAMES) {
        return false;
    }
    *value = (uint32_t)n;
    *text = end;
    return true;
}

bool sequence_parse(const char *text, sequence *s)
{
    *s = (sequence){0};
    if (!text) {
        return true;
    }
    if (!digits(&text, &s->first)) {
        return false;
    }
    if (*text == '\0') {
        s->repeat = s->first;
        return s->repeat > 0;
    }
    s->numbered = true;
    text++;
    return text[-1] == '-' && digits(&text, &s->last) && *text == '\0' && s->first <= s->last;
}

// Where the number stands in the path, how long its placeholder is, and how wide the number: the last
// of its kind, as folders may be named C#. NULL: none.
static const char *placeholder(const char *path, size_t *length, int *width)
{
    const char *found = NULL;
    for (const char *p = path; *p; p++) {
        size_t hashes = strspn(p, "#"), n = *p == '%' ? strspn(p + 1, "0123456789") : 0;
        if (hashes > 0) {
            *width = (int)hashes;
            *length = hashes;
            found = p;
            p += hashes - 1;
        } else if (*p == '%' && p[1 + n] == 'd' && n <= 3) {
            *width = n ? atoi(p + 1) : 1;
            *length = n + 2;
            found = p;
        }
    }
    return found;
}

bool sequence_has_number(const char *path)
{
    size_t length;
    int width;
    return path && placeholder(path, &length, &width) != NULL;
}

char *sequence_path(const char *path, uint32_t number)
{
    size_t length;
    int width;
    const char *at = placeholder(path, &length, &width);
    if (!at) {
        return text_format("%s", path);
    }
    return text_format("%.*s%0*u%s", (int)(at - path), path, width, number, at + length);
}
