// path_scene.h -- the scene as kernels read it that follow paths (shaders/path): their parameters, refs and cost. Tier 7.
#pragma once
#include "dispatch_sizes.h"
#include "job.h"
#include "shaders/path/path_scene.h"

#ifdef __cplusplus
extern "C" {
#endif

// All but settings, `threads` and what single passes add.
TYN_API void tyn_path_scene(const tyn_job *job, tyn_path_params *params);
// The bundle TYN_PATH_SCENE, which begins the ports of each of these passes. `bricks`: of the medium; {0} without one.
TYN_API void tyn_connect_path_scene(tyn_ref *refs, const tyn_job *job, tyn_ref bricks);
// Will method path ask for images by which its paths are guided (tyn_scene_refs.guide)?
TYN_API bool tyn_path_wants_guide(const tyn_job *job);
// Nanoseconds of a path where the device is kept busy, foretold: about right on two cores of a software device, on a card some times
// too many.
TYN_API double tyn_path_cost_ns(const tyn_job *job, bool homogeneous);
// Nanoseconds that a dispatch is to take.
TYN_API double tyn_path_dispatch_ns(const tyn_job *job);

#ifdef __cplusplus
}
#endif
