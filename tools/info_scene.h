// info_scene.h -- what is in a scene and which methods suit it, for people and as JSON.
#pragma once
#include "app.h"
#include "regime_advice.h"

void info_print_scene(const tyn_scene *scene);
void info_print_regime(const regime *r);

// {"scene": path, "media": [...], "lights": [...], "cameras": [...], ..., "regime": {...}, "methods": [...]}
cJSON *info_json_scene(const char *path, const tyn_scene *scene, const regime *r);
