// sources.h -- what shines (tyndall/extend/sources.h), with the passes of the library that make it.
#pragma once
#include <tyndall/extend/sources.h>
#include "passes/methods/light/passes.h"

// Do surfaces reach beyond the medium's box by more than so many of its longest side?
bool tyn_reach_beyond(const tyn_frame_scene *frame, float sides);
