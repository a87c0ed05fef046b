// gltf_light.c -- lights of KHR_lights_punctual.
#include "io/gltf_light.h"
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static const double quarter_pi = 0.785398163397448310;

static tyn_result read_cones(tyn_light *light, const json_doc *doc, const cJSON *spot)
{
    double inner = 0, outer = quarter_pi;
    TYN_TRY(tyn_json_number(doc, spot, "innerConeAngle", 0, 2 * quarter_pi, "0 to pi/2", &inner));
    TYN_TRY(tyn_json_number(doc, spot, "outerConeAngle", 0, 2 * quarter_pi + 1e-6, "0 to pi/2",
                            &outer));
    if (inner > outer) {
        return tyn_json_fault(doc, spot, "innerConeAngle %g must be <= outerConeAngle %g", inner,
                              outer);
    }
    light->cos_inner = (float)cos(inner);
    light->cos_outer = (float)cos(outer);
    return TYN_OK;
}

static tyn_result refuse_kind(const json_doc *doc, const cJSON *element)
{
    char names[128] = "";
    size_t used = 0;
    const tyn_light_traits *traits;
    for (int kind = 0; (traits = tyn_light_traits_of((tyn_light_kind)kind)); kind++) {
        used += (size_t)snprintf(names + used, sizeof names - used, "%s\"%s\"", kind ? ", " : "",
                                 traits->name);
    }
    return tyn_json_fault(doc, element, "type must be one of %s", names);
}

tyn_result tyn_gltf_read_light(tyn_light *light, const json_doc *doc, const cJSON *element)
{
    const char *type = "";
    cJSON *spot;
    double color[3] = {1, 1, 1}, intensity = 1;
    *light = (tyn_light){.kind = TYN_LIGHT_DIRECTIONAL};
    TYN_TRY(tyn_json_string(doc, element, "type", &type));
    const tyn_light_traits *traits = tyn_light_traits_of(light->kind);
    while (traits && strcmp(type, traits->name) != 0) {
        traits = tyn_light_traits_of(++light->kind);
    }
    if (!traits) {
        return refuse_kind(doc, element);
    }
    TYN_TRY(tyn_json_numbers(doc, element, "color", 3, 0, FLT_MAX, "a number >= 0", color));
    TYN_TRY(tyn_json_number(doc, element, "intensity", 0, FLT_MAX, "a number >= 0", &intensity));
    for (int a = 0; a < 3; a++) {
        light->color[a] = (float)(color[a] * intensity);
    }
    TYN_TRY(tyn_json_object(doc, element, "spot", &spot));
    if (!traits->has_cone) {
        return TYN_OK;
    }
    return spot ? read_cones(light, doc, spot)
                : tyn_json_fault(doc, element, "spot is missing: an object with its cone angles");
}
