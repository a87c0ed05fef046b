// env_suns.h -- finds the suns of an environment map (tyndall/extend/map_light.h).
#pragma once
#include <tyndall/extend/map_light.h>
#include <tyndall/scene.h>

// Looks at `size` and `data` alone. Texels that are negative or not finite count as 0. A constant
// environment or none has mean 0 and no suns. Deterministic. False if out of memory.
bool tyn_map_light_find(const tyn_environment *environment, tyn_map_light *out);
