// json.c -- strict reading of JSON on top of cJSON.
#include "io/json.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_DEPTH = 64, MAX_MEMBERS = 512 };

// ---- faults ---------------------------------------------------------------------------------

// Writes the path from `node` down to `target` into the end of `path`; false if it is not below.
static bool find_path(const cJSON *node, const cJSON *target, char *path, size_t room)
{
    if (node == target) {
        return true;
    }
    int i = 0;
    for (const cJSON *child = node->child; child; child = child->next, i++) {
        size_t used = strlen(path);
        if (cJSON_IsArray(node)) {
            snprintf(path + used, room - used, "[%d]", i);
        } else {
            snprintf(path + used, room - used, "%s%.60s", used ? "." : "", child->string);
        }
        if (find_path(child, target, path, room)) {
            return true;
        }
        path[used] = 0;
    }
    return false;
}

void tyn_json_path(const json_doc *doc, const cJSON *at, char *path, size_t room)
{
    path[0] = 0;
    find_path(doc->root, at, path, room);
    for (char *c = path; *c; c++) { // a line stays a line, whatever members are called
        *c = (unsigned char)*c < ' ' ? '?' : *c;
    }
}

static void print_value(const cJSON *at, char *out, size_t room)
{
    if (cJSON_IsObject(at)) {
        snprintf(out, room, "an object");
        return;
    }
    if (cJSON_IsArray(at) && cJSON_GetArraySize(at) > 16) {
        snprintf(out, room, "an array of %d", cJSON_GetArraySize(at));
        return;
    }
    char *text = cJSON_PrintUnformatted(at);
    snprintf(out, room, "%.60s%s", text ? text : "?", text && strlen(text) > 60 ? "..." : "");
    cJSON_free(text);
}

tyn_result tyn_json_fault(const json_doc *doc, const cJSON *at, const char *format, ...)
{
    char path[512], value[80], message[512];
    va_list args;
    va_start(args, format);
    vsnprintf(message, sizeof message, format, args);
    va_end(args);
    tyn_json_path(doc, at, path, sizeof path);
    print_value(at, value, sizeof value);
    if (at == doc->root) {
        tyn_log_print(doc->log, TYN_LOG_ERROR, "%s: %s", doc->file, message);
    } else {
        tyn_log_print(doc->log, TYN_LOG_ERROR, "%s: %s = %s: %s", doc->file, path, value, message);
    }
    return TYN_ERR_PARAMS;
}

tyn_result tyn_json_no_memory(const json_doc *doc, const char *what)
{
    return TYN_FAULT(doc->log, TYN_ERR_MEMORY, "%s: no memory for its %s", doc->file, what);
}

// ---- parsing --------------------------------------------------------------------------------

static bool too_deep(const char *text, size_t size)
{
    int depth = 0;
    bool in_string = false;
    for (size_t i = 0; i < size; i++) {
        char c = text[i];
        if (in_string) {
            i += c == '\\'; // the escaped character ends nothing
            in_string = c != '"';
        } else if (c == '"') {
            in_string = true;
        } else if (c == '[' || c == '{') {
            if (++depth > MAX_DEPTH) {
                return true;
            }
        } else if (c == ']' || c == '}') {
            depth--;
        }
    }
    return false;
}

// Two readers may disagree on which of two members of one name counts; none may differ here.
static const cJSON *duplicate_key(const cJSON *node)
{
    const cJSON *found = NULL;
    for (const cJSON *child = node->child; child && !found; child = child->next) {
        int members = 0;
        for (const cJSON *b = child->next; b && cJSON_IsObject(node) && !found; b = b->next) {
            if (++members > MAX_MEMBERS || strcmp(child->string, b->string) == 0) {
                found = b;
            }
        }
        found = found ? found : duplicate_key(child);
    }
    return found;
}

static const cJSON *infinite_number(const cJSON *node)
{
    const cJSON *found = cJSON_IsNumber(node) && !isfinite(node->valuedouble) ? node : NULL;
    for (const cJSON *child = node->child; child && !found; child = child->next) {
        found = infinite_number(child);
    }
    return found;
}

static int line_of(const char *text, const char *at)
{
    int line = 1;
    for (; text < at; text++) {
        line += *text == '\n';
    }
    return line;
}

tyn_result tyn_json_parse(json_doc *doc, const char *text, size_t size, const char *file,
                          const tyn_log *log)
{
    const char *end = NULL;
    *doc = (json_doc){.file = file, .log = log};
    if (too_deep(text, size)) {
        return TYN_FAULT(log, TYN_ERR_PARAMS, "%s: JSON is nested deeper than %d", file, MAX_DEPTH);
    }
    doc->root = cJSON_ParseWithLengthOpts(text, size, &end, 0);
    if (!doc->root) {
        return TYN_FAULT(log, TYN_ERR_PARAMS, "%s: not valid JSON, line %d", file,
                         line_of(text, end && end >= text && end <= text + size ? end : text));
    }
    while (end < text + size && (*end == ' ' || *end == '\t' || *end == '\r' || *end == '\n')) {
        end++;
    }
    const cJSON *at;
    if (end != text + size) {
        tyn_log_print(log, TYN_LOG_ERROR, "%s: not valid JSON, line %d: text after the end", file,
                      line_of(text, end));
    } else if (!cJSON_IsObject(doc->root)) {
        tyn_log_print(log, TYN_LOG_ERROR, "%s: JSON must be an object", file);
    } else if ((at = infinite_number(doc->root))) {
        tyn_json_fault(doc, at, "a number must be finite");
    } else if ((at = duplicate_key(doc->root))) {
        tyn_json_fault(doc, at, "a name may stand only once in an object (of at most %d)",
                       MAX_MEMBERS);
    } else {
        return TYN_OK;
    }
    tyn_json_finish(doc);
    return TYN_ERR_PARAMS;
}

