// print.h -- the report for people, as a table on stdout.
#pragma once
#include <cjson/cJSON.h>

void bench_print_head(const cJSON *report);
void bench_print_scene(const cJSON *scene); // of report.json
void bench_print_end(const cJSON *report);  // headline, ratios
