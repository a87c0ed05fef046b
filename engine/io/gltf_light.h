// gltf_light.h -- lights of KHR_lights_punctual.
#pragma once
#include "io/json.h"

// What the light of an element of `lights` is, but for its name and place. Every fault of it is logged.
tyn_result tyn_gltf_read_light(tyn_light *light, const json_doc *doc, const cJSON *element);
