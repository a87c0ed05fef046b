// gltf_animation.h -- where a glTF file's animations put its nodes at a time.
#pragma once
#include "io/gltf_accessor.h"

// All animations play at once; of two that move the same property of a node the later one counts. Before its first key and
// after its last one a property rests. The model's nodes are changed. A warning is left in the scene of what is not read: weights of
// morph targets.
tyn_result tyn_gltf_animate(gltf_model *model, double seconds, const gltf_data *data,
                            tyn_scene *scene);

// Warns that there are animations and no time was asked for.
void tyn_gltf_warn_of_animations(const json_doc *doc, tyn_scene *scene);
