// method_rows.c -- every registered method has its row wherever methods are told apart: limits (which `info`, choices and
// reports read), the selftest, the suite of fronts and its stored results, the stored stress suite.
//
// usage: test_cli_method_rows TOOLS_BENCH_FOLDER
#include <cjson/cJSON.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tyndall/registry.h>
#include <cmocka.h>

static const char *folder;

static cJSON *open_json(const char *name)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    assert_int_equal(fseek(file, 0, SEEK_END), 0);
    const size_t size = (size_t)ftell(file);
    rewind(file);
    char *text = calloc(1, size + 1);
    assert_non_null(text);
    assert_int_equal(fread(text, 1, size, file), size);
    fclose(file);
    cJSON *json = cJSON_Parse(text);
    free(text);
    assert_non_null(json);
    return json;
}

// Rows of a list whose method is this one; a run without a method is of the default.
static int rows_of(const cJSON *list, const char *method)
{
    int rows = 0;
    const cJSON *row;
    cJSON_ArrayForEach(row, list)
    {
        const char *with = cJSON_GetStringValue(cJSON_GetObjectItem(row, "method"));
        rows += strcmp(with ? with : tyn_method_default(), method) == 0;
    }
    return rows;
}

static int report(int rows, const char *method, const char *lacks)
{
    if (rows == 0) {
        print_error("%s: %s\n", method, lacks);
    }
    return rows == 0;
}

static void limits(void **state)
{
    (void)state;
    int missing = 0;
    for (uint32_t i = 0; i < tyn_num_methods(); i++) {
        tyn_method_info info;
        tyn_method_at(i, &info);
        missing += report(info.limits && info.limits->key, info.name, "no table of limits");
        for (const tyn_limit *l = info.limits; l && l->key; l++) {
            missing += report(l->source != NULL, info.name, l->key);
        }
    }
    assert_int_equal(missing, 0);
}

static void selftest(void **state)
{
    (void)state;
    int missing = 0;
    for (uint32_t i = 0; i < tyn_num_methods(); i++) {
        tyn_method_info info;
        tyn_method_at(i, &info);
        missing += report(info.promise != NULL, info.name, "no promise");
    }
    assert_int_equal(missing, 0);
}

static void fronts(void **state)
{
    (void)state;
    cJSON *suite = open_json("suites/fronts.json"), *stored = open_json("results/fronts.json");
    int missing = 0;
    for (uint32_t i = 0; i < tyn_num_methods(); i++) {
        tyn_method_info info;
        tyn_method_at(i, &info);
        missing += report(rows_of(cJSON_GetObjectItem(suite, "runs"), info.name), info.name,
                          "no run in suites/fronts.json");
        int rows = 0;
        const cJSON *scene;
        cJSON_ArrayForEach(scene, cJSON_GetObjectItem(stored, "scenes"))
        {
            rows += rows_of(cJSON_GetObjectItem(scene, "runs"), info.name);
        }
        missing += report(rows, info.name, "no run in results/fronts.json");
    }
    cJSON_Delete(suite);
    cJSON_Delete(stored);
    assert_int_equal(missing, 0);
}

static void stress(void **state)
{
    (void)state;
    cJSON *stored = open_json("results/stress.json");
    int missing = 0;
    for (uint32_t i = 0; i < tyn_num_methods(); i++) {
        tyn_method_info info;
        tyn_method_at(i, &info);
        missing += report(rows_of(cJSON_GetObjectItem(stored, "cells"), info.name), info.name,
                          "no cell in results/stress.json");
    }
    cJSON_Delete(stored);
    assert_int_equal(missing, 0);
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        return fprintf(stderr, "usage: %s TOOLS_BENCH_FOLDER\n", argv[0]), 2;
    }
    folder = argv[1];
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(limits),
        cmocka_unit_test(selftest),
        cmocka_unit_test(fronts),
        cmocka_unit_test(stress),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