void tyn_json_finish(json_doc *doc)
{
    cJSON_Delete(doc->root);
    doc->root = NULL;
}

// ---- members --------------------------------------------------------------------------------

cJSON *tyn_json_member(const cJSON *parent, const char *name)
{
    return cJSON_GetObjectItemCaseSensitive(parent, name);
}

int64_t tyn_json_whole(const cJSON *parent, const char *name, int64_t missing)
{
    const cJSON *at = tyn_json_member(parent, name);
    return at ? (int64_t)at->valuedouble : missing;
}

tyn_result tyn_json_object(const json_doc *doc, const cJSON *parent, const char *name, cJSON **out)
{
    *out = tyn_json_member(parent, name);
    return !*out || cJSON_IsObject(*out) ? TYN_OK : tyn_json_fault(doc, *out, "must be an object");
}

tyn_result tyn_json_extension(const json_doc *doc, const cJSON *object, const char *name,
                              cJSON **out)
{
    cJSON *extensions;
    TYN_TRY(tyn_json_object(doc, object, "extensions", &extensions));
    return tyn_json_object(doc, extensions, name, out);
}

tyn_result tyn_json_array(const json_doc *doc, const cJSON *parent, const char *name, cJSON **out)
{
    *out = tyn_json_member(parent, name);
    return !*out || cJSON_IsArray(*out) ? TYN_OK : tyn_json_fault(doc, *out, "must be an array");
}

tyn_result tyn_json_string(const json_doc *doc, const cJSON *parent, const char *name,
                           const char **out)
{
    const cJSON *at = tyn_json_member(parent, name);
    if (!at) {
        return TYN_OK;
    }
    *out = at->valuestring;
    return cJSON_IsString(at) ? TYN_OK : tyn_json_fault(doc, at, "must be a string");
}

static bool number_in(const cJSON *at, double lo, double hi)
{
    return cJSON_IsNumber(at) && at->valuedouble >= lo && at->valuedouble <= hi;
}

tyn_result tyn_json_number(const json_doc *doc, const cJSON *parent, const char *name, double lo,
                           double hi, const char *right, double *out)
{
    const cJSON *at = tyn_json_member(parent, name);
    if (!at) {
        return TYN_OK;
    }
    if (!number_in(at, lo, hi)) {
        return tyn_json_fault(doc, at, "must be %s", right);
    }
    *out = at->valuedouble;
    return TYN_OK;
}

tyn_result tyn_json_numbers(const json_doc *doc, const cJSON *parent, const char *name, int count,
                            double lo, double hi, const char *right, double *out)
{
    const cJSON *at = tyn_json_member(parent, name), *element;
    int i = 0;
    if (!at) {
        return TYN_OK;
    }
    if (!cJSON_IsArray(at) || cJSON_GetArraySize(at) != count) {
        return tyn_json_fault(doc, at, "must be an array of %d numbers", count);
    }
    cJSON_ArrayForEach(element, at)
    {
        if (!number_in(element, lo, hi)) {
            return tyn_json_fault(doc, element, "must be %s", right);
        }
        out[i++] = element->valuedouble;
    }
    return TYN_OK;
}

tyn_result tyn_json_color(const json_doc *doc, const cJSON *parent, const char *name, double lo,
                          double hi, const char *right, float out[3])
{
    const cJSON *at = tyn_json_member(parent, name);
    double value[3] = {out[0], out[1], out[2]};
    tyn_result r = TYN_OK;
    if (cJSON_IsNumber(at)) {
        r = tyn_json_number(doc, parent, name, lo, hi, right, &value[0]);
        value[1] = value[2] = value[0];
    } else if (at && (!cJSON_IsArray(at) || cJSON_GetArraySize(at) != 3)) {
        r = tyn_json_fault(doc, at, "must be a number or an array of 3, each %s", right);
    } else {
        r = tyn_json_numbers(doc, parent, name, 3, lo, hi, right, value);
    }
    for (int c = 0; c < 3; c++) {
        out[c] = (float)value[c];
    }
    return r;
}

tyn_result tyn_json_integer(const json_doc *doc, const cJSON *parent, const char *name, int64_t lo,
                            int64_t hi, const char *right, int64_t *out)
{
    const cJSON *at = tyn_json_member(parent, name);
    if (!at) {
        return TYN_OK;
    }
    if (!number_in(at, (double)lo, (double)hi) || at->valuedouble != floor(at->valuedouble)) {
        return tyn_json_fault(doc, at, "must be %s", right);
    }
    *out = (int64_t)at->valuedouble;
    return TYN_OK;
}

tyn_result tyn_json_index(const json_doc *doc, const cJSON *at, int64_t count, const char *what,
                          int64_t *out)
{
    if (!number_in(at, 0.0, (double)count - 1.0) || at->valuedouble != floor(at->valuedouble)) {
        return tyn_json_fault(doc, at, "must be an index of %s, there are %lld", what,
                              (long long)count);
    }
    *out = (int64_t)at->valuedouble;
    return TYN_OK;
}

tyn_result tyn_json_list(const json_doc *doc, const cJSON *parent, const char *name, json_list *out)
{
    cJSON *array;
    const cJSON *element;
    tyn_result r = tyn_json_array(doc, parent, name, &array);
    if (r || !array) {
        return r;
    }
    out->items = calloc((size_t)cJSON_GetArraySize(array) + 1, sizeof *out->items);
    if (!out->items) {
        return tyn_json_no_memory(doc, name);
    }
    cJSON_ArrayForEach(element, array)
    {
        if (!cJSON_IsObject(element)) {
            return tyn_json_fault(doc, element, "must be an object");
        }
        out->items[out->count++] = element;
    }
    return TYN_OK;
}
