// suite_reader.c -- values of a file of the bench, a suite or bands, and a line about the first that is wrong.
#include "suite_reader.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

void suite_fault(suite_reader *r, const char *key, const char *right)
{
    if (r->ok) {
        app_error(r->a, "%s: %s%s%s%s%s", r->file, r->where, r->where[0] && key[0] ? "." : "", key,
                  r->where[0] || key[0] ? ": " : "", right);
    }
    r->ok = false;
}

// ---- the whole text ---------------------------------------------------------------------------

// Length of the UTF-8 sequence at `c`; 0: it is none (overlong, a surrogate, cut short).
static size_t utf8_length(const unsigned char *c, const unsigned char *end)
{
    const size_t length = c[0] < 0x80                    ? 1
                          : c[0] >= 0xc2 && c[0] <= 0xdf ? 2
                          : (c[0] & 0xf0) == 0xe0        ? 3
                          : c[0] >= 0xf0 && c[0] <= 0xf4 ? 4
                                                         : 0;
    if (length == 0 || length > (size_t)(end - c)) {
        return 0;
    }
    for (size_t i = 1; i < length; i++) {
        if ((c[i] & 0xc0) != 0x80) {
            return 0;
        }
    }
    const bool wrong = (c[0] == 0xe0 && c[1] < 0xa0) || (c[0] == 0xed && c[1] > 0x9f) ||
                       (c[0] == 0xf0 && c[1] < 0x90) || (c[0] == 0xf4 && c[1] > 0x8f);
    return wrong ? 0 : length;
}

static void fault_at(suite_reader *r, const char *text, const char *at, const char *what)
{
    int line = 1;
    for (const char *c = text; c < at; c++) {
        line += *c == '\n';
    }
    app_error(r->a, "%s:%d: %s", r->file, line, what);
    r->ok = false;
}

// Faults are in this element of what they were in before.
static void enter(suite_reader *r, const cJSON *item, uint32_t index)
{
    const size_t used = strlen(r->where);
    char *end = r->where + used;
    if (item->string) {
        snprintf(end, sizeof r->where - used, "%s%s", used ? "." : "", item->string);
    } else {
        snprintf(end, sizeof r->where - used, "[%u]", index);
    }
}

// A value that is there twice would be two opinions, of which one silently wins.
static void check_twice(suite_reader *r, const cJSON *tree)
{
    const size_t before = strlen(r->where);
    const cJSON *item, *other;
    uint32_t index = 0;
    cJSON_ArrayForEach(item, tree)
    {
        for (other = tree->child; item->string && other != item; other = other->next) {
            if (strcmp(other->string, item->string) == 0) {
                suite_fault(r, item->string, "is there twice in the same object");
            }
        }
        enter(r, item, index++);
        check_twice(r, item);
        r->where[before] = '\0';
    }
}

cJSON *suite_parse(suite_reader *r, const char *text, size_t size)
{
    const char *end = text + size, *stop = NULL;
    for (const char *c = text; c < end;) {
        const size_t length = utf8_length((const unsigned char *)c, (const unsigned char *)end);
        if (length == 0) {
            fault_at(r, text, c, "is not UTF-8");
            return NULL;
        }
        c += length;
    }
    cJSON *root = cJSON_ParseWithLengthOpts(text, size, &stop, false);
    while (root && stop < end && strchr(" \t\r\n", *stop) && *stop) {
        stop++;
    }
    if (!root || stop < end) {
        fault_at(r, text, stop ? stop : text, "is not JSON from here on");
    } else {
        check_twice(r, root);
    }
    if (!r->ok) {
        cJSON_Delete(root);
        return NULL;
    }
    return root;
}

// ---- values -----------------------------------------------------------------------------------

const char *suite_text(suite_reader *r, const cJSON *object, const char *key, bool required)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, key);
    if (cJSON_IsString(item)) {
        return item->valuestring;
    }
    if (item || required) {
        suite_fault(r, key, "must be a string");
    }
    return NULL;
}

double suite_number(suite_reader *r, const cJSON *object, const char *key, double def, double min,
                    double max)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, key);
    if (!item) {
        return def;
    }
    // written so that NaN is refused
    if (!cJSON_IsNumber(item) || !(item->valuedouble >= min && item->valuedouble <= max)) {
        char right[96];
        snprintf(right, sizeof right, "must be a number from %.9g to %.9g", min, max);
        suite_fault(r, key, right);
        return def;
    }
    return item->valuedouble;
}

