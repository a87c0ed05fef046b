// env_cdf.h -- the table by which `path` draws directions towards an environment map.
//
// Layout: struct env_table_block, then width * height of struct env_cell (shaders/light/env_args.h).
#pragma once
#include <tyndall/scene.h>

// Bytes of the table; 0 if the environment is absent or constant, which needs none.
size_t tyn_env_cdf_size(const tyn_environment *environment);

// Fills `table` (tyn_env_cdf_size bytes). Deterministic: the same map gives the same bytes. Depends on
// `size` and `data` alone, not on rotation, tint or strength. False if out of memory.
bool tyn_env_cdf_build(const tyn_environment *environment, void *table);
