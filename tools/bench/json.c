// json.c -- figures and texts of a JSON tree.
#include "json.h"
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

double json_figure(const cJSON *tree, const char *path)
{
    while (tree && *path) {
        char key[64];
        size_t length = strcspn(path, ".");
        snprintf(key, sizeof key, "%.*s", (int)length, path);
        tree = cJSON_IsArray(tree) && isdigit((unsigned char)key[0])
                   ? cJSON_GetArrayItem(tree, atoi(key))
                   : cJSON_GetObjectItemCaseSensitive(tree, key);
        path += length + (path[length] == '.');
    }
    if (cJSON_IsRaw(tree)) { // as stats.h writes floats
        char *end = NULL;
        const double value = strtod(tree->valuestring, &end);
        return end != tree->valuestring ? value : NAN;
    }
    return cJSON_IsNumber(tree) ? tree->valuedouble : NAN;
}

const char *json_text(const cJSON *object, const char *key)
{
    const char *text = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(object, key));
    return text ? text : "";
}

void json_add_hash(cJSON *object, const char *key, uint64_t hash)
{
    char text[17];
    snprintf(text, sizeof text, "%016llx", (unsigned long long)hash);
    cJSON_AddStringToObject(object, key, text);
}

void json_add_date(cJSON *object)
{
    char text[32];
    time_t now = time(NULL);
    struct tm utc;
    strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", gmtime_r(&now, &utc));
    cJSON_AddStringToObject(object, "date", text);
}

bool json_true(const cJSON *object, const char *key)
{
    return cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(object, key));
}