uint32_t suite_whole(suite_reader *r, const cJSON *object, const char *key, double def, double min,
                     double max)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, key);
    if (cJSON_IsNumber(item) && item->valuedouble != floor(item->valuedouble)) {
        suite_fault(r, key, "must be a whole number");
        return (uint32_t)def;
    }
    return (uint32_t)suite_number(r, object, key, def, min, max);
}

void suite_vector(suite_reader *r, const cJSON *object, const char *key, bool spread, opt_vector *v)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, key);
    if (!item) {
        return;
    }
    v->given = true;
    bool number = spread && cJSON_IsNumber(item), array = cJSON_GetArraySize(item) == 3;
    for (int i = 0; i < 3; i++) {
        const cJSON *element = number ? item : cJSON_GetArrayItem(item, i);
        if (!(number || array) || !cJSON_IsNumber(element)) {
            suite_fault(r, key, spread ? "must be three numbers or one" : "must be three numbers");
            return;
        }
        v->v[i] = (float)element->valuedouble;
    }
}

void suite_size(suite_reader *r, const cJSON *object, opt_size *size)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, "size");
    if (!item) {
        return;
    }
    uint32_t *const to[2] = {&size->width, &size->height};
    for (int i = 0; i < 2; i++) {
        const cJSON *element = cJSON_GetArrayItem(item, i);
        if (cJSON_GetArraySize(item) != 2 || !cJSON_IsNumber(element) ||
            !(element->valuedouble >= 1 && element->valuedouble <= 16384) ||
            element->valuedouble != floor(element->valuedouble)) {
            suite_fault(r, "size", "must be [width, height], whole numbers from 1 to 16384");
            return;
        }
        *to[i] = (uint32_t)element->valuedouble;
    }
}

void suite_check_keys(suite_reader *r, const cJSON *object, const char *const *known)
{
    if (!cJSON_IsObject(object)) {
        suite_fault(r, "", "must be an object");
        return;
    }
    const cJSON *item;
    cJSON_ArrayForEach(item, object)
    {
        const char *const *k = known;
        while (*k && strcmp(*k, item->string) != 0) {
            k++;
        }
        if (!*k) {
            suite_fault(r, item->string, "is not a known key (docs/bench.md lists them)");
        }
    }
}

uint32_t suite_list(suite_reader *r, const cJSON *root, const char *key, uint32_t min, uint32_t max)
{
    const cJSON *array = cJSON_GetObjectItemCaseSensitive(root, key);
    int count = cJSON_GetArraySize(array);
    if ((array && !cJSON_IsArray(array)) || count < (int)min || count > (int)max) {
        char right[64];
        snprintf(right, sizeof right, "must be a list of %u to %u objects", min, max);
        suite_fault(r, key, right);
        return 0;
    }
    return (uint32_t)count;
}

const cJSON *suite_element(suite_reader *r, const cJSON *root, const char *key, uint32_t index)
{
    snprintf(r->where, sizeof r->where, "%s[%u]", key, index);
    return cJSON_GetArrayItem(cJSON_GetObjectItemCaseSensitive(root, key), (int)index);
}

// ---- files ------------------------------------------------------------------------------------

// What a name means in a suite's file: the name as seen from that file. A new string.
static char *beside_suite(const suite_reader *r, const char *name)
{
    const char *slash = strrchr(r->file, '/');
    return slash && name[0] != '/' ? text_format("%.*s/%s", (int)(slash - r->file), r->file, name)
                                   : text_format("%s", name);
}

char *suite_folder(suite_reader *r, const cJSON *object, const char *key)
{
    const char *name = suite_text(r, object, key, false);
    return name ? beside_suite(r, name) : NULL;
}

char *suite_find(suite_reader *r, const char *key, const char *name, const char *folder)
{
    char *beside = beside_suite(r, name);
    if (beside && access(beside, R_OK) == 0) {
        return beside;
    }
    free(beside);
    char *sample = folder ? text_format("%s/%s", folder, name) : NULL;
    if (sample && access(sample, R_OK) == 0) {
        return sample;
    }
    free(sample);
    char right[512];
    snprintf(right, sizeof right, "'%s' is neither beside the suite nor in '%s' (--scenes)", name,
             folder ? folder : "");
    suite_fault(r, key, right);
    return NULL;
}

char *suite_file(suite_reader *r, const cJSON *object, const char *key, const char *folder)
{
    const char *name = suite_text(r, object, key, false);
    return name ? suite_find(r, key, name, folder) : NULL;
}
