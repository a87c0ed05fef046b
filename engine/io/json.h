// json.h -- reading JSON strictly: every fault is one line with file, JSON path, value, remedy.
#pragma once
#include <tyndall/io.h>
#include <cjson/cJSON.h>
#include "base/fault.h"

typedef struct json_doc {
    const char *file;
    const tyn_log *log;
    cJSON *root;           // an object
    const uint32_t *frame; // number of a picture that stands for ### in names of files; NULL: none
} json_doc;

// Refuses nesting deeper than 64, text after the value, duplicate keys, and a root that is no
// object.
tyn_result tyn_json_parse(json_doc *doc, const char *text, size_t size, const char *file,
                          const tyn_log *log);
void tyn_json_finish(json_doc *doc);

// Logs "file: path.to[3].value = 7: message" for a node of the document. Returns TYN_ERR_PARAMS.
tyn_result tyn_json_fault(const json_doc *doc, const cJSON *at, const char *format, ...)
    TYN_PRINTF(3, 4);

// "path.to[3].value" of a node of the document; cut where there is no room.
void tyn_json_path(const json_doc *doc, const cJSON *at, char *path, size_t room);

// Members of objects. A member that is not there, as of an object that is not (NULL), is no fault (the output keeps its
// value; an object or array is NULL); one of the wrong type or range is.
tyn_result tyn_json_object(const json_doc *doc, const cJSON *parent, const char *name, cJSON **out);
// ... of what glTF has in an object's "extensions".
tyn_result tyn_json_extension(const json_doc *doc, const cJSON *object, const char *name,
                              cJSON **out);
tyn_result tyn_json_array(const json_doc *doc, const cJSON *parent, const char *name, cJSON **out);
tyn_result tyn_json_string(const json_doc *doc, const cJSON *parent, const char *name,
                           const char **out);
// `right` says what the value must be, e.g. "a number >= 0".
tyn_result tyn_json_number(const json_doc *doc, const cJSON *parent, const char *name, double lo,
                           double hi, const char *right, double *out);
tyn_result tyn_json_numbers(const json_doc *doc, const cJSON *parent, const char *name, int count,
                            double lo, double hi, const char *right, double *out);
// A number or an array of three.
tyn_result tyn_json_color(const json_doc *doc, const cJSON *parent, const char *name, double lo,
                          double hi, const char *right, float out[3]);
// A whole number in [lo, hi].
tyn_result tyn_json_integer(const json_doc *doc, const cJSON *parent, const char *name, int64_t lo,
                            int64_t hi, const char *right, int64_t *out);
// An index into `count` things called `what`.
tyn_result tyn_json_index(const json_doc *doc, const cJSON *at, int64_t count, const char *what,
                          int64_t *out);
// A member that is an array of objects, for access by index; `items` is freed with free(). Nothing where it
// is not there.
typedef struct json_list {
    const cJSON **items;
    int64_t count;
} json_list;
tyn_result tyn_json_list(const json_doc *doc, const cJSON *parent, const char *name,
                         json_list *out);
cJSON *tyn_json_member(const cJSON *parent, const char *name); // NULL: not there
// One line, and TYN_ERR_MEMORY. `what`: "nodes".
tyn_result tyn_json_no_memory(const json_doc *doc, const char *what);
// A whole number that has been checked, or `missing`.
int64_t tyn_json_whole(const cJSON *parent, const char *name, int64_t missing);
