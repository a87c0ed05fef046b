// rsm_bindings.glsl -- what both shaders of reflective shadow maps read.
#include "shaders/common/scene_args.h"
#include "rsm_draw_args.h"

#define GEOMETRY_AT 0
#include "shaders/surfaces/surfaces.glsl"
TYN_ARGS(rsm_draw_args args);
