// stress_print.c -- the heat table of the stress suite, and its faults.
#include "stress.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *text_of(const cJSON *cell, const char *name)
{
    const char *text = cJSON_GetStringValue(cJSON_GetObjectItem(cell, name));
    return text ? text : "";
}

// Of a number, plain or raw; NAN: null.
static double number_of(const cJSON *cell, const char *name)
{
    const cJSON *v = cJSON_GetObjectItem(cell, name);
    return cJSON_IsNumber(v)                                       ? v->valuedouble
           : v && cJSON_IsRaw(v) && strcmp(v->valuestring, "null") ? strtod(v->valuestring, NULL)
                                                                   : NAN;
}

static bool is_silent(const cJSON *cell)
{
    return number_of(cell, "error") > STRESS_LOSSY &&
           cJSON_GetArraySize(cJSON_GetObjectItem(cell, "warnings")) == 0;
}

// One character: how wrong, in classes that a table of text can show.
static char heat_of(const cJSON *cell)
{
    static const struct {
        double below;
        char letter;
    } classes[] = {{0.01, '.'}, {0.03, ':'}, {0.1, 'o'}, {0.3, 'O'}, {1, '#'}, {HUGE_VAL, '@'}};
    double error = number_of(cell, "error");
    if (number_of(cell, "non_finite") > 0 || number_of(cell, "negative") > 0) {
        return '!';
    }
    if (isnan(error)) {
        return cJSON_GetObjectItem(cell, "failure") ? 'x' : '-';
    }
    for (int i = 0;; i++) {
        if (error < classes[i].below || isinf(classes[i].below)) {
            return classes[i].letter;
        }
    }
}

void stress_print(const cJSON *stress)
{
    printf("\nerror: . < 1 %%, : < 3 %%, o < 10 %%, O < 30 %%, # < 100 %%, @ more; ! not finite or "
           "negative, - is its own reference, x refused\n");
    printf("in the order of docs/stress.md; lossy cells without a warning are marked by ?\n\n");
    const cJSON *axis, *method, *cell;
    cJSON_ArrayForEach(axis, cJSON_GetObjectItem(stress, "axes"))
    {
        const char *name = axis->valuestring;
        cJSON_ArrayForEach(method, cJSON_GetObjectItem(stress, "methods"))
        {
            bool any = false;
            cJSON_ArrayForEach(cell, cJSON_GetObjectItem(stress, "cells"))
            {
                if (strcmp(text_of(cell, "axis"), name) ||
                    strcmp(text_of(cell, "method"), method->valuestring)) {
                    continue;
                }
                if (!any) {
                    printf("%-20s %-10s ", name, method->valuestring);
                }
                printf(" %c%s", heat_of(cell), is_silent(cell) ? "?" : "");
                any = true;
            }
            printf("%s", any ? "\n" : "");
        }
    }
}

uint32_t stress_faults(app *a, const cJSON *stress)
{
    uint32_t faults = 0;
    const cJSON *cell;
    cJSON_ArrayForEach(cell, cJSON_GetObjectItem(stress, "cells"))
    {
        const double non_finite = number_of(cell, "non_finite");
        const double negative = number_of(cell, "negative");
        const char *method = text_of(cell, "method"), *axis = text_of(cell, "axis");
        const char *name = text_of(cell, "case");
        if (non_finite > 0 || negative > 0) {
            app_error(a, "stress: %s, %s %s: %.0f values not finite, %.0f negative", method, axis,
                      name, non_finite, negative);
            faults++;
        }
        if (is_silent(cell)) {
            app_error(a, "stress: %s, %s %s: an error of %.0f %% without a warning", method, axis,
                      name, 100 * number_of(cell, "error"));
            faults++;
        }
        if (cJSON_GetObjectItem(cell, "failure")) {
            app_error(a, "stress: %s, %s %s: %s", method, axis, name, text_of(cell, "failure"));
            faults++;
        }
    }
    return faults;
}
