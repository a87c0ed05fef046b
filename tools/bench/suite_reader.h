// suite_reader.h -- values of a file of the bench, a suite or bands, and a line about the first that is wrong.
#pragma once
#include "app.h"
#include <cjson/cJSON.h>

// Where a fault is, for the message.
typedef struct suite_reader {
    app *a;
    const char *file;
    char where[128]; // "scenes[2]"
    bool ok;         // false from the first fault on
} suite_reader;

// Says what would be right, unless there was a fault before. `key` may be "".
void suite_fault(suite_reader *r, const char *key, const char *right);

// The text as a tree: UTF-8, one value and nothing after it, no key twice in an object. NULL after a fault.
cJSON *suite_parse(suite_reader *r, const char *text, size_t size);

// A mistyped key would be a setting that silently does nothing.
void suite_check_keys(suite_reader *r, const cJSON *object, const char *const *known);
const char *suite_text(suite_reader *r, const cJSON *object, const char *key, bool required);
double suite_number(suite_reader *r, const cJSON *object, const char *key, double def, double min,
                    double max);
uint32_t suite_whole(suite_reader *r, const cJSON *object, const char *key, double def, double min,
                     double max);
void suite_vector(suite_reader *r, const cJSON *object, const char *key, bool spread,
                  opt_vector *v);
void suite_size(suite_reader *r, const cJSON *object, opt_size *size); // "size"

// The number of objects in a list, and one of them; from then on faults are in it.
uint32_t suite_list(suite_reader *r, const cJSON *root, const char *key, uint32_t min,
                    uint32_t max);
const cJSON *suite_element(suite_reader *r, const cJSON *root, const char *key, uint32_t index);

// The file of this name, beside the suite or in `folder`: a new string; NULL after a fault, which is at `key`.
char *suite_find(suite_reader *r, const char *key, const char *name, const char *folder);

// The file that a key names, beside the suite or in `folder`: a new string; NULL: the key is not there, or a fault.
char *suite_file(suite_reader *r, const cJSON *object, const char *key, const char *folder);

// The folder that a key names, as seen from the suite; it need not be there. A new string; NULL: the key is not there.
char *suite_folder(suite_reader *r, const cJSON *object, const char *key);
