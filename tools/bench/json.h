// json.h -- figures and texts of a JSON tree.
#pragma once
#include <cjson/cJSON.h>
#include <stdbool.h>
#include <stdint.h>

// A figure of a tree by its path, "errors.0.bias"; NAN where there is none or it is no number.
double json_figure(const cJSON *tree, const char *path);
// A string of an object; "" where there is none.
const char *json_text(const cJSON *object, const char *key);
bool json_true(const cJSON *object, const char *key);
void json_add_hash(cJSON *object, const char *key, uint64_t hash);
void json_add_date(cJSON *object); // "date": now, UTC
