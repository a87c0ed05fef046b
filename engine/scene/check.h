// check.h -- the parts of tyn_scene_check: what is cheap enough for every frame, and what is not.
// Surfaces are checked apart (scene/surfaces.h), where they are made ready for the GPU.
#pragma once
#include <tyndall/scene.h>

tyn_result tyn_scene_check_values(const tyn_scene *scene, const tyn_log *log); // all but the data
tyn_result tyn_scene_check_data(const tyn_scene *scene,
                                const tyn_log *log); // every voxel and texel
// What only some kinds of lights have.
tyn_result tyn_light_check_lobe(const tyn_light *light, uint32_t index, const tyn_log *log);
tyn_result tyn_camera_check(const tyn_camera *camera, uint32_t index, const tyn_log *log);
