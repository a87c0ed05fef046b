// bench_results.c -- what the repository shows of the small suite is of that suite, and inside its bands.
#include "bench/bands.h"
#include "bench/json.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tyndall/io.h>

int main(int argc, char **argv)
{
    app a;
    app_init(&a);
    if (argc != 4) {
        fprintf(stderr, "usage: bench_results SUITE BANDS REPORT\n");
        return EXIT_WRONG;
    }
    void *suite = NULL, *text = NULL;
    size_t suite_size = 0, size = 0;
    cJSON *bands = NULL;
    int code = bands_load(&a, argv[2], &bands);
    if (code != EXIT_DONE ||
        tyn_file_read(argv[1], 1 << 20, &suite, &suite_size, &a.log) != TYN_OK ||
        tyn_file_read(argv[3], 1 << 28, &text, &size, &a.log) != TYN_OK) {
        return EXIT_FAILED;
    }
    cJSON *report = cJSON_ParseWithLength(text, size);
    char hash[17];
    snprintf(hash, sizeof hash, "%016llx", (unsigned long long)text_hash(suite, suite_size, 0));
    const cJSON *of = cJSON_GetObjectItemCaseSensitive(report, "suite");
    if (strcmp(json_text(of, "hash"), hash) != 0) {
        printf("%s is of another suite than %s, which was changed since: run it again\n", argv[3],
               argv[1]);
        code = EXIT_FAILED;
    }
    if (bands_apply(&a, argv[2], bands, report) != EXIT_DONE) {
        code = EXIT_FAILED;
    }
    cJSON_Delete(bands);
    cJSON_Delete(report);
    free(suite);
    free(text);
    return code;
}
