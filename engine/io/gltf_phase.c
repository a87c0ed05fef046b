// gltf_phase.c -- reads phase functions: lobes, droplets, Legendre moments, values at angles.
#include "io/gltf_phase.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { PATH_ROOM = 512 };

// A list of numbers, which is freed with free(); NULL where it is not there.
static tyn_result read_numbers(const json_doc *doc, const cJSON *from, const char *name,
                               double **out, uint32_t *count)
{
    cJSON *array;
    const cJSON *element;
    TYN_TRY(tyn_json_array(doc, from, name, &array));
    if (!array) {
        return TYN_OK;
    }
    const int size = cJSON_GetArraySize(array);
    if (size < 1 || size > TYN_MAX_PHASE_NUMBERS) {
        return tyn_json_fault(doc, array, "must be 1 to %d numbers", TYN_MAX_PHASE_NUMBERS);
    }
    *out = malloc((size_t)size * sizeof **out);
    if (!*out) {
        return tyn_json_no_memory(doc, name);
    }
    cJSON_ArrayForEach(element, array)
    {
        if (!cJSON_IsNumber(element)) {
            return tyn_json_fault(doc, element, "must be a number");
        }
        (*out)[(*count)++] = element->valuedouble;
    }
    return TYN_OK;
}

static tyn_result read_lobes(const json_doc *doc, const cJSON *from, tyn_phase_form *form,
                             tyn_phase_lobe lobes[TYN_MAX_PHASE_LOBES])
{
    cJSON *array;
    const cJSON *element;
    TYN_TRY(tyn_json_array(doc, from, "lobes", &array));
    const int size = array ? cJSON_GetArraySize(array) : 0;
    if (array && (size < 1 || size > TYN_MAX_PHASE_LOBES)) {
        return tyn_json_fault(doc, array, "must be 1 to %d lobes", TYN_MAX_PHASE_LOBES);
    }
    cJSON_ArrayForEach(element, array)
    {
        double weight = 1, g = 0, alpha = 0;
        if (!cJSON_IsObject(element)) {
            return tyn_json_fault(doc, element, "must be an object");
        }
        TYN_TRY(tyn_json_number(doc, element, "weight", 0, 1, "between 0 and 1", &weight));
        TYN_TRY(tyn_json_number(doc, element, "g", -0.999, 0.999, "between -0.999 and 0.999", &g));
        TYN_TRY(tyn_json_number(doc, element, "alpha", 0, 1e6, "between 0 and 1e6", &alpha));
        lobes[form->count++] =
            (tyn_phase_lobe){.weight = (float)weight, .g = (float)g, .alpha = (float)alpha};
        form->lobes = lobes;
    }
    return TYN_OK;
}

// What is given of a phase function; `numbers`: its arrays, to be freed.
static tyn_result read_form(const json_doc *doc, const cJSON *from, tyn_phase_form *form,
                            tyn_phase_lobe lobes[TYN_MAX_PHASE_LOBES], double *numbers[3])
{
    uint32_t counts[3] = {0};
    double micrometres = 0;
    static const char *const names[3] = {"legendre", "angles", "values"};
    const cJSON *droplets = tyn_json_member(from, "droplets"),
                *legendre = tyn_json_member(from, "legendre"),
                *angles = tyn_json_member(from, "angles"),
                *values = tyn_json_member(from, "values"),
                *with_lobes = tyn_json_member(from, "lobes");
    if (!angles != !values || !!droplets + !!legendre + !!angles + !!with_lobes != 1) {
        return tyn_json_fault(doc, from,
                              "must have one of lobes, droplets, legendre, or angles with values");
    }
    TYN_TRY(read_lobes(doc, from, form, lobes));
    TYN_TRY(tyn_json_number(doc, from, "droplets", 5, 50,
                            "a diameter between 5 and 50, in micrometres", &micrometres));
    if (micrometres > 0) {
        tyn_phase_droplets(micrometres, lobes);
        form->lobes = lobes;
        form->count = 2;
    }
    for (int i = 0; i < 3; i++) {
        TYN_TRY(read_numbers(doc, from, names[i], &numbers[i], &counts[i]));
    }
    if (angles && counts[1] != counts[2]) {
        return tyn_json_fault(doc, values, "must be as many as there are angles, %u", counts[1]);
    }
    for (uint32_t i = 0; i < counts[1]; i++) {
        numbers[1][i] =
            i + 1 == counts[1] && numbers[1][i] == 180 ? M_PI : numbers[1][i] * (M_PI / 180);
    }
    form->moments = numbers[0];
    form->angles = numbers[1];
    form->values = numbers[2];
    form->count = legendre ? counts[0] : angles ? counts[1] : form->count;
    return TYN_OK;
}

static tyn_result read_one(tyn_scene *scene, const json_doc *doc, const cJSON *from,
                           tyn_phase *phase)
{
    char path[PATH_ROOM], of[2 * PATH_ROOM];
    tyn_phase_form form = {0};
    tyn_phase_lobe lobes[TYN_MAX_PHASE_LOBES];
    double *numbers[3] = {NULL};
    if (!cJSON_IsObject(from)) {
        return tyn_json_fault(doc, from, "must be an object");
    }
    tyn_json_path(doc, from, path, sizeof path);
    snprintf(of, sizeof of, "%s: %s", doc->file, path);
    tyn_result r = read_form(doc, from, &form, lobes, numbers);
    r = r ? r : tyn_scene_add_phase(scene, &form, of, phase, doc->log);
    for (int i = 0; i < 3; i++) {
        free(numbers[i]);
    }
    return r;
}

tyn_result tyn_gltf_read_phase(tyn_scene *scene, const json_doc *doc, const cJSON *medium,
                               tyn_phase phase[3])
{
    const cJSON *from = tyn_json_member(medium, "phase");
    if (!from) {
        return TYN_OK;
    }
    if (tyn_json_member(medium, "anisotropy")) {
        return tyn_json_fault(doc, from, "stands beside anisotropy: must be one of the two");
    }
    if (!cJSON_IsArray(from)) {
        TYN_TRY(read_one(scene, doc, from, &phase[0]));
        phase[1] = phase[2] = phase[0];
        return TYN_OK;
    }
    if (cJSON_GetArraySize(from) != 3) {
        return tyn_json_fault(doc, from, "must be an object, or three of them");
    }
    for (int c = 0; c < 3; c++) {
        TYN_TRY(read_one(scene, doc, cJSON_GetArrayItem(from, c), &phase[c]));
    }
    return TYN_OK;
}
