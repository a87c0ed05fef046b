// bare.h -- a scene around a volume that comes without one.
#pragma once
#include <tyndall/io.h>

// Takes the volume over. With an `environment` (may be NULL) that lights the volume; without one
// there is a sun and a sky. See docs/scene-format.md, "A volume alone".
tyn_result tyn_bare_scene(tyn_scene *scene, tyn_volume *volume, const char *environment,
                          const tyn_log *log);
