// record.c -- a run's record as JSON, kept as a file.
#include "record.h"
#include "stats.h"
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <tyndall/io.h>

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

static char *record_path(const char *folder, const char *key)
{
    return text_format("%s/records/%s.json", folder, key);
}

cJSON *record_load(const char *folder, const char *key)
{
    void *data = NULL;
    size_t size = 0;
    char *path = folder ? record_path(folder, key) : NULL;
    cJSON *record = NULL;
    if (path && tyn_file_read(path, 64u << 20, &data, &size, NULL) == TYN_OK) {
        record = cJSON_ParseWithLength(data, size);
    }
    if (record && (json_figure(record, "version") != BENCH_RECORD_VERSION ||
                   strcmp(json_text(record, "key"), key) != 0)) {
        cJSON_Delete(record);
        record = NULL;
    }
    free(data);
    free(path);
    return record;
}

int record_store(app *a, const char *folder, const char *key, cJSON **record)
{
    char *text = cJSON_Print(*record);
    cJSON *seen = text ? cJSON_Parse(text) : NULL;
    free(text);
    if (!seen) {
        return app_exit_code(a, TYN_ERR_MEMORY, false);
    }
    cJSON_Delete(*record);
    *record = seen;
    if (!folder) {
        return EXIT_DONE;
    }
    char *below = text_format("%s/records", folder), *path = record_path(folder, key);
    int code = EXIT_FAILED;
    if (below && path) {
        mkdir(below, 0777);
        code = json_write(a, cJSON_Duplicate(seen, true), path);
    }
    free(below);
    free(path);
    return code;
}
