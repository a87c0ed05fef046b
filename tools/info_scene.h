// info_scene.h -- what is in a scene and which methods suit it, for people and as JSON.
#pragma once
#include "app.h"
#include "fronts.h"
#include "regime_limits.h"

// Every grid of the .vdb and .nvdb files of a scene, or of such a file itself; `frame` as of tyn_scene_files.
typedef struct info_grids info_grids;
info_grids *info_grids_read(const char *scene, const uint32_t *frame);
bool info_grids_failed(const info_grids *grids); // a file is damaged, or not there
// Is the list of use where no scene can be made? Of a volume file with sound grids of numbers, none of which is a density.
bool info_grids_wanted(const char *scene, const info_grids *grids);
void info_grids_print(const info_grids *grids);
void info_grids_json(const info_grids *grids, cJSON *root); // "files": [{"path", "grids": [...]}]
void info_grids_free(info_grids *grids);

void info_print_scene(const tyn_scene *scene);
void info_print_regime(const regime *r);

// What each method as it is (path: for 5 %) is likely to miss and to take here, after the measured scenes
// nearest in regime; times are those of the device that was measured.
void info_print_outlook(const fronts *f, const regime *r, uint32_t width, uint32_t height);
cJSON *info_json_outlook(const fronts *f, const regime *r, uint32_t width, uint32_t height);

// {"scene": path, "media": [...], "lights": [...], "cameras": [...], ..., "regime": {...}, "methods": [...]}
cJSON *info_json_scene(const char *path, const tyn_scene *scene, const regime *r);
