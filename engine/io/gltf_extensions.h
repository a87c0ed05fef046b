// gltf_extensions.h -- which extensions of glTF are understood, and what is said of the others.
#pragma once
#include "io/json.h"

// A fault where a file requires an extension that is not understood; what unpacks it, where something does.
tyn_result tyn_gltf_check_required(const json_doc *doc);

// Warns of what stands in the document and is not understood, once an extension.
void tyn_gltf_warn_extensions(tyn_scene *scene, const json_doc *doc);
