// path_scene.h -- the scene as kernels read it that follow paths (shaders/path): their parameters, refs and cost. Tier 7.
#pragma once
#include "job.h"
#include "shaders/path/path_scene.h"

#ifdef __cplusplus
extern "C" {
#endif

// Aimed at for a dispatch, nanoseconds; 50 ms is the limit on a software device.
#define TYN_PATH_DISPATCH_NS 20e6

// All but settings, `threads` and what single passes add.
TYN_API void tyn_path_scene(const tyn_job *job, tyn_path_params *params);
// The bundle TYN_PATH_SCENE, which begins the ports of each of these passes. `bricks`: of the medium; {0} without one.
TYN_API void tyn_connect_path_scene(tyn_ref *refs, const tyn_job *job, tyn_ref bricks);
// Will method path ask for images by which its paths are guided (tyn_scene_refs.guide)?
TYN_API bool tyn_path_wants_guide(const tyn_job *job);
// Nanoseconds of a path on two cores of a software device, about.
TYN_API double tyn_path_cost_ns(const tyn_job *job, bool homogeneous);

#ifdef __cplusplus
}
#endif
