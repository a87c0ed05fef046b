// info_scene.h -- what is in a scene and which methods suit it, for people and as JSON.
#pragma once
#include "app.h"
#include "fronts.h"
#include "regime_limits.h"

void info_print_scene(const tyn_scene *scene);
void info_print_regime(const regime *r);

// What each method as it is (path: for 5 %) is likely to miss and to take here, after the measured scenes
// nearest in regime; times are those of the device that was measured.
void info_print_outlook(const fronts *f, const regime *r, uint32_t width, uint32_t height);
cJSON *info_json_outlook(const fronts *f, const regime *r, uint32_t width, uint32_t height);

// {"scene": path, "media": [...], "lights": [...], "cameras": [...], ..., "regime": {...}, "methods": [...]}
cJSON *info_json_scene(const char *path, const tyn_scene *scene, const regime *r);
