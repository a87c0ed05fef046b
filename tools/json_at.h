// json_at.h -- what stands under a name in JSON that somebody else may have written.
#pragma once
#include <cjson/cJSON.h>

static inline const cJSON *json_at(const cJSON *object, const char *name)
{
    return cJSON_GetObjectItemCaseSensitive(object, name);
}

// "" where there is no text.
static inline const char *json_text_at(const cJSON *object, const char *name)
{
    const char *text = cJSON_GetStringValue(json_at(object, name));
    return text ? text : "";
}

static inline double json_number_at(const cJSON *object, const char *name, double otherwise)
{
    const cJSON *item = json_at(object, name);
    return cJSON_IsNumber(item) ? item->valuedouble : otherwise;
}
