// json_get.c -- `json_get FILE key.key.0`: prints what is there in a JSON file, for the tests of the
// tool. Exit 1 if there is nothing. Objects and lists print as "object N" and "list N".
#include <cjson/cJSON.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static char *read_all(FILE *file)
{
    size_t size = 0, capacity = 1 << 16;
    char *text = malloc(capacity + 1);
    for (size_t got = 1; text && got > 0;) {
        if (size == capacity) {
            capacity *= 2;
            text = realloc(text, capacity + 1);
        }
        got = text ? fread(text + size, 1, capacity - size, file) : 0;
        size += got;
    }
    if (text) {
        text[size] = '\0';
    }
    return text;
}

int main(int argc, char **argv)
{
    FILE *file = argc == 3 ? fopen(argv[1], "rb") : NULL;
    char *text = file ? read_all(file) : NULL;
    cJSON *root = text ? cJSON_Parse(text) : NULL;
    const cJSON *item = root;
    // keys hold dots themselves ("lattice.cells"): '/' between keys is possible too
    const char *between = argc == 3 && strchr(argv[2], '/') ? "/" : ".";
    for (char *key = argc == 3 ? strtok(argv[2], between) : NULL; key && item;
         key = strtok(NULL, between)) {
        item = cJSON_IsArray(item) ? cJSON_GetArrayItem(item, atoi(key))
                                   : cJSON_GetObjectItemCaseSensitive(item, key);
    }
    int code = item ? 0 : 1;
    if (cJSON_IsString(item)) {
        printf("%s\n", item->valuestring);
    } else if (cJSON_IsNumber(item)) {
        printf("%.9g\n", item->valuedouble);
    } else if (cJSON_IsBool(item) || cJSON_IsNull(item)) {
        printf("%s\n", cJSON_IsNull(item) ? "null" : cJSON_IsTrue(item) ? "true" : "false");
    } else if (item) {
        printf("%s %d\n", cJSON_IsArray(item) ? "list" : "object", cJSON_GetArraySize(item));
    }
    cJSON_Delete(root);
    free(text);
    if (file) {
        fclose(file);
    }
    return code;
}
